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
    ir::Module known = lights_module(sources);
    std::erase_if(known.lights, [&](const ir::Model& light) {
        return std::ranges::find(lights, light.name) == lights.end();
    });
    return ir::join_lights(checked, known, model);
}

}  // namespace lobe
