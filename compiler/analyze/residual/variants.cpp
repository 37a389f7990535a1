#include "analyze/residual/variants.h"

#include "analyze/residual/selection.h"
#include "analyze/tasks.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace lobe::analyze {
namespace {

using Effects = std::vector<bool>;  ///< which of a module's effects are called for

/// More are not priced: then only what materials call for, pairs of these, and all together.
constexpr std::size_t most_candidates = 256;

Effects joined(Effects a, const Effects& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] || b[i];
    return a;
}

bool includes(const Effects& all, const Effects& some) { return joined(all, some) == all; }

/// Every union of effects that materials call for.
std::set<Effects> unions_of(const std::vector<Effects>& called)
{
    Effects everything = called.front();
    for (const Effects& effects : called) everything = joined(everything, effects);
    std::set<Effects> unions(called.begin(), called.end());
    unions.insert(everything);
    for (const Effects& effects : called) {
        const std::set<Effects> before = unions;
        for (const Effects& known : before) {
            if (unions.size() >= most_candidates) return unions;
            unions.insert(joined(known, effects));
        }
    }
    return unions;
}

/// Materials by a key, in the order of the first of each.
template <class Key>
std::vector<std::vector<std::size_t>> grouped_by(const SceneFacts& facts, const Key& key)
{
    std::map<decltype(key(facts.materials.front())), std::size_t> index;
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t m = 0; m < facts.materials.size(); ++m) {
        const auto [known, is_new] = index.try_emplace(key(facts.materials[m]), groups.size());
        if (is_new) groups.emplace_back();
        groups[known->second].push_back(m);
    }
    return groups;
}

/// A part of a name: `Diffuse Fresnel` as `diffuse_fresnel`.
std::string snake(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (c >= 'A' && c <= 'Z')
            out += static_cast<char>(c - 'A' + 'a');
        else if (letter)
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (out.ends_with('_')) out.pop_back();
    return out;
}

/// A name of its own, as `taken` has it afterwards.
std::string unique(const std::string& name, std::set<std::string>& taken)
{
    std::string out = name;
    for (int number = 2; !taken.insert(out).second; ++number)
        out = fmt::format("{}_{}", name, number);
    return out;
}

class Choice {
public:
    Choice(const ir::Module& module, const Sources& sources, const SceneFacts& facts,
           const VariantOptions& options, const Store& store)
        : module_{module}, sources_{sources}, facts_{facts}, options_{options}, store_{store}
    {
    }

    Variants run()
    {
        Shader general;
        general.residual = optimize::residual(module_, {}, facts_.model);
        if (options_.per_material)
            choose_per_material(general);
        else
            choose_by_effects(general);
        out_.general = general.cost;
        for (const Variant& variant : out_.chosen)
            out_.cycles += variant.coverage * price_of(variant.cost, options_.family);
        std::ranges::sort(out_.chosen, [](const Variant& a, const Variant& b) {
            return a.coverage != b.coverage ? a.coverage > b.coverage : a.name < b.name;
        });
        return std::move(out_);
    }

private:
    struct Shader {
        optimize::Called called;
        optimize::Residual residual;
        Cost cost;
    };

    Shader shader_for(const std::vector<std::size_t>& materials, SurfaceUse surface) const
    {
        Shader shader;
        shader.called = facts_.called(materials, surface);
        shader.residual = optimize::residual(module_, shader.called, facts_.model);
        return shader;
    }

    void measure(const std::vector<Shader*>& shaders)
    {
        std::vector<ir::Module> modules(shaders.size());
        for_each_task(shaders.size(), options_.jobs, [&](std::size_t i) {
            modules[i] = optimize::optimize(shaders[i]->residual.module);
        });
        std::vector<CostSubject> subjects;
        for (const ir::Module& each : modules) {
            CostSubject subject{&each, {}, Format::float32, true};
            for (const ir::ModelOutput& output : each.models.front().outputs)
                subject.functions.push_back(output.function);
            subjects.push_back(std::move(subject));
        }
        CostOptions options;
        options.families = {options_.family};
        options.jobs = options_.jobs;
        const Costs costs = measure_costs(subjects, sources_, options, store_);
        for (std::size_t i = 0; i < shaders.size(); ++i) shaders[i]->cost = costs.costs[i];
        out_.no_statistics = costs.no_statistics;
        out_.driver = costs.driver;
    }

