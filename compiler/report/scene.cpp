#include "report/scene.h"

#include "analyze/residual/reach.h"
#include "report/markup.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace lobe::report {
namespace {

using analyze::InputFact;
using analyze::MaterialFacts;
using analyze::SceneFacts;
using nlohmann::ordered_json;

/// Of a table that a person reads; JSON has them all.
constexpr std::size_t most_rows = 40;

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string in_words(const std::vector<double>& value)
{
    if (value.size() == 1) return number(value[0]);
    std::string all;
    for (const double component : value) all += (all.empty() ? "" : ", ") + number(component);
    return "(" + all + ")";
}

std::string in_words(const InputFact& fact)
{
    if (fact.is_constant()) return in_words(fact.value());
    if (fact.is_binary) return "0 or 1";
    ir::Range all = fact.components.front();
    for (const ir::Range& range : fact.components)
        all = {std::min(all.low, range.low), std::max(all.high, range.high)};
    all = analyze::in_digits(all);
    return fmt::format("{} .. {}", all.low, all.high);
}

std::string percent_of(double share) { return fmt::format("{:.3g} %", 100 * share); }

std::string effects_of(const SceneFacts& facts, const MaterialFacts& material)
{
    std::string out;
    for (std::size_t i = 0; i < material.calls.size(); ++i)
        if (material.calls[i]) out += (out.empty() ? "" : ", ") + facts.effects[i].name;
    return out.empty() ? "-" : out;
}

/// Parameters that are not at their default.
std::string given_by(const SceneFacts& facts, const MaterialFacts& material)
{
    std::string out;
    for (const auto& [name, fact] : material.inputs)
        if (facts.defaults.contains(name))
            out += fmt::format("{}{} {}", out.empty() ? "" : "; ", name, in_words(fact));
    return out;
}

/// What all materials together make of an input.
struct Span {
    InputFact fact;
    std::size_t materials = 0;  ///< where it is no default
};

Span over_scene(const SceneFacts& facts, const std::string& name)
{
    Span out;
    for (const MaterialFacts& material : facts.materials) {
        const InputFact& fact = facts.input(material, name);
        if (!fact.is_default) ++out.materials;
        if (out.fact.components.empty()) {
            out.fact = fact;
            continue;
        }
        for (std::size_t k = 0; k < fact.components.size(); ++k) {
            ir::Range& range = out.fact.components[k];
            range = {std::min(range.low, fact.components[k].low),
                     std::max(range.high, fact.components[k].high)};
        }
        out.fact.is_binary = out.fact.is_binary && fact.is_binary;
        if (out.fact.called_by.empty()) out.fact.called_by = fact.called_by;
    }
    return out;
}

/// The surface's fields, then the parameters that some material sets.
std::vector<std::string> told_inputs(const SceneFacts& facts)
{
    std::set<std::string> fields, parameters;
    for (const MaterialFacts& material : facts.materials)
        for (const auto& [name, fact] : material.inputs)
            (facts.defaults.contains(name) ? parameters : fields).insert(name);
    std::vector<std::string> out(fields.begin(), fields.end());
    out.insert(out.end(), parameters.begin(), parameters.end());
    return out;
}

ordered_json to_json(const InputFact& fact)
{
    ordered_json out;
    ordered_json low = ordered_json::array(), high = ordered_json::array();
    for (const ir::Range& range : fact.components) {
        low.push_back(json_number(range.low));
        high.push_back(json_number(range.high));
    }
    if (fact.is_constant())
        out["value"] = std::move(low);
    else {
        out["low"] = std::move(low);
        out["high"] = std::move(high);
        if (fact.is_binary) out["binary"] = true;
    }
    if (!fact.called_by.empty()) out["by"] = fact.called_by;
    return out;
}

}  // namespace

std::string_view name(scene::Light::Kind kind)
{
    using Kind = scene::Light::Kind;
    switch (kind) {
    case Kind::directional: return "directional";
    case Kind::point: return "point";
    case Kind::spot: return "spot";
    case Kind::sphere: return "sphere";
    case Kind::tube: return "tube";
    }
    return "";
}

