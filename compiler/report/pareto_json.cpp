// JSON: every candidate with all that is known of it, for other programs.
#include "report/markup.h"
#include "report/pareto.h"

#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const analyze::Deviation& deviation)
{
    return {{"worst", json_number(deviation.scaled)},
            {"below_99_percent", json_number(deviation.often)},
            {"typical", json_number(deviation.typical)},
            {"absolute", json_number(deviation.absolute)},
            {"root_mean_square", json_number(deviation.root_mean_square)},
            {"codes", json_number(deviation.codes)},
            {"points", deviation.points},
            {"not_finite", deviation.not_finite},
            {"at", deviation.at}};
}

ordered_json to_json(const analyze::Quantization& quantization)
{
    return {{"worst", json_number(quantization.worst)},
            {"below_95_percent", json_number(quantization.often)},
            {"typical", json_number(quantization.typical)},
            {"absolute_at_worst", json_number(quantization.absolute)},
            {"codes", json_number(quantization.codes)},
            {"codes_below_95_percent", json_number(quantization.often_codes)},
            {"points", quantization.points},
            {"at", quantization.at}};
}

ordered_json to_json(const analyze::ProvedRounding& proved)
{
    ordered_json out{{"bound", json_number(proved.bound)},
                     {"observed", json_number(proved.observed)},
                     {"any_device", json_number(proved.any_device)}};
    if (!proved.over.empty()) out["over"] = proved.over;
    return out;
}

ordered_json to_json(const analyze::Cost& cost)
{
    ordered_json out = ordered_json::object();
    for (const auto& [family, at] : cost.families)
        out[std::string{analyze::name(family)}] = {
            {"issue_cycles", json_number(at.issue)},
            {"valu", json_number(at.valu)},
            {"transcendental", json_number(at.transcendental)},
            {"inverse_throughput", json_number(at.inverse_throughput)},
            {"latency", json_number(at.latency)},
            {"vgprs", at.vgprs},
            {"waves", at.waves}};
    out["spirv_instructions"] = cost.spirv_instructions;
    return out;
}

ordered_json to_json(const std::map<analyze::Family, analyze::Standing>& standings)
{
    ordered_json out = ordered_json::object();
    for (const auto& [family, standing] : standings) {
        ordered_json& at = out[std::string{analyze::name(family)}];
        at["on_frontier"] = standing.on_frontier;
        if (standing.dominated_by) at["dominated_by"] = *standing.dominated_by + 1;
    }
    return out;
}

ordered_json to_json(const analyze::Trade& trade, std::size_t index)
{
    const analyze::Candidate& candidate = trade.candidates[index];
    ordered_json forms = ordered_json::object();
    for (const auto& [term, form] : candidate.choice) forms[term] = form;
    ordered_json out{{"number", index + 1},
                     {"name", describe(candidate)},
                     {"forms", std::move(forms)},
                     {"spelling", optimize::name(candidate.spelling)},
                     {"format", analyze::name(candidate.format)},
                     {"found", candidate.found},
                     {"selectable", candidate.selectable},
                     {"error", json_number(trade.error_of(candidate))},
                     {"model", to_json(candidate.model)},
                     {"rounding", to_json(candidate.rounding)},
                     {"total", to_json(candidate.total)}};
    if (!candidate.note.empty()) out["note"] = candidate.note;
    if (candidate.proved) out["proved_rounding"] = to_json(*candidate.proved);
    if (candidate.cost.spirv_instructions > 0) out["cost_given_fields"] = to_json(candidate.cost);
    if (candidate.from_vectors.spirv_instructions > 0)
        out["cost_from_vectors"] = to_json(candidate.from_vectors);
    out["standing"] = to_json(candidate.standing);
    return out;
}

ordered_json to_json(const analyze::Trade& trade)
{
    ordered_json candidates = ordered_json::array();
    for (std::size_t i = 0; i < trade.candidates.size(); ++i)
        candidates.push_back(to_json(trade, i));
    ordered_json out{{"name", trade.name},
                     {"whole_model", trade.whole_model},
                     {"judged_from_vectors", trade.from_vectors},
                     {"search", trade.search}};
    if (trade.quantization) out["quantization"] = to_json(*trade.quantization);
    for (const analyze::Proof& proof : trade.proofs)
        out["proved_rounding"][proof.function] = {
            {"absolute", json_number(proof.ieee.absolute)},
            {"observed", json_number(proof.ieee.observed_absolute)},
            {"any_device", json_number(proof.vulkan.absolute)}};
    out["candidates"] = std::move(candidates);
    return out;
}

}  // namespace

std::string to_json(std::span<const analyze::Pareto> paretos)
{
    ordered_json modules = ordered_json::array();
    for (const analyze::Pareto& pareto : paretos) {
        ordered_json trades = ordered_json::array();
        for (const analyze::Trade& trade : pareto.trades) trades.push_back(to_json(trade));
        ordered_json module{{"module", pareto.module}, {"driver", pareto.about.driver}};
        if (!pareto.about.no_statistics.empty())
            module["no_statistics"] = pareto.about.no_statistics;
        module["trades"] = std::move(trades);
        modules.push_back(std::move(module));
    }
    return ordered_json{{"modules", std::move(modules)}}.dump(2) + "\n";
}

}  // namespace lobe::report