    void choose_by_effects(Shader& general)
    {
        groups_ = by_effects(facts_);
        std::vector<Effects> called;
        for (const auto& group : groups_) called.push_back(facts_.materials[group.front()].calls);

        // Candidates: every union, at the price of a shader for all that it could serve.
        const std::set<Effects> unions = unions_of(called);
        Selection selection;
        std::vector<std::vector<std::size_t>> servable;
        for (const Effects& effects : unions) {
            std::vector<bool>& serves = selection.serves.emplace_back();
            std::vector<std::size_t>& groups = servable.emplace_back();
            for (std::size_t g = 0; g < groups_.size(); ++g) {
                serves.push_back(includes(effects, called[g]));
                if (serves.back()) groups.push_back(g);
            }
        }
        std::vector<Shader*> wanted{&general};
        for (const auto& groups : servable) want(groups, wanted);
        measure_wanted(wanted);
        for (const auto& groups : servable)
            selection.prices.push_back(price_of(known_.at(groups).cost, options_.family));
        for (const auto& group : groups_) selection.weights.push_back(coverage_of(group));

        const std::vector<Selected> best = cheapest(selection, options_.most);
        out_.candidates = unions.size();
        conclude(best, unions);
    }

    /// The shaders that serve what they are chosen for and nothing else, for each point of the
    /// frontier.
    void conclude(const std::vector<Selected>& best, const std::set<Effects>& unions)
    {
        std::vector<std::map<std::size_t, std::vector<std::size_t>>> served(best.size());
        std::vector<Shader*> wanted;
        for (std::size_t i = 0; i < best.size(); ++i) {
            out_.is_proved = out_.is_proved && best[i].is_proved;
            for (std::size_t g = 0; g < groups_.size(); ++g)
                served[i][best[i].of_group[g]].push_back(g);
            for (const auto& [candidate, groups] : served[i]) want(groups, wanted);
        }
        measure_wanted(wanted);
        for (const auto& by_candidate : served) {
            double cycles = 0;
            for (const auto& [candidate, groups] : by_candidate)
                cycles += coverage_of(materials_of(groups)) *
                          price_of(known_.at(groups).cost, options_.family);
            out_.frontier.push_back({by_candidate.size(), cycles});
        }
        std::set<std::string> names;
        const std::vector<Effects> effects(unions.begin(), unions.end());
        for (const auto& [candidate, groups] : served.back()) {
            const Shader& shader = known_.at(groups);
            add(unique(name_of(effects[candidate]), names), materials_of(groups), shader);
        }
    }

    void choose_per_material(Shader& general)
    {
        std::vector<Shader> shaders(facts_.materials.size());
        for_each_task(shaders.size(), options_.jobs,
                      [&](std::size_t i) { shaders[i] = shader_for({i}, SurfaceUse::fixed); });
        std::vector<std::vector<std::size_t>> sharing;
        for (std::size_t i = 0; i < shaders.size(); ++i) {
            const auto same = std::ranges::find_if(sharing, [&](const auto& materials) {
                return optimize::same_graphs(shaders[materials.front()].residual.module,
                                             shaders[i].residual.module);
            });
            if (same == sharing.end())
                sharing.push_back({i});
            else
                same->push_back(i);
        }
        std::vector<Shader*> wanted{&general};
        for (const auto& materials : sharing) wanted.push_back(&shaders[materials.front()]);
        measure(wanted);
        std::set<std::string> names;
        for (const auto& materials : sharing) {
            const Shader& shader = shaders[materials.front()];
            const std::string part = snake(facts_.materials[materials.front()].name);
            add(unique(facts_.model + "_" + (part.empty() ? "material" : part), names), materials,
                shader);
        }
    }

    void want(const std::vector<std::size_t>& groups, std::vector<Shader*>& wanted)
    {
        const auto [known, is_new] = known_.try_emplace(groups);
        if (is_new) wanted.push_back(&known->second);
    }

