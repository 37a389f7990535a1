#include "analyze/hazards/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace lobe::analyze {
namespace {

using Point = HazardSpace::Point;

constexpr std::size_t kinds = 4;
constexpr double nothing = -std::numeric_limits<double>::infinity();

/// Points whose hazards are candidates for a witness, per hazard: the worst ones.
constexpr std::size_t candidates_kept = 4;

/// Steps of climbing for each expression of a line of `usual_length` instructions or less. Longer
/// lines have more to climb and take longer for a step: they get fewer, so that no function takes
/// much more time than another.
constexpr std::size_t climbing_steps = 256;
constexpr std::size_t usual_length = 128;

void read(const Points& points, std::size_t index, Point& point)
{
    for (std::size_t i = 0; i < point.size(); ++i)
        point[i] = static_cast<double>(points.columns[i][index]);
}

/// What is known about one kind of hazard of one expression.
struct Tally {
    struct Candidate {
        double severity = 0;
        Point point;
    };
    std::size_t count = 0;
    std::size_t last = std::numeric_limits<std::size_t>::max();  ///< point that was counted
    std::vector<Candidate> worst;                                ///< first the worst

    void add(std::size_t index, double severity, const Point& point)
    {
        if (index != last) ++count;
        last = index;
        if (worst.size() == candidates_kept && severity <= worst.back().severity) return;
        const auto place = std::ranges::find_if(
            worst, [&](const Candidate& other) { return severity > other.severity; });
        worst.insert(place, {severity, point});
        if (worst.size() > candidates_kept) worst.pop_back();
    }
};

/// Where climbing starts for an expression that was not caught: the point where it came closest.
struct Start {
    double height = nothing;
    Point point;
};

class Search {
public:
    Search(const WatchedLine& line, const WatchedLine& truth, const HazardSpace& space,
           evaluate::Precision precision)
        : line_{line}, space_{space}, judge_{line}, trace_{line, precision},
          truth_{truth, precision}, is_truth_{&line == &truth}
    {
        group();
    }

    std::vector<FoundHazard> run(const Points& points)
    {
        scan(points);
        climb();
        std::vector<FoundHazard> found;
        for (std::size_t group = 0; group < groups_; ++group)
            for (std::size_t kind = 0; kind < kinds; ++kind)
                if (auto hazard = settle(group, static_cast<HazardKind>(kind), points.size()))
                    found.push_back(std::move(*hazard));
        std::ranges::stable_sort(found, [](const FoundHazard& a, const FoundHazard& b) {
            return std::tuple{a.kind, -a.share} < std::tuple{b.kind, -b.share};
        });
        return found;
    }

private:
    /// Instructions of one operation at one place in the source are one hazard: components of a
    /// color, and uses of a term that was called twice.
    void group()
    {
        std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t, int>,
                 std::size_t>
            known;
        for (const ir::ExprId owner : line_.owner) {
            const Span span = line_.function.graph.span(owner);
            const bool placed = span.begin != span.end;
            const auto [place, added] = known.emplace(
                std::tuple{span.source, span.begin, span.end, placed ? 0 : owner.index,
                           static_cast<int>(line_.function.graph[owner].op)},
                groups_);
            if (added) ++groups_;
            group_of_.push_back(place->second);
        }
        tallies_.resize(groups_);
        for (std::vector<Start>& starts : starts_) starts.resize(groups_);
    }

    /// Runs both lines at a point; whether the result is off there.
    bool run_at(const Point& point, Trace::Repair repaired = {})
    {
        trace_.run(point, repaired);
        if (!is_truth_) truth_.run(point);
        return error() > tolerance(trace_.grid());
    }
    double error() const { return worst_result(trace_, is_truth_ ? trace_ : truth_).error; }

    double severity(const HazardEvent& event) const
    {
        if (event.kind != HazardKind::cancellation) return 0;
        return -trace_.kept_bits(line_.tape.code[event.instruction].result);
    }

