#include "analyze/environment/consistency.h"

#include "analyze/environment/prefilter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::analyze {
namespace {

/// A difference against what should be there, number by number.
class RelativeError {
public:
    void add(const Radiance& is, const Radiance& should_be)
    {
        for (std::size_t channel = 0; channel < is.size(); ++channel) {
            const double off = is[channel] - should_be[channel];
            squares_ += off * off;
            sum_ += should_be[channel];
            ++count_;
        }
    }
    double value() const { return std::sqrt(squares_ / count_) / (sum_ / count_); }

private:
    double squares_ = 0;
    double sum_ = 0;
    double count_ = 0;
};

double level_error(const CubeMap& given, const CubeMap& own, std::size_t index)
{
    const CubeLevel& level = own.levels[index];
    RelativeError error;
    for (int face = 0; face < cube_faces; ++face)
        for (int row = 0; row < level.size; ++row)
            for (int column = 0; column < level.size; ++column)
                error.add(look_up(given, texel_direction(level, face, row, column),
                                  static_cast<double>(index)),
                          level.at(face, row, column));
    return error.value();
}

/// Harmonics are orthonormal: the mean square over the sphere is the coefficients' over 4 pi.
double irradiance_error(const HarmonicSeries& given, const HarmonicSeries& own)
{
    double squares = 0;
    double sum = 0;
    for (std::size_t channel = 0; channel < own[0].size(); ++channel) {
        for (std::size_t i = 0; i < harmonics; ++i)
            squares += std::pow(given[i][channel] - own[i][channel], 2);
        sum += own[0][channel];
    }
    const double channels = static_cast<double>(own[0].size());
    const double first = harmonics_at({0, 0, 1})[0];
    return std::sqrt(squares / (4 * std::numbers::pi) / channels) / (first * sum / channels);
}

}  // namespace

EnvironmentErrors environment_errors(const CubeMap& given, const HarmonicSeries& irradiance,
                                     unsigned jobs)
{
    constexpr int largest = 64;  // enough places to compare at
    const CubeLevel& sharpest = given.levels.front();
    const CubeMap own =
        prefiltered(with_levels(sharpest), {.size = std::min(sharpest.size, largest),
                                            .levels = static_cast<int>(given.levels.size()),
                                            .samples = 256,
                                            .jobs = jobs});
    EnvironmentErrors out;
    out.irradiance = irradiance_error(irradiance, irradiance_series(radiance_series(sharpest)));
    for (std::size_t i = 1; i < given.levels.size(); ++i)
        out.levels.push_back(level_error(given, own, i));
    return out;
}

}  // namespace lobe::analyze
