#include "emit/write.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {
namespace {

using ir::Expr;
using ir::ExprId;
using ir::Op;
using ir::Type;

constexpr std::size_t longest_expression = 76;
constexpr std::size_t worth_a_local = 20;

bool is_identifier(std::string_view text)
{
    return std::ranges::all_of(text, [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
               (c >= 'A' && c <= 'Z');
    });
}

class Writer {
public:
    Writer(Scope& scope, Helpers& helpers, const ir::Graph& graph)
        : scope_(scope), dialect_(scope.dialect), helpers_(helpers), graph_(graph),
          uses_(graph.size()), texts_(graph.size()), powers_(graph.size())
    {
    }

    Body write(const std::vector<ExprId>& roots)
    {
        for (const ExprId root : roots) ++uses_[root];
        for (std::size_t i = graph_.size(); i-- > 0;)
            if (uses_[ExprId{i}] > 0)
                for (const ExprId operand : graph_.operands(ExprId{i})) ++uses_[operand];

        for (const ExprId id : graph_.ids()) {
            if (uses_[id] == 0) continue;
            texts_[id] = expression(id);
            const bool named = !graph_.name_of(id).empty();
            if (!is_trivial(id) && (uses_[id] > 1 || named)) make_local(id);
        }
        for (const ExprId root : roots) body_.results.push_back(texts_[root]);
        return std::move(body_);
    }

private:
    // ---- which expressions become locals, and what they are called

    /// Not worth a name: reading it costs nothing.
    bool is_trivial(ExprId id) const
    {
        const Expr& expr = graph_[id];
        switch (expr.op) {
        case Op::literal:
        case Op::input: return true;
        case Op::component:
        case Op::negate: return is_name(graph_.operands(id)[0]);
        case Op::construct: return expr.count == 1 && is_trivial(graph_.operands(id)[0]);
        default: return is_name(id);
        }
    }

    bool is_name(ExprId id) const
    {
        return graph_[id].op != Op::literal && !texts_[id].text.empty() &&
               is_identifier(texts_[id].text);
    }

    void make_local(ExprId id)
    {
        const std::string name = scope_.namer.unique(local_name(id));
        const std::string_view type = dialect_.type(graph_[id].type);
        body_.locals.push_back(
            {fmt::format("{}{} {} = {};", dialect_.local_qualifier, type, name, texts_[id].text),
             graph_.span(id)});
        texts_[id] = {name, Precedence::primary};
    }

    std::string local_name(ExprId id)
    {
        if (const std::string& given = graph_.name_of(id); !given.empty()) {
            // The engine's booleans start with a `b`.
            const bool flag = graph_[id].type == Type::boolean && dialect_.names == Case::pascal;
            return (flag ? "b" : "") + dialect_.styled(given);
        }
        std::string name = derived_name(id);
        if (!name.empty()) return name;
        do name = dialect_.styled(fmt::format("t{}", next_++));
        while (scope_.namer.is_taken(name));
        return name;
    }

    /// What a reader would call it, judging from what it is made of; may be empty.
    std::string derived_name(ExprId id)
    {
        const auto operands = graph_.operands(id);
        switch (graph_[id].op) {
        case Op::call: return callee_name(scope_.module.functions[graph_[id].aux].name);
        case Op::multiply: return power_name(id);
        case Op::subtract:
            if (graph_.is_literal(operands[0], 1) && is_name(operands[1])) {
                const std::string& x = texts_[operands[1]].text;
                return dialect_.names == Case::pascal ? "OneMinus" + x : "one_minus_" + x;
            }
            return graph_[id].type == Type::vec3 ? pair_name(id, "minus") : std::string{};
        case Op::dot: return pair_name(id, "dot");
        case Op::cross: return pair_name(id, "cross");
        case Op::guarded_normalize:
        case Op::normalize:
            if (graph_[operands[0]].op == Op::add) return dialect_.styled("h");
            return {};
        default: return {};
        }
    }

    /// n_cross_h, NCrossH for two names.
    std::string pair_name(ExprId id, std::string_view word) const
    {
        const auto operands = graph_.operands(id);
        if (!is_name(operands[0]) || !is_name(operands[1]) || operands[0] == operands[1]) return {};
        return dialect_.styled(
            fmt::format("{}_{}_{}", texts_[operands[0]].text, word, texts_[operands[1]].text));
    }

