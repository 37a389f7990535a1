// What programs read: one object a line, and a SARIF log.
#include "base/render.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace lobe;
using nlohmann::json;

namespace {

struct Stage {
    Sources sources;
    Diagnostics diagnostics;

    Stage()
    {
        sources.add("models/a b.lobe", "x \u00E4 two\nthree\n");
        Diagnostic error{.code = Code::divisor_reaches_zero,
                         .message = "m \"q\"",
                         .primary = {{0, 5, 8}, "seen"}};
        error.secondary = {{{0, 9, 14}, "there"}};
        error.notes = {"n"};
        error.helps = {"h"};
        error.fix = Fix{{0, 5, 5}, "in", "insert"};
        diagnostics.report(error);
        diagnostics.report(
            {.code = Code::unused_name, .message = "w \xFF", .primary = {{9, 0, 0}, ""}});
    }
};

}  // namespace

TEST_CASE("JSON lines hold everything that a diagnostic says")
{
    const Stage stage;
    const std::string text = render_json(stage.sources, stage.diagnostics);
    const std::size_t end = text.find('\n');
    const json error = json::parse(text.substr(0, end));
    CHECK(error == json::parse(R"({
        "code": "E0501", "severity": "error", "message": "m \"q\"",
        "primary": {"path": "models/a b.lobe", "line": 1, "column": 5, "end_line": 1,
                    "end_column": 8, "offset": 5, "length": 3, "label": "seen"},
        "secondary": [{"path": "models/a b.lobe", "line": 2, "column": 1, "end_line": 2,
                       "end_column": 6, "offset": 9, "length": 5, "label": "there"}],
        "notes": ["n"], "helps": ["h"],
        "fix": {"path": "models/a b.lobe", "line": 1, "column": 5, "end_line": 1,
                "end_column": 5, "offset": 5, "length": 0, "replacement": "in", "text": "insert"}
    })"));
    const json warning = json::parse(text.substr(end + 1));
    CHECK(warning["severity"] == "warning");
    CHECK(warning["primary"].is_null());
    CHECK(warning["message"] == "w \uFFFD");
    CHECK(text.starts_with(R"({"code":"E0501","severity":"error","message":)"));
    CHECK(text.back() == '\n');
    CHECK(render_json(stage.sources, {}) == "");
}

TEST_CASE("a SARIF log has one run with the registry as its rules")
{
    const Stage stage;
    const json log = json::parse(render_sarif(stage.sources, stage.diagnostics, "1.2.3"));
    CHECK(log["version"] == "2.1.0");
    REQUIRE(log["runs"].size() == 1);
    const json& run = log["runs"][0];
    CHECK(run["tool"]["driver"]["name"] == "lobec");
    CHECK(run["tool"]["driver"]["version"] == "1.2.3");
    CHECK(run["columnKind"] == "unicodeCodePoints");
    CHECK(run["tool"]["driver"]["rules"].size() == all_codes().size());
    REQUIRE(run["results"].size() == 2);

    const json& error = run["results"][0];
    CHECK(error["ruleId"] == "E0501");
    const auto rule = error["ruleIndex"].get<std::size_t>();
    CHECK(run["tool"]["driver"]["rules"][rule]["id"] == "E0501");
    CHECK(error["level"] == "error");
    CHECK(error["message"]["text"] == "m \"q\": seen\nnote: n\nhelp: h");
    CHECK(error["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] ==
          "models/a%20b.lobe");
    CHECK(error["locations"][0]["physicalLocation"]["region"] ==
          json::parse(R"({"startLine": 1, "startColumn": 5, "endLine": 1, "endColumn": 8})"));
    CHECK(error["relatedLocations"][0]["message"]["text"] == "there");
    const json& change = error["fixes"][0]["artifactChanges"][0];
    CHECK(change["replacements"][0]["deletedRegion"]["endColumn"] == 5);
    CHECK(change["replacements"][0]["insertedContent"]["text"] == "in");

    CHECK(run["results"][1]["level"] == "warning");
    CHECK(run["results"][1]["locations"].empty());

    const json none = json::parse(render_sarif(stage.sources, {}, "1.2.3"));
    CHECK(none["runs"][0]["results"] == json::array());
}
