// The text for terminals, the sections of a page, and the cases of JUnit.
#include "report/stability.h"

#include "report/junit_suite.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace lobe::report {
namespace {

using analyze::Stability;
using evaluate::Precision;

/// A heading, what the table shows, and the table.
struct Part {
    std::string title;
    std::string words;
    Table table;
};

std::vector<Part> parts_of(const Stability& stability)
{
    std::vector<Part> out;
    const auto add = [&out](std::string title, std::string words, Table table) {
        if (!table.rows.empty())
            out.push_back({std::move(title), std::move(words), std::move(table)});
    };
    add("Proofs",
        "Over the whole declared box. Finite: on any device that keeps the Vulkan precision table. "
        "The bounds of the rounding error are the CPU's, beside the worst that was observed of it; "
        "and Vulkan's.",
        proof_table(stability.proofs));
    add("Fields", "What the functions are given is made from unit vectors by these.",
        proof_table(stability.fields));
    add("Hazards of the naive spelling, in float",
        "What an author would type can do this, at this input; the remedy is what is emitted "
        "instead.",
        hazard_table(stability, Precision::float32));
    add("Hazards left in what is emitted, in float",
        "An operation at the edge of what float can hold; the result beside what it should be.",
        remaining_table(stability));
    add("The corner suite",
        "At and next to every boundary, on every target, before and after the optimizer, and in "
        "the evaluator.",
        corner_table(stability.corners));
    add("Jumps", "Boundaries at which the model itself is not continuous.",
        jump_table(stability.corners));
    add("Physics",
        "Of what was emitted; beside it the definition in double, and the quadrature's own error.",
        physics_table(stability.physics));
    return out;
}

struct Count {
    std::size_t functions = 0, open = 0, hazards = 0, remedied = 0, corners = 0, bad = 0, jumps = 0,
                laws = 0, broken_laws = 0;
    double worst_ratio = 0;
    std::string worst_function;
    std::vector<std::string> unbounded;
};

Count count(Stabilities stabilities)
{
    Count out;
    for (const Stability& stability : stabilities) {
        for (const analyze::Proof& proof : stability.proofs) {
            if (proof.precision != Precision::float32) continue;
            ++out.functions;
            out.open += proof.open_count;
            if (proof.ieee.ratio() >= analyze::ErrorBound::useless) {
                out.unbounded.push_back(proof.function);
                continue;
            }
            if (proof.ieee.ratio() <= out.worst_ratio) continue;
            out.worst_ratio = proof.ieee.ratio();
            out.worst_function = proof.function;
        }
        for (const analyze::FunctionHazards& of : stability.hazards) {
            if (of.precision != Precision::float32) continue;
            out.hazards += of.naive.size();
            out.remedied += static_cast<std::size_t>(std::ranges::count_if(
                of.naive, [](const analyze::Hazard& hazard) { return hazard.remedy.has_value(); }));
        }
        for (const analyze::CornerRow& row : stability.corners.rows) {
            if (!row.required) continue;
            out.corners += row.points;
            out.bad += row.not_a_number + row.infinite + (row.failure.empty() ? 0 : 1);
        }
        for (const analyze::Continuity& at : stability.corners.continuity)
            out.jumps += at.continuous ? 0 : 1;
        for (const analyze::PhysicsRow& row : stability.physics) {
            ++out.laws;
            out.broken_laws += row.kept ? 0 : 1;
        }
    }
    return out;
}

bool ok(Stabilities stabilities)
{
    return std::ranges::all_of(stabilities, [](const Stability& each) { return each.ok(); });
}

}  // namespace

std::string to_text(const Stability& stability, const Look& look)
{
    std::string out;
    for (const Part& part : parts_of(stability))
        out += fmt::format(
            "{}\n{}\n",
            styled(fmt::format("{}: {}", stability.module, part.title), Style::strong, look.color),
            render(part.table, look));
    return out;
}

