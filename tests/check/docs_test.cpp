// Doc comments: what is a citation, what is prose; bodies on one line.
#include "check/checking.h"
#include "check/docs.h"

#include <catch2/catch.hpp>

using namespace lobe;
using lobe::tests::check_text;

namespace {

std::string citations(const ir::Function& function)
{
    std::string text;
    for (const ir::Citation& citation : function.citations)
        text += "<" + citation.source + "|" + citation.locator + ">";
    return text;
}

}  // namespace

TEST_CASE("citations are taken out of the documentation", "[check][docs]")
{
    const auto checked = check_text(R"(
source slides = "Slides"
source Walter07 = "Walter"
/// Blend weight.
///
/// slides show it on page 85, among others.
/// slides 85
/// Walter07 eqs 33 34
/// Walter07 section 5.2
/// Walter07
/// Walter07 D
/// Figure 3 of the talk.
term f(x: unit) -> unit = x
)");
    CHECK(checked.errors() == "");
    const ir::Function& function = checked.function("f");
    CHECK(citations(function) ==
          "<slides|85><Walter07|eqs 33 34><Walter07|section 5.2><Walter07|><Walter07|D>");
    CHECK(function.doc ==
          "Blend weight.\n\nslides show it on page 85, among others.\nFigure 3 of the talk.");
}

TEST_CASE("a line that can only be a citation needs its source", "[check][docs]")
{
    const auto errors = [](const std::string& line) {
        return check_text("/// " + line + "\nterm f(x: unit) -> unit = x").errors();
    };
    CHECK(errors("slides 85") == "E0308");
    CHECK(errors("Walter07") == "E0308");
    CHECK(errors("Walter07 eq 33") == "E0308");
    CHECK(errors("Karis 2013, eq 5") == "");
    CHECK(errors("Schlick's approximation") == "");
    CHECK(errors("Weight") == "");
    CHECK(errors("At most 1 of 2") == "");
}

TEST_CASE("formulas are on one line, as written", "[check][docs]")
{
    const auto checked = check_text(R"(
/// f
term f(x: unit,
       y: unit) -> float {
  // the first part
  let a = 1 - x  // of two
  max(
    a *
      y,  // and the second
    0
  )
}
)");
    CHECK(checked.function("f").formula == "let a = 1 - x; max(a * y, 0)");
    CHECK(check::one_line("a  // b\n + c") == "a + c");
}

TEST_CASE("the module's documentation stands before it", "[check][docs]")
{
    Sources sources;
    Diagnostics diagnostics;
    const auto root = sources.add("models/m.lobe",
                                  "// About m.\n// More.\nmodule m\n/// f\nterm f(x: unit) = x\n");
    const auto module = check::check(sources, root, {}, diagnostics);
    REQUIRE(module);
    CHECK(module->doc == "About m.\nMore.");
    CHECK(module->name == "m");
    CHECK(module->path == "models/m.lobe");
}
