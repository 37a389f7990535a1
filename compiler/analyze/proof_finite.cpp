#include "analyze/proof_finite.h"

#include "analyze/proof_bounds.h"
#include "evaluate/acceptance.h"
#include "evaluate/bounds.h"
#include "evaluate/literals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

namespace lobe::analyze {
namespace {

using evaluate::Acceptance;
using evaluate::Interval;
using evaluate::Limit;
using evaluate::RoundingNode;

bool is_finite(const Acceptance& x)
{
    return !x.undefined && x.low > -evaluate::infinity && x.high < evaluate::infinity;
}

/// The part of `x` that a limit leaves; where there is none the value is not wanted.
void cut(Acceptance& x, Limit::Kind kind, const Acceptance& other)
{
    switch (kind) {
    case Limit::Kind::at_least: x.low = std::max(x.low, other.low); break;
    case Limit::Kind::at_most: x.high = std::min(x.high, other.high); break;
    case Limit::Kind::size_least:
        if (x.low > -other.low) x.low = std::max(x.low, other.low);
        if (x.high < other.low) x.high = std::min(x.high, -other.low);
        break;
    }
    if (x.low > x.high && kind == Limit::Kind::at_most) x.low = x.high;
    if (x.low > x.high) x.high = x.low;
}

class Prover {
public:
    explicit Prover(const Subject& subject)
        : subject_{subject}, rules_{evaluate::rules(subject.precision)},
          values_(subject.operations.nodes.size())
    {
        const auto& nodes = subject.operations.nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].kind != RoundingNode::Kind::literal) continue;
            const double value = subject.precision == evaluate::Precision::float32
                                     ? static_cast<double>(evaluate::to_float(nodes[i].literal))
                                     : evaluate::to_half(nodes[i].literal);
            values_[i] = evaluate::admit(rules_, {value, value, false});
        }
    }

    const Acceptance& run(const Box& box)
    {
        const auto& nodes = subject_.operations.nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const RoundingNode& node = nodes[i];
            if (node.kind == RoundingNode::Kind::input)
                values_[i] =
                    evaluate::admit(rules_, {box[node.input].low, box[node.input].high, false});
            if (node.kind != RoundingNode::Kind::operation) continue;
            std::array<Acceptance, 4> operands{};
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
                operands[k] = values_[node.operands[k]];
            for (const Limit& limit : node.limits)
                cut(operands[limit.operand], limit.kind, values_[limit.other]);
            values_[i] = evaluate::apply(rules_, node.op, operands[0], operands[1], operands[2],
                                         operands[3]);
        }
        return values_.back();
    }
    bool proves(const Box& box) { return is_finite(run(box)); }

    /// The first operation whose result may not be finite although its operands are.
    std::string hazard(const Box& box)
    {
        run(box);
        const auto& nodes = subject_.operations.nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].kind != RoundingNode::Kind::operation || is_finite(values_[i])) continue;
            std::string operands;
            for (std::size_t k = 0; k < static_cast<std::size_t>(nodes[i].arity); ++k) {
                const Acceptance& x = values_[nodes[i].operands[k]];
                operands += fmt::format("{}[{:.6g}, {:.6g}]", k == 0 ? "" : ", ", x.low, x.high);
            }
            const std::string_view what =
                values_[i].undefined ? "may be undefined" : "may overflow";
            return fmt::format("{} of {} {}", evaluate::name(nodes[i].op), operands, what);
        }
        return {};
    }

    /// How far the result is from being known: a cut that lessens it is a good one.
    double doubt(const Box& box)
    {
        run(box);
        double total = 0;
        for (const Acceptance& value : values_) {
            if (value.undefined) total += 100;
            const double most = std::max(std::abs(value.low), std::abs(value.high));
            total +=
                most < evaluate::infinity ? std::max(std::log2(std::max(most, 1.0)), 0.0) : 200;
        }
        return total;
    }

private:
    const Subject& subject_;
    const evaluate::Rules& rules_;
    std::vector<Acceptance> values_;
};

/// The size of a box as part of a whole one, by binades where a side reaches 0.
double volume(const Box& box, const Box& whole)
{
    double result = 1;
    for (std::size_t i = 0; i < box.size(); ++i) {
        const double width = whole[i].high - whole[i].low;
        if (width > 0) result *= std::max((box[i].high - box[i].low) / width, 0x1p-60);
    }
    return result;
}

