// Running a flat body over boxes of inputs and over single points.
#pragma once

#include "check/flatten.h"
#include "evaluate/run.h"

#include <optional>
#include <span>
#include <vector>

namespace lobe::check {

using evaluate::Interval;
/// One interval per scalar input of a tape.
using Box = std::vector<Interval>;

/// A flat body as a tape whose outputs are the components of its roots.
class Analysis {
public:
    explicit Analysis(Flat flat);

    const std::vector<evaluate::TapeInput>& inputs() const { return traced_.tape.inputs; }
    const ir::Function& function() const { return function_; }

    /// The box of the declared ranges.
    Box declared() const;

    /// Per root, the ranges of its components over a box.
    const std::vector<std::vector<Interval>>& ranges(const Box& box);
    /// Per root, its components at a point, in double.
    const std::vector<std::vector<double>>& values(const std::vector<double>& point);

    /// The least and greatest component of a root over several points, in double.
    Interval extremes(std::size_t root, const std::vector<std::vector<double>>& points);

    /// Whether any root depends on this input.
    bool depends_on(std::size_t input) const { return used_[input]; }

private:
    template <class Number>
    void run(const std::vector<Number>& point, std::vector<Number>& flat_results,
             std::vector<std::vector<Number>>& results);

    ir::Function function_;
    evaluate::Traced traced_;
    std::vector<std::size_t> components_;  ///< per root
    std::vector<bool> used_;
    std::vector<Interval> flat_ranges_;
    std::vector<std::vector<Interval>> ranges_;
    std::vector<double> flat_values_;
    std::vector<std::vector<double>> values_;
};

/// Whether every component satisfies a requirement. `slack` is how far past a closed end still
/// counts as inside, as a fraction of that end.
bool satisfies(const std::vector<Interval>& ranges, const Requirement& requirement, double slack);
/// The same of single values; NaN satisfies nothing.
bool satisfies(const std::vector<double>& values, const Requirement& requirement, double slack);

/// The smallest range that holds every component.
Interval hull(const std::vector<Interval>& ranges);

}  // namespace lobe::check
