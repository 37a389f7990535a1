#include "analyze/proof/bounds.h"

#include "analyze/grid.h"
#include "analyze/proof/zeros.h"
#include "evaluate/bounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace lobe::analyze {
namespace {

using evaluate::BoxError;
using evaluate::Interval;
using evaluate::Machine;
using evaluate::RoundingBounds;

/// A cut that leaves more than this of the bound is no better than any other.
constexpr double worthwhile_near = 0.9;
constexpr double worthwhile_far = 0.1;

/// Of equal bounds the deeper box comes first, so that a jump is followed to where it happens.
bool less_bad(const auto& a, const auto& b)
{
    return a.bound < b.bound || (a.bound == b.bound && a.depth < b.depth);
}

/// A small part of a side. Not a point: there operations may happen to be exact.
Interval around(double x, const Interval& side)
{
    const double size = std::abs(x);
    const double from_one = std::abs(1 - size);
    const double width = side.high - side.low;
    const double radius =
        std::max(std::min({size, from_one, width}) / 64, std::min(width, 1.0) * 0x1p-24);
    return {std::max(side.low, x - radius), std::min(side.high, x + radius)};
}

/// The whole box, cut where an input is compared with a number: on either side every condition of
/// this kind is decided, and what it chooses has slopes.
std::vector<Box> by_conditions(const Subject& subject)
{
    using evaluate::RoundingNode;
    using evaluate::TapeOp;
    const auto& nodes = subject.steps.nodes;
    std::vector<Box> boxes{subject.box};
    constexpr std::size_t most = 64;
    for (const RoundingNode& node : nodes) {
        if (node.kind != RoundingNode::Kind::operation || node.arity != 2) continue;
        if (node.op != TapeOp::less && node.op != TapeOp::less_equal && node.op != TapeOp::equal &&
            node.op != TapeOp::not_equal && node.op != TapeOp::step)
            continue;
        for (std::size_t k = 0; k < 2; ++k) {
            const RoundingNode& input = nodes[node.operands[k]];
            const RoundingNode& number = nodes[node.operands[1 - k]];
            if (input.kind != RoundingNode::Kind::input ||
                number.kind != RoundingNode::Kind::literal || boxes.size() > most)
                continue;
            std::vector<Box> parts;
            for (Box& box : boxes) {
                const Interval side = box[input.input];
                const double at = number.literal.value;
                if (!(side.low <= at && at < side.high)) {
                    parts.push_back(std::move(box));
                    continue;
                }
                auto [below, above] = halves(subject, box, {input.input, at});
                parts.push_back(std::move(below));
                parts.push_back(std::move(above));
            }
            boxes = std::move(parts);
        }
    }
    return boxes;
}

}  // namespace

Division::Division(const Subject& subject, Machine machine, Measure measure, Worst& worst)
    : subject_{subject}, measure_{measure}, worst_{worst}, bounds_{subject.steps,
                                                                   evaluate::rounding(
                                                                       machine, subject.precision),
                                                                   subject.floor, subject.given}
{
    for (Box& box : by_conditions(subject)) {
        leaves_.push_back(leaf(std::move(box), 0));
        std::ranges::push_heap(leaves_, less_bad<Leaf, Leaf>);
    }
}

double Division::ratio() const
{
    if (bound() == 0) return 1;
    return worst_.error() > 0 ? bound() / worst_.error() : evaluate::infinity;
}

void Division::refine(std::size_t budget, double target)
{
    const std::size_t end = spent_ + boxes_within(budget, subject_);
    while (spent_ < end && bound() > 0 && bound() > target * worst_.error()) {
        if (spent_ >= next_search_ && subject_.given.empty()) {
            next_search_ += next_search_ / 2;
            search();
        } else if (!divide_worst()) {
            break;
        }
    }
}

double Division::bound_of(const Box& box)
{
    ++spent_;
    const BoxError error = bounds_.error(box);
    const double bound = measure_ == Measure::absolute   ? error.absolute
                         : measure_ == Measure::relative ? error.relative
                                                         : error.jump;
    return bound != bound ? evaluate::infinity : bound;
}

Division::Leaf Division::leaf(Box box, std::uint32_t depth)
{
    const double bound = bound_of(box);
    return {bound, doubt(), std::move(box), depth};
}

