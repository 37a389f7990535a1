#include "analyze/physics/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

using Value = EntryInputs::Value;
using Values = EntryInputs::Values;

/// Sets an input if the function has it, within its range.
void set(const EntryInputs& inputs, Values& values, std::string_view name, double to)
{
    const Value* value = inputs.find(name);
    if (value == nullptr) return;
    const Scalar& scalar = inputs.scalars()[value->first];
    EntryInputs::set(values, *value, std::clamp(to, scalar.low, scalar.high));
}

void append(std::string& text, std::string_view name, double value)
{
    text += fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", name, value);
}

bool is_rough(const EntryInputs& inputs)
{
    return inputs.find("roughness") != nullptr || inputs.find("alpha") != nullptr;
}

/// Every value neutral, with this roughness where there is one.
PhysicsSetting surface(const EntryInputs& inputs, double roughness)
{
    PhysicsSetting out{"", inputs.neutral()};
    if (!is_rough(inputs)) return out;
    set(inputs, out.values, "roughness", roughness);
    set(inputs, out.values, "alpha", roughness * roughness);
    append(out.text, "roughness", roughness);
    out.alpha = roughness * roughness;
    return out;
}

}  // namespace

std::vector<PhysicsSetting> surface_settings(const EntryInputs& inputs)
{
    std::vector<PhysicsSetting> out;
    for (const double roughness : {1. / 64, 0.1, 0.5, 1.0}) {
        if (!is_rough(inputs) && roughness < 1) continue;
        const PhysicsSetting plain = surface(inputs, roughness);
        if (inputs.find("metallic") == nullptr) {
            out.push_back(plain);
            continue;
        }
        for (const double metallic : {0.0, 1.0}) {
            PhysicsSetting& one = out.emplace_back(plain);
            set(inputs, one.values, "metallic", metallic);
            append(one.text, "metallic", metallic);
        }
    }
    return out;
}

std::vector<ParameterEnd> parameter_ends(const EntryInputs& inputs)
{
    const PhysicsSetting plain = surface(inputs, 0.5);
    std::vector<ParameterEnd> out;
    for (const Value& value : inputs.values()) {
        if (!value.parameter) continue;
        const Scalar& scalar = inputs.scalars()[value.first];
        for (const double end : {scalar.low, scalar.high}) {
            if (end == scalar.neutral) continue;
            ParameterEnd both{plain, plain};
            EntryInputs::set(both.alone.values, value, end);
            append(both.alone.text, value.name, end);
            for (const Value& other : inputs.values())
                if (other.parameter)
                    EntryInputs::set(both.with_others.values, other,
                                     inputs.scalars()[other.first].high);
            EntryInputs::set(both.with_others.values, value, end);
            append(both.with_others.text, value.name, end);
            both.with_others.text += ", other parameters at their upper ends";
            out.push_back(std::move(both));
        }
    }
    return out;
}

PhysicsSetting parameters_at_defaults(const EntryInputs& inputs, PhysicsSetting setting)
{
    for (const Value& value : inputs.values())
        for (std::size_t k = value.first; value.parameter && k < value.first + value.size; ++k)
            setting.values[k] = inputs.scalars()[k].neutral;
    return setting;
}

PhysicsSetting dielectric_setting(const EntryInputs& inputs, double roughness)
{
    PhysicsSetting out = surface(inputs, roughness);
    set(inputs, out.values, "f0", 0.04);
    set(inputs, out.values, "specular", 0.5);
    set(inputs, out.values, "metallic", 0);
    return out;
}

std::vector<WidthSetting> width_settings(const EntryInputs& inputs)
{
    // alpha, or what it is the square of; two of them where the lobe is stretched.
    const bool stretched = inputs.find("alpha_x") != nullptr && inputs.find("alpha_y") != nullptr;
    const bool squared =
        !stretched && inputs.find("alpha") == nullptr && inputs.find("roughness") != nullptr;
    constexpr double least = 0x1p-12;
    std::vector<std::array<double, 2>> widths;
    if (stretched)
        widths = {{0.3, 0.7}, {0.04, 0.25}, {least, 1}, {1, 1}};
    else if (inputs.find("alpha") != nullptr || squared)
        widths = {{least, least}, {0.04, 0.04}, {0.25, 0.25}, {0.7, 0.7}, {1, 1}};
    else
        widths = {{1, 1}};

    std::vector<WidthSetting> out;
    const auto add = [&](const std::array<double, 2>& width) -> WidthSetting& {
        WidthSetting& setting = out.emplace_back(WidthSetting{"", inputs.neutral()});
        setting.alpha_x = width[0];
        setting.alpha_y = width[1];
        if (stretched) {
            set(inputs, setting.values, "alpha_x", width[0]);
            set(inputs, setting.values, "alpha_y", width[1]);
            append(setting.text, "alpha_x", width[0]);
            append(setting.text, "alpha_y", width[1]);
        } else if (is_rough(inputs)) {
            set(inputs, setting.values, "alpha", width[0]);
            set(inputs, setting.values, "roughness", std::sqrt(width[0]));
            append(setting.text, squared ? "roughness" : "alpha",
                   squared ? std::sqrt(width[0]) : width[0]);
        }
        return setting;
    };
    for (const auto& width : widths) add(width);
    for (const Value& value : inputs.values()) {
        if (value.name.starts_with("alpha") || value.name == "roughness") continue;
        const Scalar& scalar = inputs.scalars()[value.first];
        for (const double end : {scalar.low, scalar.high}) {
            if (end == scalar.neutral) continue;
            WidthSetting& setting = add(widths.size() > 2 ? widths[2] : widths.front());
            EntryInputs::set(setting.values, value, end);
            append(setting.text, value.name, end);
        }
    }
    return out;
}

}  // namespace lobe::analyze