    void measure_wanted(const std::vector<Shader*>& wanted)
    {
        std::vector<const std::vector<std::size_t>*> groups;
        std::vector<Shader*> made;
        for (auto& [key, shader] : known_)
            if (std::ranges::count(wanted, &shader) > 0) {
                groups.push_back(&key);
                made.push_back(&shader);
            }
        for_each_task(made.size(), options_.jobs, [&](std::size_t i) {
            *made[i] = shader_for(materials_of(*groups[i]), SurfaceUse::shared);
        });
        if (!wanted.empty()) measure(wanted);
    }

    std::vector<std::size_t> materials_of(const std::vector<std::size_t>& groups) const
    {
        std::vector<std::size_t> out;
        for (const std::size_t g : groups)
            out.insert(out.end(), groups_[g].begin(), groups_[g].end());
        std::ranges::sort(out);
        return out;
    }

    double coverage_of(const std::vector<std::size_t>& materials) const
    {
        double sum = 0;
        for (const std::size_t m : materials) sum += facts_.materials[m].coverage;
        return sum;
    }

    /// By what is on, or, where that is most of it, by what is not.
    std::string name_of(const Effects& effects) const
    {
        std::string on, off;
        for (std::size_t i = 0; i < effects.size(); ++i)
            (effects[i] ? on : off) += "_" + snake(facts_.effects[i].name);
        if (on.empty()) return facts_.model + "_base";
        if (off.empty()) return facts_.model + "_full";
        return facts_.model + (on.size() <= off.size() + 8 ? on : "_without" + off);
    }

    void add(const std::string& name, const std::vector<std::size_t>& materials,
             const Shader& shader)
    {
        Variant variant;
        variant.name = name;
        variant.materials = materials;
        variant.called = shader.called;
        variant.residual = shader.residual;
        variant.cost = shader.cost;
        variant.coverage = coverage_of(materials);
        out_.chosen.push_back(std::move(variant));
    }

    const ir::Module& module_;
    const Sources& sources_;
    const SceneFacts& facts_;
    const VariantOptions& options_;
    const Store& store_;
    std::vector<std::vector<std::size_t>> groups_;
    std::map<std::vector<std::size_t>, Shader> known_;  ///< by indices of groups
    Variants out_;
};

}  // namespace

double price_of(const Cost& cost, Family family)
{
    return cost.families.empty() ? cost.spirv_instructions : issue_on(cost, family);
}

std::vector<std::vector<std::size_t>> by_effects(const SceneFacts& facts)
{
    return grouped_by(facts, [](const MaterialFacts& material) { return material.calls; });
}

std::vector<std::vector<std::size_t>> by_facts(const SceneFacts& facts)
{
    return grouped_by(facts, [](const MaterialFacts& material) {
        std::map<std::string, std::vector<double>> key;
        for (const auto& [name, fact] : material.inputs) {
            std::vector<double>& ends = key[name];
            for (const ir::Range& range : fact.components) {
                ends.push_back(range.low);
                ends.push_back(range.high);
            }
            ends.push_back(fact.is_binary ? 1 : 0);
        }
        return std::pair{material.calls, std::move(key)};
    });
}

ir::Module renamed(ir::Module module, const std::string& name)
{
    const std::string old = module.name;
    ir::Model& model = module.models.front();
    for (ir::Packing& packing : module.packings)
        if (packing.model.name == model.name && packing.model.module == old)
            packing.model.name = packing.model.module = name;
    for (ir::Engine& engine : module.engines)
        if (engine.model == model.name) engine.model = name;
    for (const ir::ModelOutput& output : model.outputs)
        module.functions[output.function.index].name = name + "_" + output.name;
    model.name = name;
    module.name = name;
    const auto rename = [&](std::string& of) {
        if (of == old) of = name;
    };
    for (ir::Function& function : module.functions) rename(function.module);
    for (ir::Parameter& parameter : module.parameters) rename(parameter.module);
    for (ir::Model& each : module.models) rename(each.module);
    for (ir::Packing& packing : module.packings) rename(packing.module);
    for (ir::Engine& engine : module.engines) rename(engine.module);
    return module;
}

Variants choose_variants(const ir::Module& module, const Sources& sources, const SceneFacts& facts,
                         const VariantOptions& options, const Store& store)
{
    return Choice{module, sources, facts, options, store}.run();
}

}  // namespace lobe::analyze
