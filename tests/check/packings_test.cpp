// Packings: what a good one becomes, and what is said of one that its engine cannot hold.
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using Catch::Contains;
using lobe::tests::check_layout;
using lobe::tests::check_text;
using lobe::tests::file_text;
using lobe::tests::inputs_of;
using lobe::tests::only_error;
using lobe::tests::value_at;
using lobe::tests::words;

namespace {

const std::string good = R"(
/// How cloth is stored.
packing cloth on console {
  d.r[2..7] = width : unorm 6 code linear(62/63)
  d.r[0..1], d.g = fuzz : unorm 10 in [0, 8] code power(3, 500/1023)
  over roughness in [0.1, 1]
  over fuzz in [0, 4]
  supports quality == low, high
  supports lighting == live
  without occlusion
  require exact fuzz == 1, fuzz == 0
  require radiance error < 2.5%
}
)";

std::string names(const ir::Module& module)
{
    std::string text;
    for (const ir::Function& function : module.functions)
        text += (text.empty() ? "" : " ") + function.name;
    return text;
}

std::string packed(const std::string& lines)
{
    return only_error(check_layout("packing cloth on console {\n" + lines + "\n}"));
}

std::string errors(const std::string& lines)
{
    return check_layout("packing cloth on console {\n" + lines + "\n}").errors();
}

}  // namespace

TEST_CASE("a packing of an imported model", "[check][packings]")
{
    const auto checked = check_layout(good);
    REQUIRE(checked.errors() == "");
    CHECK(checked.warnings() == "");
    const ir::Module& module = *checked.module;
    // The model comes along, with its outputs and what they read, and is not the module's own.
    CHECK(module.models.empty());
    CHECK(module.roots().empty());
    CHECK(names(module).starts_with("cloth_diffuse encode_"));
    REQUIRE(module.parameters.size() == 4);
    CHECK(module.parameters[0].name == "fuzz");
    REQUIRE(module.gbuffers.size() == 1);
    CHECK(module.gbuffers[0].module == "console");

    REQUIRE(module.packings.size() == 1);
    const ir::Packing& packing = module.packings[0];
    CHECK(packing.model.name == "cloth");
    CHECK(packing.model.module == "cloth");
    CHECK(module[packing.model.outputs.at(0).function].name == "cloth_diffuse");
    CHECK(packing.gbuffer == "console");
    CHECK(packing.module == "m");
    CHECK(packing.doc == "How cloth is stored.");
    REQUIRE(packing.fields.size() == 2);
    CHECK(ir::field_name(module, packing.fields[0]) == "width");
    CHECK(packing.fields[0].slots == std::vector<ir::Slot>{{2, 2, 6}});
    CHECK(packing.fields[1].slots == std::vector<ir::Slot>{{2, 0, 2}, {3, 0, 8}});
    CHECK(packing.fields[1].bits == 10);
    CHECK(packing.fields[1].range == ir::Range{0, 8});
    CHECK(describe(packing.fields[1].code, 10) == "power(3, 500/1023)");
    REQUIRE(packing.exact.size() == 2);
    CHECK(packing.exact[1].value == 0);
    CHECK(packing.radiance_limit == 0.025);
    REQUIRE(packing.measured.size() == 2);
    CHECK(packing.measured[1].range == ir::Range{0, 4});
    CHECK(packing.without == std::vector<std::string>{"occlusion"});

    // baked: none; live: low and high.
    CHECK(packing.supported == ir::Configurations{false, false, false, true, true, false});
}

TEST_CASE("the functions of a packing are in the module", "[check][packings]")
{
    const auto checked = check_layout(good);
    REQUIRE(checked.module);
    const ir::Module& module = *checked.module;
    const ir::Packing& packing = module.packings[0];
    REQUIRE(packing.channels.size() == 2);
    REQUIRE(packing.parameters.size() == 2);
    CHECK(inputs_of(module[packing.channels[0].pack]) == "fuzz width");
    CHECK(inputs_of(module[packing.channels[1].pack]) == "fuzz");
    // 1 is code 500, which is 01 11110100; 0.5 is code 31. The factor 1 / 255 is a float, rounded
    // down: less than 2^-23 of it is lost.
    CHECK(value_at(module, module[packing.channels[0].pack], {1, 0.5}) ==
          Approx((31 * 4 + 1) / 255.0).epsilon(0x1p-23));
    CHECK(value_at(module, module[packing.channels[1].pack], {1}) ==
          Approx(0xF4 / 255.0).epsilon(0x1p-23));
    const auto& unpacked = packing.parameters[0];
    CHECK(module.parameters[unpacked.parameter].name == "fuzz");
    CHECK(value_at(module, module[unpacked.unpack], {125 / 255.0, 0xF4 / 255.0}) == 1);
}

