#include "emit/expression.h"

#include "emit/dialect.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lobe::tests {
namespace {

using ir::Op;

/// Adding what starts with a minus counts as subtracting the rest: that is exact.
std::string infix(const std::string& left, std::string_view word, const std::string& right)
{
    if (word == "+" && right.starts_with("(-"))
        return fmt::format("({} - {})", left, right.substr(2, right.size() - 3));
    return fmt::format("({} {} {})", left, word, right);
}

/// Precedence climbing over the operators of C, loosest level first.
class Parser {
public:
    Parser(const std::string& text, const std::map<std::string, std::string>& locals)
        : text_(text), locals_(locals)
    {
    }

    std::string run()
    {
        std::string result = ternary();
        skip();
        if (at_ != text_.size()) throw std::runtime_error("left over: " + text_.substr(at_));
        return result;
    }

private:
    std::string ternary()
    {
        const std::string condition = binary(0);
        if (!take("?")) return condition;
        const std::string then = ternary();
        if (!take(":")) throw std::runtime_error("no colon in " + text_);
        const std::string otherwise = ternary();
        return fmt::format("({} ? {} : {})", condition, then, otherwise);
    }

    std::string binary(std::size_t level)
    {
        static const std::vector<std::vector<std::string>> levels{
            {"||"}, {"&&"}, {"==", "!="}, {"<=", "<", ">=", ">"}, {"+", "-"}, {"*", "/"}};
        if (level == levels.size()) return unary();
        std::string left = binary(level + 1);
        for (;;) {
            std::string taken;
            for (const std::string& word : levels[level])
                if (taken.empty() && take(word)) taken = word;
            if (taken.empty()) return left;
            std::string right = binary(level + 1);
            // A comparison has one meaning, whichever side its literal is written on.
            if (taken.front() == '>') {
                taken.front() = '<';
                std::swap(left, right);
            }
            left = infix(left, taken, right);
        }
    }

    std::string unary()
    {
        if (take("--")) throw std::runtime_error("a decrement in " + text_);
        if (take("-")) return "(-" + unary() + ")";
        if (take("!")) return "(!" + unary() + ")";
        return primary();
    }

    std::string primary()
    {
        if (take("(")) {
            std::string inside = ternary();
            if (!take(")")) throw std::runtime_error("no ) in " + text_);
            return inside;
        }
        skip();
        std::string word;
        const auto is_word = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
        };
        while (
            at_ < text_.size() &&
            (is_word(text_[at_]) || (text_[at_] == '-' && !word.empty() && word.back() == 'e' &&
                                     std::isdigit(static_cast<unsigned char>(word.front())) != 0)))
            word += text_[at_++];
        if (word.empty()) throw std::runtime_error("no operand in " + text_.substr(at_));
        if (!take("(")) {
            const auto local = locals_.find(word);
            return local == locals_.end() ? word : local->second;
        }
        std::string call = word + "(";
        for (bool first = true; !take(")"); first = false) {
            if (!first && !take(",")) throw std::runtime_error("no comma in " + text_);
            call += (first ? "" : ", ") + ternary();
        }
        return call + ")";
    }

    void skip()
    {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0)
            ++at_;
    }

    bool take(const std::string& word)
    {
        skip();
        if (text_.compare(at_, word.size(), word) != 0) return false;
        // `<` is not the start of `<=`.
        if ((word == "<" || word == ">") && text_.compare(at_, 2, word + "=") == 0) return false;
        at_ += word.size();
        return true;
    }

    const std::string& text_;
    const std::map<std::string, std::string>& locals_;
    std::size_t at_ = 0;
};

}  // namespace

std::string fully_parenthesized(const std::string& expression,
                                const std::map<std::string, std::string>& locals)
{
    return Parser{expression, locals}.run();
}

std::string fully_parenthesized(const ir::Graph& graph, ir::ExprId id,
                                const std::vector<std::string>& inputs)
{
    const emit::Dialect& glsl = emit::dialect(*emit::find_target("glsl450"));
    const auto operands = graph.operands(id);
    const auto text = [&](std::size_t i) {
        return fully_parenthesized(graph, operands[i], inputs);
    };
    const Op op = graph[id].op;
    if (op == Op::literal) {
        const std::string number = glsl.literal(graph.literal_of(id));
        return number.front() == '-' ? "(" + number + ")" : number;
    }
    if (op == Op::input) return inputs[graph[id].aux];
    const emit::Spelling spelling = glsl.spelling(op);
    using Kind = emit::Spelling::Kind;
    if (spelling.kind == Kind::prefix) return fmt::format("({}{})", spelling.word, text(0));
    if (spelling.kind == Kind::ternary)
        return fmt::format("({} ? {} : {})", text(0), text(1), text(2));
    if (spelling.kind == Kind::infix) return infix(text(0), spelling.word, text(1));
    std::string call = std::string{spelling.word} + "(";
    for (std::size_t i = 0; i < operands.size(); ++i) call += (i == 0 ? "" : ", ") + text(i);
    if (spelling.zero_and_one) call += ", 0.0, 1.0";
    return call + ")";
}

}  // namespace lobe::tests
