#include "analyze/agreement/mutation.h"

#include "analyze/agreement/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace lobe::analyze {
namespace {

// ORDER Mutation
constexpr std::array<std::string_view, 9> mutation_names{
    "swap inputs",  "drop pi",      "swap lerp ends", "flip sign",      "constant by 1e-4",
    "remove guard", "swap min max", "drop square",    "invert quotient"};

/// How the names of guarded helpers end, and the built-in function that each one guards.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> guarded{{
    {"guarded_power", "pow"},
    {"GuardedPower", "pow"},
    {"guarded_smoothstep", "smoothstep"},
    {"GuardedSmoothstep", "smoothstep"},
    {"guarded_normalize", "normalize"},
    {"GuardedNormalize", "normalize"},
}};

struct Edit {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string text;
};

/// Walks the tokens of a harness and collects the mutants of every place.
class Mutator {
public:
    explicit Mutator(const emit::Harness& harness)
        : source_(harness.artifact.text), tokens_(tokenize(source_)), entry_(harness.entry)
    {
        for (const emit::LineOrigin& origin : harness.artifact.origins)
            ranges_.emplace_back(origin.first, origin.last);
    }

    std::vector<Mutant> run()
    {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (starts_function(i)) function_ = tokens_[i + 1].text;
            if (function_ == entry_ || !is_mutable(tokens_[i].line)) continue;
            if (starts_function(i)) swap_inputs(i + 2);
            drop_pi(i);
            swap_ends(i);
            flip_sign(i);
            change_constant(i);
            remove_guard(i);
            swap_min_max(i);
            drop_square(i);
            invert_quotient(i);
        }
        return std::move(mutants_);
    }

