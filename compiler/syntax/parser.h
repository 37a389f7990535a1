// The parser's state and rules; inside `syntax` only. Recursive descent with one rule per line
// of docs/grammar.md: items in parse_items.cpp and what they are made of in parse_bodies.cpp,
// blocks of lines in parse_lines.cpp, parse_gbuffer.cpp and parse_packing.cpp, expressions in
// parse_expressions.cpp.
//
// How errors travel: the first one in a declaration sets `failed_`, and from then on `current`
// is the end of the text, so every rule runs out of input and returns what it has without
// another word. The rule for the declaration then calls `recover`, which skips to the next one.
#pragma once

#include "base/diagnostic.h"
#include "syntax/lex.h"
#include "syntax/tree.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::syntax {

/// The words that the lines of a block start with.
struct LineWords {
    std::vector<std::string> own;
    std::vector<std::string> outer;  ///< of the blocks around it: there, this one is not closed
    std::string_view expected;       ///< what a message says can stand here
    bool fields = false;             ///< lines may also start with `target.channel`
};

class Parser {
public:
    Parser(const Source& source, std::uint32_t index, Diagnostics& diagnostics);

    Tree run();

private:
    // ---- errors (parse.cpp)
    void report(Diagnostic diagnostic);
    void report_problems(std::uint32_t before);
    void fail(Diagnostic diagnostic);
    void fail_expected(std::string_view what, std::string help = {});
    void report_mended(std::string message, const Span& span, std::string replacement);
    /// After which the file is given up.
    static constexpr int most_errors = 20;

    // ---- tokens (parse.cpp)
    const Token& current() const;
    const Token& previous() const { return tokens_.all[position_ == 0 ? 0 : position_ - 1]; }
    const Token& ahead(std::size_t distance) const;
    Token advance();
    bool at(TokenKind kind) const { return current().kind == kind; }
    bool at_word(std::string_view word) const;
    bool at_item() const { return !failed_ && starts_item(position_); }
    bool starts_item(std::size_t position) const;
    bool at_likely_item() const;  ///< looks like an item with a misspelt keyword
    bool accept(TokenKind kind);
    bool expect(TokenKind kind, std::string_view what);
    bool expect_word(std::string_view word, std::string_view what);
    void expect_closing(TokenKind kind, const Token& open, std::string_view what);
    void fail_unclosed(const Token& open, std::string_view what);
    Identifier expect_identifier(std::string_view what);
    std::string_view text(const Token& token) const;
    std::string words(const Token& token) const;
    Span span(const Token& token) const { return {index_, token.begin, token.end}; }
    Span span_from(std::uint32_t begin) const;

    // ---- recovery (parse.cpp)
    void recover();
    void recover_in_block(bool outputs);

    // ---- comments (parse.cpp)
    std::vector<Comment> take_comments();
    void take_interior(std::vector<Comment>& into);
    std::vector<Comment> take_trailing();
    void report_dangling(const Comment& comment,
                         std::string label = "no declaration follows on the next line");

    // ---- items (parse_items.cpp)
    void parse_module();
    void parse_item();
    using ItemNode = decltype(Item::node);
    std::optional<ItemNode> parse_item_node(std::string_view keyword, Item& item);
    Import parse_import();
    SourceItem parse_source();
    TierItem parse_tier();
    ParamItem parse_param();
    void parse_default(ParamItem& param);
    TermItem parse_term(Item& item);
    Form parse_form();
    EffectItem parse_effect();
    ModelItem parse_model(Item& item, bool is_light);
    GbufferItem parse_gbuffer(Item& item);
    CodeItem parse_code(Item& item);
    PackingItem parse_packing(Item& item);
    EngineItem parse_engine(Item& item);
    std::vector<ParameterClause> parse_parameters();
    TypeClause parse_type();
    RangeClause parse_range();
    Body parse_body();
    void parse_block(Body& body);
    Let parse_let();
    Output parse_output();
    std::string parse_string(std::string_view what);

