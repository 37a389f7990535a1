#include "syntax/format_expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lobe::syntax {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

/// How tightly a node binds; the levels of docs/grammar.md.
enum Level {
    level_if,
    level_or,
    level_and,
    level_not,
    level_comparison,
    level_sum,
    level_product,
    level_unary,
    level_power,
    level_postfix,
};

struct OperatorText {
    std::string_view text;
    Level level;
};

/// In the order of `BinaryOperator`.
constexpr std::array operators{
    OperatorText{" + ", level_sum},         OperatorText{" - ", level_sum},
    OperatorText{" * ", level_product},     OperatorText{" / ", level_product},
    OperatorText{"^", level_power},         OperatorText{" < ", level_comparison},
    OperatorText{" <= ", level_comparison}, OperatorText{" > ", level_comparison},
    OperatorText{" >= ", level_comparison}, OperatorText{" == ", level_comparison},
    OperatorText{" != ", level_comparison}, OperatorText{" and ", level_and},
    OperatorText{" or ", level_or},
};

const OperatorText& text_of(BinaryOperator op) { return operators[static_cast<std::size_t>(op)]; }

bool is_constant(const Expression& expression)
{
    const auto* name = std::get_if<Name>(&expression.node);
    return std::holds_alternative<Number>(expression.node) ||
           (name != nullptr && name->text == "pi");
}

/// Between two constants a division is a fraction: `1/4096`, `pi/2`.
std::string_view operator_text(const Binary& binary, const Tree& tree)
{
    const bool fraction = binary.op == BinaryOperator::divide && !binary.limit.valid() &&
                          is_constant(tree[binary.left]) && is_constant(tree[binary.right]);
    return fraction ? "/" : text_of(binary.op).text;
}

Level level_of(const Expression& expression)
{
    return std::visit(Overloaded{
                          [](const Conditional&) { return level_if; },
                          [](const Binary& binary) { return text_of(binary.op).level; },
                          [](const Unary& unary) {
                              return unary.op == UnaryOperator::negate ? level_unary : level_not;
                          },
                          [](const Sum&) { return level_unary; },
                          [](const auto&) { return level_postfix; },
                      },
                      expression.node);
}

bool has_limit(const Expression& expression)
{
    const auto* binary = std::get_if<Binary>(&expression.node);
    return binary != nullptr && binary->limit.valid();
}

template <class Node>
bool is(const Expression& expression)
{
    return std::holds_alternative<Node>(expression.node);
}

/// Whether an operand stands in parentheses below an operator that takes operands from `least`.
/// A division with its limit always does: `a / b else 0 + 1` is read in two ways.
bool parenthesize(const Expression& operand, int least)
{
    return level_of(operand) < least || has_limit(operand);
}

bool parenthesize_negated(const Expression& operand)
{
    // `--x` is a decrement elsewhere, and in `-x^2` a reader may doubt; the writer chose.
    const auto* unary = std::get_if<Unary>(&operand.node);
    const bool doubtful = level_of(operand) == level_power && operand.parenthesized;
    return unary != nullptr || doubtful || parenthesize(operand, level_unary);
}

bool parenthesize_base(const Expression& operand) { return parenthesize(operand, level_postfix); }

bool parenthesize_member_base(const Expression& operand)
{
    return is<Number>(operand) || parenthesize(operand, level_postfix);
}

bool parenthesize_branch(const Expression& operand)
{
    return is<Conditional>(operand) || has_limit(operand);
}

/// Whether a sum holds nothing but a value; then it may stand on one line.
bool is_one_line(const Sum& sum)
{
    return sum.body.lets.empty() && sum.body.value_comments.empty();
}

}  // namespace

std::string slashes(const Comment& comment)
{
    return fmt::format("{}{}{}", comment.doc ? "///" : "//", comment.text.empty() ? "" : " ",
                       comment.text);
}

std::size_t character_count(std::string_view text)
{
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }));
}

/// One expression being written. Recursion is as deep as the tree, which the parser bounds.
class ExpressionWriter::Layout {
public:
    Layout(const ExpressionWriter& writer, bool may_break, std::size_t column)
        : writer_(writer), tree_(writer.tree_), may_break_(may_break), column_(column)
    {
    }

    void write(ExpressionId id, std::size_t indent)
    {
        const Expression& expression = tree_[id];
        const bool fits = !may_break_ || column_ + writer_.widths_[id.index] <= widest_line;
        std::visit(Overloaded{
                       [&](const Number& number) { put(number.text); },
                       [&](const Name& name) { put(name.text); },
                       [&](const Member& member) {
                           operand(member.base, parenthesize_member_base(tree_[member.base]),
                                   indent);
                           put(".");
                           put(member.member.text);
                       },
                       [&](const Unary& unary) { write_unary(unary, indent); },
                       [&](const Binary& binary) { write_binary(binary, indent, fits); },
                       [&](const Call& call) { write_call(call, indent, fits); },
                       [&](const Conditional& node) { write_conditional(node, indent, fits); },
                       [&](const Sum& sum) { write_sum(sum, indent, fits); },
                       [&](const Poison&) {},
                   },
                   expression.node);
    }

