#include "optimize/sum.h"

#include "optimize/literal.h"

#include <algorithm>
#include <cmath>

namespace lobe::optimize {

using namespace ir;
using evaluate::Interval;

namespace {

constexpr std::size_t most_monomials = 8;
constexpr std::size_t most_factors = 12;

/// Like monomials joined. Coefficients are small whole numbers or halves in practice; where their
/// arithmetic would round, there is no sum.
std::optional<Sum> normal(Sum sum)
{
    std::ranges::sort(sum, {}, &Monomial::factors);
    Sum result;
    for (Monomial& monomial : sum) {
        if (!result.empty() && result.back().factors == monomial.factors) {
            const double both[] = {result.back().coefficient, monomial.coefficient};
            const auto joined = fold_exactly(Op::add, both);
            if (!joined) return std::nullopt;
            result.back().coefficient = *joined;
        } else {
            result.push_back(std::move(monomial));
        }
    }
    std::erase_if(result, [](const Monomial& monomial) { return monomial.coefficient == 0; });
    return result;
}

std::optional<Sum> product(const Sum& a, const Sum& b)
{
    if (a.size() * b.size() > most_monomials) return std::nullopt;
    Sum result;
    for (const Monomial& x : a)
        for (const Monomial& y : b) {
            const double both[] = {x.coefficient, y.coefficient};
            const auto coefficient = fold_exactly(Op::multiply, both);
            if (!coefficient || x.factors.size() + y.factors.size() > most_factors)
                return std::nullopt;
            Monomial monomial{*coefficient, x.factors};
            monomial.factors.insert(monomial.factors.end(), y.factors.begin(), y.factors.end());
            std::ranges::sort(monomial.factors);
            result.push_back(std::move(monomial));
        }
    return normal(std::move(result));
}

std::optional<Sum> total(const Sum& a, const Sum& b)
{
    Sum result = a;
    result.insert(result.end(), b.begin(), b.end());
    auto joined = normal(std::move(result));
    if (joined && joined->size() > most_monomials) return std::nullopt;
    return joined;
}

/// base^exponent for a literal 1 .. 4. Of a sum it is a power of one factor, not an expansion:
/// (1 - c)^2 says more about its accuracy than 1 - 2 c + c^2.
std::optional<Sum> power(const Graph& graph, ExprId base, const Sum& expanded, ExprId exponent)
{
    const auto times = exact_literal(graph, exponent);
    if (!times || (*times != 1 && *times != 2 && *times != 3 && *times != 4)) return std::nullopt;
    const Sum one_factor = expanded.size() == 1 ? expanded : Sum{{1, {base}}};
    std::optional<Sum> result = one_factor;
    for (int i = 1; i < static_cast<int>(*times) && result; ++i)
        result = product(*result, one_factor);
    return result;
}

std::optional<Sum> expand(const Graph& graph, ExprId id, const Facts<Expr, Sum>& sums)
{
    const auto operands = graph.operands(id);
    const auto sum = [&](std::size_t i) -> const Sum& { return sums[operands[i]]; };
    switch (graph[id].op) {
    case Op::literal: {
        const auto value = exact_value(graph.literal_of(id));
        if (!value) return std::nullopt;
        return *value == 0 ? Sum{} : Sum{{*value, {}}};
    }
    case Op::negate: return negate(sum(0));
    case Op::add: return total(sum(0), sum(1));
    case Op::subtract: return total(sum(0), negate(sum(1)));
    case Op::multiply: return product(sum(0), sum(1));
    case Op::power:
    case Op::guarded_power: return power(graph, operands[0], sum(0), operands[1]);
    case Op::lerp: {
        const auto span = total(sum(1), negate(sum(0)));
        const auto part = span ? product(*span, sum(2)) : std::nullopt;
        return part ? total(sum(0), *part) : std::nullopt;
    }
    default: return std::nullopt;
    }
}

Interval times(const Interval& a, const Interval& b)
{
    // An infinite end is never reached, so zero times it is zero.
    const auto end = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
    const double ends[] = {end(a.low, b.low), end(a.low, b.high), end(a.high, b.low),
                           end(a.high, b.high)};
    return {*std::ranges::min_element(ends), *std::ranges::max_element(ends)};
}

}  // namespace

Facts<Expr, Sum> expand_sums(const Graph& graph)
{
    Facts<Expr, Sum> sums(graph.size());
    for (const ExprId id : graph.ids()) {
        auto sum = graph[id].type == Type::scalar ? expand(graph, id, sums) : std::nullopt;
        sums[id] = sum ? *std::move(sum) : Sum{{1, {id}}};
    }
    return sums;
}

std::optional<Split> split(const Sum& sum, ExprId variable, int degree)
{
    Split result;
    for (const Monomial& monomial : sum) {
        const auto power = std::ranges::count(monomial.factors, variable);
        if (power == 0) {
            result.constant.push_back(monomial);
        } else if (power == degree) {
            Monomial rest = monomial;
            std::erase(rest.factors, variable);
            result.slope.push_back(std::move(rest));
        } else {
            return std::nullopt;
        }
    }
    if (result.slope.empty()) return std::nullopt;
    return result;
}

Sum add(const Sum& a, const Sum& b)
{
    Sum result = a;
    result.insert(result.end(), b.begin(), b.end());
    // Where coefficients would round, leaving them apart is a sum as well.
    return normal(result).value_or(result);
}

Sum negate(const Sum& sum)
{
    Sum result = sum;
    for (Monomial& monomial : result) monomial.coefficient = -monomial.coefficient;
    return result;
}

Interval bounds(const Sum& sum, const Facts<Expr, Interval>& ranges)
{
    Interval result{0, 0};
    for (const Monomial& monomial : sum) {
        Interval part{monomial.coefficient, monomial.coefficient};
        for (std::size_t i = 0; i < monomial.factors.size();) {
            const auto end = std::find_if(monomial.factors.begin() + static_cast<long>(i),
                                          monomial.factors.end(),
                                          [&](ExprId id) { return id != monomial.factors[i]; });
            const auto repeats = static_cast<std::size_t>(end - monomial.factors.begin()) - i;
            const Interval& range = ranges[monomial.factors[i]];
            Interval power{1, 1};
            for (std::size_t k = 0; k < repeats; ++k) power = times(power, range);
            if (repeats % 2 == 0) {
                // An even power is not negative, and is 0 only where its base is.
                const double least = range.low > 0 ? range.low : range.high < 0 ? -range.high : 0;
                power.low = std::pow(least, static_cast<double>(repeats));
            }
            part = times(part, power);
            i += repeats;
        }
        result = {result.low + part.low, result.high + part.high};
    }
    return result;
}

}  // namespace lobe::optimize
