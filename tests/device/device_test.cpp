// Shaders run on the default device, by every route that text can take to it: results, bounds,
// what happens to unusual numbers, turns, threads, and every way to fail.
#include "device/device.h"
#include "verify/harness_texts.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

using namespace lobe;
using namespace std::chrono_literals;

namespace {

device::Device open_default(const device::Limits& limits = {})
{
    std::string why;
    auto device = device::Device::open({}, why, limits);
    INFO("a Vulkan driver is needed, mesa-vulkan-drivers for example: " << why);
    REQUIRE(device);
    return std::move(*device);
}

/// A GLSL harness of one input and one output per point, with this expression of `x`.
std::vector<std::uint32_t> shader(std::string_view expression, std::string_view before = "")
{
    const std::string text = fmt::format(R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs {{ float x[]; }} points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs {{ float y[]; }} results;
layout(push_constant) uniform Push {{ uint count; }};

void main()
{{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    float x = points.x[i];
    {}
    results.y[i] = {};
}}
)",
                                         before, expression);
    const auto verdict = verify::compile(text, verify::Dialect::glsl, verify::Stage::compute);
    for (const verify::Message& message : verdict.messages) UNSCOPED_INFO(message.text);
    REQUIRE(verdict.accepted);
    return verdict.spirv;
}

std::vector<float> run(device::Device& device, const std::vector<std::uint32_t>& spirv,
                       const std::vector<float>& input)
{
    std::vector<float> output(input.size(), -1.0F);
    const auto failure =
        device.run(spirv, "main", input, output, static_cast<std::uint32_t>(input.size()));
    INFO(failure.value_or(""));
    REQUIRE_FALSE(failure);
    return output;
}

std::vector<float> whole_numbers(std::size_t size)
{
    // Below 1024, so that their doubles are exact in float16 too.
    std::vector<float> numbers(size);
    for (std::size_t i = 0; i < size; ++i) numbers[i] = static_cast<float>(i % 1024);
    return numbers;
}

bool are_doubles(const std::vector<float>& input, const std::vector<float>& output)
{
    for (std::size_t i = 0; i < input.size(); ++i)
        if (output[i] != 2.0F * input[i]) return false;
    return input.size() == output.size();
}

}  // namespace