    void scan(const Points& points)
    {
        Point point(points.columns.size());
        for (std::size_t index = 0; index < points.size(); ++index) {
            read(points, index, point);
            const bool wrong = run_at(point);
            note_starts(point);
            if (!judge_.may_find(trace_, wrong)) continue;
            trace_.find_demand();
            judge_.find(trace_, wrong, events_);
            for (const HazardEvent& event : events_)
                tally(event).add(index, severity(event), point);
        }
    }

    Tally& tally(const HazardEvent& event)
    {
        return tallies_[group_of_[event.instruction]][static_cast<std::size_t>(event.kind)];
    }

    /// How close an instruction came to be a hazard: the nearer to the end of its domain, the more
    /// digits it lost, the higher.
    double height(std::size_t instruction, bool is_sum) const
    {
        const evaluate::Instruction& step = line_.tape.code[instruction];
        if (is_sum) return -trace_.kept_bits(step.result);
        const double distance = domain_distance(step, trace_);
        return std::isnan(distance) ? nothing : -distance;
    }

    void note_starts(const Point& point)
    {
        const auto note = [&](std::size_t instruction, bool is_sum) {
            Start& start = starts_[is_sum ? 1 : 0][group_of_[instruction]];
            const double here = height(instruction, is_sum);
            if (!(here > start.height)) return;
            start.height = here;
            start.point = point;
        };
        for (const std::size_t i : judge_.with_domain()) note(i, false);
        const double digits = static_cast<double>(trace_.grid().digits);
        for (const std::size_t i : judge_.sums()) {
            // Most sums keep all of their digits; the logarithm is only for the others.
            const evaluate::Slot slot = line_.tape.code[i].result;
            const double exact = std::fabs(trace_.exact(slot));
            const double error = std::fabs(trace_.device(slot) - trace_.exact(slot));
            const double best = starts_[1][group_of_[i]].height;
            if (best == nothing || error > exact * std::exp2(std::max(best, -digits)))
                note(i, true);
        }
    }

    void climb()
    {
        for (const std::size_t i : judge_.with_domain()) climb(i, false);
        for (const std::size_t i : judge_.sums()) climb(i, true);
    }

    void climb(std::size_t instruction, bool is_sum)
    {
        const std::size_t group = group_of_[instruction];
        const HazardKind kind = is_sum ? HazardKind::cancellation : HazardKind::domain;
        Tally& tally = tallies_[group][static_cast<std::size_t>(kind)];
        Start here = starts_[is_sum ? 1 : 0][group];
        if (tally.count > 0 || !tally.worst.empty() || here.height == nothing) return;
        Random random{group};
        const std::size_t length = std::max(line_.tape.code.size(), usual_length);
        for (std::size_t step = 0; step < climbing_steps * usual_length / length; ++step) {
            const Point next = space_.neighbor(here.point, random);
            const bool wrong = run_at(next);
            trace_.find_demand();
            if (!trace_.demanded(line_.tape.code[instruction].result)) continue;
            judge_.find(trace_, wrong, events_);
            for (const HazardEvent& event : events_) {
                if (group_of_[event.instruction] != group || event.kind != kind) continue;
                tally.worst.push_back({severity(event), next});
                return;
            }
            const double there = height(instruction, is_sum);
            if (there < here.height) continue;
            here = {there, next};
        }
    }

    /// The instruction of a group that is hazardous at a point, if one is. A cancellation has to be
    /// what makes the result wrong: with its exact value the result is clearly better.
    std::optional<std::size_t> holds(std::size_t group, HazardKind kind, const Point& point)
    {
        const bool wrong = run_at(point);
        if (!judge_.may_find(trace_, wrong)) return std::nullopt;
        trace_.find_demand();
        std::vector<HazardEvent> events;
        judge_.find(trace_, wrong, events);
        const double before = error();
        for (const HazardEvent& event : events) {
            if (group_of_[event.instruction] != group || event.kind != kind) continue;
            if (kind != HazardKind::cancellation) return event.instruction;
            constexpr double clearly = 0.75;
            run_at(point, event.instruction);
            if (error() < clearly * before && !is_inherent(point, before)) return event.instruction;
        }
        return std::nullopt;
    }

