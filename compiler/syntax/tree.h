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

/// A `//` or `///` line, without the slashes and the one space after them.
struct Comment {
    std::string text;
    Span span;
    bool doc = false;
    bool blank_before = false;  ///< an empty line stands before it
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
/// `sum i in first .. last { let … value }`: the values for every whole number from first to last,
/// added up.
struct Sum {
    Identifier index;
    ExpressionId first;
    ExpressionId last;
    Body body;  ///< a block
};
/// What stands where parsing failed. Anything that uses it stays silent.
struct Poison {};

struct Expression {
    Span span;  ///< without enclosing parentheses
    std::variant<Number, Name, Member, Unary, Binary, Call, Conditional, Sum, Poison> node;
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

/// `name: type` of a term, model or light.
struct ParameterClause {
    Identifier name;
    TypeClause type;
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
/// `model name(parameters) { let …  output = … }`, or `light …` of the same shape
struct ModelItem {
    bool is_light = false;
    Identifier name;
    std::vector<ParameterClause> parameters;
    std::vector<Let> lets;
    std::vector<Output> outputs;
};
// ---- what an engine's GBuffer is: items of a `gbuffer` block

/// `setting static_lighting "r.AllowStaticLighting" : off, on = on`: the values in their order,
/// and the one that the engine has by itself.
struct SettingItem {
    Identifier name;
    std::string label;
    std::vector<Identifier> values;
    Identifier default_value;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `unorm 8`, `float 16`
struct StorageClause {
    Identifier kind;
    int bits = 0;
    Span span;
};
/// One line inside a target or channel, by its first word:
///
///   format   storage [when condition]          how it is stored; the first that holds counts
///   exists   when condition [else number]      elsewhere a shader reads the number (default 0)
///   field    text                              where the engine's shaders have it
///   holds    name text [lent] [when condition] the engine's own content
///   also     text [when condition]             who else reads whatever is stored
///   changes  text [when condition]             who alters it between writing and reading
struct FactClause {
    enum class Kind {
        format,
        exists,
        field,
        holds,
        also,
        changes
    };
    Kind kind{};
    std::optional<StorageClause> storage;  ///< format
    Identifier name;                       ///< holds
    std::string text;                      ///< field, holds, also, changes
    bool lent = false;                     ///< holds
    ExpressionId condition;                ///< invalid where there is no `when`
    ExpressionId otherwise;                ///< exists: invalid where there is no `else`
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `channel a "Anisotropy" { … }`; without facts the braces may be left out.
struct ChannelClause {
    Identifier name;
    std::string label;
    std::vector<FactClause> facts;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `target d "GBufferD" { format … exists … channel … }`: its facts hold for every channel that
/// says nothing else.
struct TargetClause {
    Identifier name;
    std::string label;
    std::vector<FactClause> facts;
    std::vector<ChannelClause> channels;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `pin opacity "Opacity" in [0, 1] = 1`: an input of the engine's material, the range it is
/// clamped to (none: it is not), and what it is when nothing is connected.
struct PinClause {
    Identifier name;
    std::string label;
    std::optional<RangeClause> range;
    ExpressionId default_value;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `gbuffer name { settings, targets, pins }`, in this order.
struct GbufferItem {
    Identifier name;
    std::vector<SettingItem> settings;
    std::vector<TargetClause> targets;
    std::vector<PinClause> pins;
};

// ---- how parameters are stored

/// `code name(x: type) { encode = expression  decode(u) = expression }`
struct CodeItem {
    Identifier name;
    ParameterClause value;
    ExpressionId encode;
    Identifier stored;  ///< the name that `decode` gives to what was stored
    ExpressionId decode;
    std::vector<Comment> encode_comments;
    std::vector<Comment> encode_trailing;
    std::vector<Comment> decode_comments;
    std::vector<Comment> decode_trailing;
};

/// `d.r`, `d.b[4..7]`, or `d.rgb`, which is three whole channels
struct SlotClause {
    Identifier target;
    Identifier channels;
    std::optional<int> low;  ///< bits low .. high of the channel, 0 the least; none: all of them
    std::optional<int> high;
    Span span;
};
/// `code power(8, 127/255)`
struct CodeClause {
    Identifier name;
    std::vector<ExpressionId> arguments;
    Span span;
};
/// `d.r, d.g[0..3] = diffuse_fresnel : unorm 12 in [0, 128] code linear`: the first slot holds
/// the most significant bits.
struct FieldClause {
    std::vector<SlotClause> slots;
    Identifier parameter;
    std::optional<Identifier> component;  ///< `.r` of a color
    StorageClause storage;                ///< bits of one component
    std::optional<RangeClause> range;
    std::optional<CodeClause> code;
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// A line of a packing that is no field:
///
///   require exact name == value, …       these values survive, bit for bit
///   require radiance error < 2%          of the whole packing, at worst
///   supports setting == value, …         what has to work; a setting not named: all its values
///   over name in [low, high]             surface or parameter range that errors are measured over
///   without name, …                      the engine's contents that the model gives up
struct PackingClause {
    enum class Kind {
        exact,
        radiance,
        supports,
        over,
        without
    };
    struct Exact {
        Identifier parameter;
        ExpressionId value;
    };
    Kind kind{};
    std::vector<Exact> exact;
    ExpressionId limit;                ///< radiance: the number before `%`
    Identifier name;                   ///< supports: the setting; over: what is limited
    std::vector<Identifier> names;     ///< supports: the values; without: the contents
    std::optional<RangeClause> range;  ///< over
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `packing model on gbuffer { fields and clauses, in any order }`
struct PackingItem {
    Identifier model;
    Identifier gbuffer;
    std::vector<std::variant<FieldClause, PackingClause>> lines;
};

// ---- what the engine's material editor offers

/// A line of an `engine` block:
///
///   shading_model text            what the editor calls it; identifiers are made of it
///   pin name = parameter [text]   a pin of the gbuffer's engine feeds a parameter
///   node text { name, … }         a node of its own with an input for each of these
///   color (r, g, b)               in the engine's view of shading models
struct EngineClause {
    enum class Kind {
        shading_model,
        pin,
        node,
        color
    };
    Kind kind{};
    Identifier name;                  ///< pin
    Identifier parameter;             ///< pin
    std::optional<std::string> text;  ///< shading_model, pin (label), node (its name)
    std::vector<Identifier> names;    ///< node
    std::vector<ExpressionId> color;  ///< three
    std::vector<Comment> comments;
    Span span;
    bool blank_before = false;
    std::vector<Comment> trailing;
};
/// `engine gbuffer for model { … }`
struct EngineItem {
    Identifier gbuffer;
    Identifier model;
    std::vector<EngineClause> lines;
};

struct Item {
    std::vector<Comment> comments;  ///< the lines before it, docs among them
    int blank_lines_before = 0;     ///< between it and what stands before it, a comment too: 0, 1
    std::vector<Comment> trailing;  ///< `// …` on its last line; a term's are in its bodies
    std::variant<Import, SourceItem, TierItem, ParamItem, TermItem, EffectItem, ModelItem,
                 GbufferItem, CodeItem, PackingItem, EngineItem>
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
