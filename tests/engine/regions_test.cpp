// Marks in files: written, found, taken out, broken.
#include "engine/regions.h"
#include "engine/tree.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

namespace lobe::engine {
namespace {

std::string broken_of(const std::string& text)
{
    std::string result;
    for (const BrokenMark& mark : find_regions(to_lines(text)).broken)
        result += fmt::format("{}: {}\n", mark.line + 1, mark.what);
    return result;
}

std::string without(const std::string& text, const std::string& model)
{
    const Lines lines = to_lines(text);
    return to_bytes(
        without_regions(lines, find_regions(lines).regions, [&](const std::string& other) {
            return other == model;
        }).text);
}

std::string written(const NewRegion& region)
{
    Lines lines;
    write_region(region, lines.lines);
    return to_bytes(lines);
}

NewRegion sample()
{
    NewRegion region;
    region.model = "Gloss";
    region.name = "id";
    region.number = 1;
    region.total = 2;
    region.indent = "\t";
    region.before = {{"\told", LineEnd::crlf}, {"\t", LineEnd::lf}, {"\t\tlast", LineEnd::none}};
    region.after = {"\tnew", "", "// - no mark"};
    return region;
}

}  // namespace

TEST_CASE("bytes become lines and bytes again", "[engine][lines]")
{
    for (const std::string bytes : {"", "\n", "a", "a\n", "a\r\n", "\r\r\n", "\r", "a\rb\n\n\r\n",
                                    "\xEF\xBB\xBF", "\xEF\xBB\xBFx\n", "\xEF\xBBx"})
        CHECK(to_bytes(to_lines(bytes)) == bytes);
    CHECK(to_lines("\xEF\xBB\xBFx\r\ny").lines ==
          std::vector<Line>{{"x", LineEnd::crlf}, {"y", LineEnd::none}});
    CHECK(usual_end(to_lines("a\r\nb\r\nc\n")) == LineEnd::crlf);
    CHECK(usual_end(to_lines("a\r\nb\n")) == LineEnd::lf);
    CHECK(usual_end(to_lines("a")) == LineEnd::lf);
}

TEST_CASE("the hash is the one that is documented", "[engine][regions]")
{
    // FNV-1a, 32 bits; its offset basis for nothing, and the published value of "a".
    CHECK(LineHash{}.text() == "811c9dc5");
    LineHash hash;
    hash.add("");
    CHECK(hash.text() == fmt::format("{:08x}", (2166136261u ^ '\n') * 16777619u));
}

TEST_CASE("a region holds what stood there", "[engine][regions]")
{
    const std::string text = written(sample());
    CHECK(text == "\t// BEGIN lobe Gloss 1/2 id " + text.substr(28, 8) +
                      "\n"
                      "\t//- old\r\n"
                      "\t//-\n"
                      "\t//- \tlast\n"
                      "\tnew\n"
                      "\n"
                      "// - no mark\n"
                      "\t// END lobe Gloss id");
    CHECK(without("x\n" + text, "Gloss") == "x\n\told\r\n\t\n\t\tlast");
    CHECK(without("x\n" + text, "Other") == "x\n" + text);
    const Region region = find_regions(to_lines(text)).regions.at(0);
    CHECK(region.model == "Gloss");
    CHECK(region.name == "id");
    CHECK(region.number == 1);
    CHECK(region.total == 2);
    CHECK_FALSE(region.edited);
}

TEST_CASE("line ends are no edit, anything else is", "[engine][regions]")
{
    NewRegion region = sample();
    region.before[0].end = LineEnd::lf;
    const std::string text = written(region);
    const std::string crlf = with_crlf({{"", text}}).at("");
    CHECK_FALSE(find_regions(to_lines(crlf)).regions.at(0).edited);
    for (std::size_t at = text.find("//- old"); at < text.find("\n\t// END"); ++at) {
        std::string changed = text;
        changed[at] = changed[at] == '#' ? '+' : '#';
        CAPTURE(changed);
        CHECK(find_regions(to_lines(changed)).regions.at(0).edited);
    }
}

TEST_CASE("regions of others may stand inside", "[engine][regions]")
{
    NewRegion outer = sample();
    NewRegion inner;
    inner.model = "Velvet";
    inner.name = "id";
    inner.number = 1;
    inner.total = 1;
    inner.indent = "\t";
    inner.before = {{"\tnew", LineEnd::lf}};
    inner.after = {"\tnewer"};
    std::string text = written(outer);
    text.replace(text.find("\tnew\n"), 5, written(inner));
    const auto regions = find_regions(to_lines(text)).regions;
    REQUIRE(regions.size() == 1);
    CHECK_FALSE(regions[0].edited);
    REQUIRE(regions[0].inside.size() == 1);
    CHECK(regions[0].inside[0].model == "Velvet");
    CHECK(without(text, "Velvet") == written(outer));
}

TEST_CASE("marks without their other half are named", "[engine][regions]")
{
    const std::string begin = "// BEGIN lobe Gloss 1/2 id 00000000\n";
    const std::string end = "// END lobe Gloss id\n";
    CHECK(broken_of(begin + end) == "");
    CHECK(broken_of("x\n" + begin) == "2: the BEGIN of region `id` of Gloss without its END\n");
    CHECK(broken_of("x\n" + end) == "2: an END without its BEGIN\n");
    CHECK(broken_of(begin + begin + end) ==
          "1: the BEGIN of region `id` of Gloss without its END\n");
    CHECK(broken_of(begin + end + end) == "3: an END without its BEGIN\n");
    CHECK(broken_of(begin + "// END lobe Gloss other\n" + end) == "2: an END without its BEGIN\n");
    const std::string other = "// BEGIN lobe Velvet 1/1 id 00000000\n";
    CHECK(broken_of(begin + other + end) ==
          "2: the BEGIN of region `id` of Velvet without its END\n");
    CHECK(broken_of(begin + other + end + "// END lobe Velvet id\n") ==
          "2: the BEGIN of region `id` of Velvet without its END\n4: an END without its BEGIN\n");
}

TEST_CASE("marks that cannot be read are named", "[engine][regions]")
{
    for (const std::string words :
         {"", " Gloss", " Gloss 1/2 id", " Gloss 1/2 id 0 more", " Gloss 12 id 0",
          " Gloss 3/2 id 0", " Gloss 0/2 id 0", " Gloss -1/2 id 0", " Gloss 1/x id 0",
          " Gloss 1/99999999999 id 0"})
        CHECK(broken_of("// BEGIN lobe" + words + "\n") == "1: a BEGIN that cannot be read\n");
    CHECK(broken_of("// END lobe\n") == "1: an END without its BEGIN\n");
    CHECK(broken_of("// BEGIN lobes\n// BEGINNING\n// END of it\n") == "");
}

TEST_CASE("what would be taken for a mark is known", "[engine][regions]")
{
    CHECK(looks_like_mark("  // BEGIN lobe x"));
    CHECK(looks_like_mark("//- x"));
    CHECK(looks_like_mark("\t//+"));
    CHECK(looks_like_mark("//^ x"));
    CHECK_FALSE(looks_like_mark("//---"));
    CHECK_FALSE(looks_like_mark("x //- y"));
}

}  // namespace lobe::engine
