#include "analyze/residual/parameters.h"

#include "analyze/residual/reach.h"
#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace lobe::analyze {
namespace {

using ir::Parameter;
using ir::Range;

const Parameter* find_parameter(const ir::Module& module, const std::string& name)
{
    const auto found = std::ranges::find(module.parameters, name, &Parameter::name);
    return found == module.parameters.end() ? nullptr : &*found;
}

std::string listed(const Range& range) { return fmt::format("[{}, {}]", range.low, range.high); }

std::string default_of(const Parameter& parameter)
{
    const auto& value = parameter.default_value;
    return value.size() == 1 ? fmt::format("{}", value[0])
                             : fmt::format("({})", fmt::join(value, ", "));
}

/// What is wrong with the values of a parameter, or an empty message.
scene::Complaint complaint_of(const Parameter& parameter, const scene::Value& value,
                              const Reach& found)
{
    scene::Complaint out{true, value.pointer, {}, {}};
    const std::size_t size = parameter.default_value.size();
    if (found.components.size() != size) {
        out.message = fmt::format("`{}` takes {} number{}; here are {}", parameter.name, size,
                                  size == 1 ? "" : "s", found.components.size());
        return out;
    }
    if (!found.is_finite) {
        out.message = fmt::format("`{}` is not finite", parameter.name);
        return out;
    }
    const Range& declared = parameter.range;
    out.help = fmt::format("`{}` is declared in {}; its default is {}", parameter.name,
                           listed(declared), default_of(parameter));
    for (const Range& range : found.components)
        for (const double end : {range.low, range.high}) {
            if (end >= declared.low && end <= declared.high) continue;
            out.message =
                range.low == range.high
                    ? fmt::format("{} is outside of {}", end, listed(declared))
                    : fmt::format("it reaches {}, which is outside of {}", end, listed(declared));
            return out;
        }
    const bool is_whole =
        parameter.quantity == ir::Quantity::integer || parameter.quantity == ir::Quantity::boolean;
    for (const Range& range : found.components)
        if (is_whole && range.low == range.high && range.low != std::floor(range.low)) {
            out.message = fmt::format("`{}` is a whole number; got {}", parameter.name, range.low);
            return out;
        }
    return out;
}

InputFact fact_of(const Parameter& parameter, const scene::Value& value, const Reach& found)
{
    InputFact fact;
    fact.components = found.in_floats;
    for (Range& range : fact.components)
        range = {std::clamp(range.low, parameter.range.low, parameter.range.high),
                 std::clamp(range.high, parameter.range.low, parameter.range.high)};
    fact.is_binary = found.is_binary;
    fact.called_by = value.pointer;
    fact.is_default = fact.is_constant() && fact.value() == parameter.default_value;
    return fact;
}

/// The extension that a property is of, and the property that switches it on.
struct Extension {
    std::string_view prefix;
    std::string_view name;
    std::string_view switched_by;
    double off;
};
constexpr std::array extensions{
    Extension{"clearcoat", "KHR_materials_clearcoat", "clearcoat", 0},
    Extension{"sheen", "KHR_materials_sheen", "sheen_color", 0},
    Extension{"transmission", "KHR_materials_transmission", "transmission", 0},
    Extension{"thickness", "KHR_materials_volume", "thickness", 0},
    Extension{"attenuation", "KHR_materials_volume", "thickness", 0},
    Extension{"iridescence", "KHR_materials_iridescence", "iridescence", 0},
    Extension{"anisotropy", "KHR_materials_anisotropy", "anisotropy", 0},
    Extension{"dispersion", "KHR_materials_dispersion", "dispersion", 0},
};

/// The extension does something in this material: what switches it on is not off everywhere.
bool does_something(const scene::Scene& scene, const scene::Material& material,
                    const Extension& extension)
{
    const auto found = material.extensions.find(std::string{extension.switched_by});
    if (found == material.extensions.end()) return false;  // the format's defaults are off
    return !std::ranges::all_of(reach(scene, found->second).components, [&](const Range& range) {
        return range.low == extension.off && range.high == extension.off;
    });
}

bool is_of_surface(const std::string& name)
{
    return name == "ior" || name.starts_with("specular");
}

}  // namespace

bool InputFact::is_constant() const
{
    return std::ranges::all_of(components, [](const Range& r) { return r.low == r.high; });
}

std::vector<double> InputFact::value() const
{
    std::vector<double> out;
    for (const Range& range : components) out.push_back(range.low);
    return out;
}

std::string in_words(const InputFact& fact)
{
    if (fact.is_constant()) {
        std::string all;
        for (const double value : fact.value())
            all += fmt::format("{}{:.6g}", all.empty() ? "" : ", ", value);
        return fact.components.size() == 1 ? all : "(" + all + ")";
    }
    if (fact.is_binary) return "0 or 1";
    Range range = fact.components.front();
    for (const Range& component : fact.components) range = hull(range, component);
    range = in_digits(range);
    return fmt::format("in [{}, {}]", range.low, range.high);
}

std::map<std::string, InputFact> default_facts(const ir::Module& module)
{
    std::map<std::string, InputFact> out;
    for (const Parameter& parameter : module.parameters) {
        InputFact& fact = out[parameter.name];
        for (const double value : parameter.default_value)
            fact.components.push_back({value, value});
        fact.is_default = true;
        fact.is_binary =
            std::ranges::all_of(parameter.default_value, [](double v) { return v == 0 || v == 1; });
    }
    return out;
}

std::map<std::string, InputFact> given_parameters(const scene::Scene& scene,
                                                  const scene::Material& material,
                                                  const ir::Module& module,
                                                  std::vector<scene::Complaint>& complaints)
{
    std::map<std::string, InputFact> out;
    const auto take = [&](const std::string& name, const scene::Value& value) {
        const Parameter* const parameter = find_parameter(module, name);
        if (!parameter) return false;
        const Reach found = reach(scene, value);
        scene::Complaint complaint = complaint_of(*parameter, value, found);
        if (complaint.message.empty())
            out[name] = fact_of(*parameter, value, found);
        else
            complaints.push_back(std::move(complaint));
        return true;
    };
    for (const auto& [name, value] : material.extensions)
        if (!material.parameters.contains(name)) take(name, value);
    for (const auto& [name, value] : material.parameters) {
        if (take(name, value)) continue;
        std::vector<std::string> names;
        for (const Parameter& parameter : module.parameters) names.push_back(parameter.name);
        const auto near = nearest(name, names);
        complaints.push_back({true, value.pointer,
                              fmt::format("`{}` has no parameter `{}`", module.name, name),
                              near ? fmt::format("did you mean `{}`?", *near) : ""});
    }
    return out;
}

std::vector<std::string> not_modeled(const scene::Scene& scene, const scene::Material& material,
                                     const ir::Module& module)
{
    std::vector<std::string> out;
    for (const auto& [property, value] : material.extensions) {
        if (is_of_surface(property) || find_parameter(module, property)) continue;
        for (const Extension& extension : extensions) {
            const std::string name{extension.name};
            if (property.starts_with(extension.prefix) && std::ranges::count(out, name) == 0 &&
                does_something(scene, material, extension))
                out.push_back(name);
        }
    }
    return out;
}

}  // namespace lobe::analyze
