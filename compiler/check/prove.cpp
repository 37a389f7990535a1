#include "check/prove.h"

#include "check/boxes.h"
#include "check/flatten.h"
#include "check/range_report.h"
#include "check/witness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace lobe::check {
namespace {

using ir::ExprId;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// For a message, a range is worth this much.
constexpr std::size_t most_halvings = 64;

/// For a result, slopes are worth their price where the body is about this small.
constexpr std::size_t small_body = 400;

/// Ends are met up to the rounding of the analysis: a part of the greater finite one. A lone end at
/// 0 has no such room, and neither has an open one.
constexpr double slack = 0x1p-40;

class Proving {
public:
    Proving(const std::vector<ir::Function>& functions, const Draft& draft, Effort& effort)
        : functions_(functions), draft_(draft), graph_(draft.function.graph), effort_(effort)
    {
        measure();
    }

    bool holds(const Obligation& obligation) const
    {
        return obvious(obligation) || proof_of(obligation).prove();
    }

    /// The divisor is never so small that it does not divide.
    bool always_divides(const NamedLimit& limit) const
    {
        Obligation obligation;
        obligation.kind = Obligation::Kind::divisor;
        obligation.any_of = {{limit.divisor, {.low = ir::least_divisor}},
                             {limit.divisor, {.high = -ir::least_divisor}}};
        obligation.given = limit.given;
        return obvious(obligation) || proof_of(obligation).prove_quickly();
    }

    Finding investigate(const Obligation& obligation) const
    {
        Finding finding;
        finding.obligation = obligation;
        std::vector<ExprId> roots = subjects(obligation);
        BoxProof ranges{taken_in(roots, sharpened(obligation.given)), requirements(obligation), 0,
                        effort_};
        for (std::size_t i = 0; i < roots.size(); ++i)
            finding.ranges.push_back(ranges.range(i, most_halvings));

        Search search;
        search.claims = requirements(obligation);
        for (const Fact& fact : obligation.given) {
            search.facts.push_back(fact.relation);
            roots.push_back(fact.left);
            roots.push_back(fact.right);
        }
        search.flat = taken_in(roots, {});
        finding.witness = find_witness(search);

        const Analysis analysis{taken_in(subjects(obligation), {})};
        const ir::Input* last = nullptr;
        for (std::size_t i = 0; i < analysis.inputs().size(); ++i) {
            const ir::Input& input = draft_.function.inputs[analysis.inputs()[i].input];
            const bool bounded = std::isfinite(input.range.low) && std::isfinite(input.range.high);
            if (!analysis.depends_on(i) || bounded || &input == last) continue;
            finding.unbounded.push_back(&input);
            last = &input;
        }
        return finding;
    }

    /// The range of the result: inferred, within what was declared.
    ir::Range result_range() const
    {
        const ExprId result = draft_.function.result;
        if (graph_[result].type == ir::Type::boolean) return {0, 1};
        const Interval inferred = infer(result);
        ir::Range range{-infinity, infinity};
        if (inferred.low <= inferred.high) range = {inferred.low, inferred.high};
        if (const auto& declared = draft_.function.declared_range) {
            const ir::Range both{std::max(range.low, declared->low),
                                 std::min(range.high, declared->high)};
            range = both.low <= both.high ? both : *declared;
        }
        // A range has no negative zeros.
        return {range.low + 0.0, range.high + 0.0};
    }

private:
    /// The ranges of the subjects alone say so.
    bool obvious(const Obligation& obligation) const
    {
        return std::ranges::any_of(obligation.any_of, [&](const Claim& claim) {
            return satisfies(ranges_of(claim.subject), claim.requirement, slack) ||
                   (claim.requirement.nonzero && said_nonzero(claim.subject, obligation.given));
        });
    }

    BoxProof proof_of(const Obligation& obligation) const
    {
        return {taken_in(subjects(obligation), sharpened(obligation.given)),
                requirements(obligation), slack, effort_};
    }

    /// The range of the result, calls known by their range. Where the plain one is wider than what
    /// the corners of the inputs give, slopes may make it tighter.
    Interval infer(ExprId result) const
    {
        const Interval plain = hull(ranges_of(result));
        if (result_at_corners_ == plain || draft_.function.declared_range) return plain;
        BoxProof proof{flatten(functions_, draft_.function, {&result, 1}, {}, Calls::as_inputs),
                       {Requirement{}},
                       0,
                       effort_};
        return proof.cost() < small_body ? proof.range(0, 0) : plain;
    }

    Flat taken_in(const std::vector<ExprId>& roots, const std::vector<Fact>& given) const
    {
        return flatten(functions_, draft_.function, roots, given, Calls::taken_in);
    }

    /// The ranges of everything that is asked about, in one run. Calls are known by their range
    /// here, which is nearly always enough; what is not proved so is looked at with care.
    void measure()
    {
        std::vector<ExprId> roots;
        const auto add = [&](ExprId id) {
            if (known_.size() < graph_.size()) known_.resize(graph_.size());
            if (known_[id.index].empty()) roots.push_back(id);
            known_[id.index] = {{-infinity, infinity}};
        };
        for (const Obligation& obligation : draft_.obligations) {
            for (const Claim& claim : obligation.any_of) add(claim.subject);
            for (const Fact& fact : obligation.given) {
                add(fact.left);
                add(fact.right);
            }
        }
        for (const NamedLimit& limit : draft_.limits) {
            add(limit.divisor);
            for (const Fact& fact : limit.given) {
                add(fact.left);
                add(fact.right);
            }
        }
        if (draft_.function.result.valid()) add(draft_.function.result);
        if (roots.empty()) return;
        Analysis analysis{flatten(functions_, draft_.function, roots, {}, Calls::as_inputs)};
        const auto& ranges = analysis.ranges(analysis.declared());
        for (std::size_t i = 0; i < roots.size(); ++i) known_[roots[i].index] = ranges[i];
        if (draft_.function.result.valid()) look_at_corners(analysis, roots);
    }

