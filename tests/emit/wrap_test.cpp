#include "emit/wrap.h"

#include <catch2/catch.hpp>

#include <sstream>

namespace lobe::emit {

TEST_CASE("a line that fits stays whole", "[emit][wrap]")
{
    const std::string line = "x = " + std::string(96, 'y');
    CHECK(wrap(line, 0, "    ") == line);
}

TEST_CASE("a long list of arguments is broken behind commas, every piece within the page",
          "[emit][wrap]")
{
    std::string line = "float f(";
    for (int i = 0; i < 40; ++i) line += "float argument_" + std::to_string(i) + ", ";
    line += "float last)";
    const std::string wrapped = wrap(line, 4, "\t");
    std::istringstream pieces{wrapped};
    std::string joined;
    bool first = true;
    for (std::string piece; std::getline(pieces, piece); first = false) {
        if (!first) {
            REQUIRE(piece.front() == '\t');
            piece.erase(0, 1);
            joined += ' ';
        }
        CHECK(piece.size() + (first ? 4u : 8u) <= 100u);
        joined += piece;
    }
    CHECK(joined == line);
}

TEST_CASE("an operator starts the next line, and a type keeps its name", "[emit][wrap]")
{
    const std::string a(60, 'a');
    const std::string b(60, 'b');
    CHECK(wrap("float x = " + a + " + " + b + ";", 0, "  ") ==
          "float x = " + a + "\n  + " + b + ";");
    CHECK(wrap(a + " " + b + ";", 0, "  ") == a + " " + b + ";");
}

TEST_CASE("an assignment without another place is broken behind its sign", "[emit][wrap]")
{
    const std::string name(60, 'n');
    CHECK(wrap("const float Code = " + name + "( " + name + " );", 4, "\t") ==
          "const float Code =\n\t" + name + "( " + name + " );");
    // Arguments come first.
    CHECK(wrap("const float Code = " + name + "( x, " + name + " );", 4, "\t") ==
          "const float Code = " + name + "( x,\n\t" + name + " );");
}

TEST_CASE("a minus sign belongs to its number", "[emit][wrap]")
{
    const std::string a(90, 'a');
    CHECK(wrap("x = " + a + " -1.0 + 2.0;", 0, "") == "x = " + a + " -1.0\n+ 2.0;");
}

TEST_CASE("prose is filled, with ranges whole and paragraphs apart", "[emit][wrap]")
{
    CHECK(fill("a b c d", 3) == std::vector<std::string>{"a b", "c d"});
    CHECK(fill("xx in [0, 1] yy", 9) == std::vector<std::string>{"xx in", "[0, 1] yy"});
    CHECK(fill("", 9).empty());
    CHECK(fill("a \\ b \\", 3) == std::vector<std::string>{"a \\.", "b \\."});
    CHECK(paragraphs("a\nb\n\nc", 9) == std::vector<std::string>{"a b", "", "c"});
}

}  // namespace lobe::emit
