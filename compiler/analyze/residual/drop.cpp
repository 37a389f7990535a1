#include "analyze/residual/drop.h"

#include <algorithm>

namespace lobe::analyze {

std::vector<DroppedEffects> drop_effects(SceneFacts& facts, const ir::Module& module,
                                         double epsilon, const CertificateOptions& options)
{
    std::vector<DroppedEffects> out;
    for (const std::vector<std::size_t>& group : by_effects(facts)) {
        const auto& calls = facts.materials[group.front()].calls;
        if (std::ranges::count(calls, true) == 0) continue;
        auto found = droppable(module, facts.model, facts.called(group), epsilon, options);
        if (!found.empty()) out.push_back({group, std::move(found)});
    }
    for (const DroppedEffects& dropped : out)
        for (std::size_t i = 0; i < facts.effects.size(); ++i) {
            EffectFact& effect = facts.effects[i];
            const auto same = [&](const Dropped& each) { return each.effect == effect.name; };
            if (std::ranges::none_of(dropped.effects, same)) continue;
            for (const std::size_t m : dropped.materials) facts.materials[m].calls[i] = false;
            std::erase_if(effect.materials, [&](std::size_t m) {
                return std::ranges::binary_search(dropped.materials, m);
            });
            if (!effect.materials.empty()) continue;
            effect.is_on = false;
            effect.why = "within epsilon: " + effect.why;
        }
    return out;
}

std::vector<Dropped> dropped_in(const Variant& variant, const std::vector<DroppedEffects>& dropped)
{
    std::vector<Dropped> out;
    for (const DroppedEffects& group : dropped) {
        const bool serves = std::ranges::any_of(group.materials, [&](std::size_t m) {
            return std::ranges::binary_search(variant.materials, m);
        });
        if (!serves) continue;
        for (const Dropped& each : group.effects) {
            if (std::ranges::count(variant.residual.off, each.effect) == 0) continue;
            const auto known = std::ranges::find(out, each.effect, &Dropped::effect);
            if (known == out.end()) {
                out.push_back(each);
                continue;
            }
            known->bound = std::max(known->bound, each.bound);
            known->observed = std::max(known->observed, each.observed);
        }
    }
    return out;
}

}  // namespace lobe::analyze
