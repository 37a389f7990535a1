#include "emit/template.h"

#include <catch2/catch.hpp>

namespace lobe::emit {
namespace {

Record named(std::string name) { return {{{"name", std::move(name)}}, {}}; }

std::string error_of(std::string_view text, const Record& values)
{
    return render("t.glsl", text, values).error;
}

}  // namespace

TEST_CASE("a template without directives is its own result", "[emit][template]")
{
    const Rendered result = render("t", "float a;\n\n  if (x < 1 && y > 2) { }\n", {});
    CHECK(result.text == "float a;\n\n  if (x < 1 && y > 2) { }\n");
    CHECK(result.error.empty());
}

TEST_CASE("values are put in as they are", "[emit][template]")
{
    CHECK(render("t", "a ${name} b ${name}.\n", named("<&\"{{$")).text == "a <&\"{{$ b <&\"{{$.\n");
}

TEST_CASE("a value alone on its line carries its indentation to all its lines", "[emit][template]")
{
    CHECK(render("t", "{\n    ${name}\n}\n", named("a;\n\nb;")).text == "{\n    a;\n\n    b;\n}\n");
    CHECK(render("t", "{\n\t${name}\n}\n", named("")).text == "{\n}\n");
}

TEST_CASE("a loop leaves no line behind, and an empty list nothing at all", "[emit][template]")
{
    const std::string text = "a\n  //% for x in xs\n  ${x.name};\n  //% end\nb\n";
    CHECK(render("t", text, {{}, {{"xs", {named("1"), named("2")}}}}).text == "a\n  1;\n  2;\nb\n");
    CHECK(render("t", text, {{}, {{"xs", {}}}}).text == "a\nb\n");
}

TEST_CASE("loops nest, and the inner one sees the outer record", "[emit][template]")
{
    Record outer = named("o");
    outer.lists["ys"] = {named("1"), named("2")};
    const Record values{{}, {{"xs", {outer}}}};
    CHECK(render("t", "//% for x in xs\n//% for y in x.ys\n${x.name}${y.name}\n//% end\n//% end\n",
                 values)
              .text == "o1\no2\n");
}

TEST_CASE("a remark is for readers of the template", "[emit][template]")
{
    CHECK(render("t", "//% # why\na\n", {}).text == "a\n");
}

TEST_CASE("an unknown name is an error with its place", "[emit][template]")
{
    CHECK(error_of("a\n${nmae}\n", named("x")) == "t.glsl:2: unknown name `nmae`");
    CHECK(error_of("//% for x in xs\n${x.other}\n//% end\n", {{}, {{"xs", {named("1")}}}}) ==
          "t.glsl:2: unknown name `x.other`");
    CHECK(error_of("\n//% for x in ys\n//% end\n", {}) == "t.glsl:2: unknown list `ys`");
    CHECK(error_of("${y.name}\n", named("1")) == "t.glsl:1: unknown name `y.name`");
}

TEST_CASE("a value that nothing uses is an error", "[emit][template]")
{
    CHECK(error_of("a\n", named("x")) == "t.glsl: unused value `name`");
    CHECK(error_of("//% for x in xs\na\n//% end\n", {{}, {{"xs", {named("1")}}}}) ==
          "t.glsl: unused value `xs.name`");
    CHECK(error_of("a\n", {{}, {{"xs", {}}}}) == "t.glsl: unused value `xs`");
}

TEST_CASE("values may be shared by texts that each need some", "[emit][template]")
{
    const Rendered result = render("t", "a\n", named("x"), Unused::fine);
    CHECK(result.text == "a\n");
    CHECK(result.error.empty());
    CHECK(render("t", "${other}\n", named("x"), Unused::fine).error == "t:1: unknown name `other`");
}

TEST_CASE("broken directives are errors with their line", "[emit][template]")
{
    CHECK(error_of("//% for x in xs\n", {{}, {{"xs", {}}}}) == "t.glsl:1: `for` without `end`");
    CHECK(error_of("a\n//% end\n", {}) == "t.glsl:2: `end` without `for`");
    CHECK(error_of("//% if x\n", {}) == "t.glsl:1: unknown directive `if x`");
    CHECK(error_of("//% for x of xs\n", {}) == "t.glsl:1: a loop reads `for x in xs`");
    CHECK(error_of("a ${name\n", named("x")) == "t.glsl:1: `${` without `}`");
    CHECK(error_of("a ${name}\n", named("x\ny")) ==
          "t.glsl:1: a value of many lines must stand alone on its line");
}

TEST_CASE("nothing is rendered when anything was wrong", "[emit][template]")
{
    CHECK(render("t", "a\n${b}\n", {}).text.empty());
}

TEST_CASE("lines know the record they came from", "[emit][template]")
{
    Record first = named("1\n2");
    first.tag = 7;
    Record second = named("3");
    second.tag = 8;
    const Rendered result = render("t", "head\n//% for x in xs\n${x.name}\nafter\n//% end\n",
                                   {{}, {{"xs", {first, second}}}});
    REQUIRE(result.marks.size() == 2);
    CHECK((result.marks[0].tag == 7 && result.marks[0].first == 2 && result.marks[0].last == 4));
    CHECK((result.marks[1].tag == 8 && result.marks[1].first == 5 && result.marks[1].last == 6));
}

TEST_CASE("templates are part of the program", "[emit][template]")
{
    CHECK(embedded_template("glsl/module.glsl").has_value());
    CHECK_FALSE(embedded_template("glsl/no_such.glsl").has_value());
}

}  // namespace lobe::emit
