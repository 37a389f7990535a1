// JSON of what a scene was specialized to, for other programs.
#include "report/markup.h"
#include "report/residual.h"
#include "report/scene.h"

#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;

ordered_json cost_json(const analyze::Cost& cost)
{
    ordered_json out{{"spirv_instructions", cost.spirv_instructions}};
    for (const auto& [family, of] : cost.families)
        out[std::string{analyze::name(family)}] = {{"issue_cycles", json_number(of.issue)},
                                                   {"vgprs", of.vgprs}};
    return out;
}

ordered_json variant_json(const Specialization& of, const analyze::Variant& variant)
{
    ordered_json materials = ordered_json::array();
    for (const std::size_t m : variant.materials)
        materials.push_back(of.facts.materials[m].material);
    ordered_json constants = ordered_json::object();
    for (const auto& [name, value] : variant.called.constants) {
        ordered_json numbers = ordered_json::array();
        for (const double number : value) numbers.push_back(json_number(number));
        constants[name] = std::move(numbers);
    }
    ordered_json ranges = ordered_json::object();
    for (const auto& [name, range] : variant.called.ranges)
        ranges[name] = {json_number(range.low), json_number(range.high)};
    return {{"name", variant.name},
            {"materials", std::move(materials)},
            {"coverage", json_number(variant.coverage)},
            {"off", variant.residual.off},
            {"constants", std::move(constants)},
            {"ranges", std::move(ranges)},
            {"parameters_left", variant.residual.left},
            {"parameters_absent", variant.residual.absent},
            {"cost", cost_json(variant.cost)}};
}

ordered_json effects_json(const std::vector<analyze::Dropped>& effects)
{
    ordered_json out = ordered_json::array();
    for (const analyze::Dropped& each : effects)
        out.push_back({{"effect", each.effect},
                       {"bound", json_number(each.bound)},
                       {"observed", json_number(each.observed)}});
    return out;
}

ordered_json certificate_json(const analyze::Certificate& certificate, const std::string& shader)
{
    ordered_json outputs = ordered_json::array();
    for (const analyze::Equality& equal : certificate.outputs) {
        ordered_json each{{"output", equal.output},         {"ok", equal.ok()},
                          {"same_graph", equal.same_graph}, {"points", equal.points},
                          {"outside", equal.outside},       {"worst", json_number(equal.worst)}};
        if (!equal.device.empty()) {
            each["device"] = equal.device;
            each["device_outside"] = equal.device_outside;
        }
        outputs.push_back(std::move(each));
    }
    return {{"shader", shader},
            {"ok", certificate.ok()},
            {"outputs", std::move(outputs)},
            {"left_out", effects_json(certificate.dropped)},
            {"kept", effects_json(certificate.kept)}};
}

}  // namespace

ordered_json certificates_to_json(const Specialization& of)
{
    ordered_json all = ordered_json::array();
    for (std::size_t i = 0; i < of.certificates.size(); ++i)
        all.push_back(certificate_json(of.certificates[i], of.variants.chosen[i].name));
    return {{"kind", "lobe certificate"},
            {"schema", 1},
            {"scene", of.scene},
            {"module", of.module},
            {"model", of.facts.model},
            {"epsilon", json_number(of.epsilon)},
            {"ok", of.ok()},
            {"shaders", std::move(all)}};
}

ordered_json to_json(const Specialization& of)
{
    ordered_json shaders = ordered_json::array();
    for (const analyze::Variant& variant : of.variants.chosen)
        shaders.push_back(variant_json(of, variant));
    ordered_json frontier = ordered_json::array();
    for (const analyze::VariantCount& count : of.variants.frontier)
        frontier.push_back({{"shaders", count.variants}, {"per_pixel", json_number(count.cycles)}});
    ordered_json out{
        {"scene", of.scene},
        {"module", of.module},
        {"family", analyze::name(of.family)},
        {"cost_unit", of.variants.no_statistics.empty() ? "issue cycles" : "SPIR-V instructions"},
        {"per_pixel", json_number(of.variants.cycles)},
        {"general", cost_json(of.variants.general)},
        {"priced", of.variants.candidates},
        {"proved_cheapest", of.variants.is_proved},
        {"shaders", std::move(shaders)},
        {"frontier", std::move(frontier)},
        {"facts", to_json(of.facts)}};
    if (!of.certificates.empty()) out["certificate"] = certificates_to_json(of);
    return out;
}

}  // namespace lobe::report
