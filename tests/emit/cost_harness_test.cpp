// The shader that costs are measured with: its text, and that it is one that runs and gives what
// the function gives.
#include "device/device.h"
#include "emit/cost_harness.h"
#include "emit/modules.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace lobe::tests {
namespace {

using emit::NumberFormat;
using ir::Op;

/// F_Schlick of a color, with half of the cosines from vectors, and a condition.
struct Sample : Builder {
    ir::FunctionId fresnel;
    ir::FunctionId gated;

    Sample() : Builder("sample")
    {
        ir::Function& f = term("F_Schlick", 3);
        const auto f0 = color(f, "f0");
        const auto cosine = field(f, ir::GeometryField::cos_d);
        const auto x = f.graph.apply(Op::subtract, {f.graph.literal("1"), cosine});
        const auto x2 = f.graph.apply(Op::multiply, {x, x});
        const auto rest = f.graph.apply(Op::subtract, {f.graph.literal("1"), f0});
        f.result = f.graph.apply(Op::add, {f0, f.graph.apply(Op::multiply, {rest, x2})});
        fresnel = ir::FunctionId{0};

        ir::Function& g = term("gated", 9);
        const auto flag = argument(g, "flag", ir::Type::boolean, {0, 1}, ir::Quantity::boolean);
        const auto cos_d = field(g, ir::GeometryField::cos_d);
        g.result = g.graph.apply(Op::select, {flag, cos_d, g.graph.literal("0.25")});
        gated = ir::FunctionId{1};
    }
};

std::string text_of(const Sample& sample, NumberFormat format, bool from_vectors, int copies = 2,
                    int chains = 1)
{
    return emit::cost_harness(emit::evaluation(sample.module, sample.sources,
                                               {sample.fresnel, sample.gated}, format,
                                               from_vectors),
                              format, copies, chains);
}

std::vector<std::uint32_t> spirv_of(const std::string& text)
{
    const verify::Verdict verdict =
        verify::compile(text, verify::Dialect::glsl, verify::Stage::compute);
    INFO(text);
    for (const verify::Message& message : verdict.messages) UNSCOPED_INFO(message.text);
    REQUIRE(verdict.accepted);
    REQUIRE(verify::validate(verdict.spirv).accepted);
    return verdict.spirv;
}

}  // namespace

TEST_CASE("the harness of costs has the text that was agreed on", "[emit][golden]")
{
    const Sample sample;
    const std::string text = text_of(sample, NumberFormat::float32, false);
    const std::string path = "emit/cost_harness.comp";
    if (std::getenv("LOBE_REWRITE") != nullptr) std::ofstream{path, std::ios::binary} << text;
    std::ifstream file{path, std::ios::binary};
    std::ostringstream golden;
    golden << file.rdbuf();
    CHECK(text == golden.str());
}

TEST_CASE("every format and both kinds of inputs make shaders that judges accept", "[emit]")
{
    const Sample sample;
    for (const bool from_vectors : {false, true})
        for (const NumberFormat format : {NumberFormat::float32, NumberFormat::float16}) {
            spirv_of(text_of(sample, format, from_vectors));
            spirv_of(text_of(sample, format, from_vectors, 3, 4));
        }
    for (const NumberFormat format :
         {NumberFormat::float32, NumberFormat::float16, NumberFormat::packed16}) {
        for (const int exponent : {2, 3})
            spirv_of(emit::cost_harness(emit::powers(3, exponent, format), format, 2));
        spirv_of(emit::cost_harness(emit::product(format), format, 2));
    }
}

TEST_CASE("inputs are counted by component, each once", "[emit]")
{
    const Sample sample;
    const auto inputs = [&](bool from_vectors) {
        return emit::evaluation(sample.module, sample.sources, {sample.fresnel, sample.gated},
                                NumberFormat::float32, from_vectors)
            .inputs;
    };
    CHECK(inputs(false) == 3 + 1 + 1);     // f0, cos_d, flag
    CHECK(inputs(true) == 3 + 3 * 3 + 1);  // f0; l, v and n; flag
}

TEST_CASE("a chain runs, and its links are 0 at run time", "[emit][device]")
{
    std::string why;
    auto device = device::Device::open({}, why);
    INFO(why);
    REQUIRE(device);
    const Sample sample;
    // The last evaluation's bits, and the zero that only the run knows: 0, however many there were.
    for (const NumberFormat format : {NumberFormat::float32, NumberFormat::float16}) {
        if (format != NumberFormat::float32 && !device->facts().float16) continue;
        const auto spirv = spirv_of(text_of(sample, format, false, 3, 2));
        constexpr std::uint32_t points = 128;
        const std::vector<float> input(points * 5, 0.5F);
        std::vector<float> output(points, 1.0F);
        const auto failure = device->run(spirv, "main", input, output, points);
        INFO(failure.value_or(""));
        REQUIRE_FALSE(failure);
        for (const float value : output) CHECK(std::bit_cast<std::uint32_t>(value) == 0);
        std::vector<double> seconds(3);
        CHECK_FALSE(device->time(spirv, "main", input, points, points, seconds));
        for (const double each : seconds) CHECK(each > 0);
    }
}

}  // namespace lobe::tests
