// Differences of many points, gathered into a Deviation.
#pragma once

#include "analyze/trade/deviation.h"
#include "analyze/trade/rows.h"

#include <functional>
#include <vector>

namespace lobe::analyze {

/// The largest over the components of a point: |to - from| over |from| or the floor. 0 where
/// something is not finite.
double scaled_error(const Rows& rows, std::size_t row, const std::vector<double>& from,
                    const std::vector<double>& to);

/// The two values of one point with more digits. `to` stays empty where it is a format's own, both
/// where there are no more.
struct Confirmed {
    std::vector<double> from;
    std::vector<double> to;
};

class Tally {
public:
    struct Where {
        const Rows* rows = nullptr;  ///< outlives the tally
        bool over_box = false;       ///< every second point is a usual one (deviation.h)
    };

    /// Results column by column, as Rows::run makes them.
    void add(const Where& where, const std::vector<double>& from, const std::vector<double>& to);
    /// Counts the points where `to` is not finite and the exact value is.
    void count(const Rows& rows, const std::vector<double>& to);

    /// The worst of each chunk that was added, worst first.
    std::vector<std::vector<float>> worst_points(std::size_t count) const;

    /// The worst points are computed again by `confirm`. Where that shows that all there was is
    /// the noise of double, so are the other numbers.
    Deviation
    report(const std::function<Confirmed(const Rows& rows, std::size_t row)>& confirm) const;

private:
    struct Worst {
        double error = -1;
        const Rows* rows = nullptr;
        std::size_t row = 0;
        std::vector<double> to;
    };

    std::vector<const Worst*> by_error() const;

    std::vector<Worst> worst_;  ///< of each chunk
    std::vector<double> usual_;
    double sum_of_squares_ = 0;
    double absolute_ = 0;
    double codes_ = 0;
    double linear_of_codes_ = 0;
    std::size_t points_ = 0;
    std::size_t not_finite_ = 0;
};

}  // namespace lobe::analyze
