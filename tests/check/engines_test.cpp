// Engine blocks: what the editor offers, and whether it reaches the packing.
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace lobe;
using Catch::Contains;
using lobe::tests::check_layout;
using lobe::tests::only_error;
using lobe::tests::words;

namespace {

const std::string packing = R"(
packing cloth on console {
  d.r = fuzz : unorm 8 code power(3, 101/255)
  d.g = width : unorm 8 code linear(254/255)
}
)";

lobe::tests::Checked with(const std::string& lines, const std::string& before = packing)
{
    return check_layout(before + "\nengine console for cloth {\n" + lines + "\n}");
}

std::string refusal(const std::string& lines) { return only_error(with(lines)); }

}  // namespace

TEST_CASE("an engine block", "[check][engines]")
{
    const auto checked = with(R"(
  shading_model "Cloth 2"
  pin extra = fuzz
  pin opacity = width "How wide"
  color (0.25, 0.5, 1)
)");
    REQUIRE(checked.errors() == "");
    CHECK(checked.warnings() == "");
    const ir::Module& module = *checked.module;
    REQUIRE(module.engines.size() == 1);
    const ir::Engine& engine = module.engines[0];
    CHECK(engine.gbuffer == "console");
    CHECK(engine.model == "cloth");
    CHECK(engine.module == "m");
    CHECK(engine.shading_model == "Cloth 2");
    REQUIRE(engine.pins.size() == 2);
    CHECK(engine.pins[0].pin == 1);
    CHECK(module.parameters[engine.pins[0].parameter].name == "fuzz");
    // Without a label of its own a pin shows the parameter's.
    CHECK(engine.pins[0].label == "Fuzz");
    CHECK(engine.pins[1].label == "How wide");
    CHECK(!engine.node);
    REQUIRE(engine.color);
    CHECK(*engine.color == std::vector<double>{0.25, 0.5, 1});
}

TEST_CASE("a node feeds numbers and colors", "[check][engines]")
{
    const auto checked = with(
        "shading_model \"Cloth\"\nnode \"ClothParameters\" { tint, width }",
        "packing cloth on console {\n  d.r[0..4], d.r[5..7], d.g[0..1], d.g[2..6] = tint : "
        "unorm 5\n  d.b = width : unorm 8 code linear(254/255)\n  supports lighting == live\n}");
    REQUIRE(checked.errors() == "");
    const ir::Engine& engine = checked.module->engines.at(0);
    REQUIRE(engine.node);
    CHECK(engine.node->name == "ClothParameters");
    REQUIRE(engine.node->parameters.size() == 2);
    CHECK(checked.module->parameters[engine.node->parameters[0]].name == "tint");
}

TEST_CASE("what an engine block gets wrong", "[check][engines]")
{
    const std::string rest = "\nshading_model \"Cloth\"\npin extra = fuzz\npin opacity = width";
    const std::string fed = "shading_model \"Cloth\"\n";
    CHECK_THAT(refusal("pin extra = fuzz\npin opacity = width"),
               Contains("names no shading model"));
    CHECK_THAT(refusal("shading_model \"Other\"" + rest), Contains("two names"));
    for (const std::string name : {"", "2 Cloth", "Cloth!", "Cloth_2", " Cloth", "Cloth "}) {
        CAPTURE(name);
        CHECK_THAT(refusal("shading_model \"" + name + "\"\npin extra = fuzz\npin opacity = width"),
                   Contains("E0611 a shading model is named by letters"));
    }
    CHECK_THAT(refusal(fed + "pin extra = fuzz\nnode \"My Node\" { width }"), Contains("E0611"));
    CHECK_THAT(refusal(fed + "pin extra = fuzz\nnode \"N\" { width }\nnode \"M\" { width }"),
               Contains("two nodes"));
    CHECK_THAT(refusal("color (0, 0, 1.5)" + rest), Contains("in [0, 1]") && Contains("1.5"));
    CHECK_THAT(refusal("color (0, 0, 1)\ncolor (0, 0, 1)" + rest), Contains("two colors"));
    CHECK_THAT(refusal(fed + "pin extra = fuzz\npin depth = width"),
               Contains("E0611 `console` has no pin `depth`"));
    CHECK_THAT(refusal(fed + "pin extra = fuzz\npin extra = width"),
               Contains("the pin `extra` feeds two parameters"));
    CHECK_THAT(refusal(fed + "pin extra = fuzz\npin opacity = width\nnode \"N\" { width }"),
               Contains("`width` is fed twice"));
    CHECK_THAT(refusal("node \"N\" { twist }" + rest),
               Contains("E0611 `twist` is fed, and no field stores it"));
    CHECK_THAT(refusal("node \"N\" { weight }" + rest),
               Contains("E0611 the model `cloth` does not read `weight`"));
    CHECK_THAT(refusal("node \"N\" { fuzzz }" + rest), Contains("E0301"));
}