    // ---- blocks of lines (parse_lines.cpp)
    /// Where a line starts, and what stands before it.
    struct LineStart {
        std::size_t position = 0;
        std::vector<Comment> comments;
        bool blank_before = false;
        std::uint32_t begin = 0;
    };
    bool at_line(const LineWords& words) const;
    bool at_outer_line(const LineWords& words) const;
    bool at_block_line() const;
    bool starts_line(const LineWords& words) const;
    LineStart open_line(const LineWords& words);
    std::string line_word(const LineWords& words);
    std::string expect_one_of(const std::vector<std::string>& words, std::string_view what);
    bool at_near_word(std::string_view word) const;
    void refuse_docs(const LineStart& start);
    void recover_line(const LineWords& words, const LineStart& start);
    void close_block(const Token& open, const LineWords& words, std::vector<Comment>& last);
    void report_misplaced(const Span& span, std::string message, Label earlier);
    /// The end of a line: its comments, its place.
    template <class Line>
    void close_line(Line& line, LineStart start)
    {
        take_interior(start.comments);
        line.comments = std::move(start.comments);
        line.blank_before = start.blank_before;
        line.trailing = take_trailing();
        line.span = span_from(start.begin);
    }
    int parse_whole(std::string_view what);
    std::vector<Identifier> parse_names(std::string_view what);
    StorageClause parse_storage();

    // ---- lines of a gbuffer (parse_gbuffer.cpp)
    SettingItem parse_setting(LineStart start);
    TargetClause parse_target(LineStart start);
    ChannelClause parse_channel(LineStart start);
    FactClause parse_fact(const std::string& word, LineStart start);
    PinClause parse_pin(LineStart start);
    ExpressionId parse_condition();

    // ---- lines of a packing and of an engine (parse_packing.cpp)
    void parse_code_lines(CodeItem& code, Item& item);
    FieldClause parse_field(LineStart start);
    SlotClause parse_slot();
    CodeClause parse_code_clause();
    bool at_code_clause() const;
    PackingClause parse_clause(const std::string& word, LineStart start);
    void parse_requirement(PackingClause& clause);
    EngineClause parse_engine_line(const std::string& word, LineStart start);
    void parse_node_inputs(EngineClause& node, const LineStart& start);
    void parse_color(EngineClause& color);

    // ---- expressions (parse_expressions.cpp)
    ExpressionId parse_expression();
    ExpressionId parse_sum();          ///< what may stand behind `==` without parentheses
    ExpressionId parse_before_else();  ///< an expression whose `else` is not a division's
    void refuse_assign();
    ExpressionId parse_conditional();
    ExpressionId parse_operators(int level);
    ExpressionId parse_not();
    ExpressionId parse_unary();
    ExpressionId parse_power();
    ExpressionId parse_exponent();
    ExpressionId parse_postfix();
    ExpressionId parse_primary();
    ExpressionId parse_parenthesized();
    ExpressionId parse_call();
    bool at_indexed_sum() const;
    ExpressionId parse_indexed_sum();
    ExpressionId parse_limit();
    void refuse_limit(ExpressionId of);
    void refuse_chain(ExpressionId left, ExpressionId right, const Token& second);

    template <class Node>
    ExpressionId add(Node node, const Span& span, std::size_t height);
    ExpressionId poison();
    bool too_high(std::size_t height);
    std::size_t height(ExpressionId id) const { return id.valid() ? heights_[id.index] : 0; }
    const Span& outer(ExpressionId id) const { return outer_[id.index]; }

    /// How deep rules may recurse. A level costs about ten frames of the stack.
    static constexpr int most_nested = 256;
    /// How high the tree of an expression may grow: chains like `a + b + c + …` lean to the left,
    /// one level per operator, without recursion here but with recursion in whoever reads them.
    static constexpr std::size_t most_height = 1024;

    /// Counts the depth of recursion; `false` when it is too deep, and then it was reported.
    class Nesting {
    public:
        explicit Nesting(Parser& parser);
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;
        ~Nesting() { --parser_.depth_; }
        explicit operator bool() const { return !parser_.failed_; }

    private:
        Parser& parser_;
    };

    const Source& source_;
    std::uint32_t index_;
    Diagnostics& diagnostics_;
    Tokens tokens_;
    Token stop_;  ///< what `current` is after a failure
    std::size_t position_ = 0;
    std::size_t next_comment_ = 0;
    std::size_t next_problem_ = 0;
    int errors_ = 0;
    int depth_ = 0;
    bool failed_ = false;
    bool in_then_ = false;              ///< an `else` here belongs to an `if`
    const LineWords* block_ = nullptr;  ///< of the block being read
    std::optional<Span> first_not_import_;
    Tree tree_;
    std::vector<std::uint16_t> heights_;  ///< of the tree below each expression
    std::vector<Span> outer_;             ///< of each expression, with its parentheses
};

}  // namespace lobe::syntax