    /// D for D_GGX, diffuse for Diffuse_Lambert, c1_value for c1.
    std::string callee_name(const std::string& callee) const
    {
        const auto underscore = callee.find('_');
        const bool capital = callee.front() >= 'A' && callee.front() <= 'Z';
        if (underscore == std::string::npos || !capital) return dialect_.styled(callee + "_value");
        std::string head = callee.substr(0, underscore);
        if (head.size() > 2) head.front() = static_cast<char>(head.front() - 'A' + 'a');
        return dialect_.styled(head);
    }

    /// x2 for x * x, x4 for x2 * x2, x5 for x4 * x.
    std::string power_name(ExprId id)
    {
        const auto [a, b] =
            std::pair{power_of(graph_.operands(id)[0]), power_of(graph_.operands(id)[1])};
        if (a.base.empty() || a.base != b.base || a.exponent + b.exponent > 9) return {};
        powers_[id] = {a.base, a.exponent + b.exponent};
        const bool digit = a.base.back() >= '0' && a.base.back() <= '9';
        return fmt::format("{}{}{}", a.base, digit ? "_p" : "", a.exponent + b.exponent);
    }

    struct Power {
        std::string base;
        int exponent = 1;
    };

    Power power_of(ExprId id) const
    {
        if (!powers_[id].base.empty()) return powers_[id];
        return is_name(id) ? Power{texts_[id].text, 1} : Power{};
    }

    // ---- the text of one expression over the texts of its operands

    Text expression(ExprId id)
    {
        Text text = compose(id);
        // Too wide for a line: give the widest operands names of their own.
        while (text.text.size() > longest_expression) {
            ExprId widest;
            std::size_t width = worth_a_local;
            for (const ExprId operand : graph_.operands(id))
                if (texts_[operand].text.size() > width && !is_trivial(operand)) {
                    widest = operand;
                    width = texts_[operand].text.size();
                }
            if (!widest.valid()) break;
            make_local(widest);
            text = compose(id);
        }
        return text;
    }

    Text compose(ExprId id)
    {
        const Expr& expr = graph_[id];
        const auto operands = graph_.operands(id);
        const Spelling spelling = dialect_.spelling(expr.op);
        switch (spelling.kind) {
        case Spelling::Kind::special: return special(id);
        case Spelling::Kind::call: {
            std::vector<std::string> arguments = spread_all(id, spelling);
            if (spelling.zero_and_one) {
                arguments.push_back(dialect_.literal(0));
                arguments.push_back(dialect_.literal(1));
            }
            return call(spelling.word, arguments);
        }
        case Spelling::Kind::helper: {
            helpers_.insert({expr.op, expr.type});
            if (expr.type != Type::scalar && expr.op != Op::guarded_normalize)
                helpers_.insert({expr.op, Type::scalar});
            return call(helper_name(dialect_, scope_.helper_prefix, expr.op),
                        spread_all(id, spelling));
        }
        case Spelling::Kind::prefix:
            return {std::string{spelling.word} + nested(texts_[operands[0]], spelling, false),
                    spelling.precedence};
        case Spelling::Kind::infix: return infix(id, spelling);
        case Spelling::Kind::ternary: {
            const std::string condition = nested(texts_[operands[0]], spelling, false);
            const std::string then = nested(spread(id, 1), spelling, false);
            const std::string otherwise = nested(spread(id, 2), spelling, false);
            return {fmt::format("{} ? {} : {}", condition, then, otherwise), spelling.precedence};
        }
        }
        return {};
    }

    Text special(ExprId id)
    {
        const Expr& expr = graph_[id];
        const auto operands = graph_.operands(id);
        switch (expr.op) {
        case Op::literal: {
            const std::string text = dialect_.literal(graph_.literal_of(id));
            return {text, text.front() == '-' ? Precedence::unary : Precedence::primary};
        }
        case Op::input: return {scope_.inputs[expr.aux], Precedence::primary};
        case Op::component: {
            const Text& vector = texts_[operands[0]];
            const bool bare = vector.precedence == Precedence::primary;
            const std::string_view letters = is_color(operands[0]) ? "rgba" : "xyzw";
            return {fmt::format("{}.{}", bare ? vector.text : parenthesized(vector.text),
                                letters[expr.aux])};
        }
        case Op::construct: {
            if (operands.size() == 1) return spread_text(texts_[operands[0]], expr.type);
            std::vector<std::string> arguments;
            for (const ExprId operand : operands) arguments.push_back(texts_[operand].text);
            return call(dialect_.type(expr.type), arguments);
        }
        case Op::call: {
            std::vector<std::string> arguments;
            for (const ExprId operand : operands) arguments.push_back(texts_[operand].text);
            return call(scope_.functions[expr.aux], arguments);
        }
        default: return {};
        }
    }

