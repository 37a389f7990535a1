// Callisto as a port types it from the slides, against Callisto as the compiler emits it: the same
// model, in stability.
#include "analyze/agreement/judgement.h"
#include "analyze/corners/corners.h"
#include "analyze/hazards/search.h"
#include "analyze/stability_cases.h"
#include "emit/emit.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using evaluate::Precision;
using optimize::Spelling;

namespace {

double not_finite(const tests::StabilityCase& which, const std::string& function, Spelling spelling)
{
    const auto id = which.module.find(function);
    REQUIRE(id);
    const analyze::HazardSpace space{which.module, *id, Precision::float32};
    const auto line =
        analyze::watch(optimize::spell(which.module, spelling), *id, space.inputs().names());
    return analyze::not_finite_share(line, analyze::corner_points(space.inputs(), space.grid()),
                                     Precision::float32);
}

}  // namespace

TEST_CASE("a port by hand gives NaN at corners where what is emitted never does")
{
    const auto& port = tests::stability_case("callisto_port");
    const auto& callisto = tests::stability_case("../../../models/callisto");
    CHECK(not_finite(port, "port_diffuse", Spelling::naive) > 0.1);
    CHECK(not_finite(port, "port_specular", Spelling::naive) > 0);
    CHECK(not_finite(callisto, "callisto_diffuse", Spelling::stable) == 0);
    CHECK(not_finite(callisto, "callisto_specular", Spelling::stable) == 0);
    // Even the port's formulas are finite with the compiler's care.
    CHECK(not_finite(port, "port_diffuse", Spelling::stable) == 0);
    CHECK(not_finite(port, "port_specular", Spelling::stable) == 0);
}

TEST_CASE("a device finds what is found here", "[device]")
{
    std::string why;
    auto device = device::Device::open("", why);
    INFO(why);
    REQUIRE(device);
    const auto& port = tests::stability_case("callisto_port");
    const auto id = port.module.find("port_diffuse");
    REQUIRE(id);
    const emit::Target& target = *emit::find_target("glsl450");
    const auto run = [&](Spelling spelling) {
        const ir::Module module = optimize::spell(port.module, spelling);
        const analyze::Reference reference =
            analyze::reference(module, *id, Precision::float32, 8192);
        const emit::Harness harness =
            emit::harness(module, port.sources, *id, target, emit::Precision::float32);
        const analyze::Judged judged =
            analyze::judge_harness(harness, target, emit::Precision::float32);
        REQUIRE(!judged.direct.empty());
        std::vector<float> results;
        const auto failure = analyze::execute(*device, reference, harness, judged.direct, results);
        INFO(failure.value_or(""));
        REQUIRE(!failure);
        std::size_t bad = 0;
        for (std::size_t i = 0; i < results.size(); i += 3) bad += !std::isfinite(results[i]);
        return static_cast<double>(bad) / static_cast<double>(results.size() / 3);
    };
    // Its pow(0, 0) happens to be 0; 0.19 / 0 * 0 is NaN everywhere.
    CHECK(run(Spelling::naive) > 0.05);
    CHECK(run(Spelling::stable) == 0);
}
