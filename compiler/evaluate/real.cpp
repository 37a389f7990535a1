#include "evaluate/real.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lobe::evaluate {

Real::Real(int bits) { mpfr_init2(value_, bits); }

Real::Real(double value, int bits) : Real(bits) { mpfr_set_d(value_, value, MPFR_RNDN); }

Real::Real(std::string_view decimal, int bits) : Real(bits)
{
    const std::string text{decimal};
    if (text.empty() || mpfr_set_str(value_, text.c_str(), 10, MPFR_RNDN) != 0)
        mpfr_set_nan(value_);
}

Real::Real(const Real& other) : Real(other.bits()) { mpfr_set(value_, other.value_, MPFR_RNDN); }

// A moved-from number keeps a valid value of the least precision.
Real::Real(Real&& other) noexcept
{
    mpfr_init2(value_, MPFR_PREC_MIN);
    mpfr_swap(value_, other.value_);
}

Real& Real::operator=(const Real& other)
{
    if (this != &other) {
        mpfr_set_prec(value_, mpfr_get_prec(other.value_));
        mpfr_set(value_, other.value_, MPFR_RNDN);
    }
    return *this;
}

Real& Real::operator=(Real&& other) noexcept
{
    mpfr_swap(value_, other.value_);
    return *this;
}

Real::~Real() { mpfr_clear(value_); }

double Real::to_double() const { return mpfr_get_d(value_, MPFR_RNDN); }

int Real::bits() const { return static_cast<int>(mpfr_get_prec(value_)); }

std::string Real::text() const
{
    if (mpfr_nan_p(value_) != 0) return "nan";
    if (mpfr_inf_p(value_) != 0) return mpfr_sgn(value_) < 0 ? "-inf" : "inf";
    if (mpfr_zero_p(value_) != 0) return mpfr_signbit(value_) != 0 ? "-0" : "0";

    // Zero digits asks MPFR for enough of them to read back exactly.
    mpfr_exp_t exponent = 0;
    char* const written = mpfr_get_str(nullptr, &exponent, 10, 0, value_, MPFR_RNDN);
    std::string text{written};
    mpfr_free_str(written);

    text.erase(text.find_last_not_of('0') + 1);
    const std::size_t first = text.front() == '-' ? 1 : 0;
    if (text.size() > first + 1) text.insert(first + 1, 1, '.');
    const auto power = static_cast<long>(exponent) - 1;
    return power == 0 ? text : fmt::format("{}e{}", text, power);
}

}  // namespace lobe::evaluate
