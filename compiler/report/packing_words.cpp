// Errors in words: a percentage, and the input that reaches it.
#include "report/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::report {
namespace {

std::string short_value(double number) { return fmt::format("{:.4g}", number); }

struct Vector {
    double x = 0, y = 0, z = 0;
};

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double length_of(const Vector& a) { return std::sqrt(dot(a, a)); }

double degrees_between(const Vector& a, const Vector& b)
{
    const double cosine = dot(a, b) / (length_of(a) * length_of(b));
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

/// What is left of `a` in the plane of a unit vector.
Vector flattened(const Vector& a, const Vector& unit)
{
    const double along = dot(a, unit);
    return {a.x - along * unit.x, a.y - along * unit.y, a.z - along * unit.z};
}

using Values = std::vector<std::pair<std::string, double>>;

/// `l.x`, `l.y`, `l.z` of a direction, if all are there.
std::optional<Vector> find_direction(const Values& values, const std::string& name)
{
    const auto component = [&](const char* suffix) -> std::optional<double> {
        for (const auto& [input, number] : values)
            if (input == name + suffix) return number;
        return std::nullopt;
    };
    const auto x = component(".x"), y = component(".y"), z = component(".z");
    if (!x || !y || !z) return std::nullopt;
    return Vector{*x, *y, *z};
}

/// `light 80 and view 75 degrees from the normal, 180 apart around it`
std::string directions_in_words(const Values& inputs)
{
    const auto l = find_direction(inputs, "l"), v = find_direction(inputs, "v");
    const Vector n = find_direction(inputs, "n").value_or(Vector{0, 0, 1});
    std::string out;
    if (l) out += fmt::format("light {:.4g}", degrees_between(*l, n));
    if (v) out += fmt::format("{}view {:.4g}", l ? " and " : "", degrees_between(*v, n));
    if (out.empty()) return out;
    out += " degrees from the normal";
    if (!l || !v) return out;
    const Vector flat_l = flattened(*l, n), flat_v = flattened(*v, n);
    // Along the normal there is no side to be on.
    constexpr double least = 1e-6;
    if (length_of(flat_l) < least || length_of(flat_v) < least) return out;
    return out + fmt::format(", {:.4g} apart around it", degrees_between(flat_l, flat_v));
}

bool is_component(std::string_view name) { return name.size() > 2 && name[name.size() - 2] == '.'; }

/// `roughness 0.3`, `base_color (0.8, 0.7, 0.6)`: components of one input together.
std::vector<std::string> in_groups(const Values& values)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < values.size();) {
        const std::string& name = values[i].first;
        if (!is_component(name)) {
            out.push_back(fmt::format("{} {}", name, short_value(values[i].second)));
            ++i;
            continue;
        }
        const std::string base = name.substr(0, name.size() - 2);
        std::string list;
        const std::size_t first = i;
        for (; i < values.size() && is_component(values[i].first) &&
               values[i].first.substr(0, values[i].first.size() - 2) == base;
             ++i)
            list += (list.empty() ? "" : ", ") + short_value(values[i].second);
        out.push_back(i - first == 1 ? fmt::format("{} {}", name, list)
                                     : fmt::format("{} ({})", base, list));
    }
    return out;
}

std::optional<double> find(const Values& values, std::string_view name)
{
    for (const auto& [other, number] : values)
        if (other == name) return number;
    return std::nullopt;
}

/// The default of a parameter, by the name that a witness has for it.
std::optional<double> default_of(const ir::Module& module, std::string_view name)
{
    for (const ir::Parameter& parameter : module.parameters) {
        if (parameter.name == name && parameter.default_value.size() == 1)
            return parameter.default_value.front();
        if (name.size() != parameter.name.size() + 2 || !name.starts_with(parameter.name)) continue;
        const std::size_t component = std::string_view{"rgba"}.find(name.back());
        if (component < parameter.default_value.size()) return parameter.default_value[component];
    }
    return std::nullopt;
}

bool is_direction(std::string_view name)
{
    return is_component(name) && std::string_view{"lvnxy"}.find(name.front()) != name.npos &&
           name.size() == 3;
}

}  // namespace

std::string percent(double fraction)
{
    const double number = 100 * fraction;
    if (number == 0) return "0 %";
    if (!std::isfinite(number)) return "unbounded";
    if (number >= 1e5) return fmt::format("{:.3g} %", number);
    if (number >= 100) return fmt::format("{:.0f} %", number);
    if (number >= 10) return fmt::format("{:.3g} %", number);
    if (number >= 0.01) return fmt::format("{:.2g} %", number);
    return fmt::format("{:.0e} %", number);
}

std::string in_words(const Packed& packed, const analyze::RadianceWitness& witness)
{
    // What the packing changes, then where; what is at its default is what a reader expects.
    std::vector<std::string> changed, others;
    for (const auto& [name, stored] : witness.stored) {
        const double exact = find(witness.inputs, name).value_or(stored);
        if (exact != stored)
            changed.push_back(
                fmt::format("{} {} stored as {}", name, short_value(exact), short_value(stored)));
    }
    if (std::string directions = directions_in_words(witness.inputs); !directions.empty())
        others.push_back(std::move(directions));
    Values rest;
    for (const auto& [name, number] : witness.inputs) {
        if (is_direction(name) || default_of(*packed.module, name) == number) continue;
        if (find(witness.stored, name).value_or(number) == number) rest.emplace_back(name, number);
    }
    for (std::string& group : in_groups(rest)) others.push_back(std::move(group));

    std::string out;
    for (const std::string& part : changed) out += (out.empty() ? "" : ", ") + part;
    for (std::size_t i = 0; i < others.size(); ++i)
        out += (i > 0 ? "; " : out.empty() ? "at " : ", at ") + others[i];
    return out + fmt::format(": radiance {} becomes {}", short_value(witness.exact),
                             short_value(witness.packed));
}

}  // namespace lobe::report
