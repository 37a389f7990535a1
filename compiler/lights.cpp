#include "lights.h"

#include "base/embedded.h"
#include "compile.h"
#include "ir/shade.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace lobe {
namespace {

/// models/lights.lobe, checked. It is ours, so it has no errors.
ir::Module lights_module(Sources& sources)
{
    const Embedded& file = embedded_lights().front();
    const std::string path = "models/" + std::string{file.name};
    const std::uint32_t root = sources.add(path, std::string{file.text});
    Diagnostics diagnostics;
    const auto imports_none = [](Sources&, std::string_view, std::string_view) {
        return std::optional<std::uint32_t>{};
    };
    std::optional<ir::Module> module = front(sources, root, imports_none, diagnostics);
    assert(module);
    return *std::move(module);
}

}  // namespace

const std::vector<std::string>& light_names()
{
    static const std::vector<std::string> names = [] {
        Sources sources;
        std::vector<std::string> result;
        for (const ir::Model& light : lights_module(sources).lights) result.push_back(light.name);
        return result;
    }();
    return names;
}

ir::Module with_lights(const ir::Module& checked, const std::vector<std::string>& lights,
                       Sources& sources, std::string_view model)
{
    std::map<std::string, optimize::Called> known;
    for (const std::string& light : lights) known[light];
    return with_lights(checked, known, sources, model);
}

ir::Module with_lights(const ir::Module& checked,
                       const std::map<std::string, optimize::Called>& lights, Sources& sources,
                       std::string_view model)
{
    ir::Module known = lights_module(sources);
    std::erase_if(known.lights,
                  [&](const ir::Model& light) { return !lights.contains(light.name); });
    // Outputs are named apart, and no other function takes an emitter.
    std::map<std::string, const optimize::Called*> of_output;
    bool is_general = true;
    for (const ir::Model& light : known.lights) {
        const optimize::Called& emitter = lights.at(light.name);
        is_general = is_general && emitter.constants.empty() && emitter.ranges.empty();
        for (const ir::ModelOutput& output : light.outputs)
            of_output[known[output.function].name] = &emitter;
    }
    if (is_general) return ir::join_lights(checked, known, model);

    const auto emitter_of = [&](const ir::Function& function, const ir::Input& input) {
        const auto found = of_output.find(function.name);
        const bool is_field = input.origin == ir::Origin::emitter;
        return is_field && found != of_output.end() ? found->second : nullptr;
    };
    const auto in = [](const auto& values, const std::string& name) {
        const auto found = values.find(name);
        return found == values.end() ? nullptr : &found->second;
    };
    known = optimize::specialize_where(
        known,
        [&](const ir::Function& function, const ir::Input& input) -> const std::vector<double>* {
            const optimize::Called* const emitter = emitter_of(function, input);
            return emitter == nullptr ? nullptr : in(emitter->constants, input.name);
        });
    known = optimize::narrow_where(
        known, [&](const ir::Function& function, const ir::Input& input) -> const ir::Range* {
            const optimize::Called* const emitter = emitter_of(function, input);
            return emitter == nullptr ? nullptr : in(emitter->ranges, input.name);
        });
    return ir::join_lights(checked, known, model);
}

}  // namespace lobe