    std::string take() { return std::move(out_); }

private:
    void put(std::string_view text)
    {
        out_ += text;
        column_ += text.size();
    }

    void new_line(std::size_t indent)
    {
        out_ += '\n';
        out_.append(indent, ' ');
        column_ = indent;
    }

    void operand(ExpressionId id, bool parentheses, std::size_t indent)
    {
        if (parentheses) put("(");
        write(id, parentheses ? indent + 2 : indent);
        if (parentheses) put(")");
    }

    void write_unary(const Unary& unary, std::size_t indent)
    {
        const Expression& inner = tree_[unary.operand];
        if (unary.op == UnaryOperator::negate) {
            put("-");
            operand(unary.operand, parenthesize_negated(inner), indent);
        } else {
            put("not ");
            operand(unary.operand, parenthesize(inner, level_not), indent);
        }
    }

    void write_binary(const Binary& binary, std::size_t indent, bool fits)
    {
        const std::string_view text = operator_text(binary, tree_);
        const Level level = text_of(binary.op).level;
        if (level == level_power) {
            operand(binary.left, parenthesize_base(tree_[binary.left]), indent);
            put(text);
            operand(binary.right, parenthesize(tree_[binary.right], level_unary), indent);
            return;
        }
        const bool chain = level != level_comparison;
        const bool breaks = chain && !fits && !opens_block(binary);
        const std::size_t inner = breaks ? indent + 2 : indent;
        const Expression& left = tree_[binary.left];
        // The left spine of a chain is one list: all of it breaks, or none.
        if (breaks && level_of(left) == level && !has_limit(left))
            write_binary(std::get<Binary>(left.node), indent, false);
        else
            operand(binary.left, parenthesize(left, chain ? level : level + 1), inner);

        if (breaks) {
            new_line(inner);
            put(text.substr(text.find_first_not_of(' ')));
        } else {
            put(text);
        }
        operand(binary.right, parenthesize(tree_[binary.right], level + 1), inner);
        if (binary.limit.valid()) {
            put(" else ");
            operand(binary.limit, parenthesize(tree_[binary.limit], level_unary), inner);
        }
    }

    void write_call(const Call& call, std::size_t indent, bool fits)
    {
        put(call.callee.text);
        put("(");
        for (std::size_t i = 0; i < call.arguments.size(); ++i) {
            if (i > 0) put(fits ? ", " : ",");
            if (!fits) new_line(indent + 2);
            write(call.arguments[i], indent + 2);
        }
        if (!fits && !call.arguments.empty()) new_line(indent);
        put(")");
    }

    void write_conditional(const Conditional& node, std::size_t indent, bool fits)
    {
        const auto part = [&](std::string_view word, ExpressionId id, bool parentheses) {
            put(word);
            operand(id, parentheses, indent + 2);
        };
        const auto separate = [&] { fits ? put(" ") : new_line(indent); };
        part("if ", node.condition, parenthesize_branch(tree_[node.condition]));
        separate();
        part("then ", node.then_value, parenthesize_branch(tree_[node.then_value]));
        separate();
        // `else if` chains need no parentheses, and are no deeper at their end.
        if (is<Conditional>(tree_[node.else_value])) {
            put("else ");
            write(node.else_value, indent);
            return;
        }
        part("else ", node.else_value, has_limit(tree_[node.else_value]));
    }

    /// `2 * sum i in 0 .. 7 {`: the block may open on the line of what stands before it.
    bool opens_block(const Binary& binary) const
    {
        return is<Sum>(tree_[binary.right]) &&
               column_ + writer_.widths_[binary.left.index] <= widest_line / 2;
    }

    // ---- sums: a block of lines unless all of it is one short expression

    void write_sum(const Sum& sum, std::size_t indent, bool fits)
    {
        put("sum ");
        put(sum.index.text);
        put(" in ");
        operand(sum.first, parenthesize(tree_[sum.first], level_sum), indent + 2);
        put(" .. ");
        operand(sum.last, parenthesize(tree_[sum.last], level_sum), indent + 2);
        put(" {");
        if (fits && is_one_line(sum)) {
            put(" ");
            write(sum.body.value, indent);
            put(" }");
            return;
        }
        const std::size_t inner = indent + 2;
        for (const Let& let : sum.body.lets) {
            write_comments(let.comments, inner);
            begin_line(let.blank_before, inner);
            put("let ");
            put(let.name.text);
            put(" =");
            write_let_value(let.value, inner);
            for (const Comment& comment : let.trailing) put_comment(comment, "  ");
        }
        write_comments(sum.body.value_comments, inner);
        begin_line(sum.body.value_blank_before, inner);
        operand(sum.body.value, writer_.parenthesize_value(sum.body), inner);
        new_line(indent);
        put("}");
    }

