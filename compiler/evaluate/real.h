// A real number of chosen precision: MPFR with value semantics.
#pragma once

#include <mpfr.h>

#include <string>
#include <string_view>

namespace lobe::evaluate {

/// Precision travels with the value; assignment copies value and precision.
class Real {
public:
    explicit Real(int bits = 53);
    Real(double value, int bits);
    /// A decimal text, rounded once; NaN if it is not a number.
    Real(std::string_view decimal, int bits);
    Real(const Real& other);
    Real(Real&& other) noexcept;
    Real& operator=(const Real& other);
    Real& operator=(Real&& other) noexcept;
    ~Real();

    double to_double() const;
    /// Shortest text with enough digits to read back exactly at this precision.
    std::string text() const;
    int bits() const;

    mpfr_ptr get() { return value_; }
    mpfr_srcptr get() const { return value_; }

private:
    mpfr_t value_;
};

}  // namespace lobe::evaluate
