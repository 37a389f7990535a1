// The comparison passes what the contract allows and nothing else.
#include "analyze/agreement/agreement.h"
#include "analyze/models.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace lobe;
using analyze::Agreement;
using analyze::Reference;
using evaluate::Precision;

namespace {

constexpr std::size_t count = 8192;

Reference reference_of(const std::string& name)
{
    const ir::Module module = tests::sample_module();
    return analyze::reference(module, *module.find(name), Precision::float32, count);
}

/// What a device with IEEE floats would return, from the evaluator.
std::vector<float> float_results(const Reference& reference)
{
    std::vector<const float*> inputs;
    for (const auto& column : reference.points.columns) inputs.push_back(column.data());
    const std::size_t size = reference.outputs.size();
    std::vector<std::vector<float>> columns(size, std::vector<float>(count));
    std::vector<float*> outputs;
    for (auto& column : columns) outputs.push_back(column.data());
    evaluate::run(reference.tape, inputs, outputs, count);
    std::vector<float> results(size * count);
    for (std::size_t k = 0; k < size; ++k)
        for (std::size_t i = 0; i < count; ++i) results[i * size + k] = columns[k][i];
    return results;
}

}  // namespace

TEST_CASE("IEEE float results are accepted everywhere", "[agreement]")
{
    for (const char* name : {"D_GGX", "V_Smith", "F_Schlick", "blend", "lambert"}) {
        CAPTURE(name);
        const Reference reference = reference_of(name);
        const Agreement agreement = analyze::compare(reference, float_results(reference));
        INFO((agreement.example ? agreement.example->inputs : ""));
        CHECK(agreement.points == count);
        CHECK(agreement.outside == 0);
        CHECK(agreement.not_a_number == 0);
        CHECK(agreement.ulp.at.has_value());
    }
}

TEST_CASE("an error of 1e-4 is seen at every point of a sum of products", "[agreement]")
{
    const Reference reference = reference_of("F_Schlick");
    std::vector<float> results = float_results(reference);
    for (float& value : results) value *= 1.0001F;
    const Agreement agreement = analyze::compare(reference, results);
    // All but the points whose result is 0, which stays 0, in all three components.
    std::size_t zero = 0;
    for (std::size_t i = 0; i < count; ++i)
        zero += results[3 * i] == 0 && results[3 * i + 1] == 0 && results[3 * i + 2] == 0;
    CHECK(agreement.outside + zero + agreement.undefined >= count);
    CHECK(agreement.outside == analyze::count_outside(reference, results));
    REQUIRE(agreement.example);
    CHECK((agreement.example->result < agreement.example->low ||
           agreement.example->result > agreement.example->high));
    // What was put in, and at most a few ulps of the computation itself.
    CHECK(agreement.relative.size == Approx(1e-4).epsilon(0.05));
}

TEST_CASE("NaN and infinity are outside where the function is defined", "[agreement]")
{
    const Reference reference = reference_of("lambert");
    REQUIRE(reference.undefined == 0);
    std::vector<float> results = float_results(reference);
    results[5] = std::numeric_limits<float>::quiet_NaN();
    results[6] = std::numeric_limits<float>::infinity();
    const Agreement agreement = analyze::compare(reference, results);
    CHECK(agreement.outside == 2);
    CHECK(agreement.not_a_number == 1);
    CHECK(agreement.infinite == 1);
    REQUIRE(agreement.example);
    CHECK(agreement.example->point == 5);  // nothing is farther away than NaN
}

TEST_CASE("the exact value is confirmed with 113 bits", "[agreement]")
{
    const Reference reference = reference_of("D_GGX");
    for (std::size_t point = 0; point < count; point += 97) {
        const double exact = reference.outputs[0].exact[point];
        const double confirmed = analyze::confirm(reference, point).front();
        // Float and double share the conditioning: as double is 2^29 times finer, an agreement to
        // 2^-25 leaves each measured float error right to four bits of 2^-24 and better.
        CHECK(std::abs(exact - confirmed) <= 0x1p-25 * std::abs(confirmed));
    }
}

TEST_CASE("an undefined point is counted and never judged", "[agreement]")
{
    ir::Module module;
    tests::FunctionBuilder f{"quotient"};
    const auto a = f.argument("a", 0, 1);
    const auto b = f.argument("b", 0, 1);
    module.functions.push_back(f.finish(f(ir::Op::divide, {a, b})));
    const Reference reference =
        analyze::reference(module, ir::FunctionId{0}, Precision::float32, count);
    std::size_t zero_divisors = 0;
    for (const float divisor : reference.points.columns[1]) zero_divisors += divisor == 0;
    REQUIRE(zero_divisors > 0);
    CHECK(reference.undefined >= zero_divisors);
    CHECK(reference.undefined < count / 4);  // of the hostile quarter only
    const Agreement agreement = analyze::compare(reference, float_results(reference));
    CHECK(agreement.outside == 0);
    CHECK(agreement.undefined == reference.undefined);
}
