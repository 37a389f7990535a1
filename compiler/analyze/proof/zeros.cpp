#include "analyze/proof/zeros.h"

#include "analyze/grid.h"
#include "analyze/proof/search.h"
#include "analyze/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lobe::analyze {
namespace {

using evaluate::Interval;
using evaluate::RoundingNode;
using evaluate::TapeOp;

bool is_sum(TapeOp op)
{
    return op == TapeOp::add || op == TapeOp::subtract || op == TapeOp::sum3 || op == TapeOp::sum4;
}

bool is_choice(TapeOp op)
{
    return op == TapeOp::minimum || op == TapeOp::maximum || op == TapeOp::less ||
           op == TapeOp::less_equal || op == TapeOp::step;
}

/// The values of a tape's nodes at a point, nearly.
class Values {
public:
    explicit Values(const Subject& subject) : subject_{subject}, values_(subject.steps.nodes.size())
    {
    }

    /// What is to become 0: a sum; of a choice between two values, their difference.
    double at(const Point& point, std::uint32_t node)
    {
        for (std::uint32_t i = 0; i <= node; ++i) {
            const RoundingNode& each = subject_.steps.nodes[i];
            if (each.kind == RoundingNode::Kind::input) values_[i] = only(point[each.input]);
            if (each.kind == RoundingNode::Kind::literal) values_[i] = only(each.literal.value);
            if (each.kind != RoundingNode::Kind::operation) continue;
            std::array<Interval, 4> in{};
            for (std::size_t k = 0; k < static_cast<std::size_t>(each.arity); ++k)
                in[k] = values_[each.operands[k]];
            values_[i] = evaluate::value_of(each.op, in);
        }
        const RoundingNode& last = subject_.steps.nodes[node];
        return is_choice(last.op)
                   ? middle(values_[last.operands[0]]) - middle(values_[last.operands[1]])
                   : middle(values_[node]);
    }

private:
    static double middle(Interval x) { return x.low / 2 + x.high / 2; }
    static Interval only(double x) { return {x, x}; }

    const Subject& subject_;
    std::vector<Interval> values_;
};

struct Sum {
    std::uint32_t node = 0;
    std::vector<bool> reads;  ///< by input
};

std::vector<Sum> sums(const Subject& subject)
{
    std::vector<Sum> result;
    const auto& nodes = subject.steps.nodes;
    std::vector<std::vector<bool>> reads(nodes.size(), std::vector<bool>(subject.box.size()));
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].kind == RoundingNode::Kind::input) reads[i][nodes[i].input] = true;
        for (std::size_t k = 0; k < static_cast<std::size_t>(nodes[i].arity); ++k)
            for (std::size_t input = 0; input < subject.box.size(); ++input)
                if (reads[nodes[i].operands[k]][input]) reads[i][input] = true;
        if (nodes[i].kind == RoundingNode::Kind::operation &&
            (is_sum(nodes[i].op) || is_choice(nodes[i].op)))
            result.push_back({i, reads[i]});
    }
    return result;
}

/// A coordinate that the sum reads; if there are such, one that moves no sum of those before.
std::optional<std::size_t> coordinate_for(const Subject& subject, const Sum& sum,
                                          const std::vector<bool>& taken, Random& random)
{
    std::vector<std::size_t> free;
    std::vector<std::size_t> any;
    for (std::size_t i = 0; i < subject.box.size(); ++i) {
        if (!sum.reads[i] || subject.whole[i]) continue;
        any.push_back(i);
        if (!taken[i]) free.push_back(i);
    }
    const auto& from = free.empty() ? any : free;
    if (from.empty()) return std::nullopt;
    return from[random.below(static_cast<std::uint32_t>(from.size()))];
}

bool differ(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

/// Moves one coordinate to where the sum changes its sign, if it does between the ends of the side.
bool bring_to_zero(const Subject& subject, Values& values, const Interval& side, std::uint32_t sum,
                   std::size_t coordinate, Point& point)
{
    const auto at = [&](float x) {
        Point moved = point;
        moved[coordinate] = x;
        return values.at(moved, sum);
    };
    float low = static_cast<float>(side.low);
    float high = static_cast<float>(side.high);
    const float here = point[coordinate];
    double at_low = at(low);
    const double at_here = at(here);
    if (differ(at_low, at_here)) {
        high = here;
    } else if (const double at_high = at(high); differ(at_here, at_high)) {
        low = here;
        at_low = at_here;
    } else {
        return false;
    }
    constexpr int most = 80;  // a float next to 0 takes more, and is as good as 0
    for (int i = 0; i < most; ++i) {
        const double middle = static_cast<double>(low) / 2 + static_cast<double>(high) / 2;
        const float x = on_grid(middle, side, subject.precision);
        if (x == low || x == high) break;
        const double value = at(x);
        if (value == 0) {
            low = x;
            break;
        }
        if (differ(at_low, value)) {
            high = x;
        } else {
            low = x;
            at_low = value;
        }
    }
    point[coordinate] = low;
    return true;
}

}  // namespace

std::vector<Point> points_at_zeros(const Subject& subject, const Box& box, std::size_t count,
                                   std::uint64_t key)
{
    const std::vector<Sum> all = sums(subject);
    if (all.empty()) return {};
    const auto number = static_cast<std::uint32_t>(all.size());
    const Grid& grid = grid_of(subject.precision);
    Values values{subject};
    Random random{key};
    constexpr std::size_t neighbors = 4;
    std::vector<Point> points;
    for (std::size_t i = 0; i < count / (neighbors + 1); ++i) {
        Point point = points_in(subject, box, 1, key + i).front();
        std::vector<bool> taken(box.size());
        bool found = false;
        std::uint32_t which = random.below(number);
        for (std::uint32_t wanted = 1 + random.below(3), tries = 0; wanted > 0 && tries < 8;
             ++tries) {
            // Components of a vector stand side by side.
            which = random.coin() ? (which + 1) % number : random.below(number);
            const Sum& sum = all[which];
            const auto coordinate = coordinate_for(subject, sum, taken, random);
            if (!coordinate ||
                !bring_to_zero(subject, values, box[*coordinate], sum.node, *coordinate, point))
                continue;
            for (std::size_t k = 0; k < taken.size(); ++k) taken[k] = taken[k] || sum.reads[k];
            found = true;
            --wanted;
        }
        if (!found) continue;
        points.push_back(point);
        for (std::size_t n = 0; n < neighbors; ++n) {
            Point near = point;
            for (std::size_t k = 0; k < near.size(); ++k) {
                if (subject.whole[k] || random.coin()) continue;
                const double x = near[k];
                const double steps = static_cast<double>(random.below(9)) - 4;
                near[k] = on_grid(x + steps * step_at(x, grid), box[k], subject.precision);
            }
            points.push_back(std::move(near));
        }
    }
    return points;
}

}  // namespace lobe::analyze