/// How little is known of all that happens on the way, in bits: what a cut may lessen long before
/// the bound of the result follows.
double Division::doubt() const
{
    constexpr double most = 64;
    double total = 0;
    for (std::size_t i = 0; i < subject_.steps.nodes.size(); ++i) {
        if (subject_.steps.nodes[i].kind != evaluate::RoundingNode::Kind::operation) continue;
        const evaluate::Rounded& value = bounds_.values()[i];
        const double one = std::abs(value.exact.low);
        const double other = std::abs(value.exact.high);
        const double high = std::max(one, other);
        const bool has_sign = value.exact.low >= 0 || value.exact.high <= 0;
        if (!has_sign || !(high < evaluate::infinity))
            total += most;
        else if (std::min(one, other) > 0)
            total += std::min(std::log2(high / std::min(one, other)), most);
        else if (high > 0)
            // The less the nearer to 0, by little: other sides come first while they are wide.
            total += most + std::max(std::log2(high) / 16, -8.0);
        total += value.relative < 1 ? std::max(std::log2(value.relative) + 24, 0.0) : most;
    }
    return total;
}

/// Looks for bad points in the worst box.
void Division::search()
{
    std::vector<Observed> values;
    const auto look = [&](const std::vector<Point>& points) {
        evaluate_points(subject_, points, values);
        worst_.consider(points, values);
    };
    look(points_in(subject_, leaves_.front().box, 512, spent_));
    look(points_at_zeros(subject_, leaves_.front().box, 64, spent_));
    for (std::size_t round = 0; round < 4 && worst_.point() != nullptr; ++round) {
        const auto& entries = worst_.entries();
        const Point center = entries[round % entries.size()].point;
        look(points_near(subject_, center, 256, spent_ + round * 7919));
    }
}

/// The side that widens the bound most: all at full width but it; or it alone, with all others near
/// their middles. No other cut helps until that one is made, however many it takes.
std::optional<std::size_t> Division::loosest(const Leaf& parent)
{
    if (parent.box.size() < 3) return std::nullopt;
    Box narrow = parent.box;
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        const Interval& side = narrow[i];
        const double x = side.low + (side.high - side.low) / 2;
        narrow[i] = around(x, side);
    }
    Box wide = parent.box;
    std::optional<std::size_t> result;
    double most = 1.1;
    const auto gain_most = [&](const auto& gain_of) {
        for (std::size_t i = 0; i < wide.size(); ++i) {
            if (wide[i].low == wide[i].high) continue;
            std::swap(wide[i], narrow[i]);
            const double gain = gain_of();
            std::swap(wide[i], narrow[i]);
            if (!(gain > most)) continue;
            most = gain;
            result = i;
        }
    };
    gain_most([&] { return parent.bound / bound_of(wide); });
    if (!result) {
        const double tight = bound_of(narrow);
        gain_most([&] { return bound_of(narrow) / tight; });
    }
    return result;
}

bool Division::divide_worst()
{
    const Leaf parent = leaves_.front();
    std::vector<Cut> cuts;
    if (const auto side = loosest(parent)) cuts_of(parent.box[*side], *side, cuts);
    if (cuts.empty())
        for (std::size_t i = 0; i < parent.box.size(); ++i) cuts_of(parent.box[i], i, cuts);
    if (cuts.empty()) return false;

    const bool far = parent.bound > 100 * worst_.error();
    const double worthwhile = (far ? worthwhile_far : worthwhile_near) * parent.bound;
    Leaf low;
    Leaf high;
    double best = evaluate::infinity;
    double best_doubt = evaluate::infinity;
    for (const Cut& cut : cuts) {
        auto [below, above] = halves(subject_, parent.box, cut);
        Leaf left = leaf(std::move(below), parent.depth + 1);
        Leaf right = leaf(std::move(above), parent.depth + 1);
        const double most = std::max(left.bound, right.bound);
        // Cuts that do not help by themselves are told apart by what they clear up.
        const double rank = most < worthwhile ? most : parent.bound;
        const double left_over = left.bound > right.bound   ? left.doubt
                                 : right.bound > left.bound ? right.doubt
                                                            : std::max(left.doubt, right.doubt);
        if (low.box.empty() || rank < best || (rank == best && left_over < best_doubt)) {
            best = rank;
            best_doubt = left_over;
            low = std::move(left);
            high = std::move(right);
        }
    }
    std::ranges::pop_heap(leaves_, less_bad<Leaf, Leaf>);
    leaves_.pop_back();
    // A part of a box is never worse than the box.
    for (Leaf* part : {&low, &high}) {
        part->bound = std::min(part->bound, parent.bound);
        leaves_.push_back(std::move(*part));
        std::ranges::push_heap(leaves_, less_bad<Leaf, Leaf>);
    }
    return true;
}

