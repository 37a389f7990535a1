// Which types join, and which values fit where.
#include "check/checking.h"
#include "check/types.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::check;
using lobe::tests::check_text;

TEST_CASE("numbers spread, directions become vectors, colors stay colors", "[check][types]")
{
    CHECK(join(number_type, color_type).type == color_type);
    CHECK(join(color_type, color_type).type == color_type);
    CHECK(join(number_type, direction_type).type == vector_type(3));
    CHECK(join(direction_type, direction_type).type == vector_type(3));
    CHECK(join(direction_type, vector_type(3)).type == vector_type(3));
    CHECK(join(integer_type, integer_type).type == integer_type);
    CHECK(join(integer_type, number_type).type == number_type);
}

TEST_CASE("what cannot be joined says why", "[check][types]")
{
    const auto clash = [](const ValueType& a, const ValueType& b) {
        CHECK(!join(a, b).type);
        CHECK(!join(b, a).type);
        return join(a, b).clash;
    };
    CHECK(clash(color_type, direction_type) == Clash::color_direction);
    CHECK(clash(color_type, vector_type(3)) == Clash::color_vector);
    CHECK(clash(vector_type(2), vector_type(3)) == Clash::sizes);
    CHECK(clash(boolean_type, number_type) == Clash::boolean);
    CHECK(clash({{}, {}, Structure::geometry}, number_type) == Clash::structure);
}

TEST_CASE("values fit where their meaning is kept", "[check][types]")
{
    CHECK(fit(integer_type, number_type) == Fit::exact);
    CHECK(fit(number_type, integer_type) == Fit::none);
    CHECK(fit(number_type, color_type) == Fit::spread);
    CHECK(fit(number_type, vector_type(3)) == Fit::none);
    CHECK(fit(direction_type, vector_type(3)) == Fit::exact);
    CHECK(fit(vector_type(3), direction_type) == Fit::none);
    CHECK(fit(vector_type(3), color_type) == Fit::none);
    CHECK(fit(color_type, direction_type) == Fit::none);
}

TEST_CASE("ranges are written as they are read", "[check][types]")
{
    CHECK(describe(ir::Range{0, 1}) == "[0, 1]");
    CHECK(describe(ir::Range{-HUGE_VAL, 2}) == "(-inf, 2]");
    CHECK(describe(ir::Range{0x1p-6, HUGE_VAL}) == "[0.015625, inf)");
    CHECK(describe(-0.0) == "0");
}

TEST_CASE("the type of a result follows from the body", "[check][types]")
{
    const auto type_of = [](const std::string& expression) {
        const auto checked = check_text("/// f\nterm f(g: geometry, c: color, v: float3, x: unit, "
                                        "n: int in [1, 4]) = " +
                                        expression);
        CAPTURE(expression, checked.errors());
        const ir::Function& function = checked.function("f");
        return spell({function.quantity, function.type(), Structure::none});
    };
    CHECK(type_of("c * x + 1") == "color");
    CHECK(type_of("g.l + g.v") == "float3");
    CHECK(type_of("normalize(g.l + g.v)") == "direction");
    CHECK(type_of("-g.l") == "direction");
    CHECK(type_of("abs(g.l)") == "float3");
    CHECK(type_of("cross(g.n, g.l)") == "float3");
    CHECK(type_of("dot(g.n, g.l)") == "float");
    CHECK(type_of("luminance(c)") == "float");
    CHECK(type_of("if x > 0 then c else 0") == "color");
    CHECK(type_of("if x > 0 then g.l else g.v") == "direction");
    CHECK(type_of("n + 1") == "int");
    CHECK(type_of("n^2") == "int");
    CHECK(type_of("n / 2") == "float");
    CHECK(type_of("n^-1") == "float");
    CHECK(type_of("min(n, 2)") == "int");
    CHECK(type_of("sin(n)") == "float");
    CHECK(type_of("c == 1") == "bool");
    CHECK(type_of("color(v)") == "color");
    CHECK(type_of("float4(v, 1)") == "float4");
    CHECK(type_of("direction(0, 0, 1)") == "direction");
    CHECK(type_of("lerp(1, c, x)") == "color");
}