Table material_table(const SceneFacts& facts)
{
    Table table{{{"material"}, {"area", true}, {"calls for"}, {"sets"}}, {}};
    for (const MaterialFacts& material : facts.materials) {
        if (table.rows.size() == most_rows) {
            const std::size_t more = facts.materials.size() - most_rows;
            table.rows.push_back({{fmt::format("... {} more", grouped(more)), Style::faint}});
            break;
        }
        table.rows.push_back({{material.name, Style::strong},
                              {percent_of(material.coverage)},
                              {effects_of(facts, material)},
                              {given_by(facts, material)}});
    }
    return table;
}

Table effect_table(const SceneFacts& facts)
{
    Table table{{{"effect"}, {""}, {"materials", true}, {"why"}, {"by"}}, {}};
    for (const analyze::EffectFact& effect : facts.effects)
        table.rows.push_back(
            {{effect.name, Style::strong},
             {effect.is_on ? "on" : "off", effect.is_on ? Style::good : Style::faint},
             {grouped(effect.materials.size())},
             {effect.why},
             {effect.called_by, Style::faint}});
    return table;
}

Table input_table(const SceneFacts& facts)
{
    Table table{{{"input"}, {"in this scene"}, {"default"}, {"set by", true}, {"first"}}, {}};
    for (const std::string& input : told_inputs(facts)) {
        const Span span = over_scene(facts, input);
        const auto known = facts.defaults.find(input);
        table.rows.push_back(
            {{input, Style::strong},
             {in_words(span.fact)},
             {known == facts.defaults.end() ? "" : in_words(known->second), Style::faint},
             {grouped(span.materials)},
             {span.fact.called_by, Style::faint}});
    }
    return table;
}

std::string emitters_in_words(const SceneFacts& facts)
{
    std::string out;
    for (const auto& [light, emitter] : facts.emitters) {
        std::string fields;
        for (const auto& [field, range] : emitter.ranges)
            fields += fmt::format("{}{} {}", fields.empty() ? "" : ", ", field,
                                  range.low == range.high
                                      ? fmt::format("{}", range.low)
                                      : fmt::format("{} .. {}", range.low, range.high));
        out += fmt::format("{}{}{}", out.empty() ? "" : "; ", light,
                           fields.empty() ? "" : " (" + fields + ")");
    }
    return out;
}

std::string surroundings(const SceneFacts& facts)
{
    std::string lights;
    for (const analyze::LightCount& light : facts.lights)
        lights += fmt::format("{}{} {}{}", lights.empty() ? "" : ", ", light.count,
                              name(light.kind), light.ranged ? " with a range" : "");
    std::string out = fmt::format("lights        {}\n", lights.empty() ? "none" : lights);
    if (!facts.emitters.empty())
        out += fmt::format("functions     {}, in centimeters\n", emitters_in_words(facts));
    out += fmt::format("environment   {}\n", facts.has_environment ? "image-based" : "none");
    out += fmt::format("tangents      {}\n", facts.has_tangents ? "some meshes have them" : "none");
    out += fmt::format("double-sided  {}\n", facts.double_sided ? "some materials" : "none");
    out += fmt::format("layers        {}\n", facts.has_layers ? "some materials" : "none");
    out += fmt::format("not modeled   {}\n",
                       facts.not_modeled.empty()
                           ? "nothing"
                           : fmt::format("{}", fmt::join(facts.not_modeled, ", ")));
    return out;
}

std::string to_text(const SceneFacts& facts, const Look& look)
{
    return fmt::format("{}\n{}\n{}\n{}", render(effect_table(facts), look),
                       render(material_table(facts), look), render(input_table(facts), look),
                       surroundings(facts));
}