TEST_CASE("every spelling of the harness doubles a hundred thousand numbers")
{
    auto device = open_default();
    const std::vector<float> input = whole_numbers(100'000);
    for (const verify::HarnessText& harness : verify::harness_texts) {
        if (harness.float16 && !device.facts().float16) {
            WARN("`" << device.facts().name << "` has no float16");
            continue;
        }
        CAPTURE(harness.name);
        const auto compiled =
            verify::compile(harness.text, harness.dialect, verify::Stage::compute);
        REQUIRE(compiled.accepted);
        CHECK(are_doubles(input, run(device, compiled.spirv, input)));
        CHECK(are_doubles(input, run(device, verify::optimize(compiled.spirv).spirv, input)));
        const auto strict = verify::forbid_contraction(compiled.spirv);
        CHECK(are_doubles(input, run(device, strict, input)));
    }
}

TEST_CASE("float16 rounds to eleven bits")
{
    auto device = open_default();
    if (!device.facts().float16) {
        WARN("`" << device.facts().name << "` has no float16: nothing tested");
        return;
    }
    const auto& harness = verify::harness_texts[1];
    REQUIRE(harness.float16);
    const auto compiled = verify::compile(harness.text, harness.dialect, verify::Stage::compute);
    // 2049 lies halfway between two float16 numbers, the even one is 2048; 40000 doubled is
    // beyond 65504, the largest.
    const auto output = run(device, compiled.spirv, {2049.0F, 1.5F, 40000.0F});
    CHECK(output[0] == 4096.0F);
    CHECK(output[1] == 3.0F);
    CHECK(std::isinf(output[2]));
}

TEST_CASE("the count bounds what is written, inside a workgroup too")
{
    auto device = open_default();
    const auto spirv = shader("2.0 * x");
    for (const std::uint32_t count : {0U, 1U, 63U, 64U, 65U, 99U}) {
        CAPTURE(count);
        const std::vector<float> input(100, 4.0F);
        std::vector<float> output(100, -1.0F);
        REQUIRE_FALSE(device.run(spirv, "main", input, output, count));
        for (std::size_t i = 0; i < output.size(); ++i) {
            CAPTURE(i);
            CHECK(output[i] == (i < count ? 8.0F : -1.0F));
        }
    }
}

TEST_CASE("NaN and infinities reach the shader and come back")
{
    auto device = open_default();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const auto spirv = verify::forbid_contraction(shader("2.0 * x"));
    const auto output = run(device, spirv, {nan, infinity, -infinity, -0.0F});
    CHECK(std::isnan(output[0]));
    CHECK(output[1] == infinity);
    CHECK(output[2] == -infinity);
    CHECK(output[3] == 0.0F);
    CHECK(std::signbit(output[3]));
}

TEST_CASE("a denormal is computed with or flushed, and nothing else")
{
    auto device = open_default();
    constexpr float denormal = 1e-39F;
    constexpr float normal = std::numeric_limits<float>::min();
    const auto output =
        run(device, verify::forbid_contraction(shader("2.0 * x")), {denormal, normal});
    CHECK((output[0] == 2.0F * denormal || output[0] == 0.0F));
    CHECK(output[1] == 2.0F * normal);
}

TEST_CASE("min with NaN gives the number")
{
    auto device = open_default();
    const auto output =
        run(device, shader("min(x, 3.0)"), {std::numeric_limits<float>::quiet_NaN(), 2.0F});
    CHECK(output[0] == 3.0F);
    CHECK(output[1] == 2.0F);
}

TEST_CASE("forbidding contraction keeps the device from cancelling")
{
    auto device = open_default();
    // In floats 1e8 + 1 is 1e8, so the difference is 0; over the reals it is 1.
    const auto sum = shader("(x + 1.0) - x");
    CHECK(run(device, verify::forbid_contraction(sum), {1e8F})[0] == 0.0F);
    // 1e-30 squared underflows to 0 in floats, and so does the quotient.
    const auto quotient = shader("(x * y) / x", "float y = 1e-30 * x / x;");
    const auto strict = verify::forbid_contraction(quotient);
    CHECK(run(device, strict, {1e-30F})[0] == 0.0F);
    CHECK(run(device, verify::optimize(strict).spirv, {1e-30F})[0] == 0.0F);
}

TEST_CASE("points are run in turns, with the same results")
{
    const auto input = whole_numbers(10'000);
    const auto spirv = shader("2.0 * x");
    for (const std::uint32_t points : {1'000U, 3'333U, 9'999U, 10'000U}) {
        CAPTURE(points);
        auto device = open_default({.points = points});
        CHECK(are_doubles(input, run(device, spirv, input)));
    }
}

TEST_CASE("points of several numbers are divided at points")
{
    // Three inputs and two outputs each.
    const auto compiled = verify::compile(R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results.y[2 * i] = points.x[3 * i] - points.x[3 * i + 1];
    results.y[2 * i + 1] = points.x[3 * i + 2];
}
)",
                                          verify::Dialect::glsl, verify::Stage::compute);
    REQUIRE(compiled.accepted);
    auto device = open_default({.points = 100});
    constexpr std::uint32_t count = 250;
    std::vector<float> input(3 * count);
    for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<float>(i * i);
    std::vector<float> output(2 * count);
    REQUIRE_FALSE(device.run(compiled.spirv, "main", input, output, count));
    for (std::size_t i = 0; i < count; ++i) {
        CAPTURE(i);
        CHECK(output[2 * i] == input[3 * i] - input[3 * i + 1]);
        CHECK(output[2 * i + 1] == input[3 * i + 2]);
    }
}

TEST_CASE("more numbers than a storage buffer may have are run in turns too")
{
    // 33 inputs per point make 138 MB, more than the 128 MiB that a device must take and llvmpipe
    // takes, although a million points are few enough.
    auto device = open_default();
    constexpr std::uint32_t count = (1U << 20U) - 1;
    constexpr std::size_t inputs = 33;
    std::vector<float> input(inputs * count);
    for (std::size_t i = 0; i < count; ++i) input[inputs * i + 32] = static_cast<float>(i);
    const std::string text = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float x[]; } points;
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { float y[]; } results;
layout(push_constant) uniform Push { uint count; };
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results.y[i] = points.x[33 * i + 32];
}
)";
    const auto compiled = verify::compile(text, verify::Dialect::glsl, verify::Stage::compute);
    REQUIRE(compiled.accepted);
    std::vector<float> output(count, -1.0F);
    REQUIRE_FALSE(device.run(compiled.spirv, "main", input, output, count));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) wrong += output[i] != static_cast<float>(i);
    CHECK(wrong == 0);
}

