#include "emit/expression.h"
#include "emit/modules.h"
#include "emit/write.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

namespace lobe::emit {
namespace {

using ir::ExprId;
using ir::Op;

const Dialect& language(std::string_view target) { return dialect(*find_target(target)); }

/// Locals and result of a graph over the scalars x, y, z in some language.
Body write_scalars(const ir::Graph& graph, ExprId root, std::string_view target = "glsl450")
{
    const ir::Module module;
    const std::vector<std::string> functions;
    Scope scope{module, language(target),        functions, {"x", "y", "z"},
                {},     Namer{language(target)}, ""};
    for (const std::string& input : scope.inputs) scope.namer.unique(input);
    Helpers helpers;
    return write(scope, helpers, graph, {root});
}

std::string text_of(const ir::Graph& graph, ExprId root)
{
    return write_scalars(graph, root).results.front().text;
}

struct Scalars {
    ir::Graph g;
    ExprId x = g.input(0, ir::Type::scalar);
    ExprId y = g.input(1, ir::Type::scalar);
    ExprId z = g.input(2, ir::Type::scalar);
};

std::string literal(std::string_view text)
{
    ir::Graph g;
    return text_of(g, g.literal(text));
}

/// Forty random operations on three inputs and a few literals; the last scalar is the root.
ExprId random_expression(ir::Graph& g, std::mt19937& random)
{
    std::vector<ExprId> scalars{g.input(0, ir::Type::scalar),
                                g.input(1, ir::Type::scalar),
                                g.input(2, ir::Type::scalar),
                                g.literal("-2.5"),
                                g.literal("1"),
                                g.literal("1e-7")};
    std::vector<ExprId> booleans{g.apply(Op::less, {scalars[0], scalars[1]})};
    const auto pick = [&](const std::vector<ExprId>& from) {
        // Recent ones more often, so that expressions grow deep.
        const std::size_t back = std::min<std::size_t>(random() % 8, from.size() - 1);
        return from[random() % 4 == 0 ? random() % from.size() : from.size() - 1 - back];
    };
    const auto scalar = [&] { return pick(scalars); };
    const auto boolean = [&] { return pick(booleans); };
    for (int i = 0; i < 40; ++i) {
        switch (random() % 14) {
        case 0:
        case 1: scalars.push_back(g.apply(Op::add, {scalar(), scalar()})); break;
        case 2:
        case 3: scalars.push_back(g.apply(Op::subtract, {scalar(), scalar()})); break;
        case 4: scalars.push_back(g.apply(Op::multiply, {scalar(), scalar()})); break;
        case 5: scalars.push_back(g.apply(Op::divide, {scalar(), scalar()})); break;
        case 6: scalars.push_back(g.apply(Op::negate, {scalar()})); break;
        case 7: scalars.push_back(g.apply(Op::select, {boolean(), scalar(), scalar()})); break;
        case 8: scalars.push_back(g.apply(Op::saturate, {scalar()})); break;
        case 9: scalars.push_back(g.apply(Op::power, {scalar(), scalar()})); break;
        case 10: booleans.push_back(g.apply(Op::less_equal, {scalar(), scalar()})); break;
        case 11: booleans.push_back(g.apply(Op::logical_and, {boolean(), boolean()})); break;
        case 12: booleans.push_back(g.apply(Op::logical_or, {boolean(), boolean()})); break;
        default:
            booleans.push_back(random() % 2 == 0 ? g.apply(Op::logical_not, {boolean()})
                                                 : g.apply(Op::not_equal, {boolean(), boolean()}));
        }
    }
    return scalars.back();
}

}  // namespace

TEST_CASE("a compiler reads the expression that was meant", "[emit][write][property]")
{
    const auto seed = GENERATE(range(1u, 401u));
    CAPTURE(seed);
    std::mt19937 random{seed};
    ir::Graph graph;
    const ExprId root = random_expression(graph, random);
    const Body body = write_scalars(graph, root);

    std::map<std::string, std::string> locals;
    for (const Statement& local : body.locals) {
        // `float t0 = …;`
        const auto equals = local.text.find(" = ");
        const auto space = local.text.find(' ');
        const std::string name = local.text.substr(space + 1, equals - space - 1);
        const std::string value = local.text.substr(equals + 3, local.text.size() - equals - 4);
        locals[name] = tests::fully_parenthesized(value, locals);
    }
    CHECK(tests::fully_parenthesized(body.results.front().text, locals) ==
          tests::fully_parenthesized(graph, root, {"x", "y", "z"}));
}

TEST_CASE("parentheses are there where they are needed, and only there", "[emit][write]")
{
    Scalars s;
    const auto add = [&](ExprId a, ExprId b) { return s.g.apply(Op::add, {a, b}); };
    const auto subtract = [&](ExprId a, ExprId b) { return s.g.apply(Op::subtract, {a, b}); };
    const auto multiply = [&](ExprId a, ExprId b) { return s.g.apply(Op::multiply, {a, b}); };
    const auto negate = [&](ExprId a) { return s.g.apply(Op::negate, {a}); };
    CHECK(text_of(s.g, add(add(s.x, s.y), s.z)) == "x + y + z");
    CHECK(text_of(s.g, add(s.x, add(s.y, s.z))) == "x + (y + z)");
    CHECK(text_of(s.g, subtract(s.x, subtract(s.y, s.z))) == "x - (y - z)");
    CHECK(text_of(s.g, multiply(add(s.x, s.y), s.z)) == "(x + y) * z");
    CHECK(text_of(s.g, add(multiply(s.x, s.y), s.z)) == "x * y + z");
    CHECK(text_of(s.g, negate(negate(s.x))) == "-(-x)");
    CHECK(text_of(s.g, negate(add(s.x, s.y))) == "-(x + y)");
    CHECK(text_of(s.g, add(s.x, negate(s.y))) == "x - y");
    CHECK(text_of(s.g, subtract(s.x, negate(s.y))) == "x - -y");
    CHECK(text_of(s.g, multiply(s.x, s.g.literal("-2"))) == "x * -2.0");
    CHECK(text_of(s.g, add(s.x, s.g.literal("-2"))) == "x - 2.0");
    CHECK(text_of(s.g, negate(s.g.literal("-2"))) == "-(-2.0)");
}

TEST_CASE("a literal reads back as its float and has a point", "[emit][write]")
{
    CHECK(literal("1") == "1.0");
    CHECK(literal("0.19") == "0.19");
    CHECK(literal("-5.55473") == "-5.55473");
    CHECK(literal("16777217") == "16777216.0");
    CHECK(literal("1e-7") == "1.0e-7");
    CHECK(literal("2.5e30") == "2.5e30");
    CHECK(literal("1e300") == "3.4028235e38");
    CHECK(literal("pi") == "3.1415927");
    CHECK(language("ue4").literal(ir::Literal{"pi", 3.141592653589793}) == "PI");

    std::mt19937 random{7};
    for (int i = 0; i < 10'000; ++i) {
        const auto bits = static_cast<std::uint32_t>(random());
        const float value = std::bit_cast<float>(bits);
        if (!std::isfinite(value)) continue;
        const std::string text = language("glsl450").literal(static_cast<double>(value));
        REQUIRE(std::strtof(text.c_str(), nullptr) == value);
        REQUIRE(text.find('.') != std::string::npos);
    }
}

TEST_CASE("what is used twice becomes a local, what is trivial never", "[emit][write]")
{
    Scalars s;
    const ExprId sum = s.g.apply(Op::add, {s.x, s.y});
    const ExprId minus = s.g.apply(Op::negate, {s.z});
    const ExprId root = s.g.apply(
        Op::multiply, {s.g.apply(Op::subtract, {sum, minus}), s.g.apply(Op::divide, {sum, minus})});
    const Body body = write_scalars(s.g, root);
    REQUIRE(body.locals.size() == 1);
    CHECK(body.locals.front().text == "float t0 = x + y;");
    CHECK(body.results.front().text == "(t0 - -z) * (t0 / -z)");
    CHECK(write_scalars(s.g, root, "hlsl").locals.front().text == "const float t0 = x + y;");
}

TEST_CASE("dead expressions are not written", "[emit][write]")
{
    Scalars s;
    const ExprId dead = s.g.apply(Op::exp2, {s.x});
    s.g.apply(Op::add, {dead, dead});
    const Body body = write_scalars(s.g, s.y);
    CHECK(body.locals.empty());
    CHECK(body.results.front().text == "y");
}

TEST_CASE("expressions wider than a line are taken apart", "[emit][write]")
{
    ir::Graph g;
    const ExprId x = g.input(0, ir::Type::scalar);
    ExprId sum = x;
    for (int i = 1; i < 60; ++i)
        sum = g.apply(Op::add, {sum, g.apply(Op::multiply, {x, g.literal(std::to_string(i))})});
    const Body body = write_scalars(g, sum);
    CHECK(body.locals.size() > 3);
    for (const Statement& local : body.locals) CHECK(local.text.size() < 100);
}

TEST_CASE("halves are written as halves throughout", "[emit][write]")
{
    const Dialect& half = dialect(*find_target("glsl450"), Precision::float16);
    CHECK(half.literal(0.5) == "0.5hf");
    CHECK(half.type(ir::Type::vec3) == "f16vec3");
    ir::Graph g;
    const ir::Module module;
    const std::vector<std::string> functions;
    Scope scope{module, half, functions, {"x"}, {}, Namer{half}, ""};
    Helpers helpers;
    const ExprId root = g.apply(Op::saturate, {g.input(0, ir::Type::scalar)});
    CHECK(write(scope, helpers, g, {root}).results.front().text == "clamp(x, 0.0hf, 1.0hf)");
}

}  // namespace lobe::emit