    Text infix(ExprId id, const Spelling& spelling)
    {
        const auto operands = graph_.operands(id);
        std::string_view word = spelling.word;
        Text left = texts_[operands[0]];
        Text right = texts_[operands[1]];
        // `x > 0.0` reads better than `0.0 < x`.
        const Op op = graph_[id].op;
        if ((op == Op::less || op == Op::less_equal) && graph_[operands[0]].op == Op::literal &&
            graph_[operands[1]].op != Op::literal) {
            std::swap(left, right);
            word = op == Op::less ? ">" : ">=";
        }
        // `a + -b` is `a - b`, to the bit.
        const bool negative = right.precedence == Precedence::unary && right.text.front() == '-';
        if (graph_[id].op == Op::add && negative) {
            word = "-";
            right = {right.text.substr(1), Precedence::primary};
        }
        return {fmt::format("{} {} {}", nested(left, spelling, true), word,
                            nested(right, spelling, false)),
                spelling.precedence};
    }

    /// An operand's text, in parentheses where it would bind otherwise. Equal precedence may stay
    /// bare on the left of an infix operator, as in `a - b - c`; not on its right, not in a
    /// ternary, and not below a unary minus, where `--x` would be a decrement.
    std::string nested(const Text& operand, const Spelling& parent, bool left) const
    {
        const bool bare = operand.precedence > parent.precedence ||
                          (operand.precedence == parent.precedence && left) ||
                          operand.precedence == Precedence::primary;
        return bare ? operand.text : parenthesized(operand.text);
    }

    std::string parenthesized(const std::string& text) const
    {
        return fmt::format("{}{}{}", dialect_.call_open, text, dialect_.call_close);
    }

    Text call(std::string_view function, const std::vector<std::string>& arguments) const
    {
        if (arguments.empty()) return {fmt::format("{}()", function)};
        return {fmt::format("{}{}{}{}", function, dialect_.call_open, fmt::join(arguments, ", "),
                            dialect_.call_close)};
    }

    // ---- scalars among vectors

    std::vector<std::string> spread_all(ExprId id, const Spelling& spelling)
    {
        const auto operands = graph_.operands(id);
        bool may_stay = ir::shape(graph_[id].op) == ir::Shape::each;
        for (std::size_t i = 0; i < operands.size(); ++i)
            if ((spelling.scalars >> i & 1) != 0)
                may_stay = may_stay && graph_[operands[i]].type == Type::scalar;
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < operands.size(); ++i) {
            const bool stays = may_stay && (spelling.scalars >> i & 1) != 0;
            arguments.push_back(stays ? texts_[operands[i]].text : spread(id, i).text);
        }
        return arguments;
    }

    /// Operand i, as wide as the result where the operation works on each component.
    Text spread(ExprId id, std::size_t i) const
    {
        const ExprId operand = graph_.operands(id)[i];
        const bool each = ir::shape(graph_[id].op) == ir::Shape::each;
        if (!each || graph_[operand].type != Type::scalar || graph_[id].type == Type::scalar)
            return texts_[operand];
        return spread_text(texts_[operand], graph_[id].type);
    }

    Text spread_text(const Text& scalar, Type type) const
    {
        if (!dialect_.spread_by_cast) return call(dialect_.type(type), {scalar.text});
        const bool bare = scalar.precedence == Precedence::primary;
        return {fmt::format("({}){}", dialect_.type(type),
                            bare ? scalar.text : parenthesized(scalar.text)),
                Precedence::unary};
    }

    bool is_color(ExprId id) const
    {
        const Expr& expr = graph_[id];
        return (expr.op == Op::call &&
                scope_.module.functions[expr.aux].quantity == ir::Quantity::color) ||
               (expr.op == Op::input && expr.aux < scope_.colors.size() && scope_.colors[expr.aux]);
    }

    Scope& scope_;
    const Dialect& dialect_;
    Helpers& helpers_;
    const ir::Graph& graph_;
    Facts<Expr, int> uses_;
    Facts<Expr, Text> texts_;
    Facts<Expr, Power> powers_;
    Body body_;
    int next_ = 0;
};

}  // namespace

Body write(Scope& scope, Helpers& helpers, const ir::Graph& graph,
           const std::vector<ir::ExprId>& roots)
{
    return Writer{scope, helpers, graph}.write(roots);
}

std::string helper_name(const Dialect& dialect, std::string_view prefix, ir::Op op)
{
    return std::string{prefix} + dialect.styled(dialect.spelling(op).word);
}

}  // namespace lobe::emit
