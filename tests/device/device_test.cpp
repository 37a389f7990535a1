// Shaders run on the default device, by every route that text can take to it.
#include "device/device.h"
#include "verify/harness_texts.h"
#include "verify/judge.h"

#include <catch2/catch.hpp>

#include <numeric>

using namespace lobe;

TEST_CASE("every spelling of the harness doubles a hundred thousand numbers")
{
    std::string why;
    auto device = device::Device::open({}, why);
    INFO(why);
    REQUIRE(device);
    for (const verify::HarnessText& harness : verify::harness_texts) {
        CAPTURE(harness.name);
        const auto compiled =
            verify::compile(harness.text, harness.dialect, verify::Stage::compute);
        REQUIRE(compiled.accepted);
        std::vector<float> input(100'000);
        // Whole numbers below 1024: their doubles are exact in float16 too.
        for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<float>(i % 1024);
        std::vector<float> output(input.size(), -1.0F);
        const auto failure = device->run(compiled.spirv, "main", input, output,
                                         static_cast<std::uint32_t>(input.size()));
        REQUIRE_FALSE(failure);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < input.size(); ++i) wrong += output[i] != 2.0F * input[i];
        CHECK(wrong == 0);
    }
}
