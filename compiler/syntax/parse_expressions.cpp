// The rules for expressions, loosest binding first: `if`, `or`, `and`, `not`, comparisons,
// `+ -`, `* /` with its `else`, unary minus, `^`, members, calls and `sum`.
#include "syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::syntax {
namespace {

constexpr int level_or = 1;
constexpr int level_and = 2;
constexpr int level_not = 3;
constexpr int level_comparison = 4;
constexpr int level_sum = 5;
constexpr int level_product = 6;

struct Infix {
    BinaryOperator op;
    int level;
};

std::optional<Infix> infix(TokenKind kind)
{
    switch (kind) {
    case TokenKind::word_or: return Infix{BinaryOperator::logical_or, level_or};
    case TokenKind::word_and: return Infix{BinaryOperator::logical_and, level_and};
    case TokenKind::less: return Infix{BinaryOperator::less, level_comparison};
    case TokenKind::less_equal: return Infix{BinaryOperator::less_equal, level_comparison};
    case TokenKind::greater: return Infix{BinaryOperator::greater, level_comparison};
    case TokenKind::greater_equal: return Infix{BinaryOperator::greater_equal, level_comparison};
    case TokenKind::equal: return Infix{BinaryOperator::equal, level_comparison};
    case TokenKind::not_equal: return Infix{BinaryOperator::not_equal, level_comparison};
    case TokenKind::plus: return Infix{BinaryOperator::add, level_sum};
    case TokenKind::minus: return Infix{BinaryOperator::subtract, level_sum};
    case TokenKind::star: return Infix{BinaryOperator::multiply, level_product};
    case TokenKind::slash: return Infix{BinaryOperator::divide, level_product};
    default: return std::nullopt;
    }
}

bool is_comparison(BinaryOperator op)
{
    return op >= BinaryOperator::less && op <= BinaryOperator::not_equal;
}

}  // namespace

Parser::Nesting::Nesting(Parser& parser) : parser_(parser)
{
    if (++parser_.depth_ <= most_nested) return;
    Diagnostic result;
    result.code = Code::nested_too_deeply;
    result.message = fmt::format("this expression is nested more than {} deep", most_nested);
    result.primary = {parser_.span(parser_.current()), "the level that is too many"};
    result.helps.emplace_back("name a part of it with `let`");
    parser_.fail(std::move(result));
}

template <class Node>
ExpressionId Parser::add(Node node, const Span& span, std::size_t height)
{
    tree_.expressions.push_back({span, std::move(node), false});
    heights_.push_back(static_cast<std::uint16_t>(std::min(height, most_height)));
    outer_.push_back(span);
    return ExpressionId{tree_.expressions.size() - 1};
}

ExpressionId Parser::poison() { return add(Poison{}, span(current()), 1); }

bool Parser::too_high(std::size_t height)
{
    if (height <= most_height) return false;
    Diagnostic result;
    result.code = Code::nested_too_deeply;
    result.message = fmt::format("more than {} operators in one chain", most_height);
    result.primary = {span(previous()), "the operand that is too many"};
    result.helps.emplace_back("put parts of it in parentheses, or name them with `let`");
    fail(std::move(result));
    return true;
}

ExpressionId Parser::parse_expression()
{
    const Nesting nesting{*this};
    if (!nesting) return poison();
    return at(TokenKind::word_if) ? parse_conditional() : parse_operators(level_or);
}

ExpressionId Parser::parse_sum()
{
    const Nesting nesting{*this};
    if (!nesting) return poison();
    return parse_operators(level_sum);
}

ExpressionId Parser::parse_before_else()
{
    const bool outer_then = in_then_;
    in_then_ = true;
    const ExpressionId result = parse_expression();
    in_then_ = outer_then;
    return result;
}

/// Behind a condition, `=` is meant to compare.
void Parser::refuse_assign()
{
    if (!at(TokenKind::assign)) return;
    Diagnostic result;
    result.code = Code::unexpected_token;
    result.message = "`=` gives a name a value; it does not compare";
    result.primary = {span(current()), ""};
    result.fix = Fix{span(current()), "==", "write `==`"};
    fail(std::move(result));
}

ExpressionId Parser::parse_conditional()
{
    const Token keyword = advance();
    const bool outer_then = in_then_;

    in_then_ = false;
    const ExpressionId condition = parse_expression();
    refuse_assign();
    expect(TokenKind::word_then, "`then`");

    in_then_ = true;
    const ExpressionId then_value = parse_expression();
    expect(TokenKind::word_else, "`else`");

    in_then_ = outer_then;
    const ExpressionId else_value = parse_expression();
    const std::size_t high =
        1 + std::max({height(condition), height(then_value), height(else_value)});
    if (too_high(high)) return poison();
    return add(Conditional{condition, then_value, else_value}, span_from(keyword.begin), high);
}

