// What codes mean over the reals, in the words that emitted comments have: the arithmetic that
// keeps values exact is in field_functions.cpp.
#include "ir/field_functions.h"

#include <fmt/format.h>

#include <cmath>

namespace lobe::ir {
namespace {

std::string number_text(double value) { return fmt::format("{:.7g}", value); }

/// Without what a factor or divisor of 1 would add.
std::string scaled(double factor, const std::string& x)
{
    return factor == 1 ? x : fmt::format("{} * {}", number_text(factor), x);
}
std::string over(const std::string& x, double divisor)
{
    return divisor == 1 ? x : fmt::format("{} / {}", x, number_text(divisor));
}
std::string raised(const std::string& x, int exponent, std::string_view form)
{
    return exponent == 1 ? x : x + fmt::format(fmt::runtime(form), exponent);
}
std::string sum(const std::string& x, double offset)
{
    if (offset == 0) return x;
    return offset > 0 ? fmt::format("{} + {}", x, number_text(offset))
                      : fmt::format("{} - {}", x, number_text(-offset));
}

std::string plus_low(const Field& field, const std::string& rest)
{
    const double low = field.range.low;
    return low == 0 ? rest : fmt::format("{} + {}", number_text(low), rest);
}

}  // namespace

std::string encode_formula(const Field& field)
{
    const Code& code = field.code;
    const int last = field.last_code();
    const int pivot = code.pivot == 0 ? last : code.pivot;
    const double size = field.range.high - field.range.low;
    const double low = field.range.low;
    const std::string above = low == 0 ? "x" : fmt::format("({})", sum("x", -low));
    if (field.is_signed)
        return fmt::format("round({} + {})", last / 2, over(scaled(last / 2, "x"), size / 2));
    switch (code.kind) {
    case Code::Kind::linear: return fmt::format("round({})", over(scaled(pivot, above), size));
    case Code::Kind::square_root:
        return fmt::format("round({} * sqrt({}))", last, over(above, size));
    case Code::Kind::power:
        return fmt::format(
            "round({})",
            scaled(pivot,
                   raised(code.unit == 1 ? above : fmt::format("({})", over(above, code.unit)),
                          code.exponent, "^(1/{})")));
    case Code::Kind::log2: {
        const std::string log = fmt::format("log2({})", sum("x", 1 - low));
        return code.pivot == 0
                   ? fmt::format("round({} / log2({}))", scaled(last, log), number_text(1 + size))
                   : fmt::format("round({})", scaled(pivot, log));
    }
    case Code::Kind::halving: {
        const double whole = code.top - low;
        const std::string missing = fmt::format("{} - x", number_text(code.top));
        return fmt::format("round({} * log2({}))",
                           number_text(pivot / std::log2((code.top - code.at_pivot) / whole)),
                           whole == 1 ? missing
                                      : fmt::format("({}) / {}", missing, number_text(whole)));
    }
    case Code::Kind::declared: return fmt::format("round({} * {}_encode(x))", last, code.name);
    }
    return {};
}

std::string decode_formula(const Field& field)
{
    const Code& code = field.code;
    const int last = field.last_code();
    const int pivot = code.pivot == 0 ? last : code.pivot;
    const double size = field.range.high - field.range.low;
    if (field.is_signed)
        return over(scaled(size / 2, fmt::format("(code - {})", last / 2)), last / 2);
    const auto part = [](int divisor) {
        return divisor == 1 ? "code" : fmt::format("(code / {})", divisor);
    };
    switch (code.kind) {
    case Code::Kind::linear: return plus_low(field, over(scaled(size, "code"), pivot));
    case Code::Kind::square_root: return plus_low(field, scaled(size, part(last) + "^2"));
    case Code::Kind::power:
        return plus_low(field, scaled(code.unit, raised(part(pivot), code.exponent, "^{}")));
    case Code::Kind::log2:
        return sum(fmt::format("{}^{}", number_text(code.pivot == 0 ? 1 + size : 2), part(pivot)),
                   field.range.low - 1);
    case Code::Kind::halving: {
        const double size_to_top = code.top - field.range.low;
        return fmt::format(
            "{} - {}", number_text(code.top),
            scaled(size_to_top,
                   fmt::format("{}^{}", number_text((code.top - code.at_pivot) / size_to_top),
                               part(pivot))));
    }
    case Code::Kind::declared: return fmt::format("{}_decode({})", code.name, over("code", last));
    }
    return {};
}

}  // namespace lobe::ir
