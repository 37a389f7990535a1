// What was written: the tree of one source file, before any name or type is looked up.
//
// Expressions live in one arena and are named by ids; items hold ids. Every node has the span
// it was read from. Comments are kept beside the items they stand before, so that the canonical
// text (`format.h`) loses none of them.
#pragma once

#include "base/id.h"
#include "base/source.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lobe::syntax {

struct Expression;
using ExpressionId = Id<Expression>;

/// An identifier where it stands.
struct Identifier {
    std::string text;
    Span span;
};

// ---- expressions

/// A literal, kept as its decimal text: a literal is a real number, not the nearest double.
struct Number {
    std::string text;
};
struct Name {
    std::string text;
};
/// `base.member`: a field of a geometry or surface, or a component (.x .y .z .w .r .g .b).
struct Member {
    ExpressionId base;
    Identifier member;
};
enum class UnaryOperator {
    negate,
    logical_not
};
struct Unary {
    UnaryOperator op{};
    ExpressionId operand;
};
enum class BinaryOperator {
    add,
    subtract,
    multiply,
    divide,
    power,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
    logical_and,
    logical_or,
};
/// `a / b else c` keeps the limit `c` here; every other operator has none.
struct Binary {
    BinaryOperator op{};
    ExpressionId left;
    ExpressionId right;
    ExpressionId limit;  ///< invalid unless a division names its limit
    Span op_span;
};
struct Call {
    Identifier callee;
    std::vector<ExpressionId> arguments;
};
/// `if condition then a else b`
struct Conditional {
    ExpressionId condition;
    ExpressionId then_value;
    ExpressionId else_value;
};
/// What stands where parsing failed. Anything that uses it stays silent.
struct Poison {};

struct Expression {
    Span span;  ///< without enclosing parentheses
    std::variant<Number, Name, Member, Unary, Binary, Call, Conditional, Poison> node;
    bool parenthesized = false;  ///< written in parentheses; the formatter keeps what is needed
};

// ---- pieces of items

/// `in [low, high]`
struct RangeClause {
    ExpressionId low;
    ExpressionId high;
    Span span;
};

/// `float in [0, 2]`, `color`, `geometry`, ...
struct TypeClause {
    Identifier name;
    std::optional<RangeClause> range;
    Span span;
};

/// A `//` or `///` line, without the slashes and the one space after them.
struct Comment {
    std::string text;
    Span span;
    bool doc = false;
    bool blank_before = false;  ///< an empty line stands before it
};

/// `name: type` of a term or model.
struct ParameterClause {
    Identifier name;
    TypeClause type;
};

struct Let {
    Identifier name;
    ExpressionId value;
    std::vector<Comment> comments;  ///< lines that stand before it
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;  ///< `// …` on its last line
};

/// `= expression`, or `{ let … expression }`.
struct Body {
    std::vector<Let> lets;
    ExpressionId value;
    bool block = false;
    std::vector<Comment> value_comments;  ///< lines before the value, in a block
    Span span;
    bool value_blank_before = false;
    std::vector<Comment> trailing;  ///< `// …` on its last line
};

// ---- items

/// `import microfacet { D_GGX, V_SmithGGX }`
struct Import {
    Identifier module;
    std::vector<Identifier> names;
};
/// `source slides = "Jimenez et al. 2023, …"`
struct SourceItem {
    Identifier name;
    std::string text;
};
/// `tier base, advanced, full`: in this order.
struct TierItem {
    std::vector<Identifier> names;
};
/// `param name : type = default  tier  "Label"`
struct ParamItem {
    Identifier name;
    TypeClause type;
    std::vector<ExpressionId> default_value;  ///< one, or one per component in `(r, g, b)`
    Span default_span;
    std::optional<Identifier> tier;
    std::optional<std::string> label;
};
struct Form {
    Identifier name;
    Body body;
    std::vector<Comment> comments;
    Span span;
};
/// `term name(parameters) -> type = …` with its forms.
struct TermItem {
    Identifier name;
    std::vector<ParameterClause> parameters;
    std::optional<TypeClause> result;
    Body body;
    std::vector<Form> forms;
};
/// `effect "Name" off when condition`
struct EffectItem {
    std::string name;
    Span name_span;
    ExpressionId off_when;
};
struct Output {
    Identifier name;
    ExpressionId value;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `model name(parameters) { let …  output = … }`
struct ModelItem {
    Identifier name;
    std::vector<ParameterClause> parameters;
    std::vector<Let> lets;
    std::vector<Output> outputs;
};
/// `packing … { … }` and `engine … { … }`: recognized, balanced, and refused by this edition.
struct ReservedItem {
    Identifier keyword;
};

struct Item {
    std::vector<Comment> comments;  ///< the lines before it, docs among them
    int blank_lines_before = 0;     ///< between it and what stands before it, a comment too: 0, 1
    std::vector<Comment> trailing;  ///< `// …` on its last line; a term's are in its bodies
    std::variant<Import, SourceItem, TierItem, ParamItem, TermItem, EffectItem, ModelItem,
                 ReservedItem>
        node;
    Span span;
};

struct Tree {
    std::uint32_t source = 0;     ///< index into Sources
    std::vector<Comment> header;  ///< comments before `module`
    std::optional<Identifier> module;
    bool module_blank_before = false;  ///< an empty line between the header and `module`
    std::vector<Item> items;
    std::vector<Comment> footer;  ///< comments after the last item
    std::vector<Expression> expressions;

    const Expression& operator[](ExpressionId id) const { return expressions[id.index]; }
};

/// The `///` lines among comments, joined by newlines.
std::string doc_text(const std::vector<Comment>& comments);

}  // namespace lobe::syntax
