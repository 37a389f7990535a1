#include "analyze/trade/tally.h"

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

bool all_finite(const std::vector<double>& columns, std::size_t rows, std::size_t row)
{
    for (std::size_t k = row; k < columns.size(); k += rows)
        if (!std::isfinite(columns[k])) return false;
    return true;
}

}  // namespace

double scaled_error(const Rows& rows, std::size_t row, const std::vector<double>& from,
                    const std::vector<double>& to)
{
    double worst = 0;
    for (std::size_t k = row; k < from.size(); k += rows.size()) {
        if (!std::isfinite(from[k]) || !std::isfinite(to[k])) return 0;
        const double size = std::max(std::abs(from[k]), rows.floor_of(row));
        worst = std::max(worst, std::abs(to[k] - from[k]) / size);
    }
    return worst;
}

void Tally::add(const Where& where, const std::vector<double>& from, const std::vector<double>& to)
{
    const Rows& rows = *where.rows;
    Worst worst;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!all_finite(rows.exact(), rows.size(), row) || !all_finite(from, rows.size(), row))
            continue;
        ++points_;
        if (!all_finite(to, rows.size(), row)) {
            ++not_finite_;
            continue;
        }
        const double error = scaled_error(rows, row, from, to);
        if (error > worst.error) worst = {error, &rows, row, {}};
        double difference = 0;
        for (std::size_t k = row; k < to.size(); k += rows.size()) {
            difference = std::max(difference, std::abs(to[k] - from[k]));
            // The curve is concave and 0 at 0: the codes of two values differ by no more than
            // that of their difference. So most need not be computed.
            const double on_display =
                std::abs(std::clamp(to[k], 0.0, 1.0) - std::clamp(from[k], 0.0, 1.0));
            if (on_display <= linear_of_codes_) continue;
            const double codes = std::abs(display_code(to[k]) - display_code(from[k]));
            if (codes <= codes_) continue;
            codes_ = codes;
            linear_of_codes_ = linear_of_code(codes);
        }
        absolute_ = std::max(absolute_, difference);
        if (!where.over_box || row % 2 != 0) continue;
        usual_.push_back(error);
        sum_of_squares_ += difference * difference;
    }
    if (worst.rows == nullptr) return;
    for (std::size_t k = worst.row; k < to.size(); k += rows.size()) worst.to.push_back(to[k]);
    worst_.push_back(std::move(worst));
}

void Tally::count(const Rows& rows, const std::vector<double>& to)
{
    points_ += rows.size();
    for (std::size_t row = 0; row < rows.size(); ++row)
        if (all_finite(rows.exact(), rows.size(), row) && !all_finite(to, rows.size(), row))
            ++not_finite_;
}

std::vector<const Tally::Worst*> Tally::by_error() const
{
    std::vector<const Worst*> ranked;
    for (const Worst& worst : worst_) ranked.push_back(&worst);
    std::ranges::stable_sort(ranked,
                             [](const Worst* a, const Worst* b) { return a->error > b->error; });
    return ranked;
}

std::vector<std::vector<float>> Tally::worst_points(std::size_t count) const
{
    std::vector<const Worst*> ranked = by_error();
    if (ranked.size() > count) ranked.resize(count);
    std::vector<std::vector<float>> points;
    for (const Worst* worst : ranked) points.push_back(worst->rows->point(worst->row));
    return points;
}

Deviation
Tally::report(const std::function<Confirmed(const Rows& rows, std::size_t row)>& confirm) const
{
    Deviation out;
    out.points = points_;
    out.not_finite = not_finite_;
    if (worst_.empty()) return out;

    // What double computed of a point may be noise: then the next one is the worst.
    constexpr std::size_t most_confirmed = 16;
    const std::vector<const Worst*> ranked = by_error();
    bool over_reals = false;
    double absolute = 0;
    double codes = 0;
    for (std::size_t i = 0; i < std::min(ranked.size(), most_confirmed); ++i) {
        const Worst& worst = *ranked[i];
        if (i > 0 && worst.error <= out.scaled) break;
        const Rows& rows = *worst.rows;
        const Confirmed values = confirm(rows, worst.row);
        if (values.from.empty()) {
            out.scaled = worst.error;
            out.at = rows.describe(worst.row);
            break;
        }
        over_reals = !values.to.empty();
        const std::vector<double>& to = over_reals ? values.to : worst.to;
        double scaled = 0;
        for (std::size_t k = 0; k < to.size(); ++k) {
            const double difference = std::abs(to[k] - values.from[k]);
            const double size = std::max(std::abs(values.from[k]), rows.floor_of(worst.row));
            scaled = std::max(scaled, difference / size);
            absolute = std::max(absolute, difference);
            codes = std::max(codes, std::abs(display_code(to[k]) - display_code(values.from[k])));
        }
        if (i > 0 && scaled <= out.scaled) continue;
        out.scaled = scaled;
        out.at = rows.describe(worst.row);
    }

    std::vector<double> usual = usual_;
    if (!usual.empty()) {
        const auto share = [&usual](std::size_t percent) {
            const auto at = static_cast<std::ptrdiff_t>((usual.size() - 1) * percent / 100);
            std::nth_element(usual.begin(), usual.begin() + at, usual.end());
            return usual[static_cast<std::size_t>(at)];
        };
        out.typical = share(50);
        out.often = share(99);
        out.root_mean_square = std::sqrt(sum_of_squares_ / static_cast<double>(usual.size()));
    }
    constexpr double noise = 1e-3;        // of what double said
    constexpr double usual_noise = 1e-7;  // more than double makes of any usual point
    const bool only_noise =
        over_reals && out.scaled <= noise * ranked.front()->error && out.often <= usual_noise;
    out.absolute = only_noise ? absolute : std::max(absolute, absolute_);
    out.codes = only_noise ? codes : std::max(codes, codes_);
    if (only_noise) {
        out.often = std::min(out.often, out.scaled);
        out.typical = std::min(out.typical, out.scaled);
        out.root_mean_square = std::min(out.root_mean_square, absolute);
    }
    out.scaled = std::max(out.scaled, out.often);
    return out;
}

}  // namespace lobe::analyze
