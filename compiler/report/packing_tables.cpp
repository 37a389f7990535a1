// The tables of a packing.
#include "report/packing_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

/// A value as float arithmetic has it, with no more digits than tell it from its neighbors.
std::string value(double number) { return fmt::format("{}", static_cast<float>(number)); }

std::string short_value(double number) { return fmt::format("{:.4g}", number); }

std::vector<Cell> error_row(std::string name, int bits, const analyze::RadianceError& error,
                            Style style)
{
    return {{std::move(name), style},
            {std::to_string(bits)},
            {percent(error.typical)},
            {percent(error.often)},
            {percent(error.worst), style}};
}

int bits_of(const ir::Packing& packing, std::uint32_t parameter)
{
    int sum = 0;
    for (const ir::Field& field : packing.fields)
        if (field.parameter == parameter) sum += field.bits;
    return sum;
}

std::string code_in_words(const ir::Code& code, int bits, bool is_signed)
{
    return (is_signed ? "signed " : "") + describe(code, bits);
}

/// What a search gave to each component of a parameter; 0 without a result.
int chosen_bits(const analyze::Suggestion& suggestion, std::uint32_t parameter)
{
    if (!suggestion.found) return 0;
    for (const ir::Field& field : suggestion.module.packings.back().fields)
        if (field.parameter == parameter) return field.bits;
    return 0;
}

const analyze::CurvePoint* at_bits(const analyze::Curve& curve, int bits)
{
    for (const analyze::CurvePoint& point : curve.points)
        if (point.bits == bits) return &point;
    return nullptr;
}

}  // namespace

Table field_table(const Packed& packed)
{
    Table table;
    table.columns = {{"field"},   {"place"},   {"code"},        {"codes", true},
                     {"carries"}, {"default"}, {"largest step"}};
    for (std::size_t i = 0; i < packed.packing->fields.size(); ++i) {
        const ir::Field& field = packed.packing->fields[i];
        const analyze::FieldCodes& codes = packed.codes[i];
        const bool exact =
            static_cast<float>(codes.default_value) == static_cast<float>(codes.default_decoded);
        table.rows.push_back(
            {{field_name(*packed.module, field), Style::strong},
             {slots_of(packed, field)},
             {code_in_words(field.code, field.bits, field.is_signed)},
             {std::to_string(codes.codes)},
             {fmt::format("[{}, {}]", value(codes.low), value(codes.high))},
             {fmt::format("{} -> {}", value(codes.default_value), value(codes.default_decoded)),
              exact ? Style::plain : Style::bad},
             {fmt::format("{} at {}", short_value(codes.largest_step),
                          short_value(codes.largest_step_from))}});
    }
    return table;
}

Table error_table(const Packed& packed)
{
    Table table;
    table.columns = {{"radiance error"},
                     {"bits", true},
                     {"typical", true},
                     {"95 % below", true},
                     {"worst", true}};
    const ir::Packing& packing = *packed.packing;
    int all = 0;
    for (const ir::Field& field : packing.fields) all += field.bits;
    for (const auto& [parameter, error] : packed.errors.parameters)
        table.rows.push_back(error_row(packed.module->parameters[parameter].name,
                                       bits_of(packing, parameter), error, Style::plain));
    table.rows.push_back(error_row("all together", all, packed.errors.whole,
                                   packed.met ? Style::strong : Style::bad));
    return table;
}

Table curve_table(const analyze::Suggestion& suggestion, int columns)
{
    Table table;
    table.columns = {{"worst error, % at bits"}};
    const ir::Module& module = suggestion.module;
    const auto chosen = [&](const analyze::Curve& curve) {
        return chosen_bits(suggestion, curve.parameter);
    };
    int first = 16, last = 0, least = 16, most = 0;
    for (const analyze::Curve& curve : suggestion.curves) {
        for (const analyze::CurvePoint& point : curve.points) {
            first = std::min(first, point.bits);
            last = std::max(last, point.bits);
        }
        if (chosen(curve) == 0) continue;
        least = std::min(least, chosen(curve));
        most = std::max(most, chosen(curve));
    }
    if (columns > 0 && last - first + 1 > columns) {
        // As many on either side of what was chosen as there is room for.
        const int middle = most > 0 ? (least + most) / 2 : first + columns / 2;
        first = std::clamp(middle - columns / 2, first, last - columns + 1);
        last = first + columns - 1;
    }
    for (int bits = first; bits <= last; ++bits)
        table.columns.push_back({std::to_string(bits), true});
    table.columns.push_back({"code"});
    for (const analyze::Curve& curve : suggestion.curves) {
        std::vector<Cell> row{{module.parameters[curve.parameter].name}};
        for (int bits = first; bits <= last; ++bits) {
            const analyze::CurvePoint* point = at_bits(curve, bits);
            std::string text = point == nullptr ? "-" : percent(point->error);
            if (text.ends_with(" %")) text.resize(text.size() - 2);
            const bool is_chosen = bits == chosen(curve);
            row.push_back({is_chosen ? "*" + text : text, is_chosen          ? Style::strong
                                                          : point == nullptr ? Style::faint
                                                                             : Style::plain});
        }
        const analyze::CurvePoint* taken = at_bits(curve, chosen(curve));
        row.push_back(
            {taken == nullptr ? "" : code_in_words(taken->code, taken->bits, taken->is_signed)});
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table trade_table(const analyze::Suggestion& suggestion)
{
    Table table;
    table.columns = {
        {"bits", true}, {"predicted", true}, {"measured", true}, {"bits of each parameter"}};
    for (const analyze::TradePoint& point : suggestion.trade) {
        std::string shares;
        for (const int share : point.shares)
            shares += fmt::format("{}{}", shares.empty() ? "" : " ", share);
        table.rows.push_back({{std::to_string(point.bits)},
                              {percent(point.predicted)},
                              {percent(point.measured), Style::strong},
                              {shares, Style::faint}});
    }
    return table;
}

}  // namespace lobe::report
