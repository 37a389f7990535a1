// Rows of text from results: every table of stability.h.
#include "report/stability.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::report {
namespace {

using analyze::Proof;
using evaluate::Precision;

std::string number_or_none(double value)
{
    return std::isfinite(value) ? short_number(value) : "none";
}

Cell finite_cell(const Proof& proof)
{
    if (proof.finite && proof.open_count == 0) return {"proved", Style::good};
    return {fmt::format("{} open", grouped(proof.open_count)), Style::bad};
}

/// What is known of the same function in half.
Cell half_cell(const Proof* half)
{
    if (half == nullptr) return {"-", Style::faint};
    if (half->finite && !half->over) return {"everywhere", Style::good};
    if (half->finite) return {analyze::describe(*half->over)};
    return {half->refused.empty() ? "not proved" : "no: " + half->refused, Style::faint};
}

const Proof* find(std::span<const Proof> proofs, const std::string& function, Precision precision)
{
    const auto found = std::ranges::find_if(proofs, [&](const Proof& proof) {
        return proof.function == function && proof.precision == precision;
    });
    return found == proofs.end() ? nullptr : &*found;
}

std::string share_of(double share)
{
    return share > 0 ? fmt::format("{} %", short_number(100 * share)) : "found";
}

}  // namespace

Table proof_table(std::span<const Proof> proofs)
{
    Table table;
    table.columns = {{"function"},       {"finite"},         {"absolute", true},
                     {"relative", true}, {"observed", true}, {"bound / observed", true},
                     {"Vulkan", true},   {"boxes", true},    {"finite in half"}};
    for (const Proof& proof : proofs) {
        if (proof.precision != Precision::float32) continue;
        // The observed error in the measure in which the bound is sharper.
        const analyze::ErrorBound& bound = proof.ieee;
        const double absolute = bound.observed_absolute > 0
                                    ? bound.absolute / bound.observed_absolute
                                    : std::numeric_limits<double>::infinity();
        const bool by_absolute = absolute <= bound.ratio();
        table.rows.push_back(
            {{proof.function},
             finite_cell(proof),
             {number_or_none(bound.absolute), by_absolute ? Style::strong : Style::faint},
             {number_or_none(bound.relative), by_absolute ? Style::faint : Style::strong},
             {short_number(by_absolute ? bound.observed_absolute : bound.observed_relative)},
             {number_or_none(bound.ratio())},
             {number_or_none(by_absolute ? proof.vulkan.absolute : proof.vulkan.relative)},
             {grouped(proof.boxes), Style::faint},
             half_cell(find(proofs, proof.function, Precision::float16))});
    }
    return table;
}

Table hazard_table(const analyze::Stability& stability, Precision precision)
{
    Table table;
    table.columns = {{"function"},           {"hazard"}, {"as written"}, {"points", true},
                     {"cycles RDNA2", true}, {"remedy"}, {"witness"}};
    for (const analyze::FunctionHazards& of : stability.hazards) {
        if (of.precision != precision) continue;
        bool first = true;
        for (const analyze::Hazard& hazard : of.naive) {
            std::string what{analyze::name(hazard.kind)};
            if (hazard.kind == analyze::HazardKind::cancellation)
                what += fmt::format(", {} bits", short_number(std::floor(hazard.lost_bits)));
            std::string cycles;
            if (hazard.remedy && hazard.remedy->cycles)
                cycles = fmt::format(
                    "{:+.3g}",
                    (*hazard.remedy->cycles)[static_cast<std::size_t>(analyze::Family::rdna2)]);
            table.rows.push_back(
                {{first ? of.function : ""},
                 {what},
                 {hazard.expression.empty() ? hazard.operation : hazard.expression},
                 {share_of(hazard.share)},
                 {cycles},
                 {hazard.remedy ? hazard.remedy->name : "", Style::good},
                 {hazard.witness, Style::faint}});
            first = false;
        }
    }
    return table;
}