ExpressionId Parser::parse_operators(int level)
{
    if (level == level_not) return parse_not();
    if (level > level_product) return parse_unary();

    ExpressionId left = parse_operators(level + 1);
    if (level == level_product) refuse_limit(left);
    while (const auto found = infix(current().kind)) {
        if (found->level != level) break;
        const Token op = advance();
        const ExpressionId right = parse_operators(level + 1);
        ExpressionId limit;
        if (found->op == BinaryOperator::divide) limit = parse_limit();

        const std::size_t high = 1 + std::max({height(left), height(right), height(limit)});
        if (too_high(high)) return left;
        const Span whole = join(outer(left), outer(limit.valid() ? limit : right));
        left = add(Binary{found->op, left, right, limit, span(op)}, whole, high);
        if (level == level_product) refuse_limit(left);
        if (is_comparison(found->op)) {
            if (const auto next = infix(current().kind); next && is_comparison(next->op))
                refuse_chain(left, right, current());
        }
    }
    if (level == level_product && at(TokenKind::percent)) {
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.message = "`%` is not an operator";
        result.primary = {span(current()), ""};
        result.helps.emplace_back("percents stand in `require radiance error < 2%` only");
        fail(std::move(result));
    }
    return left;
}

ExpressionId Parser::parse_not()
{
    if (!at(TokenKind::word_not)) return parse_operators(level_comparison);
    const Nesting nesting{*this};
    if (!nesting) return poison();
    const Token op = advance();
    const ExpressionId operand = parse_not();
    const std::size_t high = 1 + height(operand);
    if (too_high(high)) return poison();
    return add(Unary{UnaryOperator::logical_not, operand}, join(span(op), outer(operand)), high);
}

/// After the divisor of a division: what it is where the divisor is 0. Inside a `then` branch
/// `else` belongs to the `if`, as a reader expects; parentheses make it the division's.
ExpressionId Parser::parse_limit()
{
    if (in_then_ || !accept(TokenKind::word_else)) return {};
    return parse_unary();
}

void Parser::refuse_limit(ExpressionId of)
{
    if (in_then_ || !at(TokenKind::word_else)) return;
    const auto* binary = std::get_if<Binary>(&tree_[of].node);
    const bool division = binary != nullptr && binary->op == BinaryOperator::divide;
    // A complete division accepts an `else`; here it has one, or is a factor already.
    Diagnostic result;
    result.code = Code::missing_limit_operand;
    result.message = "`else` names the limit of a division, and this is none";
    result.primary = {span(current()), ""};
    result.secondary = {{outer(of), "not a division"}};
    result.helps.emplace_back("a conditional is written `if condition then a else b`");
    if (division && tree_[of].parenthesized) {
        result.message = "`else` stands outside the division that it belongs to";
        result.secondary = {{outer(of), "the division ends here"}};
        result.helps = {"write the limit inside the parentheses: `(a / b else c)`"};
    } else if (division) {
        result.message = "this division has a limit already";
        result.secondary = {{outer(binary->limit.valid() ? binary->limit : of), "its limit"}};
        result.helps.clear();
    }
    fail(std::move(result));
}

void Parser::refuse_chain(ExpressionId left, ExpressionId right, const Token& second)
{
    const std::string_view all = source_.text();
    const Span middle = outer(right);
    const std::string again{all.substr(middle.begin, middle.end - middle.begin)};
    Diagnostic result;
    result.code = Code::chained_comparison;
    result.message = "comparisons do not chain";
    result.primary = {span(second), "the second comparison"};
    result.secondary = {{std::get<Binary>(tree_[left].node).op_span, "the first comparison"}};
    if (again.size() <= 60 && again.find('\n') == std::string::npos)
        result.fix = Fix{
            {index_, second.begin, second.begin}, fmt::format("and {} ", again), "compare twice"};
    else
        result.helps.emplace_back("compare twice: `a < b and b < c`");
    fail(std::move(result));
}

ExpressionId Parser::parse_unary()
{
    if (!at(TokenKind::minus)) return parse_power();
    const Nesting nesting{*this};
    if (!nesting) return poison();
    const Token op = advance();
    const ExpressionId operand = parse_unary();
    const std::size_t high = 1 + height(operand);
    if (too_high(high)) return poison();
    return add(Unary{UnaryOperator::negate, operand}, join(span(op), outer(operand)), high);
}

ExpressionId Parser::parse_power()
{
    const ExpressionId base = parse_postfix();
    if (!at(TokenKind::caret)) return base;
    const Token op = advance();
    const ExpressionId exponent = parse_exponent();
    const std::size_t high = 1 + std::max(height(base), height(exponent));
    if (too_high(high)) return poison();
    return add(Binary{BinaryOperator::power, base, exponent, {}, span(op)},
               join(outer(base), outer(exponent)), high);
}

/// `-` may stand before an exponent, and powers associate to the right: `a^-b^c` is a^(-(b^c)).
ExpressionId Parser::parse_exponent()
{
    const Nesting nesting{*this};
    if (!nesting) return poison();
    return at(TokenKind::minus) ? parse_unary() : parse_power();
}

ExpressionId Parser::parse_postfix()
{
    ExpressionId base = parse_primary();
    while (accept(TokenKind::dot)) {
        Identifier member = expect_identifier("the name of a member");
        const std::size_t high = 1 + height(base);
        if (failed_ || too_high(high)) return base;
        const Span whole = join(outer(base), member.span);
        base = add(Member{base, std::move(member)}, whole, high);
    }
    return base;
}

