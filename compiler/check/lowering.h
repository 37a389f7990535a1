// From the expressions of one body to the graph of one function.
//
// `Lowering` is split by what is lowered: names and choices in lowering.cpp, members in
// members.cpp, operators in operators.cpp, calls in calls.cpp, sums in sums.cpp. Every operation is
// typed here, in the words of the author; what must be true of its operands is noted in the draft
// and proved later.
#pragma once

#include "check/builtins.h"
#include "check/draft.h"
#include "check/traverse.h"

#include <unordered_map>

namespace lobe::check {

/// What an expression became. A value that is not `good` was reported, or uses one that was.
struct Value {
    bool good = false;
    ValueType type;
    ir::ExprId expr;  ///< not for structures
};

class Lowering {
public:
    Lowering(Program& program, std::size_t file, const Sources& sources, Draft& draft,
             Diagnostics& diagnostics);

    void add_arguments(const Signature& signature);
    /// Lowers the lets in order; each may use those before it.
    void add_lets(const std::vector<syntax::Let>& lets);
    /// Warns of lets that nothing used.
    void report_unused_lets();

    Value lower(syntax::ExpressionId root);
    /// From now on reports go elsewhere.
    void report_to(Diagnostics& diagnostics) { diagnostics_ = &diagnostics; }

    /// The value in a place that asks for a type; a number spreads over a color. Reports a value
    /// that does not fit as `what` of the place, with `declared` as the place that asks.
    Value convert(Value value, const ValueType& to, const Span& span, std::string_view what,
                  const std::optional<Label>& declared);

    /// What each local that was used means; for callers that lower several values over the same
    /// lets.
    struct Local {
        Value value;
        Span span;
        bool is_let = false;
        bool used = false;
    };
    const std::map<std::string, Local, std::less<>>& locals() const { return locals_; }

private:
    using Binary = syntax::Binary;
    using Call = syntax::Call;

    const syntax::Expression& at(syntax::ExpressionId id) const { return file_.tree[id]; }
    const Value& value(syntax::ExpressionId id) const { return values_.at(id.index); }
    ir::Graph& graph() { return draft_.function.graph; }
    Span span_of(syntax::ExpressionId id) const { return at(id).span; }
    std::string text_of(syntax::ExpressionId id) const;
    Value good(const ValueType& type, ir::ExprId expr) { return {true, type, expr}; }

    // lowering.cpp
    bool enter_local(const syntax::Identifier& name, const Local& local, std::string_view what);
    Value lower_node(const syntax::Expression& expression);
    Value lower_name(const syntax::Name& name, const Span& span);
    Value lower_declared(const std::string& name, Declared& declared, const Span& span);
    void report_unknown_name(const std::string& name, const Span& span);
    Value lower_conditional(const syntax::Conditional& conditional, const Span& span);
    std::vector<Fact> facts() const;
    void collect_facts(syntax::ExpressionId condition, bool holds, std::vector<Fact>& result) const;

    // sums.cpp
    struct Around;
    Value lower_sum(const syntax::Sum& sum, const Span& span);
    std::optional<double> sum_end(syntax::ExpressionId end);
    Value lower_term(const syntax::Sum& sum, double index);
    Value add_term(const Value& total, const Value& term, const Span& span);
    void report_unused_in(const syntax::Sum& sum);

    // members.cpp
    std::optional<Fix> field_fix(std::string_view name, const Span& span,
                                 std::vector<std::string>& helps) const;
    Value lower_member(const syntax::Member& member, const Span& span);
    Value unknown_member(const syntax::Member& member, const ValueType& type,
                         const std::vector<std::string>& known);

    // operators.cpp
    Value lower_unary(const syntax::Unary& unary, const Span& span);
    Value lower_binary(const Binary& binary, const Span& span);
    Value lower_comparison(const Binary& binary, const Span& span);
    Value lower_logic(const Binary& binary, const Span& span);
    Value lower_division(const Binary& binary, const ValueType& type, const Span& span);
    Value lower_power(syntax::ExpressionId base, syntax::ExpressionId exponent, const Span& span);
    std::optional<ValueType> join_operands(const std::vector<syntax::ExpressionId>& operands,
                                           std::string_view what, const Span& at);
    /// The literal that an expression is, if it is a whole number.
    std::optional<double> whole_literal(ir::ExprId expr);

    // calls.cpp
    Value lower_call(const Call& call, const Span& span);
    Value lower_builtin(const Builtin& builtin, const Call& call, const Span& span);
    Value lower_each(const Builtin& builtin, const Call& call, const Span& span);
    Value lower_vector_function(const Builtin& builtin, const Call& call, const Span& span);
    Value lower_construct(const Builtin& builtin, const Call& call, const Span& span);
    Value lower_term_call(const Callable& callable, const Call& call, const Span& span);
    bool check_count(std::size_t given, std::size_t wanted, const Call& call, const Span& span,
                     std::string_view signature, const std::optional<Label>& declared);
    void report_unknown_callee(const Call& call);
    Value report_operand(syntax::ExpressionId operand, std::string message);
    void oblige(Obligation obligation);

    Program& program_;
    File& file_;
    const Sources& sources_;
    Draft& draft_;
    Diagnostics* diagnostics_;
    std::map<std::string, Local, std::less<>> locals_;
    std::unordered_map<std::uint32_t, Value> values_;  ///< of the expression being lowered
    Walk walk_;                                        ///< of the expression being lowered
    std::size_t guard_ = 0;                            ///< of the node being lowered

    // Inside a sum: what is known of the place that it stands at, and of the term.
    std::vector<Fact> given_;
    bool in_choice_ = false;
    std::string term_;          ///< `i = 3, j = 0`
    std::size_t unrolled_ = 0;  ///< expressions lowered in sums so far
};

/// `falloff_scale(x: unit)`, for notes.
std::string describe_signature(const Callable& callable, const Sources& sources);

}  // namespace lobe::check
