// Everything that emission writes, before real compilers: hand-built modules and the models that
// ship.
#include "emit/cases.h"
#include "emit/emit.h"
#include "emit/packings.h"
#include "emit/shipped.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace lobe::tests {
namespace {

verify::Dialect judge_dialect(const emit::Target& target)
{
    switch (target.language) {
    case emit::Language::glsl: return verify::Dialect::glsl;
    case emit::Language::essl: return verify::Dialect::essl;
    case emit::Language::hlsl: return verify::Dialect::hlsl;
    }
    return {};
}

/// Warnings are fine where the front end has no `#pragma once`.
void check_accepted(const verify::Verdict& verdict, const std::string& text)
{
    std::string messages;
    for (const verify::Message& message : verdict.messages) messages += message.text + "\n";
    CAPTURE(messages, text);
    CHECK(verdict.accepted);
    if (!verdict.spirv.empty()) CHECK(verify::validate(verdict.spirv).accepted);
}

void check_file(const emit::Artifact& artifact, const emit::Target& target)
{
    const emit::Framed framed = emit::frame(artifact, target);
    const bool desktop = target.version == 330 || target.version == 300;
    check_accepted(
        desktop ? verify::parse_only(framed.text, judge_dialect(target), verify::Stage::fragment)
                : verify::compile(framed.text, judge_dialect(target), verify::Stage::fragment),
        framed.text);
}

void check_files(const Shipped& input)
{
    for (const emit::Target& target : emit::targets()) {
        CAPTURE(target.name);
        for (const emit::Artifact& artifact : emit::emit(input.module, input.sources, target))
            check_file(artifact, target);
    }
}

void check_harnesses(const Shipped& input)
{
    for (const emit::Target& target : emit::targets())
        for (const emit::Precision precision :
             {emit::Precision::float32, emit::Precision::float16}) {
            if (precision == emit::Precision::float16 && target.name != "glsl450") continue;
            std::vector<ir::FunctionId> roots = input.module.roots();
            if (precision == emit::Precision::float32)
                std::ranges::copy(input.module.packing_roots(), std::back_inserter(roots));
            for (const ir::FunctionId id : input.module.reachable(roots)) {
                CAPTURE(target.name, input.module[id].name);
                const emit::Harness harness =
                    emit::harness(input.module, input.sources, id, target, precision);
                check_accepted(verify::compile(harness.artifact.text, judge_dialect(target),
                                               verify::Stage::compute, harness.entry),
                               harness.artifact.text);
            }
        }
}

}  // namespace

TEST_CASE("compilers take every file of the small modules", "[emit][judged]")
{
    for (const GoldenCase& golden : golden_cases()) {
        Builder b = golden.build();
        const Shipped input{std::move(b.module), std::move(b.sources)};
        check_files(input);
        check_harnesses(input);
    }
}

TEST_CASE("compilers take every file of the models that ship", "[emit][judged]")
{
    for (const char* name : {"microfacet", "callisto", "ue4", "lights"}) {
        const Shipped input = shipped(name);
        check_files(input);
        check_harnesses(input);
    }
}

TEST_CASE("a module's file and its packing's stand in one shader", "[emit][judged][packing]")
{
    const Builder b = packed_skin();
    for (const emit::Target& target : emit::targets()) {
        CAPTURE(target.name);
        const auto artifacts = emit::emit(b.module, b.sources, target);
        REQUIRE(artifacts.size() == 2);
        emit::Artifact both = artifacts[1];
        both.text += artifacts[0].text;
        both.calls.insert(both.calls.end(), artifacts[0].calls.begin(), artifacts[0].calls.end());
        check_file(both, target);
        if (target.name != "ue4") continue;
        // The model's file has seen the macro: without it the parameters stay at their defaults.
        const std::size_t asked = both.text.find("#ifdef SKIN_PARAMETERS");
        REQUIRE(asked != std::string::npos);
        CHECK(both.text.find("#define SKIN_PARAMETERS(") < asked);
    }
}