TEST_CASE("a color takes a field per component", "[check][packings]")
{
    const auto checked = check_layout(
        "packing cloth on console {\n  d.rgb = tint : unorm 8\n  supports lighting == live\n}");
    REQUIRE(checked.errors() == "");
    const auto& fields = checked.module->packings.at(0).fields;
    REQUIRE(fields.size() == 3);
    for (int i = 0; i < 3; ++i) {
        const auto index = static_cast<std::size_t>(i);
        CHECK(fields[index].component == i);
        CHECK(fields[index].slots == std::vector<ir::Slot>{{2 + index, 0, 8}});
    }
    // Or part of a channel each, or a line each, in any order.
    CHECK(errors("d.r[0..4], d.r[5..7], d.g[0..1], d.g[2..6] = tint : unorm 5").empty());
    CHECK(errors("d.g = tint.b : unorm 8\nd.r[0..3] = tint.r : unorm 4\n"
                 "d.r[4..7] = tint.g : unorm 4")
              .empty());
    CHECK_THAT(packed("d.r, d.g = tint : unorm 5"), Contains("`tint` takes 15 bits"));
    CHECK_THAT(packed("d.r, d.g[0..6] = tint : unorm 5"),
               Contains("`tint.r` do not end where a slot ends"));
    CHECK_THAT(packed("d.r = tint.r : unorm 8\nd.g = tint.b : unorm 8"),
               Contains("E0603 `tint` is packed in part") && Contains("nothing stores `tint.g`"));
    CHECK_THAT(packed("d.r = tint.x : unorm 8"), Contains("E0309"));
    CHECK_THAT(packed("d.r = fuzz.r : unorm 8"), Contains("it is one number"));
}

TEST_CASE("a model and a gbuffer of the module itself", "[check][packings]")
{
    const auto checked = check_text(R"(
param strength : unit = 1
/// Not read by the model.
param other : unit = 1
model glow(g: geometry) { diffuse = strength * g.cos_i }
gbuffer here {
  target t "T" { format unorm 4 channel r "R" { field "R" } }
}
packing glow on here { t.r = strength : unorm 4 }
engine here for glow {
  shading_model "Glow"
  node "GlowNode" { strength }
}
)");
    REQUIRE(checked.errors() == "");
    CHECK(checked.module->models.size() == 1);
    CHECK(checked.module->roots().size() == 1);
    CHECK(checked.module->packings.at(0).model.module == "m");
    CHECK(checked.module->engines.at(0).model == "glow");
}

TEST_CASE("imports that only a packing needs are used, others are not", "[check][packings]")
{
    const std::string packing = "packing cloth on console { d.r = width : unorm 8 code "
                                "linear(254/255) }\n";
    CHECK(check_layout(packing).warnings() == "");
    CHECK(check_layout("import cloth { width }\n" + packing).warnings() == "");
    CHECK(check_layout("import cloth { fuzz }\n" + packing).warnings() == "W0301");
    CHECK(check_layout("").warnings() == "W0301 W0301");
    // A gbuffer that nothing names does not come along.
    const auto unused = check_layout("");
    REQUIRE(unused.module);
    CHECK(unused.module->gbuffers.empty());
}

TEST_CASE("slots are where the gbuffer has channels and bits", "[check][packings]")
{
    CHECK_THAT(packed("e.r = width : unorm 8"), Contains("E0601 `console` has no target `e`"));
    CHECK_THAT(packed("d.q = width : unorm 8"), Contains("E0601 `d` has no channel `q`"));
    CHECK_THAT(packed("d.rq = width : unorm 8"), Contains("E0601 `d` has no channel `rq`"));
    CHECK_THAT(packed("d.r[8] = width : unorm 1"), Contains("E0601 `d.r` has no bit 8"));
    CHECK_THAT(packed("d.rg[0..3] = width : unorm 8"), Contains("E0601"));
}

TEST_CASE("two fields in one bit", "[check][packings]")
{
    const std::string one = packed("d.r[0..4] = fuzz : unorm 5 code power(4, 15/31)\n"
                                   "d.r[4..7] = width : unorm 4 code linear(14/15)");
    CHECK_THAT(one, Contains("E0602 `fuzz` and `width` share a bit of `d.r`") &&
                        Contains("bit 4 is taken") && Contains("by `fuzz`"));
    CHECK_THAT(packed("d.r[0..3], d.r[3..6] = fuzz : unorm 8 code power(3, 101/255)"),
               Contains("E0602 `fuzz` takes a bit twice"));
}

