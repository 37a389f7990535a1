#include "analyze/trade/deviation.h"

#include "evaluate/kernels.h"

#include <algorithm>

namespace lobe::analyze {

double display_code(double linear)
{
    // IEC 61966-2-1, equations 9 and 10.
    const double x = std::clamp(linear, 0.0, 1.0);
    if (x <= 0.0031308) return 255 * (12.92 * x);
    return 255 * (1.055 * evaluate::power_one(x, 1 / 2.4) - 0.055);
}

double linear_of_code(double code)
{
    const double x = std::clamp(code / 255, 0.0, 1.0);
    if (x <= 12.92 * 0.0031308) return x / 12.92;
    return evaluate::power_one((x + 0.055) / 1.055, 2.4);
}

}  // namespace lobe::analyze
