// What is a comment, and where a definition ends.
#include "engine/code.h"
#include "engine/lines.h"
#include "engine/pattern.h"

#include <catch2/catch.hpp>

#include <string>

namespace lobe::engine {
namespace {

/// A letter per byte: code, literal, line comment, block comment.
std::string parts(std::string_view text)
{
    std::string result;
    for (const Part part : parts_of(text)) result += "clLB"[static_cast<int>(part)];
    return result;
}

/// The text of the definition that starts it.
std::string definition(const std::string& text)
{
    const auto end = end_of_definition(text, parts_of(text), 0);
    return end ? text.substr(0, *end) : "none";
}

}  // namespace

TEST_CASE("comments and literals are told from code", "[engine][code]")
{
    CHECK(parts("a // b\nc") == "cccLLLcc");
    CHECK(parts("a /* b\n */ c") == "cccBBBBBBBcc");
    CHECK(parts("\"//\" //") == "clllccL");
    CHECK(parts("'{' {") == "cllcc");
    CHECK(parts("'\\'' {") == "clllcc");
    CHECK(parts("\"\\\"{\" {") == "cllllcc");
    CHECK(parts("R\"x(\")\" )x\" {") == "cclllllllllcc");
    CHECK(parts("// a \\\n b\nc") == "cLLLLLLLLcc");
    CHECK(parts("/*/ a */b") == "cBBBBBBBc");
    CHECK(parts("") == "");
}

TEST_CASE("what is never closed ends where it must", "[engine][code]")
{
    CHECK(parts("#error don't\nx") == std::string(14, 'c'));
    CHECK(parts("1'000'000") == std::string(9, 'c'));
    CHECK(parts("\"a\nb") == "clcc");
    CHECK(parts("/* a") == "cBBB");
    CHECK(parts("R\"(a") == "ccll");
    CHECK(parts("\"\\") == "cl");
    CHECK(parts("'") == "c");
    CHECK(parts("/") == "c");
}

TEST_CASE("a definition ends with the line of its closing brace", "[engine][code]")
{
    CHECK(definition("f()\n{\n}\nafter\n") == "f()\n{\n}\n");
    CHECK(definition("f() { a; } // tail\nafter\n") == "f() { a; } // tail\n");
    CHECK(definition("f()\n{\n if (x) { y; }\n}") == "f()\n{\n if (x) { y; }\n}");
    CHECK(definition("f(int a = g(1), int b)\n{ }\n;") == "f(int a = g(1), int b)\n{ }\n");
    CHECK(definition("f() // }\n{\n /* } */ \"}\" '}'\n}\nafter") ==
          "f() // }\n{\n /* } */ \"}\" '}'\n}\n");
}

TEST_CASE("a declaration is no definition", "[engine][code]")
{
    CHECK(definition("f();\n{ }\n") == "none");
    CHECK(definition("enum E : int;\nenum E { a };\n") == "none");
    CHECK(definition("f()\n{\n") == "none");
    CHECK(definition("f()") == "none");
    CHECK(definition("f(for (;;))\n{ }\n") == "f(for (;;))\n{ }\n");
}

TEST_CASE("each branch of an #if starts at the same depth", "[engine][code]")
{
    const std::string text = "f()\n{\n#if A\n\tif (a) {\n#elif B\n\tif (b) {\n#else\n\t{\n#endif\n"
                             "\t}\n}\n";
    CHECK(definition(text + "after\n") == text);
    const std::string nested =
        "f()\n{\n# if A\n#  ifdef B\n{\n#  else\n{\n#  endif\n}\n# endif\n}\n";
    CHECK(definition(nested + "after\n") == nested);
    // The branch that the definition is in ends inside of it, or has begun before it.
    CHECK(definition("f()\n{\n#else\n#endif\n}\nafter\n") == "f()\n{\n#else\n#endif\n}\n");
}

TEST_CASE("hits do not start within comments", "[engine][pattern]")
{
    const std::string text = "x /* x */ x // x\n// x\nx";
    const auto hits = Pattern{"x"}.find_all(text, parts_of(text), {0, text.size()});
    REQUIRE(hits.size() == 3);
    CHECK(hits[0][0]->begin == 0);
    CHECK(hits[1][0]->begin == 10);
    CHECK(hits[2][0]->begin == 22);
    CHECK(Pattern{"// x$"}.find_all(text, parts_of(text), {0, text.size()}).size() == 2);
    CHECK(Pattern{"/\\* x"}.find_all(text, parts_of(text), {0, text.size()}).size() == 1);
}

TEST_CASE("^ and $ are those of lines, also at the ends of a stretch", "[engine][pattern]")
{
    const std::string text = "ab\nab\nab";
    const auto parts = parts_of(text);
    CHECK(Pattern{"^ab$"}.find_all(text, parts, {0, text.size()}).size() == 3);
    CHECK(Pattern{"^b"}.find_all(text, parts, {1, text.size()}).empty());
    CHECK(Pattern{"a$"}.find_all(text, parts, {0, 4}).empty());
    CHECK(Pattern{"\\bab"}.find_all(text, parts, {3, 5}).size() == 1);
    CHECK(Pattern{"(a)|(b)"}.find_all(text, parts, {1, 2})[0][1] == std::nullopt);
}

TEST_CASE("values are quoted in patterns and only there", "[engine][pattern]")
{
    const ValueOf values = [](std::string_view name) {
        return name == "a" ? std::optional<std::string>{"x.y*"} : std::nullopt;
    };
    CHECK(substitute("${a}/${a}", values).text == "x.y*/x.y*");
    const Substituted quoted = substitute_quoted("^${a}$", values);
    const std::string text = "xyyy\nx.y*";
    CHECK(Pattern{quoted.text}.find_all(text, parts_of(text), {0, text.size()}).size() == 1);
    CHECK(substitute("${b}", values).error == "no value `b`");
    CHECK(substitute("${b", values).error == "`${` without its `}`");
}

TEST_CASE("a pattern takes time in proportion to its text", "[engine][pattern]")
{
    // Backtracking would need 2^50 steps here, recursion a frame per byte.
    const std::string text = std::string(1'000'000, 'a') + "b";
    CHECK(Pattern{"(a|a)*(a|a)*c"}.find_all(text, parts_of(text), {0, 50}).empty());
    CHECK(Pattern{"(?:a|b)*b"}.find_all(text, parts_of(text), {0, text.size()}).size() == 1);
}

}  // namespace lobe::engine
