// Mutants are the text that was asked for, changed in one place and nowhere else.
#include "analyze/agreement/mutation.h"
#include "analyze/agreement/symmetry.h"
#include "analyze/agreement/tokens.h"
#include "analyze/models.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace lobe;
using analyze::Mutation;

namespace {

/// A harness around one line of a body; only that function may be changed.
emit::Harness harness(const std::string& body, const std::string& parameters = "float a, float b")
{
    emit::Harness out;
    out.artifact.text = "// a * a is no square here\n#define HALF 0.5\nfloat f(" + parameters +
                        ")\n{\n    " + body + "\n}\n\nvoid main()\n{\n    x = 1.5 * f(y, z);\n}\n";
    out.artifact.origins = {{1, 11, {}}};
    return out;
}

std::vector<std::string> changes(const std::string& body, Mutation mutation)
{
    std::vector<std::string> out;
    for (const analyze::Mutant& mutant : analyze::mutants(harness(body)))
        if (mutant.mutation == mutation) out.push_back(mutant.before + " -> " + mutant.after);
    return out;
}

using Changes = std::vector<std::string>;

}  // namespace

TEST_CASE("tokens leave out comments, space and preprocessor lines", "[tokens]")
{
    const auto tokens = analyze::tokenize("#version 450\nfloat x = -1.5e-3f; // y\n/* z\n */ a<=b");
    std::vector<std::string> texts;
    for (const analyze::Token& token : tokens) texts.emplace_back(token.text);
    CHECK(texts ==
          std::vector<std::string>{"float", "x", "=", "-", "1.5e-3f", ";", "a", "<=", "b"});
    CHECK(tokens.front().line == 2);
    CHECK(tokens.back().line == 4);
}

TEST_CASE("arguments are split at their own commas only", "[tokens]")
{
    const auto tokens = analyze::tokenize("f(a, g(b, c), (d))");
    const auto args = analyze::arguments(tokens, 1);
    REQUIRE(args.size() == 3);
    CHECK(tokens[args[1].first].text == "g");
    CHECK(args[1].last - args[1].first == 6);
    CHECK(analyze::arguments(analyze::tokenize("f()"), 1).empty());
}

TEST_CASE("each mutation changes what its name says", "[mutation]")
{
    CHECK(changes("return a / 3.1415927;", Mutation::drop_pi) == Changes{"3.1415927 -> 1.0"});
    CHECK(changes("return a / PI;", Mutation::drop_pi) == Changes{"PI -> 1.0"});
    CHECK(changes("return mix(a, 1.0, b * a);", Mutation::swap_ends) ==
          Changes{"mix(a, 1.0, b * a) -> mix(1.0, a, b * a)"});
    CHECK(changes("return lerp(a, a, b);", Mutation::swap_ends).empty());
    CHECK(changes("return a - b + 1.0;", Mutation::flip_sign) == Changes{"- -> +", "+ -> -"});
    CHECK(changes("return a * 2.0f;", Mutation::change_constant) == Changes{"2.0f -> 2.0002f"});
    CHECK(changes("return a * 0.0 + float(2);", Mutation::change_constant).empty());
    CHECK(changes("return saturate(a * b);", Mutation::remove_guard) ==
          Changes{"saturate(a * b) -> (a * b)"});
    CHECK(changes("return max(a, 0.0);", Mutation::remove_guard) == Changes{"max(a, 0.0) -> (a)"});
    CHECK(changes("return max(a, b);", Mutation::remove_guard).empty());
    CHECK(changes("return clamp(a, 0.0, 1.0);", Mutation::remove_guard) ==
          Changes{"clamp(a, 0.0, 1.0) -> (a)"});
    CHECK(changes("return b == 0.0 ? a : a / b;", Mutation::remove_guard) ==
          Changes{"? a : a / b -> ? a / b : a / b", "? a : a / b -> ? a : a"});
    CHECK(changes("return guarded_power(a, b);", Mutation::remove_guard) ==
          Changes{"guarded_power -> pow"});
    CHECK(changes("return Callisto_GuardedSmoothstep(a, b, a);", Mutation::remove_guard) ==
          Changes{"Callisto_GuardedSmoothstep -> smoothstep"});
    CHECK(changes("return min(a, b);", Mutation::swap_min_max) == Changes{"min -> max"});
    CHECK(changes("return a * a * b;", Mutation::drop_square) == Changes{"a * a -> a"});
    CHECK(changes("return a * b;", Mutation::drop_square).empty());
    CHECK(changes("return a / b;", Mutation::invert_quotient) == Changes{"/ -> *"});
}