Table remaining_table(const analyze::Stability& stability)
{
    Table table;
    table.columns = {{"function"},     {"hazard"},         {"as written"},
                     {"points", true}, {"what comes out"}, {"witness"}};
    for (const analyze::FunctionHazards& of : stability.hazards) {
        if (of.precision != Precision::float32) continue;
        for (const analyze::Hazard& hazard : of.emitted)
            table.rows.push_back(
                {{of.function},
                 {std::string{analyze::name(hazard.kind)}},
                 {hazard.expression.empty() ? hazard.operation : hazard.expression},
                 {share_of(hazard.share)},
                 {hazard.result},
                 {hazard.witness, Style::faint}});
    }
    return table;
}

Table corner_table(const analyze::Corners& corners)
{
    struct Sums {
        std::size_t runs = 0, points = 0, bad = 0;
        std::vector<std::string> failures;
    };
    struct Line {
        std::string function;
        Sums float32, half_proved, half_elsewhere;
        std::string example;
    };
    std::vector<Line> lines;
    for (const analyze::CornerRow& row : corners.rows) {
        auto at = std::ranges::find(lines, row.function, &Line::function);
        if (at == lines.end()) at = lines.insert(lines.end(), Line{row.function, {}, {}, {}, {}});
        const bool is_float = row.precision == emit::Precision::float32;
        Sums& sums = is_float ? at->float32 : row.required ? at->half_proved : at->half_elsewhere;
        ++sums.runs;
        sums.points += row.points;
        sums.bad += row.not_a_number + row.infinite;
        if (!row.failure.empty()) sums.failures.push_back(row.target + ": " + row.failure);
        if (is_float && at->example.empty()) at->example = row.example;
    }
    const auto cell = [](const Sums& sums, bool required) -> Cell {
        if (!sums.failures.empty()) return {sums.failures.front(), Style::bad};
        if (sums.runs == 0) return {"-", Style::faint};
        if (sums.bad == 0) return {"0", Style::good};
        return {grouped(sums.bad), required ? Style::bad : Style::plain};
    };
    Table table;
    table.columns = {{"function"},
                     {"runs", true},
                     {"results", true},
                     {"NaN, inf", true},
                     {"half, proved", true},
                     {"NaN, inf there", true},
                     {"half, elsewhere", true},
                     {"NaN, inf there", true},
                     {"example"}};
    for (const Line& line : lines)
        table.rows.push_back({{line.function},
                              {std::to_string(line.float32.runs)},
                              {grouped(line.float32.points)},
                              cell(line.float32, true),
                              {grouped(line.half_proved.points)},
                              cell(line.half_proved, true),
                              {grouped(line.half_elsewhere.points)},
                              cell(line.half_elsewhere, false),
                              {line.example, Style::faint}});
    return table;
}

Table jump_table(const analyze::Corners& corners)
{
    Table table;
    table.columns = {{"function"}, {"across"}, {"jump", true}, {"of at most", true}, {"at"}};
    for (const analyze::Continuity& at : corners.continuity)
        if (!at.continuous)
            table.rows.push_back({{at.function},
                                  {at.across},
                                  {short_number(at.jump), Style::strong},
                                  {short_number(at.scale)},
                                  {at.at, Style::faint}});
    return table;
}

Table physics_table(std::span<const analyze::PhysicsRow> rows)
{
    Table table;
    table.columns = {{"law"},          {"of"}, {"where"}, {"value", true}, {"definition", true},
                     {"within", true}, {""}};
    for (const analyze::PhysicsRow& row : rows)
        table.rows.push_back({{std::string{analyze::name(row.law)}},
                              {row.subject},
                              {row.where},
                              {fmt::format("{:.6g}", row.value)},
                              {fmt::format("{:.6g}", row.exact), Style::faint},
                              {short_number(row.uncertainty), Style::faint},
                              {row.note.empty() ? (row.kept ? "kept" : "not kept") : row.note,
                               row.kept ? Style::good : Style::plain}});
    return table;
}

}  // namespace lobe::report
