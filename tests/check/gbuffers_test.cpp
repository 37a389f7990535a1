// Gbuffers: conditions become sets of configurations, facts of targets hold for their channels.
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

using namespace lobe;
using Catch::Contains;
using lobe::tests::check_text;
using lobe::tests::only_error;

namespace {

/// A gbuffer of three settings and one channel with these facts.
std::string with_facts(const std::string& facts)
{
    return R"(
gbuffer g {
  setting version "Version" : v1, v2, v3 = v3
  setting light "Light" : baked, live = live
  setting depth "Depth" : off, on = off
  target d "Data" {
    format unorm 8
    channel r "Data.x" { field "Data.x" )" +
           facts + R"( }
  }
}
)";
}

/// The configurations where a condition holds, as values: `v1 live on, …`.
std::string where(const std::string& condition)
{
    const auto checked = check_text(with_facts("exists when " + condition));
    REQUIRE(checked.errors() == "");
    const ir::Gbuffer& gbuffer = checked.module->gbuffers.at(0);
    std::string text;
    for (std::size_t i = 0; i < gbuffer.configurations(); ++i) {
        if (!gbuffer.channels[0].exists[i]) continue;
        text += text.empty() ? "" : ", ";
        const auto values = gbuffer.values(i);
        for (std::size_t k = 0; k < values.size(); ++k)
            text += (k == 0 ? "" : " ") + gbuffer.settings[k].values[values[k]];
    }
    return text;
}

std::string refusal(const std::string& condition)
{
    return only_error(check_text(with_facts("exists when " + condition)));
}

}  // namespace

TEST_CASE("conditions are decided for every configuration", "[check][gbuffers]")
{
    CHECK(where("version == v2 and light == live") == "v2 live off, v2 live on");
    CHECK(where("version > v2 and depth != off") == "v3 baked on, v3 live on");
    CHECK(where("version >= v2 and depth == on and not light == baked") ==
          "v2 live on, v3 live on");
    CHECK(where("version < v2 and light == live or version <= v1 and depth == on") ==
          "v1 baked on, v1 live off, v1 live on");
    // The value may stand on the left; what is compared turns with it.
    CHECK(where("v2 < version and on == depth") == "v3 baked on, v3 live on");
    CHECK(where("v2 >= version and on == depth and light == live") == "v1 live on, v2 live on");
    // Parentheses, and conditions that never hold.
    CHECK(where("not (version == v1 or version == v2) and (depth == on)") ==
          "v3 baked on, v3 live on");
    CHECK(where("version == v1 and version == v2").empty());
}

TEST_CASE("a long condition takes no stack", "[check][gbuffers]")
{
    std::string condition = "depth == on";
    for (int i = 0; i < 200; ++i) condition += " and depth == on";
    CHECK(where(condition).starts_with("v1 baked on, "));
}

TEST_CASE("conditions are about settings and their values", "[check][gbuffers]")
{
    CHECK_THAT(refusal("light"), Contains("E0614 `light` is a setting, not a condition") &&
                                     Contains("`light == live`"));
    CHECK_THAT(refusal("light == livee"), Contains("did you mean `live`?"));
    CHECK_THAT(refusal("light == v1"), Contains("the setting `light` has no value `v1`"));
    CHECK_THAT(refusal("weather == rain"), Contains("`g` has no setting `weather`"));
    CHECK_THAT(refusal("light == 1"), Contains("E0614"));
    CHECK_THAT(refusal("light + depth == live"), Contains("E0614"));
    CHECK_THAT(refusal("not light"), Contains("E0614"));
    CHECK_THAT(refusal("max(light, depth) == live"), Contains("E0614"));
    CHECK_THAT(refusal("if light == live then depth == on else depth == off"), Contains("E0614"));
}

