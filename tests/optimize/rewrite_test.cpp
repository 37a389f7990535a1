// Calls follow their callee's inputs, and the order of inputs is the canonical one.
#include "build.h"
#include "optimize/rewrite.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::ir;
using namespace lobe::tests;
using optimize::Rebuild;

namespace {

std::vector<std::string> input_names(const Function& function)
{
    std::vector<std::string> names;
    for (const Input& input : function.inputs) names.push_back(input.name);
    return names;
}

Module unchanged(const Module& module)
{
    return optimize::rewrite(module, [](Rebuild& rebuild) -> optimize::Step {
        return [&rebuild](ExprId id) { return rebuild.copy(id); };
    });
}

/// callee(x, cos_h, y) = cos_h * y, called by a root with x and y of its own.
Module caller_and_callee()
{
    Module module = empty_module();
    Term callee{"callee"};
    callee.argument("x");
    const ExprId cos_h = callee.field(GeometryField::cos_h);
    const ExprId y = callee.argument("y");
    const FunctionId id = callee.in(module, callee.multiply(cos_h, y));

    Term caller{"caller"};
    const ExprId a = caller.argument("a");
    const ExprId h = caller.field(GeometryField::cos_h);
    const ExprId d = caller.field(GeometryField::cos_d);
    const FunctionId root = caller.in(module, caller.add(caller.call(module, id, {a, h, d}), d));
    set_roots(module, {root});
    return module;
}

}  // namespace

TEST_CASE("an input that nothing reads goes, and the caller stops passing it")
{
    const Module before = caller_and_callee();
    REQUIRE_FALSE(verify(before));
    const Module after = unchanged(before);
    CHECK_FALSE(verify(after));
    CHECK(input_names(after.functions[0]) == std::vector<std::string>{"cos_h", "y"});
    // `a` is read by nothing now, but it is a root's own argument.
    CHECK(input_names(after.functions[1]) == std::vector<std::string>{"a", "cos_h", "cos_d"});
    CHECK(optimize::same_graphs(after, unchanged(after)));
}

TEST_CASE("a field that a callee gains is handed on by its callers, in the order of fields")
{
    const Module before = caller_and_callee();
    const Module after = optimize::rewrite(before, [](Rebuild& rebuild) -> optimize::Step {
        return [&rebuild](ExprId id) {
            const Graph& old = rebuild.old().graph;
            const bool is_cos_h = rebuild.id() == FunctionId{0} && old[id].op == Op::input &&
                                  rebuild.old().inputs[old[id].aux].origin == Origin::geometry;
            if (!is_cos_h) return rebuild.copy(id);
            const ExprId v_dot_l = rebuild.input(GeometryField::v_dot_l);
            const ExprId cos_i = rebuild.input(GeometryField::cos_i);
            const ExprId both = rebuild.graph.apply(Op::multiply, {v_dot_l, cos_i});
            return rebuild.graph.apply(Op::multiply, {rebuild.copy(id), both});
        };
    });
    CHECK_FALSE(verify(after));
    CHECK(input_names(after.functions[0]) ==
          std::vector<std::string>{"cos_i", "cos_h", "v_dot_l", "y"});
    CHECK(input_names(after.functions[1]) ==
          std::vector<std::string>{"a", "cos_i", "cos_h", "cos_d", "v_dot_l"});
}

TEST_CASE("an argument's complement follows it and callers make it")
{
    const Module before = caller_and_callee();
    const Module after = optimize::rewrite(before, [](Rebuild& rebuild) -> optimize::Step {
        return [&rebuild](ExprId id) {
            const Graph& old = rebuild.old().graph;
            const bool is_y = rebuild.id() == FunctionId{0} && old[id].op == Op::input &&
                              rebuild.old().inputs[old[id].aux].name == "y";
            if (!is_y) return rebuild.copy(id);
            return rebuild.graph.apply(Op::subtract,
                                       {rebuild.graph.literal("1"), rebuild.complement_input(2)});
        };
    });
    CHECK_FALSE(verify(after));
    CHECK(input_names(after.functions[0]) == std::vector<std::string>{"cos_h", "one_minus_y"});
    // By default a caller subtracts.
    const Graph& graph = after.functions[1].graph;
    for (const ExprId id : graph.ids())
        if (graph[id].op == Op::call) CHECK(graph[graph.operands(id)[1]].op == Op::subtract);
}

TEST_CASE("the name of a let survives, also on what replaces the expression")
{
    Term term{"named"};
    const ExprId x = term.argument("x");
    const ExprId half = term.multiply(x, term.number("0.5"));
    term.function.graph.set_name(half, "half_of_x");
    const Module module = only(term, term.add(half, x));
    const Module after = optimize::rewrite(module, [](Rebuild& rebuild) -> optimize::Step {
        return [&rebuild](ExprId id) {
            const ExprId copy = rebuild.copy(id);
            if (rebuild.old().graph[id].op != Op::multiply) return copy;
            return rebuild.graph.apply(Op::divide,
                                       {rebuild.moved_operands(id)[0], rebuild.graph.literal("2")});
        };
    });
    const Graph& graph = after.functions[0].graph;
    CHECK(graph.name_of(graph.operands(after.functions[0].result)[0]) == "half_of_x");
}
