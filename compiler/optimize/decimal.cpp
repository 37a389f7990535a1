#include "optimize/decimal.h"

#include "optimize/literal.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace lobe::optimize {

using namespace ir;

namespace {

constexpr std::int64_t largest = 99'999'999'999'999'999;  ///< 17 digits
constexpr int largest_scale = 40;

/// digits * 10^exponent, without zeros at the end of the digits.
struct Decimal {
    std::int64_t digits = 0;
    int exponent = 0;
};

using Exact = std::optional<Decimal>;

Exact trimmed(std::int64_t digits, int exponent)
{
    if (digits == 0) return Decimal{};
    while (digits % 10 == 0) {
        digits /= 10;
        ++exponent;
    }
    if (digits > largest || digits < -largest || exponent > largest_scale ||
        exponent < -largest_scale)
        return std::nullopt;
    return Decimal{digits, exponent};
}

/// Nothing for pi, and for more digits than can be held.
Exact decimal_of(const Literal& literal)
{
    std::int64_t digits = 0;
    int exponent = 0;
    bool fraction = false;
    const std::string_view text = literal.text;
    const bool negative = text.starts_with('-');
    for (std::size_t i = negative ? 1 : 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c >= '0' && c <= '9') {
            if (digits > largest / 10) return std::nullopt;
            digits = 10 * digits + (c - '0');
            exponent -= fraction ? 1 : 0;
        } else if (c == '.') {
            fraction = true;
        } else {
            int scale = 0;
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data() + i + 1, end, scale);
            if (c != 'e' || read.ec != std::errc{} || read.ptr != end) return std::nullopt;
            exponent += scale;
            break;
        }
    }
    return trimmed(negative ? -digits : digits, exponent);
}

Exact product(const Decimal& a, const Decimal& b)
{
    const std::int64_t limit = std::numeric_limits<std::int64_t>::max();
    const std::int64_t size = a.digits < 0 ? -a.digits : a.digits;
    if (size != 0 && (b.digits < 0 ? -b.digits : b.digits) > limit / size) return std::nullopt;
    return trimmed(a.digits * b.digits, a.exponent + b.exponent);
}

Exact sum(Decimal a, Decimal b)
{
    if (a.digits == 0) return b;
    if (b.digits == 0) return a;
    for (Decimal* each : {&a, &b}) {
        const Decimal& other = each == &a ? b : a;
        while (each->exponent > other.exponent) {
            if (each->digits > largest || each->digits < -largest) return std::nullopt;
            each->digits *= 10;
            --each->exponent;
        }
    }
    // Both below 10^18: their sum fits.
    return trimmed(a.digits + b.digits, a.exponent);
}

Decimal negative(const Decimal& x) { return {-x.digits, x.exponent}; }

/// Where it ends.
Exact quotient(Decimal a, const Decimal& b)
{
    if (b.digits == 0) return std::nullopt;
    while (a.digits % b.digits != 0) {
        if (a.digits > largest || a.digits < -largest) return std::nullopt;
        a.digits *= 10;
        --a.exponent;
    }
    return trimmed(a.digits / b.digits, a.exponent - b.exponent);
}

/// Of a whole exponent.
Exact power(const Decimal& x, const Decimal& exponent)
{
    constexpr std::int64_t most = 8;
    if (exponent.exponent != 0 || exponent.digits < 1 || exponent.digits > most)
        return std::nullopt;
    Exact result = x;
    for (std::int64_t i = 1; i < exponent.digits && result; ++i) result = product(*result, x);
    return result;
}

Exact folded(Op op, const std::vector<Decimal>& x)
{
    switch (op) {
    case Op::negate: return negative(x[0]);
    case Op::add: return sum(x[0], x[1]);
    case Op::subtract: return sum(x[0], negative(x[1]));
    case Op::multiply: return product(x[0], x[1]);
    case Op::divide: return quotient(x[0], x[1]);
    case Op::power:
    case Op::guarded_power: return power(x[0], x[1]);
    case Op::lerp: {
        const Exact span = sum(x[1], negative(x[0]));
        const Exact part = span ? product(*span, x[2]) : std::nullopt;
        return part ? sum(x[0], *part) : std::nullopt;
    }
    default: return std::nullopt;
    }
}

/// One component of an operation whose operands are literals.
Exact component_of(const Graph& graph, Op op, const std::vector<ExprId>& operands,
                   std::size_t component)
{
    std::vector<Decimal> values;
    for (const ExprId operand : operands) {
        ExprId scalar = spread_of(graph, operand);
        if (graph[scalar].op == Op::construct) scalar = graph.operands(scalar)[component];
        if (graph[scalar].op != Op::literal) return std::nullopt;
        const Exact value = decimal_of(graph.literal_of(scalar));
        if (!value) return std::nullopt;
        values.push_back(*value);
    }
    return folded(op, values);
}

bool is_arithmetic(Op op)
{
    switch (op) {
    case Op::negate:
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
    case Op::power:
    case Op::guarded_power:
    case Op::lerp: return true;
    default: return false;
    }
}

/// The nearest decimal of six digits that is no greater (`direction` -1) or no less (1).
double in_digits(double end, int direction)
{
    if (end == 0 || !std::isfinite(end)) return end;
    // d.ddddde+x
    const std::string text = fmt::format("{:.5e}", end);
    if (const double nearest = std::stod(text); direction * (nearest - end) >= 0) return nearest;
    const std::size_t e = text.find('e');
    // One digit more, so that the step below a power of 10 is as fine as those before it.
    const long long digits = 10 * std::llround(std::stod(text.substr(0, e)) * 1e5);
    const bool is_finer = std::abs(digits) == 1'000'000 && direction * digits < 0;
    return std::stod(fmt::format("{}e{}", digits + (is_finer ? direction : 10 * direction),
                                 std::stoi(text.substr(e + 1)) - 6));
}

}  // namespace

Range in_digits(const Range& range) { return {in_digits(range.low, -1), in_digits(range.high, 1)}; }

Module fold_decimals(const Module& module)
{
    return rewrite(module, [](Rebuild& rebuild) -> Step {
        return [&rebuild](ExprId id) {
            const Graph& old = rebuild.old().graph;
            const Expr& expr = old[id];
            if (!is_arithmetic(expr.op)) return rebuild.copy(id);
            Graph& graph = rebuild.graph;
            const std::vector<ExprId> operands = rebuild.moved_operands(id);
            std::vector<ExprId> parts;
            for (int k = 0; k < components(expr.type); ++k) {
                const Exact value =
                    component_of(graph, expr.op, operands, static_cast<std::size_t>(k));
                if (!value) return rebuild.copy(id);
                parts.push_back(graph.literal(fmt::format("{}e{}", value->digits, value->exponent),
                                              old.span(id)));
            }
            return expr.type == Type::scalar ? parts[0]
                                             : graph.construct(expr.type, parts, old.span(id));
        };
    });
}

}  // namespace lobe::optimize