TEST_CASE("parameters of one type trade places, and callers keep their order", "[mutation]")
{
    std::vector<analyze::Mutant> swaps;
    for (analyze::Mutant& mutant : analyze::mutants(harness("return a / b;")))
        if (mutant.mutation == Mutation::swap_inputs) swaps.push_back(std::move(mutant));
    REQUIRE(swaps.size() == 1);
    CHECK(swaps[0].before == "a, b");
    CHECK(swaps[0].after == "b, a");
    CHECK(swaps[0].text.find("float f(float b, float a)\n{") != std::string::npos);
    CHECK(swaps[0].swapped == std::pair{0, 1});
    CHECK(swaps[0].function == "f");
    CHECK(swaps[0].text.find("f(y, z)") != std::string::npos);

    const auto mixed = analyze::mutants(harness("return b;", "vec3 a, float b"));
    CHECK(std::ranges::none_of(mixed, [](const analyze::Mutant& mutant) {
        return mutant.mutation == Mutation::swap_inputs;
    }));
}

TEST_CASE("only lines that stem from a model are changed, and never the entry point", "[mutation]")
{
    emit::Harness whole = harness("return a * 0.25;");
    for (const analyze::Mutant& mutant : analyze::mutants(whole)) {
        CHECK(mutant.line >= 3);
        CHECK(mutant.line <= 5);
        CHECK(mutant.text != whole.artifact.text);
        CHECK(mutant.text.find("1.5 * f(y, z)") != std::string::npos);
    }
    whole.artifact.origins = {{100, 200, {}}};
    CHECK(analyze::mutants(whole).empty());
}

TEST_CASE("symmetry in two inputs is proved, and never claimed where it is not", "[symmetry]")
{
    ir::Module module;
    module.functions.push_back(tests::smith());
    const ir::FunctionId smith{0};
    CHECK(analyze::is_symmetric(module, smith, 1, 2));
    CHECK_FALSE(analyze::is_symmetric(module, smith, 0, 1));
    CHECK(analyze::is_symmetric(module, smith, 2, 2));

    // Through a call, and with the factors grouped in another way: smith(a2, x, y) x (2 y).
    tests::FunctionBuilder f{"lit"};
    const auto a2 = f.argument("a2", 0x1p-20, 1);
    const auto x = f.argument("x", 0x1p-10, 1);
    const auto y = f.argument("y", 0x1p-10, 1);
    const ir::ExprId operands[] = {a2, x, y};
    const auto visibility = f.function.graph.call(smith, ir::Type::scalar, operands);
    const auto twice = f(ir::Op::multiply, {f.literal("2"), y});
    module.functions.push_back(
        f.finish(f(ir::Op::multiply, {f(ir::Op::multiply, {visibility, x}), twice})));
    CHECK(analyze::is_symmetric(module, ir::FunctionId{1}, 1, 2));
    CHECK_FALSE(analyze::is_symmetric(module, ir::FunctionId{1}, 0, 2));

    // (a - b)^2 is symmetric over the reals, but its form does not show it.
    tests::FunctionBuilder g{"difference"};
    const auto a = g.argument("a", 0, 1);
    const auto b = g.argument("b", 0, 1);
    const auto difference = g(ir::Op::subtract, {a, b});
    module.functions.push_back(g.finish(g(ir::Op::multiply, {difference, difference})));
    CHECK_FALSE(analyze::is_symmetric(module, ir::FunctionId{2}, 0, 1));
}
