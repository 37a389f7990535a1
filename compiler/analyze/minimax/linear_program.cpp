#include "analyze/minimax/linear_program.h"

#include <coin/Clp_C_Interface.h>

#include <cassert>
#include <limits>
#include <memory>

namespace lobe::analyze {
namespace {

constexpr double tolerance = 1e-9;
constexpr int optimal = 0;
constexpr int silent = 0;
constexpr int unscaled = 0;  // scaled, it calls programs solved that are not

struct Delete {
    void operator()(Clp_Simplex* model) const { Clp_deleteModel(model); }
};
using Model = std::unique_ptr<Clp_Simplex, Delete>;

}  // namespace

LinearProgram::LinearProgram(std::vector<double> cost, std::vector<double> low,
                             std::vector<double> high)
    : cost_(std::move(cost)), low_(std::move(low)), high_(std::move(high))
{
    assert(low_.size() == cost_.size() && high_.size() == cost_.size());
}

void LinearProgram::require(std::span<const double> coefficients, double limit)
{
    assert(coefficients.size() == cost_.size());
    coefficients_.insert(coefficients_.end(), coefficients.begin(), coefficients.end());
    limits_.push_back(limit);
}

std::optional<std::vector<double>> LinearProgram::solve() const
{
    const std::size_t columns = cost_.size();
    const std::size_t rows = limits_.size();
    // Column after column, as Clp reads a matrix.
    std::vector<CoinBigIndex> starts;
    std::vector<int> indices;
    std::vector<double> elements;
    for (std::size_t column = 0; column < columns; ++column) {
        starts.push_back(static_cast<CoinBigIndex>(elements.size()));
        for (std::size_t row = 0; row < rows; ++row) {
            indices.push_back(static_cast<int>(row));
            elements.push_back(coefficients_[row * columns + column]);
        }
    }
    starts.push_back(static_cast<CoinBigIndex>(elements.size()));
    const std::vector<double> unlimited(rows, -std::numeric_limits<double>::infinity());

    const Model model{Clp_newModel()};
    Clp_setLogLevel(model.get(), silent);
    Clp_loadProblem(model.get(), static_cast<int>(columns), static_cast<int>(rows), starts.data(),
                    indices.data(), elements.data(), low_.data(), high_.data(), cost_.data(),
                    unlimited.data(), limits_.data());
    Clp_scaling(model.get(), unscaled);
    Clp_setPrimalTolerance(model.get(), tolerance);
    Clp_setDualTolerance(model.get(), tolerance);
    Clp_initialDualSolve(model.get());
    if (Clp_status(model.get()) != optimal) return std::nullopt;
    const double* const solution = Clp_primalColumnSolution(model.get());
    return std::vector<double>(solution, solution + columns);
}

}  // namespace lobe::analyze
