#include "check/boxes.h"

#include <algorithm>
#include <cmath>

namespace lobe::check {
namespace {

/// Boxes that one proof may look at, and a quick one.
constexpr std::size_t most_boxes = 4096;
constexpr std::size_t few_boxes = 32;
/// A proof takes at most this part of the effort that is left.
constexpr std::size_t proof_share = 5;
/// Above this many expressions slopes cost more than halving boxes.
constexpr std::size_t most_slope_expressions = 200'000;

bool is_point(const Interval& range) { return range.low == range.high; }

/// Where to cut a range in two. Unbounded ones at 0, then further and further out; ranges of many
/// orders of magnitude in the middle of their exponents.
double cut(const Interval& range)
{
    if (std::isinf(range.low) && std::isinf(range.high)) return 0;
    if (std::isinf(range.high)) return range.low < 1 ? std::max(1.0, range.low + 1) : 2 * range.low;
    if (std::isinf(range.low))
        return range.high > -1 ? std::min(-1.0, range.high - 1) : 2 * range.high;
    if (range.low > 0 && range.high > 16 * range.low) return std::sqrt(range.low * range.high);
    if (range.high < 0 && range.low < 16 * range.high) return -std::sqrt(range.low * range.high);
    return range.low + (range.high - range.low) / 2;
}

}  // namespace

std::size_t Effort::times(std::size_t cost, std::size_t most) const
{
    return std::clamp<std::size_t>(left / (cost + 1), 1, most);
}

BoxProof::BoxProof(const Flat& flat, std::vector<Requirement> claims, double slack, Effort& effort)
    : flat_(flat), claims_(std::move(claims)), slack_(slack), effort_(effort), analysis_(flat),
      whole_(analysis_.declared()), slopes_(flat.roots.size())
{
    for (std::size_t i = 0; i < analysis_.inputs().size(); ++i)
        if (analysis_.depends_on(i)) {
            varied_.push_back({analysis_.inputs()[i].input, analysis_.inputs()[i].component});
            varied_index_.push_back(i);
        }
}

Analysis* BoxProof::slopes(std::size_t root)
{
    if (varied_.size() * flat_.function.graph.size() > most_slope_expressions) return nullptr;
    if (varied_.empty()) return nullptr;
    if (!slopes_[root])
        slopes_[root] =
            std::make_unique<Analysis>(differentiate(flat_, flat_.roots[root], varied_));
    return slopes_[root].get();
}

bool BoxProof::holds(const Box& box)
{
    const auto& ranges = analysis_.ranges(box);
    for (std::size_t i = 0; i < claims_.size(); ++i)
        if (satisfies(ranges[i], claims_[i], slack_)) return true;
    return false;
}

double BoxProof::bound(std::size_t root, std::size_t component, const Box& box, bool low)
{
    Box face = box;
    Analysis* const slopes_of_root = slopes(root);
    // On a face of the box more slopes may have a sign than in all of it.
    for (int round = 0; slopes_of_root != nullptr && round < 4; ++round) {
        Box extended = face;
        extended.push_back({0, HUGE_VAL});
        extended.push_back({-HUGE_VAL, HUGE_VAL});
        const auto& signs = slopes_of_root->ranges(extended);
        bool moved = false;
        for (std::size_t i = 0; i < varied_.size(); ++i) {
            Interval& range = face[varied_index_[i]];
            if (is_point(range)) continue;
            const Interval slope = signs[i][component];
            const bool rises = slope.low >= 0;
            if (!rises && !(slope.high <= 0)) continue;
            const double end = rises == low ? range.low : range.high;
            if (std::isinf(end)) continue;
            range = {end, end};
            moved = true;
        }
        if (!moved) break;
    }
    const Interval range = analysis_.ranges(face)[root][component];
    return low ? range.low : range.high;
}

bool BoxProof::holds_by_slopes(const Box& box)
{
    for (std::size_t i = 0; i < claims_.size(); ++i) {
        if (slopes(i) == nullptr) continue;
        std::vector<Interval> ranges = analysis_.ranges(box)[i];
        for (std::size_t k = 0; k < ranges.size(); ++k) {
            ranges[k].low = std::max(ranges[k].low, bound(i, k, box, true));
            ranges[k].high = std::min(ranges[k].high, bound(i, k, box, false));
        }
        if (satisfies(ranges, claims_[i], slack_)) return true;
    }
    return false;
}

std::optional<std::size_t> BoxProof::widest(const Box& box) const
{
    constexpr double narrowest = 0x1p-48;
    std::optional<std::size_t> best;
    double best_width = narrowest;
    for (const std::size_t i : varied_index_) {
        const double all = whole_[i].high - whole_[i].low;
        const double width = std::isinf(all) ? box[i].high - box[i].low
                                             : (box[i].high - box[i].low) / (all > 0 ? all : 1);
        if (width > best_width) {
            best = i;
            best_width = width;
        }
    }
    return best;
}

bool BoxProof::prove() { return prove(most_boxes, true); }
bool BoxProof::prove_quickly() { return prove(few_boxes, false); }

bool BoxProof::prove(std::size_t most, bool with_slopes)
{
    const std::size_t budget = effort_.times(cost() * proof_share, most);
    std::vector<Box> open{whole_};
    for (std::size_t seen = 0; !open.empty(); ++seen) {
        if (seen == budget) return false;
        effort_.spend(cost());
        const Box box = std::move(open.back());
        open.pop_back();
        if (holds(box) || (with_slopes && holds_by_slopes(box))) continue;
        const auto split = widest(box);
        if (!split) return false;
        const double middle = cut(box[*split]);
        if (!(middle > box[*split].low && middle < box[*split].high)) return false;
        open.push_back(box);
        open.back()[*split].low = middle;
        open.push_back(box);
        open.back()[*split].high = middle;
    }
    return true;
}

Interval BoxProof::bounds(std::size_t root, const Box& box)
{
    std::vector<Interval> ranges = analysis_.ranges(box)[root];
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        ranges[k].low = std::max(ranges[k].low, bound(root, k, box, true));
        ranges[k].high = std::min(ranges[k].high, bound(root, k, box, false));
    }
    return hull(ranges);
}

Interval BoxProof::range(std::size_t root, std::size_t halvings)
{
    // The hull of the halves is never wider than the whole. Each turn halves the box that holds
    // the hull open, first at one end, then at the other.
    struct Part {
        Box box;
        Interval range;
    };
    std::vector<Part> parts{{whole_, bounds(root, whole_)}};
    const std::size_t turns = effort_.times(16 * cost(), halvings + 1) - 1;
    for (std::size_t turn = 0; turn < turns; ++turn) {
        const auto extreme = turn % 2 == 0
                                 ? std::ranges::max_element(
                                       parts, {}, [](const Part& part) { return part.range.high; })
                                 : std::ranges::min_element(
                                       parts, {}, [](const Part& part) { return part.range.low; });
        const auto split = widest(extreme->box);
        if (!split) break;
        const double middle = cut(extreme->box[*split]);
        effort_.spend(8 * cost());  // two parts, two ends, up to four faces each
        Part upper{extreme->box, {}};
        Part lower = upper;
        upper.box[*split].low = middle;
        lower.box[*split].high = middle;
        upper.range = bounds(root, upper.box);
        lower.range = bounds(root, lower.box);
        *extreme = std::move(upper);
        parts.push_back(std::move(lower));
    }
    Interval result = parts.front().range;
    for (const Part& part : parts) {
        result.low = std::min(result.low, part.range.low);
        result.high = std::max(result.high, part.range.high);
    }
    return result;
}

}  // namespace lobe::check
