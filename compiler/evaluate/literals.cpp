#include "evaluate/literals.h"

#include "evaluate/half.h"

#include <mpfr.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace lobe::evaluate {
namespace {

double bound(const ir::Literal& literal, mpfr_rnd_t direction)
{
    Real number{53};
    if (literal.text == "pi")
        mpfr_const_pi(number.get(), direction);
    else
        mpfr_strtofr(number.get(), literal.text.c_str(), nullptr, 10, direction);
    return mpfr_get_d(number.get(), direction);
}

}  // namespace

float to_float(const ir::Literal& literal)
{
    if (literal.text == "pi") return 0x1.921fb6p+1F;
    float value = 0;
    const char* const begin = literal.text.data();
    const auto read = std::from_chars(begin, begin + literal.text.size(), value);
    if (read.ec == std::errc::result_out_of_range) {
        // Left alone by from_chars; the double tells on which side it fell off.
        const float magnitude = std::abs(literal.value) < 1 ? 0.0F : HUGE_VALF;
        return literal.value < 0 ? -magnitude : magnitude;
    }
    return value;
}

double to_double(const ir::Literal& literal) { return literal.value; }

double to_half(const ir::Literal& literal)
{
    // Rounding twice is right when the first rounding keeps a sticky last bit: of the two doubles
    // around the number, the odd one is no midpoint of two halves.
    const Interval around = to_interval(literal);
    const bool low_is_odd = (std::bit_cast<std::uint64_t>(around.low) & 1U) != 0;
    const double nearest =
        round_to_half(low_is_odd ? around.low : around.high, HalfMode::keep_denormals);
    return literal.value == 0 || std::abs(nearest) >= least_normal_half
               ? nearest
               : std::copysign(least_normal_half, literal.value);
}

Interval to_interval(const ir::Literal& literal)
{
    if (const auto rounding = ir::rounding_of(literal)) {
        const double value = literal.value;
        return {*rounding > 0 ? std::nextafter(value, -HUGE_VAL) : value,
                *rounding < 0 ? std::nextafter(value, HUGE_VAL) : value};
    }
    return {bound(literal, MPFR_RNDD), bound(literal, MPFR_RNDU)};
}

Real to_real(const ir::Literal& literal, int bits)
{
    if (literal.text != "pi") return Real{std::string_view{literal.text}, bits};
    Real number{bits};
    mpfr_const_pi(number.get(), MPFR_RNDN);
    return number;
}

}  // namespace lobe::evaluate