TEST_CASE("what cannot be divided among points is refused")
{
    auto device = open_default({.points = 10});
    const std::vector<float> input(101);
    std::vector<float> output(100);
    const auto failure = device.run(shader("x"), "main", input, output, 100);
    REQUIRE(failure);
    CHECK(failure->find("cannot be divided evenly") != std::string::npos);
}

TEST_CASE("copying through a second buffer changes nothing")
{
    auto device = open_default({.points = 4'000, .always_stage = true});
    const auto input = whole_numbers(10'000);
    CHECK(are_doubles(input, run(device, shader("2.0 * x"), input)));
    std::vector<float> output(10, -1.0F);
    REQUIRE_FALSE(device.run(shader("2.0 * x"), "main", whole_numbers(10), output, 9));
    CHECK(output[8] == 16.0F);
    CHECK(output[9] == -1.0F);
}

TEST_CASE("buffers that shrink and grow do not show old numbers")
{
    auto device = open_default();
    const auto spirv = shader("2.0 * x");
    for (const std::size_t size : {10'000U, 1U, 100U, 20'000U, 7U}) {
        const auto input = whole_numbers(size);
        CHECK(are_doubles(input, run(device, spirv, input)));
    }
}

TEST_CASE("threads share one device")
{
    auto device = open_default();
    constexpr int shaders = 12;
    std::vector<std::vector<std::uint32_t>> spirv;
    for (int i = 0; i < shaders; ++i) spirv.push_back(shader(fmt::format("x * {}.0", i)));
    const auto input = whole_numbers(5'000);
    std::atomic<int> next = 0;
    std::atomic<int> wrong = 0;
    const auto work = [&] {
        for (int i = next++; i < shaders; i = next++) {
            std::vector<float> output(input.size());
            const auto failure = device.run(spirv[static_cast<std::size_t>(i)], "main", input,
                                            output, static_cast<std::uint32_t>(input.size()));
            bool is_right = !failure;
            for (std::size_t point = 0; point < input.size(); ++point)
                is_right = is_right && output[point] == input[point] * static_cast<float>(i);
            wrong += is_right ? 0 : 1;
        }
    };
    // More threads than processors here or there: some wait for a lane.
    std::vector<std::thread> threads;
    for (int i = 0; i < shaders; ++i) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
}

TEST_CASE("a shader that takes too long is given up")
{
    auto device = open_default({.time = 20ms});
    // Nothing that a driver could fold away; a second of work or so on a software device. (A
    // longer loop would not do: llvmpipe leaves every loop after 65,535 rounds.)
    const auto slow = shader("x", "for (uint k = 0u; k < 20000u; ++k) x = sin(x) + 1.0;");
    const std::vector<float> input(1U << 14U, 0.5F);
    std::vector<float> output(input.size(), -1.0F);
    const auto count = static_cast<std::uint32_t>(input.size());
    const auto failure = device.run(slow, "main", input, output, count);
    if (!failure && !device.facts().software) {
        WARN("`" << device.facts().name << "` is too fast for this test");
        return;
    }
    REQUIRE(failure);
    CHECK(failure->find("did not end within 20 ms") != std::string::npos);
    CHECK(output == std::vector<float>(input.size(), -1.0F));
}

TEST_CASE("an entry point that is not there is refused before the driver sees it")
{
    auto device = open_default();
    std::vector<float> output(1);
    const std::vector<float> input(1);
    const auto failure = device.run(shader("x"), "elsewhere", input, output, 1);
    REQUIRE(failure);
    CHECK(failure->find("elsewhere") != std::string::npos);
}

TEST_CASE("what is no SPIR-V is refused before the driver sees it")
{
    auto device = open_default();
    const std::vector<std::uint32_t> noise(20, 7);
    std::vector<float> output(1);
    const std::vector<float> input(1);
    CHECK(device.run(noise, "main", input, output, 1));
    CHECK(device.run({}, "main", input, output, 1));
}
