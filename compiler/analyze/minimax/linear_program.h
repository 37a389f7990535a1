// A linear program with few unknowns and many inequalities, solved by COIN-OR's Clp. Whoever states
// it sees to it that unknowns and rows are of a size of about 1.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace lobe::analyze {

class LinearProgram {
public:
    /// Minimizes cost . x for low <= x <= high; infinite ends mean: unbounded.
    LinearProgram(std::vector<double> cost, std::vector<double> low, std::vector<double> high);

    /// And coefficients . x <= limit.
    void require(std::span<const double> coefficients, double limit);

    /// Meets every inequality up to 1e-9. Nothing where they contradict each other, or the cost has
    /// no least value.
    std::optional<std::vector<double>> solve() const;

private:
    std::vector<double> cost_;
    std::vector<double> low_;
    std::vector<double> high_;
    std::vector<double> coefficients_;  ///< row after row
    std::vector<double> limits_;
};

}  // namespace lobe::analyze
