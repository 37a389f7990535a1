// JSON: everything the tables and pictures show, for other programs.
#include "report/markup.h"
#include "report/packing_layout.h"

#include <nlohmann/json.hpp>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;

ordered_json by_name(const std::vector<std::pair<std::string, double>>& values)
{
    ordered_json out = ordered_json::object();
    for (const auto& [name, value] : values) out[name] = json_number(value);
    return out;
}

ordered_json to_json(const analyze::RadianceError& error)
{
    return {{"typical", json_number(error.typical)},
            {"below_95_percent", json_number(error.often)},
            {"worst", json_number(error.worst)},
            {"at",
             {{"inputs", by_name(error.witness.inputs)},
              {"stored", by_name(error.witness.stored)},
              {"exact_radiance", json_number(error.witness.exact)},
              {"packed_radiance", json_number(error.witness.packed)}}}};
}

ordered_json to_json(const ir::Module& module, const analyze::PackingErrors& errors)
{
    ordered_json parameters = ordered_json::object();
    for (const auto& [parameter, error] : errors.parameters)
        parameters[module.parameters[parameter].name] = to_json(error);
    return {{"points", errors.points},
            {"whole", to_json(errors.whole)},
            {"parameters", std::move(parameters)}};
}

std::string_view name(Piece::Holds holds)
{
    switch (holds) {
    case Piece::Holds::field: return "field";
    case Piece::Holds::nothing: return "free";
    case Piece::Holds::engine: return "engine";
    case Piece::Holds::closed: return "closed";
    }
    return "";
}

ordered_json layout_json(const Packed& packed)
{
    const ir::Gbuffer& gbuffer = packed.gbuffer();
    const Layout layout = layout_of(packed);
    ordered_json targets = ordered_json::array();
    for (const TargetLayout& target : layout.targets) {
        ordered_json channels = ordered_json::array();
        for (const ChannelLayout& channel : target.channels) {
            ordered_json pieces = ordered_json::array();
            for (const Piece& piece : channel.pieces)
                pieces.push_back({{"low", piece.low},
                                  {"bits", piece.bits},
                                  {"holds", name(piece.holds)},
                                  {"label", piece.label},
                                  {"detail", piece.detail}});
            const ir::Channel& about = gbuffer.channels[channel.channel];
            channels.push_back({{"name", about.name},
                                {"label", about.label},
                                {"format", describe(channel.format)},
                                {"pieces", std::move(pieces)}});
        }
        const ir::RenderTarget& about = gbuffer.targets[target.target];
        targets.push_back(
            {{"name", about.name}, {"label", about.label}, {"channels", std::move(channels)}});
    }
    ordered_json settings = ordered_json::object();
    const std::vector<std::size_t> values = gbuffer.values(layout.configuration);
    for (std::size_t i = 0; i < values.size(); ++i)
        settings[gbuffer.settings[i].name] = gbuffer.settings[i].values[values[i]];
    int left = 0;
    for (const ir::Slot& slot : layout.left) left += slot.bits;
    return {{"settings", std::move(settings)},
            {"bits", layout.bits},
            {"bits_left", left},
            {"targets", std::move(targets)}};
}

ordered_json fields_json(const Packed& packed)
{
    ordered_json out = ordered_json::array();
    for (std::size_t i = 0; i < packed.packing->fields.size(); ++i) {
        const ir::Field& field = packed.packing->fields[i];
        const analyze::FieldCodes& codes = packed.codes[i];
        out.push_back({{"name", field_name(*packed.module, field)},
                       {"place", slots_of(packed, field)},
                       {"bits", field.bits},
                       {"signed", field.is_signed},
                       {"code", describe(field.code, field.bits)},
                       {"codes", codes.codes},
                       {"carries", {json_number(codes.low), json_number(codes.high)}},
                       {"default", json_number(codes.default_value)},
                       {"default_code", codes.default_code},
                       {"default_decoded", json_number(codes.default_decoded)},
                       {"largest_step", json_number(codes.largest_step)},
                       {"largest_step_from", json_number(codes.largest_step_from)}});
    }
    return out;
}

ordered_json to_json(const analyze::Suggestion& suggestion)
{
    const ir::Module& module = suggestion.module;
    ordered_json curves = ordered_json::object();
    for (const analyze::Curve& curve : suggestion.curves) {
        ordered_json points = ordered_json::array();
        for (const analyze::CurvePoint& point : curve.points)
            points.push_back({{"bits", point.bits},
                              {"signed", point.is_signed},
                              {"code", describe(point.code, point.bits)},
                              {"worst", json_number(point.error)}});
        curves[module.parameters[curve.parameter].name] = std::move(points);
    }
    ordered_json trade = ordered_json::array();
    for (const analyze::TradePoint& point : suggestion.trade) {
        ordered_json shares = ordered_json::object();
        for (std::size_t i = 0; i < point.shares.size() && i < suggestion.curves.size(); ++i)
            shares[module.parameters[suggestion.curves[i].parameter].name] = point.shares[i];
        trade.push_back({{"bits", point.bits},
                         {"predicted", json_number(point.predicted)},
                         {"measured", json_number(point.measured)},
                         {"shares", std::move(shares)}});
    }
    ordered_json out{{"found", suggestion.found}};
    if (!suggestion.found) out["why_not"] = suggestion.why_not;
    out["give_up"] = suggestion.give_ups;
    if (suggestion.found) {
        out["text"] = suggestion.text;
        out["linear_8_bits"] = to_json(module, suggestion.linear);
    }
    out["curves"] = std::move(curves);
    out["trade"] = std::move(trade);
    return out;
}

}  // namespace

std::string to_json(std::span<const Packed> packings)
{
    ordered_json all = ordered_json::array();
    bool ok = true;
    for (const Packed& packed : packings) {
        const bool found = packed.suggestion == nullptr || packed.suggestion->found;
        ok &= packed.met && found;
        ordered_json one{{"model", packed.packing->model.name},
                         {"gbuffer", packed.packing->gbuffer},
                         {"suggested", packed.suggestion != nullptr},
                         {"met", packed.met}};
        if (packed.limit) one["radiance_limit"] = json_number(*packed.limit);
        if (found) {
            one["layout"] = layout_json(packed);
            one["fields"] = fields_json(packed);
            one["errors"] = to_json(*packed.module, packed.errors);
        }
        if (packed.suggestion != nullptr) one["suggestion"] = to_json(*packed.suggestion);
        all.push_back(std::move(one));
    }
    const ordered_json out{{"ok", ok}, {"packings", std::move(all)}};
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobe::report
