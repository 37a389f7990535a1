#include "analyze/minimax/orthogonal.h"

#include <cmath>
#include <numeric>

namespace lobe::analyze {
namespace {

double product(const std::vector<double>& a, const std::vector<double>& b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(a.size());
}

}  // namespace

void Triangle::solve(std::vector<double>& x) const
{
    for (std::size_t i = x.size(); i-- > 0;) {
        for (std::size_t j = i + 1; j < x.size(); ++j) x[i] -= rows_[i][j] * x[j];
        x[i] = rows_[i][i] == 0 ? 0 : x[i] / rows_[i][i];
    }
}

void Triangle::divide(std::vector<double>& x) const
{
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) x[i] -= x[j] * rows_[j][i];
        x[i] = rows_[i][i] == 0 ? 0 : x[i] / rows_[i][i];
    }
}

/// By Gram and Schmidt, each column twice, so that what rounding left goes too.
Triangle orthogonalize(Columns& columns)
{
    constexpr double dependent = 1e-11;
    Triangle result{columns.size()};
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const double before = std::sqrt(product(columns[k], columns[k]));
        for (int time = 0; time < 2; ++time)
            for (std::size_t j = 0; j < k; ++j) {
                const double along = product(columns[j], columns[k]);
                result.at(j, k) += along;
                for (std::size_t i = 0; i < columns[k].size(); ++i)
                    columns[k][i] -= along * columns[j][i];
            }
        const double size = std::sqrt(product(columns[k], columns[k]));
        const bool is_new = size > dependent * before;
        if (is_new) result.at(k, k) = size;
        for (double& value : columns[k]) value = is_new ? value / size : 0;
    }
    return result;
}

}  // namespace lobe::analyze