private:
    bool is_mutable(int line) const
    {
        return std::ranges::any_of(ranges_, [line](const std::pair<int, int>& range) {
            return range.first <= line && line <= range.second;
        });
    }

    std::string_view text_at(std::size_t i) const
    {
        return i < tokens_.size() ? tokens_[i].text : std::string_view{};
    }
    bool is_name(std::size_t i) const
    {
        return i < tokens_.size() && tokens_[i].kind == Token::Kind::name;
    }
    bool is_call(std::size_t i, std::string_view callee) const
    {
        return text_at(i) == callee && text_at(i + 1) == "(";
    }
    bool ends_operand(std::size_t i) const
    {
        return i < tokens_.size() &&
               (tokens_[i].kind != Token::Kind::symbol || text_at(i) == ")" || text_at(i) == "]");
    }
    std::string_view text_of(const TokenRange& range) const
    {
        if (range.first == range.last) return {};
        const std::size_t begin = tokens_[range.first].begin;
        return source_.substr(begin, tokens_[range.last - 1].end - begin);
    }

    /// `float D_GGX(…) {` at i.
    bool starts_function(std::size_t i) const
    {
        if (!is_name(i) || !is_name(i + 1) || text_at(i + 2) != "(") return false;
        return text_at(closing(tokens_, i + 2) + 1) == "{";
    }

    /// Adds a mutant that replaces bytes [begin, end) as the edits say, in order of place.
    void add(Mutation mutation, std::size_t begin, std::size_t end, std::vector<Edit> edits,
             std::optional<std::pair<int, int>> swapped = std::nullopt)
    {
        std::ranges::sort(edits, {}, &Edit::begin);
        std::string after;
        std::size_t at = begin;
        for (const Edit& edit : edits) {
            after += source_.substr(at, edit.begin - at);
            after += edit.text;
            at = edit.end;
        }
        after += source_.substr(at, end - at);

        Mutant mutant;
        mutant.mutation = mutation;
        mutant.line =
            1 + static_cast<int>(std::count(
                    source_.begin(), source_.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
        mutant.function = function_;
        mutant.before = source_.substr(begin, end - begin);
        mutant.text = fmt::format("{}{}{}", source_.substr(0, begin), after, source_.substr(end));
        mutant.after = std::move(after);
        mutant.swapped = swapped;
        mutants_.push_back(std::move(mutant));
    }

    /// A mutant that replaces tokens [first, last).
    void replace(Mutation mutation, std::size_t first, std::size_t last, std::string text)
    {
        const std::size_t begin = tokens_[first].begin;
        const std::size_t end = tokens_[last - 1].end;
        add(mutation, begin, end, {{begin, end, std::move(text)}});
    }

    void swap_inputs(std::size_t open)
    {
        const auto parameters = arguments(tokens_, open);
        const auto type_of = [this](const TokenRange& range) {
            std::string type;
            for (std::size_t i = range.first; i + 1 < range.last; ++i) {
                type += tokens_[i].text;
                type += ' ';
            }
            return type;
        };
        const auto name_of = [this](const TokenRange& range) -> const Token& {
            return tokens_[range.last - 1];
        };
        const std::size_t end = closing(tokens_, open);
        for (std::size_t a = 0; a < parameters.size(); ++a)
            for (std::size_t b = a + 1; b < parameters.size(); ++b) {
                if (type_of(parameters[a]) != type_of(parameters[b])) continue;
                const Token& first = name_of(parameters[a]);
                const Token& second = name_of(parameters[b]);
                add(Mutation::swap_inputs, tokens_[open - 1].begin, tokens_[end].end,
                    {{first.begin, first.end, std::string{second.text}},
                     {second.begin, second.end, std::string{first.text}}},
                    std::pair{static_cast<int>(a), static_cast<int>(b)});
                // The whole list would hide what was done to it.
                mutants_.back().before = fmt::format("{}, {}", first.text, second.text);
                mutants_.back().after = fmt::format("{}, {}", second.text, first.text);
            }
    }

    void drop_pi(std::size_t i)
    {
        const Token& token = tokens_[i];
        const auto starts = [&token](std::string_view digits) {
            return token.text.substr(0, digits.size()) == digits;
        };
        const bool number =
            token.kind == Token::Kind::number &&
            (starts("3.14159") || starts("0.31830") || starts("6.28318") || starts("0.15915"));
        if (number || token.text == "PI" || token.text == "LOBE_PI")
            replace(Mutation::drop_pi, i, i + 1, "1.0");
    }

    void swap_ends(std::size_t i)
    {
        if (!is_call(i, "mix") && !is_call(i, "lerp")) return;
        const auto args = arguments(tokens_, i + 1);
        if (args.size() != 3 || text_of(args[0]) == text_of(args[1])) return;
        replace(Mutation::swap_ends, i, closing(tokens_, i + 1) + 1,
                fmt::format("{}({}, {}, {})", text_at(i), text_of(args[1]), text_of(args[0]),
                            text_of(args[2])));
    }

    void flip_sign(std::size_t i)
    {
        if (text_at(i) == "-") replace(Mutation::flip_sign, i, i + 1, "+");
        if (text_at(i) == "+" && i > 0 && ends_operand(i - 1))
            replace(Mutation::flip_sign, i, i + 1, "-");
    }

    void change_constant(std::size_t i)
    {
        const std::string_view text = tokens_[i].text;
        if (tokens_[i].kind != Token::Kind::number ||
            text.find_first_of(".e") == std::string_view::npos)
            return;
        double value = 0;
        const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
        if (read.ec != std::errc{} || value == 0) return;
        const std::string_view suffix{
            read.ptr, static_cast<std::size_t>(text.data() + text.size() - read.ptr)};
        replace(Mutation::change_constant, i, i + 1,
                fmt::format("{:.9g}{}", value * 1.0001, suffix));
    }

    void remove_guard(std::size_t i)
    {
        constexpr auto mutation = Mutation::remove_guard;
        const auto close = [&] { return closing(tokens_, i + 1) + 1; };
        if (is_call(i, "saturate") || is_call(i, "clamp")) {
            const auto args = arguments(tokens_, i + 1);
            if (!args.empty()) replace(mutation, i, close(), fmt::format("({})", text_of(args[0])));
        }
        if (is_call(i, "max") || is_call(i, "min")) {
            const auto args = arguments(tokens_, i + 1);
            if (args.size() != 2) return;
            // The guard is the literal; what it guards is the other argument.
            if (is_literal(args[1]))
                replace(mutation, i, close(), fmt::format("({})", text_of(args[0])));
            else if (is_literal(args[0]))
                replace(mutation, i, close(), fmt::format("({})", text_of(args[1])));
        }
        if (text_at(i) == "?") remove_choice(i);
        // The guarded helpers, whatever their prefix and style: the bare function in their place.
        if (is_name(i) && text_at(i + 1) == "(" && !starts_function(i - 1))
            for (const auto& [ending, bare] : guarded)
                if (text_at(i).ends_with(ending)) replace(mutation, i, i + 1, std::string{bare});
    }

    bool is_literal(const TokenRange& range) const
    {
        const std::size_t last = range.last - 1;
        return tokens_[last].kind == Token::Kind::number && last - range.first <= 1;
    }

    /// `c ? x : y` with the `?` at i becomes `c ? y : y`, and `c ? x : x`: the choice is gone, the
    /// condition stays so that nothing around it changes its meaning.
    void remove_choice(std::size_t question)
    {
        int depth = 0;
        std::size_t colon = tokens_.size(), end = tokens_.size();
        int nested = 0;
        for (std::size_t i = question + 1; i < tokens_.size(); ++i) {
            const std::string_view text = tokens_[i].text;
            if (text == "(" || text == "[") ++depth;
            if (text == ")" || text == "]") --depth;
            if (depth < 0 || (depth == 0 && (text == ";" || (text == "," && colon < i)))) {
                end = i;
                break;
            }
            if (depth != 0) continue;
            if (text == "?" && colon == tokens_.size()) ++nested;
            if (text == ":" && colon == tokens_.size() && nested-- == 0) colon = i;
        }
        if (colon == tokens_.size() || end == tokens_.size()) return;
        const TokenRange yes{question + 1, colon}, no{colon + 1, end};
        const auto arms = [&](std::string_view text) {
            replace(Mutation::remove_guard, question, end, fmt::format("? {} : {}", text, text));
        };
        arms(text_of(no));
        arms(text_of(yes));
    }

    void swap_min_max(std::size_t i)
    {
        if (is_call(i, "min")) replace(Mutation::swap_min_max, i, i + 1, "max");
        if (is_call(i, "max")) replace(Mutation::swap_min_max, i, i + 1, "min");
    }

    void drop_square(std::size_t i)
    {
        const bool square = is_name(i) && text_at(i + 1) == "*" && is_name(i + 2) &&
                            text_at(i) == text_at(i + 2) && text_at(i + 3) != "." &&
                            text_at(i + 3) != "(" && (i == 0 || text_at(i - 1) != ".");
        if (square) replace(Mutation::drop_square, i, i + 3, std::string{text_at(i)});
    }

    void invert_quotient(std::size_t i)
    {
        if (text_at(i) == "/") replace(Mutation::invert_quotient, i, i + 1, "*");
    }

    std::string_view source_;
    std::vector<Token> tokens_;
    std::string entry_;
    std::vector<std::pair<int, int>> ranges_;  ///< lines first .. last that may be changed
    std::string function_;
    std::vector<Mutant> mutants_;
};

}  // namespace

std::string_view name(Mutation mutation)
{
    return mutation_names[static_cast<std::size_t>(mutation)];
}

const std::vector<Mutation>& all_mutations()
{
    static const std::vector<Mutation> all = [] {
        std::vector<Mutation> list;
        for (std::size_t i = 0; i < mutation_names.size(); ++i)
            list.push_back(static_cast<Mutation>(i));
        return list;
    }();
    return all;
}

std::vector<Mutant> mutants(const emit::Harness& harness) { return Mutator{harness}.run(); }

}  // namespace lobe::analyze