ExpressionId Parser::parse_primary()
{
    const Token token = current();
    if (at_item() || at_block_line()) {
        fail_expected("an expression");
        return poison();
    }
    switch (token.kind) {
    case TokenKind::number: advance(); return add(Number{std::string{text(token)}}, span(token), 1);
    case TokenKind::bad_number: advance(); return add(Poison{}, span(token), 1);
    case TokenKind::identifier: {
        if (at_indexed_sum()) return parse_indexed_sum();
        // On a line of its own, `(` starts the value of a block rather than arguments.
        const Token& next = ahead(1);
        if (next.kind == TokenKind::left_parenthesis && !next.first_on_line) return parse_call();
        advance();
        return add(Name{std::string{text(token)}}, span(token), 1);
    }
    case TokenKind::left_parenthesis: return parse_parenthesized();
    case TokenKind::word_if: {
        const Nesting nesting{*this};
        if (!nesting) return poison();
        const ExpressionId conditional = parse_conditional();
        if (failed_) return conditional;
        const Span whole = outer(conditional);
        Diagnostic result;
        result.code = Code::unexpected_token;
        result.message = "an `if` that is an operand stands in parentheses";
        result.primary = {span(token), ""};
        if (const std::string written{source_.text().substr(whole.begin, whole.end - whole.begin)};
            written.find('\n') == std::string::npos)
            result.fix = Fix{whole, fmt::format("({})", written), "add them"};
        report(std::move(result));
        return conditional;
    }
    case TokenKind::word_let:
        fail_expected("an expression", "`let` stands in a block: `{ let y = x  y * y }`");
        return poison();
    default: fail_expected("an expression"); return poison();
    }
}

ExpressionId Parser::parse_parenthesized()
{
    const Token open = advance();
    const bool outer_then = in_then_;
    in_then_ = false;
    const ExpressionId inner = parse_expression();
    expect_closing(TokenKind::right_parenthesis, open, "`)`");
    in_then_ = outer_then;
    tree_.expressions[inner.index].parenthesized = true;
    if (!failed_) outer_[inner.index] = span_from(open.begin);
    return inner;
}

ExpressionId Parser::parse_call()
{
    const Token name = advance();
    const Token open = advance();
    const bool outer_then = in_then_;
    in_then_ = false;
    Call call;
    call.callee = {std::string{text(name)}, span(name)};
    std::size_t high = 0;
    while (!failed_ && !at(TokenKind::right_parenthesis)) {
        call.arguments.push_back(parse_expression());
        high = std::max(high, height(call.arguments.back()));
        if (!accept(TokenKind::comma)) break;
        if (at(TokenKind::right_parenthesis)) fail_expected("an argument");
    }
    expect_closing(TokenKind::right_parenthesis, open,
                   call.arguments.empty() ? "an argument or `)`" : "`,` or `)`");
    in_then_ = outer_then;
    if (too_high(high + 1)) return poison();
    return add(std::move(call), span_from(name.begin), high + 1);
}

/// `sum` is a name like any other unless an index and what it runs over stand beside it. No other
/// name has a name beside it in an expression; what else is written there is taken for `in`.
bool Parser::at_indexed_sum() const
{
    if (!at_word("sum") || ahead(1).kind != TokenKind::identifier || ahead(1).first_on_line)
        return false;
    const Token& after = ahead(2);
    return after.kind == TokenKind::assign || after.kind == TokenKind::number ||
           (after.kind == TokenKind::identifier && !after.first_on_line &&
            (text(after) == "in" || text(after) == "from" || text(after) == "of"));
}

/// sum = "sum" name "in" sum ".." sum "{" { let } expression "}"
ExpressionId Parser::parse_indexed_sum()
{
    const Nesting nesting{*this};
    if (!nesting) return poison();
    const Token keyword = advance();
    const bool outer_then = in_then_;
    in_then_ = false;
    const std::string_view help = "a sum is written `sum i in 0 .. 7 { … }`";
    Sum sum;
    sum.index = expect_identifier("the name of the index");
    if (!at_word("in"))
        fail_expected("`in` and two whole numbers", std::string{help});
    else
        advance();
    if (at(TokenKind::left_bracket)) fail_expected("a whole number", std::string{help});
    sum.first = parse_sum();
    if (!accept(TokenKind::dot_dot)) fail_expected("`..` and the last number", std::string{help});
    sum.last = parse_sum();
    if (at(TokenKind::left_brace))
        parse_block(sum.body);
    else
        fail_expected("`{` and what is summed", std::string{help});
    in_then_ = outer_then;
    if (failed_) return poison();

    std::size_t high = std::max({height(sum.first), height(sum.last), height(sum.body.value)});
    for (const Let& let : sum.body.lets) high = std::max(high, height(let.value));
    if (too_high(high + 1)) return poison();
    return add(std::move(sum), span_from(keyword.begin), high + 1);
}

}  // namespace lobe::syntax
