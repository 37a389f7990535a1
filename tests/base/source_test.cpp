#include "base/source.h"

#include <catch2/catch.hpp>

using namespace lobe;

TEST_CASE("places count lines and characters from 1")
{
    const Source source{"p", "a\n\u00E4\u4E2Db\r\n\nlast"};
    const auto at = [&](std::uint32_t offset) {
        const Position place = source.position(offset);
        return std::pair{place.line, place.column};
    };
    CHECK(at(0) == std::pair{1, 1});
    CHECK(at(1) == std::pair{1, 2});
    CHECK(at(2) == std::pair{2, 1});
    CHECK(at(4) == std::pair{2, 2});
    CHECK(at(7) == std::pair{2, 3});
    CHECK(at(10) == std::pair{3, 1});
    CHECK(at(11) == std::pair{4, 1});
    CHECK(at(15) == std::pair{4, 5});
    CHECK(at(999) == std::pair{4, 5});
    CHECK(source.line(2) == "\u00E4\u4E2Db");
    CHECK(source.line(3) == "");
    CHECK(source.line(4) == "last");
    CHECK(source.line(5) == "");
    CHECK(source.line_count() == 4);
    CHECK(Source{"p", ""}.line_count() == 1);
}

TEST_CASE("spans join, are quoted and cited")
{
    Sources sources;
    sources.add("a.lobe", "one two\nthree");
    CHECK(join({0, 4, 7}, {0, 0, 3}) == Span{0, 0, 7});
    CHECK(join({0, 4, 7}, {1, 0, 3}) == Span{0, 4, 7});
    CHECK(sources.text({0, 4, 7}) == "two");
    CHECK(sources.text({0, 8, 999}) == "three");
    CHECK(sources.text({0, 999, 1000}) == "");
    CHECK(sources.cite({0, 9, 10}) == "a.lobe:2");
}
