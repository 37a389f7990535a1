// JSON: everything of every function, for other programs.
#include "report/markup.h"
#include "report/stability.h"
#include "report/verification.h"

#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const analyze::NamedBox& box)
{
    ordered_json out = ordered_json::object();
    for (const auto& [name, side] : box.sides)
        out[name] = {json_number(side.low), json_number(side.high)};
    return out;
}

ordered_json to_json(const analyze::ErrorBound& bound)
{
    return {{"absolute", json_number(bound.absolute)},
            {"relative", json_number(bound.relative)},
            {"observed_absolute", json_number(bound.observed_absolute)},
            {"observed_relative", json_number(bound.observed_relative)},
            {"ratio", json_number(bound.ratio())},
            {"at", bound.at}};
}

std::string_view name_of(evaluate::Precision precision)
{
    return precision == evaluate::Precision::float32 ? "float32" : "float16";
}

template <class Each>
ordered_json list(const std::vector<Each>& values, ordered_json (*convert)(const Each&))
{
    ordered_json out = ordered_json::array();
    for (const Each& value : values) out.push_back(convert(value));
    return out;
}

ordered_json to_json(const analyze::Proof& proof)
{
    ordered_json out{{"function", proof.function},
                     {"precision", name_of(proof.precision)},
                     {"finite", proof.finite},
                     {"open_boxes", proof.open_count},
                     {"open", list(proof.open, to_json)},
                     {"open_points", proof.open_tested},
                     {"open_points_not_finite", proof.open_not_finite},
                     {"cpu", to_json(proof.ieee)},
                     {"vulkan", to_json(proof.vulkan)},
                     {"boxes", proof.boxes}};
    if (proof.over) out["over"] = to_json(*proof.over);
    if (!proof.refused.empty()) out["refused"] = proof.refused;
    return out;
}

ordered_json to_json(const analyze::Hazard& hazard)
{
    ordered_json out{{"kind", analyze::name(hazard.kind)},
                     {"operation", hazard.operation},
                     {"expression", hazard.expression},
                     {"witness", hazard.witness},
                     {"share", hazard.share},
                     {"lost_bits", json_number(hazard.lost_bits)},
                     {"result", hazard.result}};
    if (!hazard.remedy) return out;
    ordered_json remedy{{"name", hazard.remedy->name}, {"text", hazard.remedy->text}};
    if (hazard.remedy->cycles)
        for (const analyze::Family family : analyze::all_families)
            remedy["issue_cycles"][std::string{analyze::name(family)}] =
                (*hazard.remedy->cycles)[static_cast<std::size_t>(family)];
    out["remedy"] = std::move(remedy);
    return out;
}

ordered_json to_json(const analyze::FunctionHazards& of)
{
    return {{"function", of.function},
            {"precision", name_of(of.precision)},
            {"naive_not_finite", of.naive_not_finite},
            {"emitted_not_finite", of.emitted_not_finite},
            {"naive", list(of.naive, to_json)},
            {"emitted", list(of.emitted, to_json)}};
}

ordered_json to_json(const analyze::CornerRow& row)
{
    ordered_json out{
        {"function", row.function}, {"target", row.target},  {"precision", name(row.precision)},
        {"required", row.required}, {"results", row.points}, {"not_a_number", row.not_a_number},
        {"infinite", row.infinite}};
    if (!row.claim.empty()) out[row.required ? "claim" : "not_claimed"] = row.claim;
    if (!row.example.empty()) out["example"] = row.example;
    if (!row.failure.empty()) out["failure"] = row.failure;
    return out;
}

ordered_json to_json(const analyze::Continuity& at)
{
    return {{"function", at.function},        {"across", at.across},
            {"continuous", at.continuous},    {"jump", json_number(at.jump)},
            {"scale", json_number(at.scale)}, {"at", at.at}};
}

ordered_json to_json(const analyze::PhysicsRow& row)
{
    return {{"law", analyze::name(row.law)},
            {"subject", row.subject},
            {"where", row.where},
            {"value", json_number(row.value)},
            {"definition", json_number(row.exact)},
            {"uncertainty", json_number(row.uncertainty)},
            {"kept", row.kept},
            {"note", row.note}};
}

}  // namespace

std::string to_json(Stabilities stabilities)
{
    bool ok = true;
    ordered_json modules = ordered_json::array();
    for (const analyze::Stability& stability : stabilities) {
        ok = ok && stability.ok();
        ordered_json module{{"module", stability.module},
                            {"ok", stability.ok()},
                            {"proofs", list(stability.proofs, to_json)},
                            {"fields", list(stability.fields, to_json)},
                            {"hazards", list(stability.hazards, to_json)},
                            {"corners", list(stability.corners.rows, to_json)},
                            {"continuity", list(stability.corners.continuity, to_json)},
                            {"physics", list(stability.physics, to_json)},
                            {"device", stability.corners.device}};
        if (!stability.corners.no_device.empty()) module["no_device"] = stability.corners.no_device;
        modules.push_back(std::move(module));
    }
    const ordered_json out{{"ok", ok}, {"modules", std::move(modules)}};
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobe::report