    /// Inputs that cannot be told from these have results that are as far apart, and the emitted
    /// spelling is no better: that is the function's conditioning, and no arithmetic's fault.
    bool is_inherent(const Point& point, double error)
    {
        truth_.run(point);
        std::vector<double> exact;
        for (const evaluate::Slot slot : truth_.line().tape.outputs)
            exact.push_back(truth_.exact(slot));
        if (worst_result(truth_, truth_).error < error / 2) return false;
        double spread = 0;
        for (const Point& near : space_.indistinguishable(point)) {
            truth_.run(near);
            double apart = 0;
            for (std::size_t k = 0; k < exact.size(); ++k)
                apart = std::max(
                    apart, scaled_error(truth_.exact(truth_.line().tape.outputs[k]), exact[k]));
            spread += apart / 2;  // of the two neighbors in every column
        }
        return error <= spread;
    }

    /// A witness that 113 bits confirm, simplified; nothing if there is none.
    std::optional<FoundHazard> settle(std::size_t group, HazardKind kind, std::size_t points)
    {
        const Tally& tally = tallies_[group][static_cast<std::size_t>(kind)];
        for (const Tally::Candidate& candidate : tally.worst) {
            if (!holds(group, kind, candidate.point)) continue;
            FoundHazard found;
            found.kind = kind;
            found.share = static_cast<double>(tally.count) / static_cast<double>(points);
            found.witness = space_.simplest(candidate.point, [&](const Point& point) {
                return holds(group, kind, point).has_value();
            });
            const auto instruction = holds(group, kind, found.witness);
            if (!instruction) continue;
            found.instruction = *instruction;
            if (kind == HazardKind::cancellation) {
                const evaluate::Slot result = line_.tape.code[*instruction].result;
                trace_.run(found.witness);
                trace_.confirm(found.witness);
                const auto digits = static_cast<double>(trace_.grid().digits);
                found.lost_bits = digits - trace_.kept_bits(result);
                if (found.lost_bits < digits / 2) continue;
            }
            return found;
        }
        return std::nullopt;
    }

    const WatchedLine& line_;
    const HazardSpace& space_;
    HazardJudge judge_;
    Trace trace_;
    Trace truth_;
    bool is_truth_;
    std::size_t groups_ = 0;
    std::vector<std::size_t> group_of_;  ///< by instruction
    std::vector<std::array<Tally, kinds>> tallies_;
    std::array<std::vector<Start>, 2> starts_;  ///< by group; of domains, of sums
    std::vector<HazardEvent> events_;
};

}  // namespace

WorstResult worst_result(const Trace& trace, const Trace& truth)
{
    WorstResult worst;
    worst.error = -1;
    const auto& outputs = trace.line().tape.outputs;
    for (std::size_t k = 0; k < outputs.size(); ++k) {
        const double result = trace.device(outputs[k]);
        const double exact = truth.exact(truth.line().tape.outputs[k]);
        const double error = scaled_error(result, exact);
        if (error > worst.error) worst = {k, result, exact, error};
    }
    return worst;
}

std::vector<FoundHazard> search_hazards(const WatchedLine& line, const WatchedLine& truth,
                                        const HazardSpace& space, const Points& points,
                                        evaluate::Precision precision)
{
    return Search{line, truth, space, precision}.run(points);
}

double not_finite_share(const WatchedLine& line, const Points& points,
                        evaluate::Precision precision)
{
    Trace trace{line, precision};
    Point point(points.columns.size());
    std::size_t count = 0;
    for (std::size_t index = 0; index < points.size(); ++index) {
        read(points, index, point);
        trace.run(point);
        count += std::ranges::any_of(line.tape.outputs, [&](evaluate::Slot slot) {
            return !std::isfinite(trace.device(slot));
        });
    }
    return points.size() == 0 ? 0 : static_cast<double>(count) / static_cast<double>(points.size());
}

}  // namespace lobe::analyze