TEST_CASE("a pin is one number", "[check][engines]")
{
    CHECK_THAT(only_error(with("shading_model \"Cloth\"\npin extra = tint",
                               "packing cloth on console { d.rgb = tint : unorm 8 supports "
                               "lighting == live }")),
               Contains("the pin `extra` is one number, and `tint` is a color"));
}

TEST_CASE("a pin that clamps what is carried", "[check][engines]")
{
    const std::string rest = "shading_model \"Cloth\"\n";
    CHECK_THAT(refusal(rest + "pin opacity = fuzz\npin extra = width"),
               Contains("E0607 the pin `opacity` does not let all of `fuzz` pass") &&
                   Contains("fuzz = 16 arrives as 1") && Contains("`extra`"));
    // What is not carried need not pass.
    CHECK(with(rest + "pin opacity = fuzz",
               "packing cloth on console { d.r = fuzz : unorm 8 in [0, 1] }")
              .errors()
              .empty());
    CHECK_THAT(only_error(with(rest + "pin opacity = twist",
                               "packing cloth on console { d.r = twist : snorm 8 in [-1, 1] }")),
               Contains("twist = -1 arrives as 0"));
}

TEST_CASE("without a packing what is fed has no place", "[check][engines]")
{
    CHECK_THAT(only_error(with("shading_model \"Cloth\"\npin extra = width", "")),
               Contains("E0611 no packing stores `cloth` on `console`"));
    // One that has errors is not missing.
    CHECK(with("shading_model \"Cloth\"\npin extra = width",
               "packing cloth on console { d.q = width : unorm 8 }")
              .errors() == "E0601");
}

TEST_CASE("what is packed and not fed is a warning", "[check][engines]")
{
    const auto checked = with("shading_model \"Cloth\"\npin extra = fuzz");
    CHECK(checked.module.has_value());
    REQUIRE(checked.warnings() == "W0601");
    CHECK_THAT(words(checked.diagnostics.all()[0]),
               Contains("`width` is packed, but no pin or node feeds it"));
    // A color is one parameter.
    CHECK(with("shading_model \"Cloth\"",
               "packing cloth on console { d.rgb = tint : unorm 8 supports lighting == live }")
              .warnings() == "W0601");
    // Without an engine block nothing can be fed.
    CHECK(check_layout(packing).warnings() == "");
}

TEST_CASE("whatever word is missing, doubled or swapped, the check has an answer",
          "[check][engines]")
{
    // As one module: what cloth.lobe and console.lobe declare, a packing and an engine block.
    const auto body = [](const std::string& path) {
        const std::string text = lobe::tests::file_text(path);
        return text.substr(text.find('\n', text.find("\nmodule") + 1));
    };
    const std::string text = body("diagnostics/cloth.lobe") + body("diagnostics/console.lobe") +
                             packing +
                             "engine console for cloth {\n  shading_model \"Cloth\"\n  pin extra "
                             "= fuzz\n  node \"More\" { width }\n  color (0, 0.5, 1)\n}\n";
    REQUIRE(lobe::tests::check_text(text).errors() == "");

    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(" \n", at), text.size() - 1) + 1;
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    REQUIRE(words.size() > 200);
    for (std::size_t i = 0; i < words.size(); ++i)
        for (const int change : {0, 1, 2}) {
            std::vector<std::string> changed = words;
            if (change == 0) changed[i].clear();
            if (change == 1) changed[i] += " " + words[i];
            if (change == 2) std::swap(changed[i], changed[(i * 7 + 3) % words.size()]);
            std::string other;
            for (const std::string& word : changed) other += word;
            CAPTURE(i, change, words[i]);
            // Either it means a module that keeps its promises, or it is refused: see check_text.
            lobe::tests::check_text(other);
        }
}
