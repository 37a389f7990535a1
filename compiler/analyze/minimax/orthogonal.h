// Columns of numbers in orthogonal combinations: what equations are written in where the columns
// themselves are nearly alike.
#pragma once

#include <cstddef>
#include <vector>

namespace lobe::analyze {

using Columns = std::vector<std::vector<double>>;

/// Upper triangular R of A = Q R. A column that the ones before it make up is 0 in Q and R.
class Triangle {
public:
    explicit Triangle(std::size_t size) : rows_(size, std::vector<double>(size, 0)) {}

    double& at(std::size_t row, std::size_t column) { return rows_[row][column]; }

    /// x = R^-1 x: coefficients of A's columns from those of Q's.
    void solve(std::vector<double>& x) const;
    /// x = x R^-1: a linear function of A's coefficients as one of Q's.
    void divide(std::vector<double>& x) const;

private:
    std::vector<std::vector<double>> rows_;
};

/// Columns, of one length, become orthogonal with a mean square of 1.
Triangle orthogonalize(Columns& columns);

}  // namespace lobe::analyze
