#include "analyze/residual/ladder.h"

#include "optimize/optimize.h"
#include "optimize/residual.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

std::vector<std::string> effects_left(const ir::Module& module, const optimize::Residual& residual)
{
    std::vector<std::string> out;
    for (const ir::Effect& effect : module.effects)
        if (std::ranges::count(residual.off, effect.name) == 0) out.push_back(effect.name);
    return out;
}

CostSubject outputs_of(const ir::Module& module)
{
    CostSubject subject{&module, {}, Format::float32, true};
    for (const ir::ModelOutput& output : module.models.front().outputs)
        subject.functions.push_back(output.function);
    return subject;
}

}  // namespace

Ladder ladder(const ir::Module& module, const std::string& model, const Sources& sources,
              std::span<const LadderScene> scenes, std::span<const LadderReference> references,
              const CostOptions& options, const Store& store)
{
    Ladder out;
    out.module = module.name;
    out.model = model;
    std::vector<ir::Module> modules;  // general, scenes, references
    const auto add = [&](const ir::Module& of, const optimize::Called& called,
                         const std::string& name, const std::string& model_name) {
        const optimize::Residual residual = optimize::residual(of, called, model_name);
        modules.push_back(optimize::optimize(residual.module));
        return Rung{name, effects_left(of, residual), {}};
    };
    out.general = add(module, {}, "everything, for any scene", model);
    for (const LadderScene& scene : scenes)
        out.scenes.push_back(add(module, scene.facts.called(), scene.name, model));
    for (const LadderReference& reference : references)
        out.references.push_back(add(*reference.module, {}, reference.name, reference.model));

    std::vector<CostSubject> subjects;
    for (const ir::Module& each : modules) subjects.push_back(outputs_of(each));
    out.about = measure_costs(subjects, sources, options, store);
    auto cost = out.about.costs.begin();
    out.general.cost = *cost++;
    for (Rung& rung : out.scenes) rung.cost = *cost++;
    for (Rung& rung : out.references) rung.cost = *cost++;
    out.about.costs.clear();
    return out;
}

}  // namespace lobe::analyze