/// Joins boxes that differ in one side, where they touch.
void join(std::vector<Box>& boxes)
{
    const auto joined = [](Box& a, const Box& b) {
        std::optional<std::size_t> side;
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i] == b[i]) continue;
            if (side) return false;
            side = i;
        }
        if (!side) return true;
        if (a[*side].high < b[*side].low || b[*side].high < a[*side].low) return false;
        a[*side] = {std::min(a[*side].low, b[*side].low), std::max(a[*side].high, b[*side].high)};
        return true;
    };
    for (bool again = boxes.size() <= 2048; again;) {
        again = false;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (std::size_t k = boxes.size(); k-- > i + 1;)
                if (joined(boxes[i], boxes[k])) {
                    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(k));
                    again = true;
                }
    }
}

}  // namespace

Finite prove_finite(const Subject& subject, const Box& box, std::size_t budget)
{
    Prover prover{subject};
    Finite result;
    std::deque<Box> waiting{box};
    while (!waiting.empty() && result.boxes < budget) {
        const Box parent = std::move(waiting.front());
        waiting.pop_front();
        ++result.boxes;
        if (prover.proves(parent)) continue;
        std::vector<Cut> cuts;
        for (std::size_t i = 0; i < parent.size(); ++i) cuts_of(parent[i], i, cuts);
        if (cuts.empty()) {
            result.open.push_back(parent);
            continue;
        }
        std::optional<std::pair<Box, Box>> best;
        double best_doubt = 0;
        for (const Cut& cut : cuts) {
            auto parts = halves(parent, cut);
            const double doubt = prover.doubt(parts.first) + prover.doubt(parts.second);
            result.boxes += 2;
            if (best && doubt >= best_doubt) continue;
            best = std::move(parts);
            best_doubt = doubt;
        }
        waiting.push_back(std::move(best->first));
        waiting.push_back(std::move(best->second));
    }
    for (Box& left : waiting)
        if (!prover.proves(left)) result.open.push_back(std::move(left));
    join(result.open);
    std::ranges::stable_sort(
        result.open, [&](const Box& a, const Box& b) { return volume(a, box) > volume(b, box); });
    return result;
}

std::string first_hazard(const Subject& subject, const Box& box)
{
    return Prover{subject}.hazard(box);
}

std::optional<Box> finite_part(const Subject& subject, std::size_t budget)
{
    const auto proves = [&](const Box& box) {
        return prove_finite(subject, box, budget).open.empty();
    };
    const std::size_t sides = subject.box.size();
    // How far each side is cut back: below 2^-k, and above high 2^-j.
    constexpr int none = 25;
    std::vector<int> low(sides, none);
    std::vector<int> high(sides, 0);
    const auto box_of = [&] {
        Box box = subject.box;
        for (std::size_t i = 0; i < sides; ++i) {
            const double top = std::ldexp(box[i].high, -high[i]);
            const double bottom = std::ldexp(1.0, -low[i]);
            if (high[i] > 0 && top > box[i].low && box[i].high > 0) box[i].high = top;
            if (low[i] < none && box[i].low >= 0 && bottom > box[i].low && bottom < box[i].high)
                box[i].low = bottom;
        }
        return box;
    };
    const auto search = [&] {
        for (int j = 0; j <= 8; ++j)
            for (int k = none; k >= 1; k = k == none ? 14 : k - 1) {
                std::ranges::fill(low, k);
                std::ranges::fill(high, j);
                if (proves(box_of())) return true;
            }
        return false;
    };
    if (!search()) return std::nullopt;
    // Each side back as far as it goes.
    for (std::size_t i = 0; i < sides; ++i) {
        const auto relax = [&](int& amount, int goal) {
            const int step = goal > amount ? 1 : -1;
            const int kept = std::exchange(amount, goal);
            if (proves(box_of())) return;
            amount = kept;
            for (int next = kept + step; next != goal; next += step) {
                amount = next;
                if (!proves(box_of())) {
                    amount = next - step;
                    return;
                }
            }
        };
        if (high[i] > 0) relax(high[i], 0);
        if (low[i] < none) relax(low[i], none);
    }
    return box_of();
}

}  // namespace lobe::analyze
