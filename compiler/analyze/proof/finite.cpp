#include "analyze/proof/finite.h"

#include "analyze/grid.h"
#include "analyze/proof/bounds.h"
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

/// A box of inputs and, behind them, of the values that more than one operation reads. A device
/// computes each of those once, so cases of its value may be told apart like those of an input; in
/// sum and quotient of the same value that is what keeps them together.
class Prover {
public:
    explicit Prover(const Subject& subject)
        : subject_{subject}, rules_{evaluate::rules(subject.precision)},
          values_(subject.operations.nodes.size()), side_of_(subject.operations.nodes.size())
    {
        const auto& nodes = subject.operations.nodes;
        std::vector<int> users(nodes.size());
        for (const RoundingNode& node : nodes)
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.arity); ++k)
                ++users[node.operands[k]];
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (nodes[i].kind == RoundingNode::Kind::operation && users[i] > 1) {
                shared_.push_back(i);
                side_of_[i] = subject.box.size() + shared_.size() - 1;
            }
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
            // Past the arity they are not read.
            std::array<Acceptance, 4> operands{};
            for (std::size_t k = 0; k < operands.size(); ++k)
                operands[k] = values_[node.operands[k]];
            for (const Limit& limit : node.limits)
                cut(operands[limit.operand], limit.kind, values_[limit.other]);
            values_[i] = evaluate::apply(rules_, node.op, operands[0], operands[1], operands[2],
                                         operands[3]);
            if (side_of_[i] == 0 || side_of_[i] >= box.size() || !is_finite(values_[i])) continue;
            const Interval& side = box[side_of_[i]];
            Acceptance& value = values_[i];
            if (value.low > side.high || value.high < side.low) return never;
            value.low = std::max(value.low, side.low);
            value.high = std::min(value.high, side.high);
        }
        return values_.back();
    }
    /// The same box with sides for the shared values that are known to be finite; the others stay
    /// as they are.
    Box with_shared(Box box)
    {
        run(box);
        for (const std::size_t node : shared_) {
            const Acceptance& value = values_[node];
            box.push_back(is_finite(value) ? Interval{value.low, value.high}
                                           : Interval{-evaluate::infinity, evaluate::infinity});
        }
        return box;
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
                if (k > 0) operands += ", ";
                operands += fmt::format("[{:.6g}, {:.6g}]", x.low, x.high);
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
    std::vector<std::size_t> shared_;
    std::vector<std::size_t> side_of_;               ///< of a shared value; 0: none
    static constexpr Acceptance never{0, 0, false};  ///< no input of the box gets there
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

/// Joins boxes that differ in one side, where there is no number between them.
void join(std::vector<Box>& boxes, const Grid& grid)
{
    const auto joined = [&grid](Box& a, const Box& b) {
        std::optional<std::size_t> side;
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i] == b[i]) continue;
            if (side) return false;
            side = i;
        }
        if (!side) return true;
        if (next_above(a[*side].high, grid) < b[*side].low ||
            next_above(b[*side].high, grid) < a[*side].low)
            return false;
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

namespace {

/// How much of a side a part of it is: by width, and by binades.
double share_of(const Interval& part, const Interval& side)
{
    const auto binades = [](const Interval& of) {
        const auto at = [](double x) { return std::log2(std::max(std::abs(x), 0x1p-150)); };
        return of.low < 0 && of.high > 0 ? 300 + at(of.low) + at(of.high)
                                         : std::abs(at(of.high) - at(of.low));
    };
    return (part.high - part.low) / (side.high - side.low) +
           binades(part) / std::max(binades(side), 1e-6);
}

/// Divides boxes until they are proved or the budget is spent; what is left is open.
std::vector<Box> divide(const Subject& subject, Prover& prover, std::deque<Box> waiting,
                        std::size_t budget, std::size_t& looked)
{
    const std::size_t end = looked + budget;
    std::vector<Box> open;
    while (!waiting.empty() && looked < end) {
        const Box parent = std::move(waiting.front());
        waiting.pop_front();
        ++looked;
        if (prover.proves(parent)) continue;
        std::vector<Cut> cuts;
        for (std::size_t i = 0; i < parent.size(); ++i)
            if (parent[i].high < evaluate::infinity) cuts_of(parent[i], i, cuts);
        std::optional<std::pair<Box, Box>> best;
        double most_proved = 0;
        double best_doubt = 0;
        for (const Cut& cut : cuts) {
            auto parts = halves(subject, parent, cut);
            const double doubt = prover.doubt(parts.first) + prover.doubt(parts.second);
            double proved = 0;
            for (const Box* part : {&parts.first, &parts.second})
                if (prover.proves(*part)) proved += share_of((*part)[cut.side], parent[cut.side]);
            looked += 2;
            if (best && (proved < most_proved || (proved == most_proved && doubt >= best_doubt)))
                continue;
            best = std::move(parts);
            most_proved = proved;
            best_doubt = doubt;
        }
        if (!best) {
            open.push_back(parent);
            continue;
        }
        waiting.push_back(std::move(best->first));
        waiting.push_back(std::move(best->second));
    }
    for (Box& left : waiting)
        if (!prover.proves(left)) open.push_back(std::move(left));
    return open;
}

}  // namespace

Finite prove_finite(const Subject& subject, const Box& box, std::size_t budget)
{
    Prover prover{subject};
    Finite result;
    budget = boxes_within(budget, subject);
    std::vector<Box> open = divide(subject, prover, {box}, budget / 2, result.boxes);
    join(open, grid_of(subject.precision));
    std::ranges::stable_sort(
        open, [&](const Box& a, const Box& b) { return volume(a, box) > volume(b, box); });
    // By cases of values on the way, box by box.
    for (const Box& left : open) {
        const std::size_t share = std::max<std::size_t>(budget / 2 / open.size(), 64);
        if (!divide(subject, prover, {prover.with_shared(left)}, share, result.boxes).empty())
            result.open.push_back(left);
    }
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