TEST_CASE("facts of a target hold for channels that say nothing else", "[check][gbuffers]")
{
    const auto checked = check_text(R"(
/// For tests.
gbuffer g {
  /// Which one.
  setting light "r.Light" : baked, live = live
  /// Its targets.
  target d "Data" {
    format float 16 when light == baked
    format unorm 8
    exists when light == live else 0.5
    holds depth "the depth" lent
    also "the fog"
    /// A channel.
    channel r "Data.x"
    channel g "Data.y" {
      field "Pixel.y"
      format unorm 10
      exists when light == baked or light == live
      holds fog "the fog" when light == baked
      changes "the sky" when light == live
    }
  }
  /// A pin.
  pin opacity "Opacity" in [0, 1] = 0.25
  pin raw "Raw" = -3
}
)");
    REQUIRE(checked.errors() == "");
    const ir::Gbuffer& gbuffer = checked.module->gbuffers.at(0);
    CHECK(gbuffer.name == "g");
    CHECK(gbuffer.module == "m");
    CHECK(gbuffer.doc == "For tests.");
    REQUIRE(gbuffer.settings.size() == 1);
    CHECK(gbuffer.settings[0].label == "r.Light");
    CHECK(gbuffer.settings[0].doc == "Which one.");
    CHECK(gbuffer.default_configuration() == 1);
    CHECK(gbuffer.targets.at(0).doc == "Its targets.");

    const ir::Channel& plain = gbuffer.channels.at(0);
    CHECK(gbuffer.name_of(plain) == "d.r");
    CHECK(plain.doc == "A channel.");
    CHECK(plain.field.empty());
    CHECK(describe(plain.formats.at(0)) == "float 16");
    CHECK(describe(plain.formats.at(1)) == "unorm 8");
    CHECK(plain.exists == ir::Configurations{false, true});
    CHECK(plain.absent_value == 0.5);
    REQUIRE(plain.holders.size() == 1);
    CHECK(plain.holders[0].lent);
    CHECK(plain.consumers.at(0).text == "the fog");

    const ir::Channel& own = gbuffer.channels.at(1);
    CHECK(own.field == "Pixel.y");
    CHECK(describe(own.formats.at(0)) == "unorm 10");
    CHECK(own.exists == ir::Configurations{true, true});
    CHECK(own.absent_value == 0);
    REQUIRE(own.holders.size() == 2);
    CHECK(own.holders[1].name == "fog");
    CHECK(own.holders[1].when == ir::Configurations{true, false});
    CHECK(own.changes.at(0).when == ir::Configurations{false, true});

    REQUIRE(gbuffer.pins.size() == 2);
    CHECK(gbuffer.pins[0].range == ir::Range{0, 1});
    CHECK(gbuffer.pins[0].default_value == 0.25);
    CHECK(gbuffer.pins[0].doc == "A pin.");
    CHECK(!gbuffer.pins[1].range);
    CHECK(gbuffer.pins[1].default_value == -3);
}

TEST_CASE("a module may declare nothing but a gbuffer", "[check][gbuffers]")
{
    const auto checked = check_text(with_facts(""));
    REQUIRE(checked.module);
    CHECK(checked.warnings() == "");
    CHECK(checked.module->functions.empty());
    CHECK(checked.module->roots().empty());
    CHECK(checked.module->gbuffers.size() == 1);
}

TEST_CASE("what a gbuffer contradicts itself about", "[check][gbuffers]")
{
    const auto errors = [](const std::string& body) {
        return check_text("gbuffer g {\n" + body + "\n}").errors();
    };
    CHECK(errors("setting a \"A\" : x, y = x\nsetting a \"B\" : x, y = x") == "E0302");
    CHECK(errors("setting a \"A\" : x, x = x") == "E0302");
    CHECK(errors("setting a \"A\" : x, y = z") == "E0614");
    CHECK(errors("target t \"T\" { format unorm 8 }\ntarget t \"U\" { format unorm 8 }") ==
          "E0302");
    CHECK(errors("target t \"T\" { format unorm 8 channel r \"R\" channel r \"S\" }") == "E0302");
    CHECK(errors("pin p \"P\" = 0\npin p \"Q\" = 0") == "E0302");
    CHECK(errors("pin p \"P\" in [0, 1] = 2") == "E0504");
    CHECK(errors("pin p \"P\" in [1, 0] = 0") == "E0505");
    CHECK(errors("target t \"T\" { channel r \"R\" }") == "E0614");
    CHECK(errors("target t \"T\" { format unorm 8 holds a \"A\" holds a \"B\" channel r \"R\" }") ==
          "E0302");
    for (const std::string wrong : {"unorm 0", "unorm 17", "snorm 17", "float 8", "srgb 10"})
        CHECK(errors("target t \"T\" { format " + wrong + " channel r \"R\" }") == "E0614");
    for (const std::string right : {"unorm 1", "unorm 16", "snorm 16", "float 32", "srgb 8"})
        CHECK(errors("target t \"T\" { format " + right + " channel r \"R\" }").empty());
}

TEST_CASE("configurations are counted before any is looked at", "[check][gbuffers]")
{
    std::string settings;
    for (int i = 0; i < 12; ++i)
        settings += "setting s" + std::to_string(i) + " \"S\" : off, on = off\n";
    CHECK(check_text("gbuffer g {\n" + settings + "}").errors().empty());
    CHECK(check_text("gbuffer g {\n" + settings + "setting t \"T\" : off, on = off\n}").errors() ==
          "E0614");
    for (int i = 12; i < 80; ++i)
        settings += "setting s" + std::to_string(i) + " \"S\" : off, on = off\n";
    CHECK(check_text("gbuffer g {\n" + settings + "}").errors() == "E0614");
}