TEST_CASE("more bits than there are", "[check][packings]")
{
    const auto checked =
        check_layout("packing cloth on console {\n  d.r = fuzz : unorm 8 code power(3, 101/255)\n"
                     "  d.g = width : unorm 8 code linear(254/255)\n  d.rg[0] = tint : unorm 8\n}");
    CHECK(checked.errors() == "E0601");
    const auto over =
        check_layout("packing cloth on console {\n  d.r = fuzz : unorm 8 code power(3, 101/255)\n"
                     "  d.g = width : unorm 8 code linear(254/255)\n  d.rgr = tint : unorm 8\n}");
    std::string budget;
    for (const Diagnostic& diagnostic : over.diagnostics.all())
        if (diagnostic.code == Code::budget_exceeded) budget = words(diagnostic);
    CHECK_THAT(budget, Contains("need 40 bits, and `console` has 16") &&
                           Contains("d.r with 8, d.g with 8"));
}

TEST_CASE("a channel that somebody else uses", "[check][packings]")
{
    const std::string width = " = width : unorm 8 code linear(254/255)\n";
    CHECK_THAT(packed("d.b" + width),
               Contains("E0604 `d.b` is not the model's alone") &&
                   Contains("where Lighting = baked it is also read by the fog") &&
                   Contains("`supports lighting == live`"));
    CHECK(errors("d.b" + width + "supports lighting == live").empty());
    CHECK_THAT(packed("c.r" + width), Contains("in every configuration it holds the color") &&
                                          Contains("store it in another channel"));
    CHECK_THAT(packed("c.a" + width + "supports lighting == live\nsupports quality == low"),
               Contains("it holds occlusion, which the sky reads") &&
                   Contains("`without occlusion`"));
    CHECK_THAT(packed("c.a" + width +
                      "supports lighting == live\nsupports quality == low, high\n"
                      "without occlusion"),
               Contains("where Lighting = live, Quality = high it is changed by the sky, which "
                        "scales it") &&
                   Contains("`supports quality == low`"));
    CHECK(errors("c.a" + width +
                 "supports lighting == live\nsupports quality == low\nwithout occlusion")
              .empty());
}

TEST_CASE("a channel that is not always there", "[check][packings]")
{
    const std::string width = "c.a = width : unorm 8 code linear(254/255)\nwithout occlusion\n";
    CHECK_THAT(packed(width + "supports quality == low"),
               Contains("E0605 `c.a` is not there") &&
                   Contains("where Lighting = baked it reads 1") &&
                   Contains("`supports lighting == live`"));
    CHECK_THAT(packed(width + "supports quality == low, best\nsupports lighting == live"),
               Contains("E0605 `c.a` does not hold codes") &&
                   Contains("Quality = best it is float 16, which holds no codes") &&
                   Contains("`supports quality == low`"));
    CHECK_THAT(packed(width + "supports quality == low, best"),
               Contains("`supports lighting == live` and `supports quality == low`"));
}

TEST_CASE("a channel has the bits that it has everywhere it has to work", "[check][packings]")
{
    const std::string gbuffer = R"(
param strength : unit = 1
model glow(g: geometry) { diffuse = strength * g.cos_i }
gbuffer here {
  setting depth "Depth" : deep, shallow = deep
  target t "T" {
    format unorm 10 when depth == deep
    format unorm 8
    channel r "R" { field "R" }
  }
}
packing glow on here { )";
    // A whole channel is as wide as the narrowest; the codes of 8 bits survive in 10.
    const auto whole = check_text(gbuffer + "t.r = strength : unorm 8 }");
    REQUIRE(whole.errors() == "");
    const ir::Packing& packing = whole.module->packings[0];
    const ir::Function& pack = (*whole.module)[packing.channels[0].pack];
    const ir::Function& unpack = (*whole.module)[packing.parameters[0].unpack];
    for (int code = 0; code <= 255; ++code) {
        const double stored = value_at(*whole.module, pack, {code / 255.0});
        for (const int last : {255, 1023}) {
            const double read = std::floor(stored * last + 0.5) / last;
            CAPTURE(code, last);
            CHECK(std::round(value_at(*whole.module, unpack, {read}) * 255) == code);
        }
    }
    CHECK_THAT(only_error(check_text(gbuffer + "t.r[8..9] = strength : unorm 2 }")),
               Contains("E0605") &&
                   Contains("where Depth = shallow it is unorm 8, and bit 9 is "
                            "used") &&
                   Contains("`supports depth == deep`"));
    CHECK(
        check_text(gbuffer + "t.r[8..9] = strength : unorm 2 supports depth == deep }").errors() ==
        "");
    CHECK_THAT(only_error(check_text(gbuffer + "t.r[8..10] = strength : unorm 3 }")),
               Contains("E0601 `t.r` has no bit 10"));
}

