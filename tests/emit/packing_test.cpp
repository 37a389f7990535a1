// The file that packs and unpacks, and the drawing at its top.
#include "emit/emit.h"
#include "emit/layout.h"
#include "emit/packing.h"
#include "emit/packings.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

namespace lobe::tests {
namespace {

const emit::Target& target(const char* name) { return *emit::find_target(name); }

std::string packing_text(const Builder& b, const char* name)
{
    return emit::emit(b.module, b.sources, target(name)).back().text;
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
        ++found;
    return found;
}

}  // namespace

TEST_CASE("a module with packings has one more file per target", "[emit][packing]")
{
    const Builder b = packed_skin();
    std::vector<std::string> paths;
    for (const emit::Target& each : emit::targets())
        for (const emit::Artifact& artifact : emit::emit(b.module, b.sources, each))
            paths.push_back(artifact.path);
    CHECK(paths ==
          std::vector<std::string>{"skin/ue4/Skin.ush", "skin/ue4/SkinPacking.ush",
                                   "skin/glsl450/skin.glsl", "skin/glsl450/skin_packing.glsl",
                                   "skin/glsl330/skin.glsl", "skin/glsl330/skin_packing.glsl",
                                   "skin/essl310/skin.glsl", "skin/essl310/skin_packing.glsl",
                                   "skin/essl300/skin.glsl", "skin/essl300/skin_packing.glsl",
                                   "skin/hlsl/skin.hlsl", "skin/hlsl/skin_packing.hlsl"});
}

TEST_CASE("several targets at once have the files that each has alone", "[emit][packing]")
{
    const Builder b = packed_skin();
    std::vector<const emit::Target*> all;
    for (const emit::Target& each : emit::targets()) all.push_back(&each);
    const auto together = emit::emit(b.module, b.sources, all);
    std::size_t at = 0;
    for (const emit::Target* each : all)
        for (const emit::Artifact& alone : emit::emit(b.module, b.sources, *each)) {
            REQUIRE(at < together.size());
            CAPTURE(alone.path);
            CHECK(together[at].path == alone.path);
            CHECK(together[at].text == alone.text);
            CHECK(together[at].calls == alone.calls);
            ++at;
        }
    CHECK(at == together.size());
}

TEST_CASE("a module that only packs has no other file", "[emit][packing]")
{
    Builder b = packed_skin();
    b.module.models.clear();
    b.module.functions[0].module = "elsewhere";  // the model is imported
    b.module.packings[0].model.module = "elsewhere";
    const auto artifacts = emit::emit(b.module, b.sources, target("ue4"));
    REQUIRE(artifacts.size() == 1);
    CHECK(artifacts[0].path == "skin/ue4/SkinPacking.ush");
    // The macro is the one that the file of the model's own module looks for.
    CHECK(count(artifacts[0].text, "#define ELSEWHERE_SKIN_PARAMETERS( GBuffer, Parameters )") ==
          1);
    CHECK(count(artifacts[0].text, "void ElsewhereSkin_PackGBuffer(") == 1);
}

TEST_CASE("every channel is written, what is free in its target is 0, what is held is let be",
          "[emit][packing]")
{
    Builder b = packed_skin();
    const auto access = emit::gbuffer_access(b.module, 0);
    REQUIRE(access);
    CHECK(access->macro == "SKIN_PARAMETERS");
    CHECK(access->function == "Skin_PackGBuffer");
    CHECK(access->fields == std::vector<std::string>{"GBuffer.GBufferAO", "GBuffer.CustomData.x",
                                                     "GBuffer.CustomData.y", "GBuffer.CustomData.z",
                                                     "GBuffer.CustomData.w",
                                                     "GBuffer.PrecomputedShadowFactors.x"});
    CHECK(access->unused == std::vector<std::string>{"GBuffer.PrecomputedShadowFactors.y"});

    // The engine's own content is not cleared.
    ir::Channel& free = b.module.gbuffers[0].channels[7];
    free.holders.push_back({"shadow", "precomputed shadow", false, {true}, {}});
    CHECK(emit::gbuffer_access(b.module, 0)->unused.empty());
    // What no shader can name cannot be reached at all; the functions are there nevertheless.
    b.module.gbuffers[0].channels[2].field = "";
    CHECK_FALSE(emit::gbuffer_access(b.module, 0));
    const std::string text = packing_text(b, "ue4");
    CHECK(count(text, "#define") == 0);
    CHECK(count(text, "float Skin_UnpackGain( float DR )") == 1);
}

TEST_CASE("a model that is packed twice has both, under two names", "[emit][packing]")
{
    Builder b = packed_skin();
    ir::Gbuffer fork = b.module.gbuffers[0];
    fork.name = "my_fork";
    b.module.gbuffers.push_back(fork);
    ir::Packing again = b.module.packings[0];
    again.gbuffer = "my_fork";
    ir::build_functions(b.module, again, fork);
    b.module.packings.push_back(again);
    REQUIRE_FALSE(ir::verify(b.module));
    const std::string text = packing_text(b, "ue4");
    CHECK(count(text, "#define SKIN_PARAMETERS( GBuffer, Parameters ) \\") == 1);
    CHECK(count(text, "#define SKIN_ON_MY_FORK_PARAMETERS( GBuffer, Parameters ) \\") == 1);
    CHECK(count(text, "void Skin_PackGBuffer( ") == 1);
    CHECK(count(text, "void Skin_PackGBufferOnMyFork( ") == 1);
    CHECK(count(text, "// skin on ue4\n") == 1);
    CHECK(count(text, "// skin on my_fork\n") == 1);
}

TEST_CASE("functions of both files have two names", "[emit][packing]")
{
    // A code that calls what the model calls too.
    Builder b{"shared"};
    ir::Function& square = b.term("square", 3);
    {
        const ir::ExprId x = argument(square, "x");
        square.result = square.graph.apply(ir::Op::multiply, {x, x});
    }
    const auto calls_square = [&](const std::string& name, ir::Function::Kind kind) {
        ir::Function& f = b.term(name, 5);
        f.kind = kind;
        const std::array operands{argument(f, "y")};
        f.result = f.graph.call(ir::FunctionId{0}, ir::Type::scalar, operands);
    };
    calls_square("shade", ir::Function::Kind::output);
    calls_square("pack_d_r", ir::Function::Kind::storage);
    b.module.models.push_back({"m", "", "shared", b.line(4), {{"shade", ir::FunctionId{1}}}});
    ir::Packing packing;
    packing.model = b.module.models[0];
    packing.channels = {{0, ir::FunctionId{2}}};
    b.module.packings.push_back(packing);
    for (const char* name : {"ue4", "glsl450", "hlsl"}) {
        CAPTURE(name);
        const auto artifacts = emit::emit(b.module, b.sources, target(name));
        REQUIRE(artifacts.size() == 2);
        const std::string head =
            name == std::string{"ue4"} ? "float Shared_Square" : "float square";
        CHECK(count(artifacts[0].text, head + "(") == 1);
        CHECK(count(artifacts[1].text, head + "(") == 0);
        CHECK(count(artifacts[1].text, head + "_2(") == 1);
    }
}

TEST_CASE("no line of a packing's file is wider than a page, and none ends in a space",
          "[emit][packing]")
{
    const Builder b = packed_skin();
    for (const emit::Target& each : emit::targets()) {
        std::istringstream lines{emit::emit(b.module, b.sources, each).back().text};
        for (std::string line; std::getline(lines, line);) {
            CAPTURE(each.name, line);
            if (line.find("// Generated") != 0) CHECK(line.size() <= 100);
            CHECK((line.empty() || (line.back() != ' ' && line.back() != '\t')));
        }
    }
}

TEST_CASE("the layout is drawn bit by bit", "[emit][packing]")
{
    const Builder b = packed_skin();
    const std::vector<std::string> drawn = emit::draw_layout(b.module, b.module.packings[0]);
    const auto line = [&](const std::string& start) {
        const auto found = std::ranges::find_if(
            drawn, [&](const std::string& each) { return each.starts_with(start); });
        REQUIRE(found != drawn.end());
        return *found;
    };
    CHECK(line("d.g") == "d.g      | 2 falloff     | 4 roughening  |  CustomData.y");
    CHECK(line("d.b") == "d.b      | 6 tint_r  | 7 tint_g  | 8     |  CustomData.z");
    CHECK(line("d.a") == "d.a      | 3 terminator      |   | 9     |  CustomData.w");
    CHECK(line("9 ") == "9 depth       d.a[0..1], e.r  unorm 10 linear(1020/1023)  [0, 2]");
    CHECK(line("3 ") == "3 terminator  d.a[3..7]       snorm 5 linear              [-1, 1]");
}

TEST_CASE("channels of different widths are drawn from their lowest bit on", "[emit][packing]")
{
    Builder b = packed_skin();
    ir::Gbuffer& gbuffer = b.module.gbuffers[0];
    gbuffer.channels[1].formats = {{ir::Storage::unorm, 10}};  // c.a
    gbuffer.channels[0].holders.clear();
    gbuffer.channels[0].formats = {{ir::Storage::unorm, 2}};
    const std::vector<std::string> drawn = emit::draw_layout(b.module, b.module.packings[0]);
    const std::vector<std::string> start{drawn.begin(), drawn.begin() + 6};
    CHECK(start == std::vector<std::string>{
                       "GBufferC   9   8   7   6   5   4   3   2   1   0",
                       "                                         +-------+",
                       "c.r                                      |       |  BaseColor.r",
                       "         +-------+-----------------------+-------+",
                       "c.a      |       | 5 sheen                       |  GenericAO",
                       "         +-------+-------------------------------+"});
}

}  // namespace lobe::tests
