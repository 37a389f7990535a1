// Tables line up, give way when the terminal is narrow, and color nothing unasked.
#include "report/table.h"

#include <catch2/catch.hpp>

using namespace lobe::report;

namespace {

Table sample()
{
    Table table;
    table.columns = {{"term", false}, {"points", true}, {"worst at", false}};
    table.rows = {{{"D_GGX"}, {"65,536"}, {"roughness = 0.5, l = (0, 0, 1)", Style::faint}},
                  {{"F"}, {"9"}}};
    return table;
}

}  // namespace

TEST_CASE("columns are aligned and lines have no trailing space", "[table]")
{
    CHECK(render(sample(), {}) == "term   points  worst at\n"
                                  "D_GGX  65,536  roughness = 0.5, l = (0, 0, 1)\n"
                                  "F           9\n");
}

TEST_CASE("the last column gives way, down to what is worth reading", "[table]")
{
    CHECK(render(sample(), {false, 32}) == "term   points  worst at\n"
                                           "D_GGX  65,536  roughness = 0.5..\n"
                                           "F           9\n");
    CHECK(render(sample(), {false, 5}).find("roughness ..") != std::string::npos);
}

TEST_CASE("color is there when asked for and does not move columns", "[table]")
{
    const std::string plain = render(sample(), {});
    CHECK(plain.find('\x1b') == std::string::npos);
    std::string colored = render(sample(), {true, 0});
    CHECK(colored.find('\x1b') != std::string::npos);
    for (std::size_t at; (at = colored.find('\x1b')) != std::string::npos;)
        colored.erase(at, colored.find('m', at) - at + 1);
    CHECK(colored == plain);
}

TEST_CASE("characters are counted, not bytes, and never cut", "[table]")
{
    CHECK(length("θ ≤ π") == 5);
    Table table;
    table.columns = {{"", false}};
    table.rows = {{{"αβγδεζηθικλμνξ"}}};
    CHECK(render(table, {false, 12}) == "\nαβγδεζηθικ..\n");
}

TEST_CASE("large numbers are grouped by thousands", "[table]")
{
    CHECK(grouped(0) == "0");
    CHECK(grouped(999) == "999");
    CHECK(grouped(1000) == "1,000");
    CHECK(grouped(23592960) == "23,592,960");
}
