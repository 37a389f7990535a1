// The worst errors that can be found in a box: points everywhere and at the ends, then a climb.
#pragma once

#include "analyze/proof/subject.h"
#include "evaluate/rounding_bounds.h"

#include <cstdint>

namespace lobe::analyze {

/// What an error is measured by.
enum class Measure : std::uint8_t {
    absolute,
    relative,
    jump  ///< absolute, where rounding turns a decision
};

double error_of(const Subject& subject, const Observed& value, Measure measure);

/// The worst points so far by one measure, worst first.
class Worst {
public:
    Worst(const Subject& subject, Measure measure);

    /// Where a decision may turn and the error is more than rounding explains, it is a jump's: it
    /// counts for that measure and for no other.
    void consider(const std::vector<Point>& points, const std::vector<Observed>& values);
    Measure measure() const { return measure_; }
    double error() const { return entries_.empty() ? 0 : entries_.front().error; }
    const Point* point() const { return entries_.empty() ? nullptr : &entries_.front().point; }

    struct Entry {
        double error = 0;
        Point point;
    };
    const std::vector<Entry>& entries() const { return entries_; }

private:
    bool is_jump(const Point& point, double error);

    const Subject& subject_;
    Measure measure_;
    std::vector<Entry> entries_;
    evaluate::RoundingBounds bounds_;
    bool may_jump_ = false;  ///< somewhere in the subject's box
};

/// `count` points of a box: uniform, by binades, at and next to its ends.
std::vector<Point> points_in(const Subject& subject, const Box& box, std::size_t count,
                             std::uint64_t key);

/// Points near `center`: every coordinate may move, by as little as one number of the grid.
std::vector<Point> points_near(const Subject& subject, const Point& center, std::size_t count,
                               std::uint64_t key);

}  // namespace lobe::analyze
