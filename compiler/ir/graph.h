// The intermediate representation: one pure expression graph per function.
//
// There are no statements, no memory and no control flow; a term of a BRDF is an expression
// over its inputs. Three invariants make every pass a single loop over `ids()`:
//
//   ordered   an expression's operands have smaller ids than the expression itself
//   shared    structurally equal expressions are the same expression (hash-consing)
//   typed     `type` is final at creation; nothing is inferred later
//
// Source spans live beside the nodes, not inside: they describe an expression, but are no
// part of what it is. The first span wins.
#pragma once

#include "base/hash_index.h"
#include "base/id.h"
#include "base/source.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::ir {

enum class Op : std::uint8_t {
#define LOBE_OP(name, arity, shape) name,
#include "ir/ops.def"
#undef LOBE_OP
};

enum class Shape : std::uint8_t {
    leaf,
    each,
    compare,
    logic,
    reduce,
    vector,
    list
};

int arity(Op op);
Shape shape(Op op);
std::string_view name(Op op);

/// What a value is made of. What it *means* (a color, a direction) is `Quantity`, in module.h.
enum class Type : std::uint8_t {
    boolean,
    scalar,
    vec2,
    vec3,
    vec4
};

/// Components of a type: 1 for booleans and scalars.
int components(Type type);
/// scalar, vec2, vec3, vec4 for 1..4.
Type vector_type(int components);
std::string_view name(Type type);

/// `a / b else c` is a / b where |b| is at least this, and c elsewhere: 2^-64, so that no quotient
/// of what is shipped comes near the end of float. In half it is that format's least normal number.
inline constexpr double least_divisor = 0x1p-64;

struct Expr;
struct Function;
using ExprId = Id<Expr>;
using FunctionId = Id<Function>;

/// One operation. Operands are a slice of the graph's operand list; read them through
/// `Graph::operands`.
struct Expr {
    Op op{};
    Type type{};
    std::uint32_t aux = 0;  ///< literal, input, component, call: see ops.def; else 0
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// A real number as it was written. `text` is canonical decimal (or "pi") and decides equality;
/// `value` is the nearest double.
struct Literal {
    std::string text;
    double value = 0;
    friend bool operator==(const Literal&, const Literal&) = default;
};

/// The sign of a literal's double minus the real number: 0 when the double is exact. Nothing
/// where the text is too long to tell without big numbers, and for pi.
std::optional<int> rounding_of(const Literal& literal);

/// The canonical text of a decimal literal: no leading or trailing zeros, "0.5", "1e-7".
std::string canonical_number(std::string_view text);

class Graph {
public:
    ExprId literal(std::string_view text, Span span = {});
    /// The literal whose value is exactly this double (finite); written with enough digits to
    /// be that double exactly.
    ExprId literal(double value, Span span = {});
    ExprId input(std::uint32_t index, Type type, Span span = {});
    /// An operation whose type follows from its operands (every shape but leaf and list).
    ExprId apply(Op op, std::span<const ExprId> operands, Span span = {});
    ExprId apply(Op op, std::initializer_list<ExprId> operands, Span span = {})
    {
        return apply(op, std::span{operands.begin(), operands.size()}, span);
    }
    ExprId component(ExprId vector, int index, Span span = {});
    ExprId construct(Type type, std::span<const ExprId> scalars, Span span = {});
    ExprId call(FunctionId callee, Type type, std::span<const ExprId> arguments, Span span = {});
    /// What the author calls an expression (`let x = ...`): a hint for who writes text, no part
    /// of what it is. The first name wins; `copy` keeps it.
    void set_name(ExprId id, std::string_view name);
    const std::string& name_of(ExprId id) const { return names_[id.index]; }
    /// A copy of an expression of another graph (or this one) over new operands: what every
    /// rewriting pass does with what it leaves alone. Inputs and calls keep their aux.
    ExprId copy(const Graph& from, ExprId id, std::span<const ExprId> operands);

    const Expr& operator[](ExprId id) const { return exprs_[id.index]; }
    std::span<const ExprId> operands(ExprId id) const
    {
        const Expr& expr = exprs_[id.index];
        return std::span{operands_}.subspan(expr.first, expr.count);
    }
    const Literal& literal_of(ExprId id) const { return literals_[exprs_[id.index].aux]; }
    const std::vector<Literal>& literals() const { return literals_; }
    const Span& span(ExprId id) const { return spans_[id.index]; }

    /// True for a literal with exactly this value.
    bool is_literal(ExprId id, double value) const;

    std::size_t size() const { return exprs_.size(); }

    /// All ids in topological order: a range for `for (const ExprId id : graph.ids())`.
    struct Ids {
        std::size_t size;
        struct Iterator {
            std::size_t index;
            ExprId operator*() const { return ExprId{index}; }
            Iterator& operator++()
            {
                ++index;
                return *this;
            }
            bool operator!=(const Iterator& other) const { return index != other.index; }
        };
        Iterator begin() const { return {0}; }
        Iterator end() const { return {size}; }
    };
    Ids ids() const { return {exprs_.size()}; }

private:
    ExprId intern(Op op, Type type, std::uint32_t aux, std::span<const ExprId> operands, Span span);
    std::optional<std::uint32_t> find_literal(std::string_view text) const;
    std::uint32_t intern_literal(std::string_view text, double value);

    std::vector<Expr> exprs_;
    std::vector<ExprId> operands_;
    std::vector<Span> spans_;
    std::vector<std::string> names_;
    std::vector<Literal> literals_;
    HashIndex literal_index_;  ///< of literals_, by text
    HashIndex shared_;         ///< of exprs_
};

/// The type of an operation over operands of these types. Asserts on a combination that the
/// checker must have refused.
Type result_type(Op op, std::span<const Type> operands);

/// How often each expression is an operand, counting `root` once; 0 means dead.
Facts<Expr, int> use_counts(const Graph& graph, ExprId root);

/// One line per expression, for tests and failure messages.
std::string dump(const Graph& graph);

}  // namespace lobe::ir
