// The list of edits: what it says, and every way to write it wrong.
#include "engine/edits.h"
#include "engine/tree.h"

#include <catch2/catch.hpp>

#include <climits>
#include <random>

namespace lobe::engine {
namespace {

std::string error_of(std::string_view text) { return parse_edits(text).error; }

const std::string edit = "file F\nedit e \"words\"\n";

}  // namespace

TEST_CASE("a list is read as it is written", "[engine][edits]")
{
    const EditList list = list_of("# remark\n"
                                  "path SH Engine/Shaders\r\n"
                                  "supports 4.25 4.27\n"
                                  "word has_node \"a node\"\n"
                                  "\n"
                                  "file SH/A.ush\n"
                                  "  optional\n"
                                  "  when has_node !extra\n"
                                  "probe extra \\bExtra\\b\n"
                                  "read id ID (\\d+) # 1\n"
                                  "  else 0\n"
                                  "  scope ^f\\(\n"
                                  "assert \"why not\" a b\n"
                                  "  hits 2\n"
                                  "at_most 0xF id_plus_1 \"room\"\n"
                                  "file B\n"
                                  "edit one \"the one\"\n"
                                  "  since 4.26\n"
                                  "  until 4.26\n"
                                  "  at ^x$\n"
                                  "  hits 0..2\n"
                                  "  flush\n"
                                  "  after\n"
                                  "  | a\n"
                                  "  |\tb\n"
                                  "  |  c | d\n"
                                  "  |\n"
                                  "edit two \"the other\"\n"
                                  "  at (x)\n"
                                  "  last\n"
                                  "  append\n"
                                  "  | y\n"
                                  "new SH/${Model}.ush from.ush\n"
                                  "  when has_node\n");
    CHECK(list.folders.at("SH") == "Engine/Shaders");
    REQUIRE(list.files.size() == 2);
    CHECK(list.files[0].path == "Engine/Shaders/A.ush");
    CHECK(list.files[0].optional);
    CHECK(list.files[0].condition.set == std::vector<std::string>{"has_node"});
    CHECK(list.files[0].condition.not_set == std::vector<std::string>{"extra"});
    CHECK(list.files[1].path == "B");
    CHECK(list.first_version == Version{4, 25});
    CHECK(list.last_version == Version{4, 27});
    REQUIRE(list.queries.size() == 4);
    CHECK(list.queries[0].kind == Query::Kind::probe);
    CHECK(list.queries[1].name == "id");
    CHECK(list.queries[1].anchor.pattern == "ID (\\d+) # 1");
    CHECK(list.queries[1].anchor.scope == "^f\\(");
    CHECK(list.queries[1].fallback == "0");
    CHECK(list.queries[2].why == "why not");
    CHECK(list.queries[2].anchor.pattern == "a b");
    CHECK(list.queries[2].anchor.least_hits == 2);
    CHECK(list.queries[3].left == "0xF");
    CHECK(list.queries[3].right == "id_plus_1");
    CHECK(list.queries[3].why == "room");
    REQUIRE(list.edits.size() == 2);
    CHECK(list.edits[0].name == "one");
    CHECK(list.edits[0].purpose == "the one");
    CHECK(list.edits[0].file == 1);
    CHECK(list.edits[0].condition.since == Version{4, 26});
    CHECK(list.edits[0].condition.until == Version{4, 26});
    CHECK(list.edits[0].anchor.least_hits == 0);
    CHECK(list.edits[0].anchor.most_hits == 2);
    CHECK(list.edits[0].flush);
    CHECK(list.edits[0].text == "a\n\tb\n c | d\n\n");
    CHECK(list.edits[0].line == 17);
    CHECK(list.edits[1].last);
    CHECK(list.edits[1].anchor.most_hits == INT_MAX);
    CHECK(list.edits[1].action == Action::append);
    REQUIRE(list.new_files.size() == 1);
    CHECK(list.new_files[0].path == "Engine/Shaders/${Model}.ush");
    CHECK(list.new_files[0].from == "from.ush");
    CHECK(list.new_files[0].condition.set.size() == 1);
}

TEST_CASE("versions compare as numbers", "[engine][edits]")
{
    CHECK(parse_version("4.25") == Version{4, 25});
    CHECK(parse_version("4.25.1") == Version{4, 25});
    CHECK(*parse_version("4.9") < *parse_version("4.10"));
    CHECK(*parse_version("4.27") < *parse_version("5.0"));
    for (const std::string_view text : {"", "4", "4.", ".4", "4.x", "a.b", "-4.2"})
        CHECK_FALSE(parse_version(text));
}

TEST_CASE("words that mean nothing are errors with their line", "[engine][edits]")
{
    CHECK(error_of("\nfiles x\n") == "2: unknown word `files`\n");
    CHECK(error_of("file F\noptional yes\n") == "2: `optional` stands alone, behind `file`\n");
    CHECK(error_of("path SH\n") == "1: `path` gives a short name to a folder\n");
    CHECK(error_of("supports 4.25\n") == "1: this reads `supports 4.25 4.27`\n");
    CHECK(error_of("word a-b \"w\"\n") == "1: `a-b` is no name: letters, digits and _\n");
    CHECK(error_of("word a w\n") == "1: words for people in quotes are missing\n");
    CHECK(error_of("| text\n") == "1: a line of text stands behind an action\n");
    CHECK(error_of("new A\n") == "1: this reads `new PATH FROM`\n");
    CHECK(error_of("file\n") == "1: a path is missing\n");
}

TEST_CASE("what belongs to something else is an error", "[engine][edits]")
{
    CHECK(error_of("read id (x)\n") == "1: this stands behind a `file`\n");
    CHECK(error_of("at x\n") == "1: `at` stands behind `edit`\n");
    CHECK(error_of("scope x\n") == "1: `scope` stands behind a question with a REGEX or an edit\n");
    CHECK(error_of("since 4.26\n") ==
          "1: `since` stands behind a question, `edit`, `file` or `new`\n");
    CHECK(error_of("file F\nelse 1\n") == "2: `else` stands behind `read`\n");
    CHECK(error_of("file F\nunique \"w\" x\nhits 1\n") ==
          "3: `hits` stands behind `assert` or an edit\n");
    CHECK(error_of("file F\nat_most 1 1 \"w\"\nscope x\n") ==
          "3: `scope` stands behind a question with a REGEX or an edit\n");
}

TEST_CASE("an edit has an anchor, one action and a text", "[engine][edits]")
{
    CHECK(error_of(edit) == "2: edit `e` has no `at`\n"
                            "2: edit `e` has no action: before, after, replace, append or clone\n"
                            "2: edit `e` has no text: lines behind `|`\n");
    CHECK(error_of(edit + "at x\nbefore\nafter\n| t\n") == "5: an edit has one action\n");
    CHECK(error_of(edit + "at x\nat y\nafter\n| t\n") == "4: `at` comes twice\n");
    CHECK(error_of(edit + "at x\nappend\n| t\n") ==
          "2: edit `e` has no group in its anchor that says where the text goes\n");
    CHECK(error_of(edit + "at x\nafter here\n| t\n") ==
          "2: edit `e` has no action: before, after, replace, append or clone\n"
          "4: `after` stands alone in its line\n");
    CHECK(error_of(edit + "at x\nhits 0\nafter\n| t\n") ==
          "4: this reads `hits 2` or `hits 0..1`\n");
    CHECK(error_of(edit + "at x\nhits 3..2\nafter\n| t\n") ==
          "4: this reads `hits 2` or `hits 0..1`\n");
}

TEST_CASE("what comes twice or was never said is an error", "[engine][edits]")
{
    const std::string rest = "at x\nafter\n| t\n";
    CHECK(error_of("file F\nfile F\n") == "2: `F` comes twice\n");
    CHECK(error_of("path A x\npath B x\nfile A/F\nfile B/F\n") == "4: `x/F` comes twice\n");
    CHECK(error_of(edit + rest + "edit e \"w\"\n" + rest) ==
          "6: edit `e` comes twice, before in line 2\n");
    CHECK(error_of(edit + "when some\n" + rest) == "3: nothing declares the word `some`\n");
    CHECK(error_of("file F\nat_most 15 id \"w\"\n") == "2: nothing reads a value `id`\n");
    CHECK(error_of("file F\nread id (x)\nequal id id_plus_1 \"w\"\n") == "");
}

TEST_CASE("regular expressions are checked where they stand", "[engine][edits]")
{
    CHECK(error_of("file F\nread id (x\n") == "2: regular expression: missing ): (?m)(x\n");
    CHECK(error_of("file F\nprobe w\n") == "2: a regular expression is missing\n");
    CHECK(error_of("file F\nprobe w x*\n") ==
          "2: this regular expression matches nothing at all, everywhere\n");
    CHECK(error_of("file F\nread id x\n") ==
          "2: `read` takes a value out of one group (make others `(?:…)`)\n");
    CHECK(error_of("file F\nread id (x)(y)\n") ==
          "2: `read` takes a value out of one group (make others `(?:…)`)\n");
    CHECK(error_of("file F\nversion x\n") == "2: `version` takes its numbers out of groups\n");
    CHECK(error_of("file F\nversion 4.25 x\n") == "");
    CHECK(error_of("file F\nprobe w ${MODEL\n") == "2: `${` without its `}`\n");
    CHECK(error_of("file F\nprobe w (a)\\1\n") ==
          "2: regular expression: invalid escape sequence: \\1\n");
}

TEST_CASE("any text is a list or an error", "[engine][edits]")
{
    const std::string text = "path A b\nword w \"x\"\nfile A/F\nread id (x)\nelse 1\nedit e \"y\"\n"
                             "when w\nscope f\nat (x)\nhits 0..1\nappend\n| ${id}\nnew A/N n\n";
    std::mt19937 engine{5};
    for (int i = 0; i < 3000; ++i) {
        std::string changed = text;
        for (int edits = 0; edits < 3; ++edits) {
            const auto at = engine() % changed.size();
            switch (engine() % 3) {
            case 0: changed.erase(at, engine() % 8); break;
            case 1:
                changed.insert(at, changed.substr(engine() % changed.size(), engine() % 12));
                break;
            default: changed[at] = static_cast<char>(engine() % 256); break;
            }
            if (changed.empty()) changed = text;
        }
        const ParsedEdits parsed = parse_edits(changed);
        if (!parsed.error.empty()) CHECK(parsed.list.edits.empty());
    }
}

}  // namespace lobe::engine