ordered_json to_json(const SceneFacts& facts)
{
    ordered_json effects = ordered_json::array();
    for (const analyze::EffectFact& effect : facts.effects) {
        ordered_json each{{"name", effect.name}, {"on", effect.is_on}, {"why", effect.why}};
        if (!effect.called_by.empty()) each["by"] = effect.called_by;
        ordered_json materials = ordered_json::array();
        for (const std::size_t m : effect.materials)
            materials.push_back(facts.materials[m].material);
        each["materials"] = std::move(materials);
        effects.push_back(std::move(each));
    }
    ordered_json materials = ordered_json::array();
    for (const MaterialFacts& material : facts.materials) {
        ordered_json inputs = ordered_json::object();
        for (const auto& [input, fact] : material.inputs) inputs[input] = to_json(fact);
        ordered_json calls = ordered_json::array();
        for (std::size_t i = 0; i < material.calls.size(); ++i)
            if (material.calls[i]) calls.push_back(facts.effects[i].name);
        materials.push_back({{"material", material.material},
                             {"name", material.name},
                             {"coverage", json_number(material.coverage)},
                             {"calls", std::move(calls)},
                             {"inputs", std::move(inputs)}});
    }
    ordered_json lights = ordered_json::array();
    for (const analyze::LightCount& light : facts.lights)
        lights.push_back(
            {{"kind", name(light.kind)}, {"count", light.count}, {"ranged", light.ranged}});
    ordered_json emitters = ordered_json::object();
    for (const auto& [light, emitter] : facts.emitters) {
        ordered_json& fields = emitters[light] = ordered_json::object();
        for (const auto& [field, range] : emitter.ranges)
            fields[field] = {json_number(range.low), json_number(range.high)};
    }
    return {{"model", facts.model},
            {"effects", std::move(effects)},
            {"materials", std::move(materials)},
            {"lights", std::move(lights)},
            {"light_functions", std::move(emitters)},
            {"environment", facts.has_environment},
            {"tangents", facts.has_tangents},
            {"double_sided", facts.double_sided},
            {"layers", facts.has_layers},
            {"not_modeled", facts.not_modeled}};
}

Table layer_table(const analyze::LayeredMaterials& layered)
{
    Table table{{{"layered material"},
                 {"layers", true},
                 {"median", true},
                 {"of 95 %", true},
                 {"worst", true},
                 {"blend and shade once?"}},
                {}};
    for (const analyze::LayeredMaterial& material : layered.measured) {
        const bool enough = material.one_shading_is_enough();
        table.rows.push_back({{material.name, Style::strong},
                              {grouped(material.layers)},
                              {percent_of(material.error.typical)},
                              {percent_of(material.error.often)},
                              {percent_of(material.error.worst)},
                              {enough ? "one shading is enough" : "it shows: shade every layer",
                               enough ? Style::good : Style::plain}});
    }
    return table;
}

std::string to_text(const analyze::LayeredMaterials& layered, const Look& look)
{
    if (layered.measured.empty()) return "";
    std::string out = render(layer_table(layered), look);
    for (const analyze::LayeredMaterial& material : layered.measured) {
        std::string inputs;
        for (const auto& [input, value] : material.error.witness.inputs)
            inputs += fmt::format("{}{} {}", inputs.empty() ? "" : ", ", input, number(value));
        out += fmt::format("worst of {}: {} shaded by layers, {} at once, at {}\n", material.name,
                           number(material.error.witness.exact),
                           number(material.error.witness.packed), inputs);
    }
    if (layered.not_measured > 0)
        out += fmt::format("{} more layered materials were not measured\n",
                           grouped(layered.not_measured));
    return out;
}

ordered_json to_json(const analyze::LayeredMaterials& layered)
{
    ordered_json materials = ordered_json::array();
    for (const analyze::LayeredMaterial& material : layered.measured) {
        const analyze::RadianceError& error = material.error;
        ordered_json inputs = ordered_json::object();
        for (const auto& [input, value] : error.witness.inputs) inputs[input] = json_number(value);
        materials.push_back({{"material", material.material},
                             {"name", material.name},
                             {"layers", material.layers},
                             {"one_shading_is_enough", material.one_shading_is_enough()},
                             {"median", json_number(error.typical)},
                             {"of_95_percent", json_number(error.often)},
                             {"worst", json_number(error.worst)},
                             {"witness",
                              {{"inputs", std::move(inputs)},
                               {"shaded_by_layers", json_number(error.witness.exact)},
                               {"shaded_once", json_number(error.witness.packed)}}}});
    }
    return {{"measured", std::move(materials)}, {"not_measured", layered.not_measured}};
}

}  // namespace lobe::report