    void write_let_value(ExpressionId value, std::size_t indent)
    {
        const bool beside = column_ + 1 + writer_.widths_[value.index] <= widest_line;
        if (beside || writer_.is_block(value)) {
            put(" ");
            write(value, indent);
        } else {
            new_line(indent + 2);
            write(value, indent + 2);
        }
    }

    void begin_line(bool blank_before, std::size_t indent)
    {
        if (blank_before && !out_.ends_with('{')) out_ += '\n';
        new_line(indent);
    }

    void write_comments(const std::vector<Comment>& comments, std::size_t indent)
    {
        for (const Comment& comment : comments) {
            begin_line(comment.blank_before, indent);
            put_comment(comment, "");
        }
    }

    void put_comment(const Comment& comment, std::string_view space)
    {
        put(space);
        put(slashes(comment));
    }

    const ExpressionWriter& writer_;
    const Tree& tree_;
    bool may_break_;
    std::size_t column_;
    std::string out_;
};

ExpressionWriter::ExpressionWriter(const Tree& tree) : tree_(tree)
{
    // Operands come before what uses them.
    widths_.reserve(tree.expressions.size());
    const auto in = [&](ExpressionId id, bool parentheses) {
        return id.valid() ? widths_[id.index] + (parentheses ? 2 : 0) : 0;
    };
    for (const Expression& expression : tree.expressions) {
        widths_.push_back(std::visit(
            Overloaded{
                [](const Number& number) { return number.text.size(); },
                [](const Name& name) { return name.text.size(); },
                [&](const Member& member) {
                    return in(member.base, parenthesize_member_base(tree_[member.base])) + 1 +
                           member.member.text.size();
                },
                [&](const Unary& unary) {
                    const Expression& inner = tree_[unary.operand];
                    return unary.op == UnaryOperator::negate
                               ? 1 + in(unary.operand, parenthesize_negated(inner))
                               : 4 + in(unary.operand, parenthesize(inner, level_not));
                },
                [&](const Binary& binary) {
                    const Level level = text_of(binary.op).level;
                    const std::string_view text = operator_text(binary, tree_);
                    return in(binary.left, parenthesize(tree_[binary.left], level)) + text.size() +
                           in(binary.right, parenthesize(tree_[binary.right], level + 1)) +
                           (binary.limit.valid() ? 6 + in(binary.limit, false) : 0);
                },
                [&](const Call& call) {
                    std::size_t width = call.callee.text.size() + 2;
                    for (const ExpressionId argument : call.arguments)
                        width += in(argument, false) + 2;
                    return call.arguments.empty() ? width : width - 2;
                },
                [&](const Conditional& node) {
                    return std::size_t{16} + in(node.condition, false) +
                           in(node.then_value, false) + in(node.else_value, false);
                },
                [&](const Sum& sum) {
                    if (!is_one_line(sum)) return widest_line + 1;
                    return sum.index.text.size() + 17 +
                           in(sum.first, parenthesize(tree_[sum.first], level_sum)) +
                           in(sum.last, parenthesize(tree_[sum.last], level_sum)) +
                           in(sum.body.value, false);
                },
                [](const Poison&) { return std::size_t{0}; },
            },
            expression.node));
    }
}

bool ExpressionWriter::is_block(ExpressionId id) const
{
    const auto* binary = std::get_if<Binary>(&tree_[id].node);
    return is<Sum>(tree_[id]) || (binary != nullptr && is<Sum>(tree_[binary->right]) &&
                                  widths_[binary->left.index] <= widest_line / 2);
}

bool ExpressionWriter::parenthesize_before_else(ExpressionId id) const
{
    return parenthesize_branch(tree_[id]);
}

bool ExpressionWriter::parenthesize_value(const Body& body) const
{
    // A line that starts with `-` would continue the `let` before it.
    return !body.lets.empty() && flat(body.value).starts_with('-');
}

bool ExpressionWriter::parenthesize_as_sum(ExpressionId id) const
{
    return parenthesize(tree_[id], level_sum);
}

std::string ExpressionWriter::flat(ExpressionId id) const
{
    Layout layout{*this, false, 0};
    layout.write(id, 0);
    return layout.take();
}

std::string ExpressionWriter::broken(ExpressionId id, std::size_t column, std::size_t indent) const
{
    Layout layout{*this, true, column};
    layout.write(id, indent);
    return layout.take();
}

}  // namespace lobe::syntax