    /// Most ranges of results are attained where all inputs are at an end.
    void look_at_corners(Analysis& analysis, const std::vector<ExprId>& roots)
    {
        const auto found = std::ranges::find(roots, draft_.function.result);
        const Box declared = analysis.declared();
        constexpr std::size_t corners = 16;
        std::vector<std::vector<double>> points(corners);
        for (std::size_t corner = 0; corner < corners; ++corner)
            for (std::size_t i = 0; i < declared.size(); ++i)
                points[corner].push_back((corner >> (i % 4)) % 2 == 0 ? declared[i].low
                                                                      : declared[i].high);
        result_at_corners_ =
            analysis.extremes(static_cast<std::size_t>(found - roots.begin()), points);
    }

    const std::vector<Interval>& ranges_of(ExprId id) const { return known_[id.index]; }

    static std::vector<ExprId> subjects(const Obligation& obligation)
    {
        std::vector<ExprId> result;
        for (const Claim& claim : obligation.any_of) result.push_back(claim.subject);
        return result;
    }
    static std::vector<Requirement> requirements(const Obligation& obligation)
    {
        std::vector<Requirement> result;
        for (const Claim& claim : obligation.any_of) result.push_back(claim.requirement);
        return result;
    }

    bool is_zero(ExprId id) const { return graph_.is_literal(id, 0); }

    bool said_nonzero(ExprId subject, const std::vector<Fact>& given) const
    {
        return std::ranges::any_of(given, [&](const Fact& fact) {
            return fact.relation == Relation::not_equal &&
                   ((fact.left == subject && is_zero(fact.right)) ||
                    (fact.right == subject && is_zero(fact.left)));
        });
    }

    /// What differs from 0 and is not negative is positive.
    std::vector<Fact> sharpened(std::vector<Fact> given) const
    {
        for (Fact& fact : given) {
            if (fact.relation != Relation::not_equal) continue;
            if (is_zero(fact.left)) std::swap(fact.left, fact.right);
            if (!is_zero(fact.right)) continue;
            const Interval range = hull(ranges_of(fact.left));
            if (range.low >= 0)
                fact = {Relation::less, fact.right, fact.left};
            else if (range.high <= 0)
                fact.relation = Relation::less;
        }
        return given;
    }

    const std::vector<ir::Function>& functions_;
    const Draft& draft_;
    const ir::Graph& graph_;
    Effort& effort_;
    Interval result_at_corners_;
    std::vector<std::vector<Interval>> known_;  ///< per expression of the draft, where asked for
};

/// `x / (1 + x) else 0`: the `else` and what follows it can go.
Diagnostic describe_unused(const NamedLimit& limit, const Sources& sources)
{
    Diagnostic diagnostic{.code = Code::unused_limit,
                          .message = "this limit is never used",
                          .primary = {limit.limit, ""},
                          .secondary = {{limit.divisor_span, "this cannot be 0"}},
                          .helps = {"leave out the `else`"}};
    const std::string_view before =
        std::string_view{sources[limit.limit.source].text()}.substr(0, limit.limit.begin);
    const std::size_t keyword = before.rfind("else");
    const std::size_t divisor = keyword == std::string_view::npos || keyword == 0
                                    ? std::string_view::npos
                                    : before.find_last_not_of(" \t\r\n", keyword - 1);
    // Only where nothing but space follows the keyword: a parenthesis would be left over.
    const bool plain =
        divisor != std::string_view::npos &&
        before.substr(keyword + 4).find_first_not_of(" \t") == std::string_view::npos;
    if (plain) {
        diagnostic.helps.clear();
        diagnostic.fix =
            Fix{{limit.limit.source, static_cast<std::uint32_t>(divisor + 1), limit.limit.end},
                "",
                "leave out the `else`"};
    }
    return diagnostic;
}

}  // namespace

bool prove(const Program& program, Draft& draft, const Sources& sources, Effort& effort,
           Diagnostics& diagnostics)
{
    const Proving proving{program.functions, draft, effort};
    bool proved = true;
    // The terms of a sum ask the same of every index: one that fails is reported, and a limit is
    // of use where one of them needs it.
    std::set<std::tuple<Obligation::Kind, std::uint32_t, std::uint32_t>> failed;
    for (const Obligation& obligation : draft.obligations) {
        const std::tuple place{obligation.kind, obligation.whole.source, obligation.subject.begin};
        if (failed.contains(place) || proving.holds(obligation)) continue;
        diagnostics.report(describe(proving.investigate(obligation), sources));
        failed.insert(place);
        proved = false;
    }
    std::map<std::uint32_t, const NamedLimit*> unused;
    for (const NamedLimit& limit : draft.limits) {
        const auto [place, added] = unused.try_emplace(limit.limit.begin, &limit);
        if (place->second && !proving.always_divides(limit)) place->second = nullptr;
    }
    for (const auto& [begin, limit] : unused)
        if (limit) diagnostics.report(describe_unused(*limit, sources));
    if (proved && draft.function.result.valid()) draft.function.range = proving.result_range();
    return proved;
}

}  // namespace lobe::check
