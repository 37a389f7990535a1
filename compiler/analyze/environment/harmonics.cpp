#include "analyze/environment/harmonics.h"

#include <cmath>
#include <numbers>

namespace lobe::analyze {

std::array<double, harmonics> harmonics_at(const Vector& d)
{
    const double pi = std::numbers::pi;
    const double first = std::sqrt(3 / (4 * pi));
    const double second = std::sqrt(15 / (4 * pi));
    return {std::sqrt(1 / (4 * pi)),
            first * d.y,
            first * d.z,
            first * d.x,
            second * d.x * d.y,
            second * d.y * d.z,
            std::sqrt(5 / (16 * pi)) * (3 * d.z * d.z - 1),
            second * d.x * d.z,
            second / 2 * (d.x * d.x - d.y * d.y)};
}

HarmonicSeries radiance_series(const CubeLevel& environment)
{
    HarmonicSeries out{};
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < environment.size; ++row)
            for (int column = 0; column < environment.size; ++column) {
                const double part = texel_solid_angle(environment.size, row, column);
                const auto at = harmonics_at(texel_direction(environment, face, row, column));
                const Radiance value = environment.at(face, row, column);
                for (std::size_t i = 0; i < harmonics; ++i)
                    for (std::size_t channel = 0; channel < value.size(); ++channel)
                        out[i][channel] += part * at[i] * value[channel];
            }
    return out;
}

HarmonicSeries irradiance_series(const HarmonicSeries& radiance)
{
    const double pi = std::numbers::pi;
    HarmonicSeries out = radiance;
    for (std::size_t i = 0; i < harmonics; ++i)
        for (double& channel : out[i]) channel *= i == 0 ? pi : i < 4 ? 2 * pi / 3 : pi / 4;
    return out;
}

Radiance value_of(const HarmonicSeries& series, const Vector& direction)
{
    const auto at = harmonics_at(direction);
    Radiance out{};
    for (std::size_t i = 0; i < harmonics; ++i)
        for (std::size_t channel = 0; channel < out.size(); ++channel)
            out[channel] += at[i] * series[i][channel];
    return out;
}

}  // namespace lobe::analyze
