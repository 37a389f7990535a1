// Imports: what comes along, what collides, what is loaded once.
#include "check/checking.h"

#include <catch2/catch.hpp>

using namespace lobe;
using lobe::tests::check_text;
using lobe::tests::inputs_of;

namespace {

const std::string lib = R"(module lib
source Walter07 = "Walter et al. 2007"
tier base
/// Gain.
param gain : float in [0, 4] = 2 base "Gain"
/// Not needed by anyone.
param other : unit = 0
/// Scales.
/// Walter07 eq 1
term scaled(x: unit) -> float in [0, 4] = gain * half(x)
/// Half.
term half(x: unit) -> unit = x / 2
  /// Also half.
  form doubled = 0.5 * x
/// Not needed by anyone either.
term unused(x: unit) -> unit = x * other
)";

}  // namespace

TEST_CASE("an imported term brings along what it uses, with its forms, and no more",
          "[check][modules]")
{
    const auto checked = check_text(R"(
import lib { scaled }
param mine : unit = 1
/// f
term f(x: unit) -> float = scaled(x) * mine
)",
                                    {{"lib", lib}});
    REQUIRE(checked.errors() == "");
    std::string names;
    for (const ir::Function& function : checked.module->functions) names += function.name + " ";
    CHECK(names == "half half_doubled scaled f ");
    REQUIRE(checked.module->parameters.size() == 2);
    CHECK(checked.module->parameters[0].name == "gain");
    CHECK(checked.module->parameters[0].module == "lib");
    CHECK(checked.module->parameters[1].name == "mine");
    CHECK(inputs_of(checked.function("f")) == "x gain mine");
    CHECK(checked.function("f").inputs[1].which == 0);
    CHECK(checked.function("f").inputs[2].which == 1);
    REQUIRE(checked.module->sources.size() == 1);
    CHECK(checked.module->sources[0].text == "Walter et al. 2007");
    CHECK(checked.function("scaled").module == "lib");
    CHECK(checked.module->owns(checked.function("f")));
    CHECK(checked.module->tiers == std::vector<std::string>{"base"});
}

TEST_CASE("forms and parameters are imported by name", "[check][modules]")
{
    const auto checked = check_text(R"(
import lib { half_doubled, gain }
/// f
term f(x: unit) -> float = half_doubled(x) * gain
)",
                                    {{"lib", lib}});
    REQUIRE(checked.errors() == "");
    CHECK(checked.warnings() == "");
    const ir::Function& form = checked.function("half_doubled");
    CHECK(form.kind == ir::Function::Kind::form);
    CHECK((*checked.module)[form.form_of].name == "half");
    CHECK(inputs_of(checked.function("f")) == "x gain");
}

TEST_CASE("a module is loaded once, whoever imports it", "[check][modules]")
{
    Sources sources;
    Diagnostics diagnostics;
    int loads = 0;
    const std::map<std::string, std::string> files{
        {"a", "module a\nimport c { f }\n/// a\nterm fa(x: unit) -> unit = f(x)"},
        {"b", "module b\nimport c { f }\n/// b\nterm fb(x: unit) -> unit = f(x)"},
        {"c", "module c\n/// f\nterm f(x: unit) -> unit = x"}};
    const auto root = sources.add(
        "m.lobe",
        "module m\nimport a { fa }\nimport b { fb }\n/// g\nterm g(x: unit) = fa(x) + fb(x)");
    const auto module = check::check(
        sources, root,
        [&](Sources& all, std::string_view name, std::string_view) -> std::optional<std::uint32_t> {
            ++loads;
            return all.add(std::string{name}, files.at(std::string{name}));
        },
        diagnostics);
    REQUIRE(module);
    CHECK(loads == 3);
    CHECK(module->functions.size() == 4);
}

TEST_CASE("what comes along may not take a name", "[check][modules]")
{
    CHECK(check_text("import lib { scaled }\nparam gain : unit = 1\n/// f\n"
                     "term f(x: unit) -> float = scaled(x) * gain",
                     {{"lib", lib}})
              .errors() == "E0302");
    CHECK(check_text("import lib { scaled }\n/// half\nterm half(x: unit) -> float = scaled(x)",
                     {{"lib", lib}})
              .errors() == "E0302");
}

TEST_CASE("sources of one name and other text are kept apart", "[check][modules]")
{
    const auto checked = check_text(R"(
import lib { scaled }
source Walter07 = "Another Walter"
/// f
/// Walter07 eq 2
term f(x: unit) -> float = scaled(x)
)",
                                    {{"lib", lib}});
    REQUIRE(checked.module);
    REQUIRE(checked.module->sources.size() == 2);
    CHECK(checked.function("f").citations[0].source == "Walter07");
    CHECK(checked.function("scaled").citations[0].source == "lib_Walter07");
}

TEST_CASE("one broken import is one message", "[check][modules]")
{
    const std::string use = "/// f\nterm f(x: unit) -> float = D(x) * D(x) + E(1, 2, 3)";
    CHECK(check_text("import lib { D, E }\n" + use).errors() == "E0303");
    CHECK(check_text("import lib { D, E }\n" + use, {{"lib", "module lib\nterm D(x: = 1"}})
              .errors() == "E0201");
    // The file is there, under another name.
    CHECK(check_text("import lib { D, E }\n" + use,
                     {{"lib", "module bib\n/// D\nterm D(x: unit) = x\n/// E\n"
                              "term E(x: unit, y: float, z: float) = x"}})
              .errors() == "E0303");
}

TEST_CASE("an error in an imported file is shown in that file", "[check][modules]")
{
    const auto checked =
        check_text("import lib { D }\n/// f\nterm f(x: unit) -> float = D(x)",
                   {{"lib", "module lib\nterm D(x: unit) -> float = 1 / x\nterm E(x: unit) = y"}});
    REQUIRE(checked.errors() == "E0501");
    CHECK(checked.sources.cite(checked.diagnostics.sorted()[0].primary.span) == "lib.lobe:2");
    // The import's undocumented terms are its own affair.
    CHECK(checked.warnings() == "");
}
