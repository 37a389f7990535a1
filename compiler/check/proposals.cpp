#include "check/proposals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::check {
namespace {

using Kind = ir::Code::Kind;

bool keeps(const ir::Field& field, const std::vector<double>& values)
{
    return std::ranges::all_of(
               values, [&](double value) { return ir::code_of(field, value).has_value(); }) &&
           ir::position(field, field.range.high) <= field.last_code() + 0.5;
}

/// Where the pivot may go down to: a part of the greatest one.
std::optional<ir::Code> with_pivot(ir::Field field, int greatest, double part,
                                   const std::vector<double>& values)
{
    const int least = std::max(1, static_cast<int>(std::ceil(greatest * part)));
    for (int pivot = greatest; pivot >= least; --pivot) {
        field.code.pivot = pivot;
        if (keeps(field, values)) return field.code;
    }
    return std::nullopt;
}

std::optional<ir::Code> linear(ir::Field field, double part, const std::vector<double>& values)
{
    field.code = {};
    auto code = with_pivot(field, field.last_code(), part, values);
    if (code && code->pivot == field.last_code()) code->pivot = 0;
    return code;
}

std::optional<ir::Code> power(ir::Field field, double unit, int exponent,
                              const std::vector<double>& values)
{
    field.code = {};
    field.code.kind = Kind::power;
    field.code.name = "power";
    field.code.exponent = exponent;
    field.code.unit = unit;
    const auto pivot = reaching_pivot(field);
    return pivot ? with_pivot(field, *pivot, 0.75, values) : std::nullopt;
}

std::optional<ir::Code> logarithm(ir::Field field, const std::vector<double>& values)
{
    field.code = {};
    field.code.kind = Kind::log2;
    field.code.name = "log2";
    const auto pivot = reaching_pivot(field);
    return pivot ? with_pivot(field, *pivot, 0.75, values) : std::nullopt;
}

std::optional<ir::Code> halving(ir::Field field, const ir::Parameter& parameter,
                                const std::vector<double>& values)
{
    const auto code = ir::halving(parameter, field.component, field.range, 1);
    if (!code) return std::nullopt;
    field.code = *code;
    const auto pivot = reaching_pivot(field);
    return pivot ? with_pivot(field, *pivot, 0.75, values) : std::nullopt;
}

std::optional<ir::Code> any_power(const ir::Field& field, double unit,
                                  const std::vector<double>& values)
{
    if (field.code.kind == Kind::power)
        if (auto code = power(field, unit, field.code.exponent, values)) return code;
    // One whose steps grow about as those of a logarithm do: 8 for a range of 256 units.
    std::array<int, 6> exponents{8, 4, 2, 16, 3, 6};
    const double doublings = std::log2(std::max(1.0, (field.range.high - field.range.low) / unit));
    std::ranges::stable_sort(exponents, {},
                             [doublings](int exponent) { return std::abs(exponent - doublings); });
    for (const int exponent : exponents)
        if (auto code = power(field, unit, exponent, values)) return code;
    return std::nullopt;
}

}  // namespace

std::optional<int> reaching_pivot(const ir::Field& field)
{
    ir::Field one = field;
    one.code.pivot = 1;
    // The position of the high end is in proportion to the pivot.
    const double pivot = std::floor((field.last_code() + 0.5) / ir::position(one, one.range.high));
    if (!(pivot >= 1)) return std::nullopt;
    return static_cast<int>(std::min<double>(pivot, field.last_code()));
}

std::optional<ir::Code> code_for(const ir::Field& field, const ir::Parameter& parameter,
                                 const std::vector<double>& values)
{
    const bool has_powers =
        parameter.quantity == ir::Quantity::number || parameter.quantity == ir::Quantity::color;
    const double unit = ir::power_unit(parameter, field.component, field.range);
    if (field.is_signed) return std::nullopt;
    if (!has_powers) return linear(field, 0.5, values);
    // A logarithm over less than two units is nearly straight.
    const bool wide = field.range.high - field.range.low > 2 * unit;
    const bool curved = field.code.kind == Kind::power || (field.code.kind == Kind::log2 && wide);
    if (field.code.kind == Kind::log2)
        if (auto code = logarithm(field, values)) return code;
    if (field.code.kind == Kind::halving)
        if (auto code = halving(field, parameter, values)) return code;
    if (curved)
        if (auto code = any_power(field, unit, values)) return code;
    // A quarter of the codes is worth an easy decode; more is not.
    if (auto code = linear(field, 0.75, values)) return code;
    if (auto code = any_power(field, unit, values)) return code;
    return linear(field, 0.5, values);
}

}  // namespace lobe::check