Bound::Bound(const Subject& subject, Machine machine, Measure measure, Worst& worst)
    : subject_{subject}, machine_{machine}, measure_{measure}, worst_{worst}
{
    divisions_.emplace_back(subject, machine, measure, worst);
}

std::size_t Bound::best() const
{
    const auto best = std::ranges::min_element(divisions_, {}, &Division::bound);
    return static_cast<std::size_t>(best - divisions_.begin());
}

void Bound::start_waists()
{
    if (std::exchange(started_, true)) return;
    from_ = from_waists(subject_, machine_, measure_ == Measure::jump);
    for (const Subject& from : from_) divisions_.emplace_back(from, machine_, measure_, worst_);
}

void Bound::refine(std::size_t budget, double target)
{
    divisions_.front().refine(budget / 4, target);
    if (ratio() <= target) return;
    start_waists();
    // A part of the budget to see which way leads anywhere: in every round the better half goes on.
    std::vector<std::size_t> order(divisions_.size());
    std::iota(order.begin(), order.end(), 0);
    while (order.size() > 1 && ratio() > target) {
        for (const std::size_t i : order) divisions_[i].refine(budget / 16 / order.size(), target);
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return divisions_[i].bound(); });
        order.resize((order.size() + 1) / 2);
    }
    divisions_[best()].refine(budget / 2, target);
}

std::size_t Bound::boxes() const
{
    std::size_t total = 0;
    for (const Division& division : divisions_) total += division.boxes();
    return total;
}

void cuts_of(const Interval& side, std::size_t index, std::vector<Cut>& cuts)
{
    if (!(side.low < side.high)) return;
    const auto add = [&](double at) {
        if (side.low < at && at < side.high) cuts.push_back({index, at});
    };
    const double middle = side.low + (side.high - side.low) / 2;
    add(middle);
    const double most = std::max(std::abs(side.low), std::abs(side.high));
    const double least = std::min(std::abs(side.low), std::abs(side.high));
    if (side.low >= 0 || side.high <= 0) {
        // By binades, between the ends or toward 0.
        if (most > 4 * least) {
            const double floor =
                least > 0 ? std::log2(least) : std::max(-150.0, 8 * std::log2(most) - 8);
            const double at = std::exp2(std::round((floor + std::log2(most)) / 2));
            add(side.low >= 0 ? at : -at);
        }
        // Toward 1, where differences from it are small.
        const double rest = 1 - side.low;
        if (side.high == 1 && rest > 0x1p-22)
            add(1 - std::exp2(std::round((std::log2(rest) - 24) / 2)));
    } else {
        add(0);
    }
}

std::pair<Box, Box> halves(const Subject& subject, const Box& box, const Cut& cut)
{
    std::pair<Box, Box> result{box, box};
    const Interval& side = box[cut.side];
    if (!subject.given.empty()) {
        result.first[cut.side].high = result.second[cut.side].low = cut.at;
        return result;
    }
    const Grid& grid = grid_of(subject.precision);
    double at = on_grid(cut.at, side, subject.precision);
    if (at >= side.high) at = next_below(side.high, grid);
    result.first[cut.side].high = at;
    result.second[cut.side].low = next_above(at, grid);
    return result;
}

void explore(const Subject& subject, const std::vector<Worst*>& worst, std::uint64_t round)
{
    std::vector<Observed> values;
    const auto look = [&](const std::vector<Point>& points) {
        evaluate_points(subject, points, values);
        for (Worst* each : worst) each->consider(points, values);
    };
    std::uint64_t next = round << 8;
    const auto key = [&next] { return next++ << 20; };
    for (int batch = 0; batch < 16; ++batch) look(points_in(subject, subject.box, 2048, key()));
    for (int batch = 0; batch < 2; ++batch)
        look(points_at_zeros(subject, subject.box, boxes_within(4096, subject), key()));
    for (Worst* each : worst)
        for (std::size_t climb = 0; climb < 48 && each->point() != nullptr; ++climb) {
            const Point center = each->entries()[climb * climb % each->entries().size()].point;
            look(points_near(subject, center, 512, key()));
        }
}

}  // namespace lobe::analyze