TEST_CASE("models under lights have a file of their own, which stands beside the module's",
          "[emit][judged][lights]")
{
    const Shipped input = written(R"(
module scene
import lights { point, capsule }
model matte(g: geometry, s: surface) {
  diffuse  = s.diffuse_color * g.cos_i
  specular = s.f0 * g.cos_h * g.cos_i
}
light flash(e: emitter) {
  direction  = e.l
  irradiance = 1 / (e.distance_squared + 1)
}
)");
    for (const emit::Target& target : emit::targets()) {
        CAPTURE(target.name);
        const auto artifacts = emit::emit(input.module, input.sources, target);
        REQUIRE(artifacts.size() == 2);
        const bool unreal = target.name == "ue4";
        CHECK(artifacts[1].path == "scene/" + target.name +
                                       (unreal ? "/SceneLights" : "/scene_lights") +
                                       target.extension);
        for (const emit::Artifact& artifact : artifacts) check_file(artifact, target);
        const std::string& text = artifacts[1].text;
        for (const char* name : {"flash", "point", "capsule"})
            CHECK(artifacts[1].text.find(unreal ? "ShadeMatte"
                                                : "shade_matte_" + std::string{name}) !=
                  std::string::npos);
        // Lights that nobody asked for, and what only they call, are not there.
        for (const char* name : {"punctual", "Punctual", "cone", "Cone"})
            CHECK(text.find(name) == std::string::npos);
        emit::Artifact both = artifacts[0];
        both.text += artifacts[1].text;
        both.calls.insert(both.calls.end(), artifacts[1].calls.begin(), artifacts[1].calls.end());
        check_file(both, target);
    }
    check_harnesses(input);
}

TEST_CASE("no line of a generated file is wider than a page, but the BxDF's own signature",
          "[emit]")
{
    for (const char* name : {"microfacet", "callisto", "ue4", "lights"}) {
        const Shipped input = shipped(name);
        for (const emit::Target& target : emit::targets())
            for (const emit::Artifact& artifact : emit::emit(input.module, input.sources, target)) {
                std::istringstream lines{artifact.text};
                for (std::string line; std::getline(lines, line);) {
                    if (line.find("FDirectLighting ") == 0 || line.find("// Generated") == 0 ||
                        line.find("\tif( AreaLight") == 0)
                        continue;
                    CAPTURE(artifact.path, line);
                    CHECK(line.size() <= 100);
                    CHECK((line.empty() || (line.back() != ' ' && line.back() != '\t')));
                }
            }
    }
}

TEST_CASE("every line of a function knows its place in the model", "[emit]")
{
    const Shipped input = shipped("callisto");
    for (const emit::Target& target : emit::targets()) {
        CAPTURE(target.name);
        const emit::Artifact artifact = emit::emit(input.module, input.sources, target).front();
        int previous = 0;
        for (const emit::LineOrigin& origin : artifact.origins) {
            CHECK(origin.first > previous);
            CHECK(origin.last >= origin.first);
            CHECK(origin.span.source < input.sources.size());
            previous = origin.last;
        }
        // The citation in a function's comment says the same.
        std::istringstream lines{artifact.text};
        int number = 0;
        int found = 0;
        for (std::string line; std::getline(lines, line);) {
            ++number;
            if (line.find("// models/") != 0) continue;
            for (const emit::LineOrigin& origin : artifact.origins)
                if (origin.first <= number && number <= origin.last) {
                    CHECK("// " + input.sources.cite(origin.span) == line);
                    ++found;
                }
        }
        CHECK(found > 10);
    }
}

TEST_CASE("equal inputs give equal bytes", "[emit]")
{
    const Shipped input = shipped("callisto");
    for (const emit::Target& target : emit::targets())
        CHECK(emit::emit(input.module, input.sources, target).front().text ==
              emit::emit(input.module, input.sources, target).front().text);
}

TEST_CASE("no path of a machine reaches a generated file", "[emit]")
{
    Builder b = golden_cases().front().build();
    b.module.path = "/somewhere/someone/models/microfacet.lobe";
    Sources sources;
    sources.add(b.module.path, b.sources[0].text());
    for (const emit::Target& target : emit::targets())
        CHECK(emit::emit(b.module, sources, target).front().text.find("someone") ==
              std::string::npos);
}

}  // namespace lobe::tests