TEST_CASE("storage that does not fit", "[check][packings]")
{
    CHECK_THAT(packed("d.r = width : unorm 7"),
               Contains("E0603 `width` takes 7 bits, and its slots have 8") && Contains("unorm 8"));
    CHECK_THAT(packed("d.r = width : float 8"), Contains("E0603"));
    CHECK_THAT(packed("d.r = width : unorms 8"), Contains("did you mean `unorm`?"));
    CHECK_THAT(packed("d.r[0] = width : snorm 1"), Contains("E0603 snorm has 2 to 16 bits"));
    CHECK_THAT(packed("d.rg, d.r = width : unorm 24"), Contains("E0603 unorm has 1 to 16 bits"));
    CHECK_THAT(packed("d.r = width : unorm 8 in [0, 2]"),
               Contains("2 is outside of its range") && Contains("its range is [0, 1]"));
    CHECK_THAT(packed("d.r = twist : unorm 8"), Contains("E0607 `twist` has no range"));
    CHECK(errors("d.r = twist : snorm 8 in [-2, 2]").empty());
}

TEST_CASE("names in a packing", "[check][packings]")
{
    CHECK_THAT(packed("d.r = fuz : unorm 8"),
               Contains("E0301 `cloth` has no parameter `fuz`; did you mean `fuzz`?"));
    CHECK_THAT(packed("d.r = weight : unorm 8"),
               Contains("E0615 the model `cloth` does not read `weight`"));
    CHECK_THAT(packed("d.r = width : unorm 8 code linear(254/255)\n"
                      "d.g = width : unorm 8 code linear(254/255)"),
               Contains("E0302 `width` is packed twice"));
    CHECK_THAT(only_error(check_layout("packing clothes on console { d.r = width : unorm 8 }")),
               Contains("E0301 no model is called `clothes`; did you mean `cloth`?"));
    CHECK_THAT(only_error(check_layout("packing cloth on ue4 { d.r = width : unorm 8 }")),
               Contains("E0301 no gbuffer is called `ue4`"));
    CHECK_THAT(only_error(check_layout("packing console on console { d.r = width : unorm 8 }")),
               Contains("E0301 `console` is a gbuffer, not a model"));
    CHECK_THAT(only_error(check_layout(good + "packing cloth on console { }")),
               Contains("E0302 a module has one packing"));
}

TEST_CASE("clauses that make no sense", "[check][packings]")
{
    const std::string field = "d.r = fuzz : unorm 8 code power(3, 101/255)\n";
    for (const std::string clause :
         {"supports weather == rain", "supports quality == medium",
          "supports quality == low\nsupports quality == high", "without color", "without nothing",
          "require exact width == 1", "require exact fuzz == 17", "require radiance error < 0%",
          "require radiance error < 1%\nrequire radiance error < 2%", "over alpha in [0.1, 1]",
          "over roughness in [0, 1]", "over fuzz in [0, 17]",
          "over fuzz in [0, 4]\nover fuzz in [0, 4]", "over weight in [0, 1]"}) {
        CAPTURE(clause);
        CHECK(errors(field + clause) == "E0615");
    }
    CHECK(errors(field + "require exact depth == 1") == "E0301");
    CHECK(errors(field + "over depth in [0, 1]") == "E0301");
    CHECK(errors(field + "require exact fuzz == fuzz") == "E0508");
    CHECK(errors(field + "over fuzz in [4, 0]") == "E0505");
    CHECK(errors(field + "over f0 in [0.02, 1]").empty());
}

TEST_CASE("one thing wrong is said once", "[check][packings]")
{
    // A model that cannot be checked is not blamed on its packing, nor a gbuffer.
    CHECK(check_text(
              "param a : unit = 1\nmodel x(g: geometry) { diffuse = a / g.cos_i }\n"
              "gbuffer h { target t \"T\" { format unorm 8 channel r \"R\" { field \"R\" } } }\n"
              "packing x on h { t.r = a : unorm 8 }")
              .errors() == "E0501");
    CHECK(check_text("param a : unit = 1\nmodel x(g: geometry) { diffuse = a }\n"
                     "gbuffer h { target t \"T\" { format unorm 17 channel r \"R\" } }\n"
                     "packing x on h { t.r = a : unorm 8 }")
              .errors() == "E0614");
    CHECK(check_text("import nowhere { x, h }\npacking x on h { t.r = a : unorm 8 }").errors() ==
          "E0303");
    // A field that makes no sense is not missed by what is required of it, or by the engine.
    CHECK(errors("d.r = width : unorm 7\nrequire exact width == 1") == "E0603");
    CHECK(check_layout("packing cloth on console { d.r = width : unorm 7 }\n"
                       "engine console for cloth { shading_model \"Cloth\" pin extra = width }")
              .errors() == "E0603");
}
