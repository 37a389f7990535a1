// Random expression graphs through every part that has an opinion of them: simplify, the passes
// after it, every kind of number, both front ends, the optimizer and the device. All must agree,
// and no tolerance is chosen: sets that are said to hold one and the same real number must meet,
// and what was computed must lie in what was allowed.
#include "analyze/agreement/agreement.h"
#include "analyze/agreement/judgement.h"
#include "evaluate/random_graph.h"
#include "optimize/optimize.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace lobe;
using evaluate::Acceptance;
using evaluate::HalfMode;
using evaluate::Interval;
using evaluate::Precision;
using evaluate::Real;

namespace {

constexpr std::size_t count = 512;

template <class Number>
struct Table {
    std::vector<std::vector<Number>> columns;

    Table(std::size_t width, const Number& value)
        : columns(width, std::vector<Number>(count, value))
    {
    }
    std::vector<const Number*> read() const
    {
        std::vector<const Number*> heads;
        for (const auto& column : columns) heads.push_back(column.data());
        return heads;
    }
    std::vector<Number*> write()
    {
        std::vector<Number*> heads;
        for (auto& column : columns) heads.push_back(column.data());
        return heads;
    }
};

/// The reference's points as numbers of another kind.
template <class Number, class Make>
Table<Number> points_as(const analyze::Reference& reference, const Number& blank, const Make& make)
{
    Table<Number> table{reference.points.columns.size(), blank};
    for (std::size_t i = 0; i < table.columns.size(); ++i)
        for (std::size_t p = 0; p < count; ++p)
            table.columns[i][p] = make(reference.points.columns[i][p]);
    return table;
}

Table<Interval> intervals(const analyze::Reference& reference, const evaluate::Tape& tape)
{
    const auto in = points_as(reference, Interval{}, [](float x) { return Interval{x, x}; });
    Table<Interval> out{tape.outputs.size(), Interval{}};
    evaluate::run(tape, in.read(), out.write(), count);
    return out;
}

Table<float> halves(const analyze::Reference& reference, HalfMode mode)
{
    const auto in = points_as(reference, 0.0F, [](float x) { return x; });
    Table<float> out{reference.outputs.size(), 0.0F};
    evaluate::run_half(reference.tape, mode, in.read(), out.write(), count);
    return out;
}

std::vector<float> interleaved(const Table<float>& table)
{
    std::vector<float> out;
    for (std::size_t p = 0; p < count; ++p)
        for (const auto& column : table.columns) out.push_back(column[p]);
    return out;
}

ir::Module module_of(unsigned seed, const tests::RandomShape& shape)
{
    std::mt19937 random{seed};
    return tests::random_module(random, shape);
}

/// Every number type on one function, before and after the passes.
void check_numbers(const ir::Module& before, const ir::Module& after)
{
    const ir::FunctionId last{after.functions.size() - 1};
    const auto reference = analyze::reference(after, last, Precision::float32, count);
    const std::size_t width = reference.outputs.size();

    const auto simplified = intervals(reference, reference.tape);
    const auto original_entry = ir::entry_point(before, *before.find(after[last].name));
    const auto original = intervals(reference, evaluate::compile(before, original_entry));
    const auto reals_in = points_as(reference, Real{113}, [](float x) {
        return Real{double{x}, 113};
    });
    Table<Real> reals{width, Real{113}};
    evaluate::run_real(reference.tape, 113, reals_in.read(), reals.write(), count);
    for (std::size_t k = 0; k < width; ++k)
        for (std::size_t p = 0; p < count; ++p) {
            const Interval& a = simplified.columns[k][p];
            const Interval& b = original.columns[k][p];
            INFO(analyze::describe_inputs(reference, p));
            INFO("after [" << a.low << ", " << a.high << "], before [" << b.low << ", " << b.high
                           << "]");
            // Both hold the one real number that the function has here.
            REQUIRE(a.low <= b.high);
            REQUIRE(b.low <= a.high);
            const double real = reals.columns[k][p].to_double();
            const double exact = reference.outputs[k].exact[p];
            REQUIRE(a.low <= real);
            REQUIRE(real <= a.high);
            REQUIRE(a.low <= exact);
            REQUIRE(exact <= a.high);
        }

    const auto in = points_as(reference, 0.0F, [](float x) { return x; });
    Table<float> floats{width, 0.0F};
    evaluate::run(reference.tape, in.read(), floats.write(), count);
    REQUIRE(analyze::count_outside(reference, interleaved(floats)) == 0);

    const auto half = analyze::reference(after, last, Precision::float16, count);
    for (const HalfMode mode : {HalfMode::keep_denormals, HalfMode::flush_denormals})
        REQUIRE(analyze::count_outside(half, interleaved(halves(half, mode))) == 0);
}

/// The emitted text on the device, through a front end and its optimizer.
void check_device(device::Device& device, const ir::Module& module, const char* target_name)
{
    const emit::Target& target = *emit::find_target(target_name);
    const ir::FunctionId last{module.functions.size() - 1};
    const auto reference = analyze::reference(module, last, Precision::float32, count);
    Sources sources;
    sources.add("random.lobe", "");
    const emit::Harness harness =
        emit::harness(module, sources, last, target, emit::Precision::float32);
    INFO(harness.artifact.text);
    const analyze::Judged judged =
        analyze::judge_harness(harness, target, emit::Precision::float32);
    for (const analyze::Judgement& judgement : judged.judgements) {
        INFO(judgement.judge);
        for (const analyze::Remark& remark : judgement.remarks) UNSCOPED_INFO(remark.text);
        REQUIRE(judgement.accepted);
    }
    for (const auto* spirv : {&judged.direct, &judged.optimized}) {
        std::vector<float> results;
        const auto why = analyze::execute(device, reference, harness, *spirv, results);
        REQUIRE(why.value_or("") == "");
        const analyze::Agreement agreement = analyze::compare(reference, results);
        if (agreement.example) {
            const analyze::Witness& at = *agreement.example;
            UNSCOPED_INFO("component " << at.component << " at " << at.inputs << ": " << at.result
                                       << " is not in [" << at.low << ", " << at.high << "]");
        }
        REQUIRE(agreement.outside == 0);
    }
}

}  // namespace

TEST_CASE("random graphs mean the same in every kind of number, before and after the passes",
          "[random]")
{
    for (unsigned seed = 1; seed <= 100; ++seed) {
        CAPTURE(seed);
        const ir::Module module = module_of(seed, {});
        INFO(ir::dump(module.functions.back().graph));
        check_numbers(module, optimize::simplify(module));
        check_numbers(module, optimize::optimize(module));
    }
}

TEST_CASE("random graphs run as they mean, on both routes", "[random][device]")
{
    std::string why;
    auto device = device::Device::open("", why);
    REQUIRE(why == "");
    REQUIRE(device);
    for (unsigned seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const ir::Module module = optimize::optimize(module_of(seed, {}));
        check_device(*device, module, seed % 2 == 0 ? "glsl450" : "hlsl");
    }
}