std::string summary(Stabilities stabilities, const Look& look)
{
    const Count sum = count(stabilities);
    std::string out;
    const auto line = [&out](std::string_view title, const std::string& words) {
        out += fmt::format("{:<9} {}\n", title, words);
    };
    line("finite", sum.open == 0
                       ? fmt::format("all {} functions, proved over their declared ranges",
                                     grouped(sum.functions))
                       : styled(fmt::format("{} open boxes in {} functions", grouped(sum.open),
                                            grouped(sum.functions)),
                                Style::bad, look.color));
    line("bounds",
         fmt::format("at most {} times the observed error{}{}", short_number(sum.worst_ratio),
                     sum.worst_function.empty() ? "" : " (" + sum.worst_function + ")",
                     sum.unbounded.empty()
                         ? ""
                         : fmt::format("; none for {}", fmt::join(sum.unbounded, ", "))));
    if (sum.hazards > 0)
        line("hazards", fmt::format("{} in the naive spelling, {} with a remedy",
                                    grouped(sum.hazards), grouped(sum.remedied)));
    line("corners",
         fmt::format("{} results, {}", grouped(sum.corners),
                     sum.bad == 0 ? std::string{"none NaN or infinite"}
                                  : styled(grouped(sum.bad) + " NaN, infinite or not run",
                                           Style::bad, look.color)));
    line("jumps", fmt::format("{}, stated above", grouped(sum.jumps)));
    line("physics", fmt::format("{} statements, {} not kept by the model itself", grouped(sum.laws),
                                grouped(sum.broken_laws)));
    for (const Stability& stability : stabilities)
        if (!stability.corners.no_device.empty()) {
            line("device", "none: " + stability.corners.no_device);
            break;
        }
    return out;
}

Paragraph stability_verdict(Stabilities stabilities)
{
    if (ok(stabilities))
        return {"Every function is finite over its declared ranges, proved; no corner gives NaN "
                "or an infinity in float.",
                Style::good};
    return {"Something is not proved finite, or gives NaN or an infinity in float.", Style::bad};
}

std::vector<Section> stability_sections(const Stability& stability, const std::string& path)
{
    std::vector<Section> out;
    Section head;
    head.title = "Stability: " + stability.module;
    head.command = "lobec stability " + path;
    head.paragraphs.push_back(stability_verdict({&stability, 1}));
    out.push_back(std::move(head));
    for (Part& part : parts_of(stability)) {
        Section section;
        section.level = 3;
        section.title = std::move(part.title);
        section.paragraphs.push_back({std::move(part.words), Style::faint});
        section.tables.push_back(std::move(part.table));
        out.push_back(std::move(section));
    }
    Table half = hazard_table(stability, Precision::float16);
    if (!half.rows.empty()) {
        Section section;
        section.level = 3;
        section.title = "Hazards of the naive spelling, in half";
        section.tables.push_back(std::move(half));
        out.push_back(std::move(section));
    }
    return out;
}

std::string to_junit(Stabilities stabilities)
{
    std::vector<JunitSuite> suites;
    for (const Stability& stability : stabilities) {
        JunitSuite proofs{stability.module + ".finite", {}};
        for (const analyze::Proof& proof : stability.proofs) {
            if (proof.precision != Precision::float32) continue;
            JunitCase one;
            one.name = proof.function;
            if (!proof.finite || proof.open_count > 0) {
                one.failure = fmt::format("{} boxes are open", proof.open_count);
                for (const analyze::NamedBox& box : proof.open)
                    one.details += analyze::describe(box) + "\n";
            }
            proofs.cases.push_back(std::move(one));
        }
        suites.push_back(std::move(proofs));
        JunitSuite corners{stability.module + ".corners", {}};
        for (const analyze::CornerRow& row : stability.corners.rows) {
            JunitCase one;
            one.name = fmt::format("{} {} {}", row.function, row.target, name(row.precision));
            if (row.required && !row.claim.empty()) one.name += " where proved";
            const std::size_t bad = row.not_a_number + row.infinite;
            if (!row.required && (bad > 0 || !row.failure.empty())) {
                one.skipped = fmt::format("not claimed: {} results are NaN or infinite", bad);
                if (!row.claim.empty()) one.skipped += "; " + row.claim;
            } else if (!row.failure.empty()) {
                one.failure = row.failure;
            } else if (bad > 0) {
                one.failure = fmt::format("{} results are NaN or infinite", bad);
                one.details = row.example;
            }
            corners.cases.push_back(std::move(one));
        }
        if (!stability.corners.no_device.empty())
            corners.cases.push_back({"device", "", "", stability.corners.no_device, 0});
        suites.push_back(std::move(corners));
    }
    return to_junit("lobec stability", suites, false);
}

}  // namespace lobe::report
