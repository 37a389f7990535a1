// Claims about the evaluator, as one run with a table of ratios:
//
//   the float tape of the full Callisto model is at least 4 times as fast as scalar C++, within
//   1.5 times of AVX2 code written by hand, and uses all cores; an acceptance check of a point
//   takes at most 5 microseconds
//
// Usage: lobe-bench [models-folder] [Google Benchmark's own flags]
#include "base/render.h"
#include "callisto.h"
#include "compile.h"
#include "evaluate/kernels.h"
#include "evaluate/parallel.h"
#include "evaluate/run.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace lobe;
using namespace lobe::evaluate;

/// Points that stay in the second-level cache with all their columns.
constexpr std::size_t point_count = 2048;
/// Points for the threads: more than every cache holds.
constexpr std::size_t many_points = std::size_t{1} << 20;

std::optional<std::string> read(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    if (!file) return std::nullopt;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::optional<ir::Module> load(const std::string& folder)
{
    Sources sources;
    Diagnostics diagnostics;
    const auto add = [&](Sources& into, std::string_view module) -> std::optional<std::uint32_t> {
        const std::string path = fmt::format("{}/{}.lobe", folder, module);
        auto text = read(path);
        if (!text) return std::nullopt;
        return into.add(path, std::move(*text));
    };
    const auto root = add(sources, "callisto");
    if (!root) return std::nullopt;
    auto checked = front(
        sources, *root,
        [&](Sources& into, std::string_view module, std::string_view) { return add(into, module); },
        diagnostics);
    if (!checked) return std::nullopt;
    return middle(*checked);
}

/// Diffuse plus specular, over the union of their inputs.
ir::Function both(const ir::Module& module)
{
    ir::Function sum;
    sum.name = "callisto";
    std::vector<ir::ExprId> parts;
    for (const char* name : {"callisto_diffuse", "callisto_specular"}) {
        const ir::FunctionId id = *module.find(name);
        std::vector<ir::ExprId> operands;
        for (const ir::Input& input : module[id].inputs) {
            auto index = sum.find_input(input.origin, input.which);
            if (!index) {
                index = static_cast<std::uint32_t>(sum.inputs.size());
                sum.inputs.push_back(input);
            }
            operands.push_back(sum.graph.input(*index, input.type));
        }
        parts.push_back(sum.graph.call(id, module[id].type(), operands));
        sum.quantity = module[id].quantity;
    }
    sum.result = sum.graph.apply(ir::Op::add, parts);
    return sum;
}

/// Columns that start on a cache line, as every one of the three programs likes best.
template <class Number>
struct Aligned {
    using value_type = Number;
    Number* allocate(std::size_t count)
    {
        return static_cast<Number*>(::operator new (count * sizeof(Number), std::align_val_t{64}));
    }
    void deallocate(Number* memory, std::size_t)
    {
        ::operator delete (memory, std::align_val_t{64});
    }
    friend bool operator==(const Aligned&, const Aligned&) = default;
};
template <class Number>
using Column = std::vector<Number, Aligned<Number>>;

/// Random columns for every input of the model, and where the result goes.
struct Data {
    std::map<std::string, Column<float>> inputs;
    std::vector<Column<float>> results;
    bench::CallistoColumns columns;

    explicit Data(std::size_t count) : results(3, Column<float>(count))
    {
        std::mt19937 random{1};
        const auto add = [&](const char* name, float low, float high) {
            std::uniform_real_distribution<float> pick{low, high};
            Column<float>& column = inputs[name];
            for (std::size_t i = 0; i < count; ++i) column.push_back(pick(random));
            return static_cast<const float*>(column.data());
        };
#define LOBE_INPUT(field, name, low, high) columns.field = add(name, low, high);
#include "callisto_inputs.def"
#undef LOBE_INPUT
        // What stands for the same angle must agree, for each program picks what it needs.
        for (std::size_t i = 0; i < count; ++i) {
            const float cos_h = columns.cos_h[i];
            inputs["one_minus_cos_h"][i] = 1 - cos_h;
            inputs["one_minus_cos_d"][i] = 1 - columns.cos_d[i];
            inputs["sin2_h"][i] = (1 - cos_h) * (1 + cos_h);
        }
        columns.r = results[0].data();
        columns.g = results[1].data();
        columns.b = results[2].data();
    }

    std::vector<const float*> in(const Tape& tape) const
    {
        std::vector<const float*> found;
        for (const TapeInput& input : tape.inputs) found.push_back(inputs.at(input.name).data());
        return found;
    }
    std::vector<float*> out() { return {results[0].data(), results[1].data(), results[2].data()}; }
};

/// Collects the time per point of each benchmark, in place of Google Benchmark's own lines.
class Collector : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override
    {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
            const auto found = run.counters.find("points");
            if (found == run.counters.end()) continue;
            const double time = 1e9 / found->second.value;
            const auto [at, added] = times.try_emplace(run.run_name.function_name, time);
            if (!added) at->second = std::min(at->second, time);
        }
    }
    std::map<std::string, double> times;  ///< nanoseconds per point, the least of all repetitions
};

/// On one thread the processor's time counts, so that a busy machine changes little.
enum class Clock {
    processor,
    wall
};

template <class Work>
void add(const std::string& name, std::size_t points, Work work, Clock clock = Clock::processor)
{
    auto* const added =
        benchmark::RegisterBenchmark(name.c_str(), [points, work](benchmark::State& state) {
            for (auto step : state) {
                (void)step;
                work();
                benchmark::ClobberMemory();
            }
            state.counters["points"] = benchmark::Counter(
                static_cast<double>(points) * static_cast<double>(state.iterations()),
                benchmark::Counter::kIsRate);
        });
    added->Repetitions(7)->ReportAggregatesOnly(false)->MinTime(0.05);
    if (clock == Clock::wall) added->UseRealTime();
}

/// The three programs compute the same model: within float's rounding of each other.
bool agree(const std::vector<Column<float>>& a, const std::vector<Column<float>>& b)
{
    for (std::size_t k = 0; k < a.size(); ++k)
        for (std::size_t i = 0; i < a[k].size(); ++i) {
            // Powers of up to 10 of numbers near 2^-24 lose 80 units; the rest is below that.
            const float scale = std::max(1e-3F, std::abs(a[k][i]));
            if (!(std::abs(a[k][i] - b[k][i]) <= 1e-4F * scale)) {
                fmt::print(stderr, "point {}: {} and {}\n", i, a[k][i], b[k][i]);
                return false;
            }
        }
    return true;
}

void row(const char* claim, double ratio, const char* goal)
{
    fmt::print("{:<58}{:>8.2f}   {}\n", claim, ratio, goal);
}

}  // namespace

int main(int argc, char** argv)
{
    std::string folder = "models";
    if (argc > 1 && argv[1][0] != '-') {
        folder = argv[1];
        for (int i = 1; i + 1 < argc; ++i) argv[i] = argv[i + 1];
        --argc;
    }
    benchmark::Initialize(&argc, argv);
    const auto module = load(folder);
    if (!module) {
        fmt::print(stderr, "no callisto.lobe that compiles in {}\n", folder);
        return 2;
    }
    const ir::Function function = both(*module);
    const Tape tape = compile(*module, function);
    fmt::print("callisto: {} inputs, {} operations, {} slots\n", tape.inputs.size(),
               tape.code.size(), tape.slots);

    Data data{point_count};
    const auto in = data.in(tape);
    const auto out = data.out();
    callisto_scalar(data.columns, point_count);
    const auto by_scalar = data.results;
    run(tape, Columns<float>{in}, Results<float>{out}, point_count);
    const auto by_tape = data.results;
    callisto_avx2(data.columns, point_count);
    if (!agree(by_scalar, by_tape) || !agree(by_tape, data.results)) return 1;

    add("scalar", point_count, [&] { callisto_scalar(data.columns, point_count); });
    add("avx2_fma", point_count, [&] { callisto_avx2_fma(data.columns, point_count); });
    add("avx2", point_count, [&] { callisto_avx2(data.columns, point_count); });
    add("tape", point_count,
        [&] { run(tape, Columns<float>{in}, Results<float>{out}, point_count); });
    if (available(InstructionSet::avx2))
        add("tape_avx2", point_count, [&] {
            run_on(InstructionSet::avx2, tape, Columns<float>{in}, Results<float>{out},
                   point_count);
        });
    add("tape_baseline", point_count, [&] {
        run_on(InstructionSet::baseline, tape, Columns<float>{in}, Results<float>{out},
               point_count);
    });

    std::vector<Column<double>> wide;
    for (const float* column : in) wide.emplace_back(column, column + point_count);
    std::vector<Column<double>> wide_results(3, Column<double>(point_count));
    std::vector<const double*> wide_in;
    std::vector<double*> wide_out;
    for (const auto& column : wide) wide_in.push_back(column.data());
    for (auto& column : wide_results) wide_out.push_back(column.data());
    add("tape_double", point_count,
        [&] { run(tape, Columns<double>{wide_in}, Results<double>{wide_out}, point_count); });

    std::vector<std::vector<Acceptance>> bounds;
    for (const auto& column : wide) {
        auto& points = bounds.emplace_back();
        for (const double value : column) points.push_back({value, value, false});
    }
    std::vector<std::vector<Acceptance>> accepted(3, std::vector<Acceptance>(point_count));
    std::vector<const Acceptance*> bounds_in;
    std::vector<Acceptance*> bounds_out;
    for (const auto& column : bounds) bounds_in.push_back(column.data());
    for (auto& column : accepted) bounds_out.push_back(column.data());
    add("acceptance", point_count, [&] {
        run_acceptance(tape, Precision::float32, Columns<Acceptance>{bounds_in},
                       Results<Acceptance>{bounds_out}, point_count);
    });

    Data large{many_points};
    const auto large_in = large.in(tape);
    const auto large_out = large.out();
    for (const unsigned threads : {1U, 2U, 4U})
        add(fmt::format("threads_{}", threads), many_points,
            [&, threads] { run_parallel<float>(tape, large_in, large_out, many_points, threads); });

    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);
    auto& time = collector.times;
    for (const auto& [name, nanoseconds] : time)
        fmt::print("{:<16}{:>10.2f} ns per point\n", name, nanoseconds);
    fmt::print("\n");
    row("scalar C++ (-O3 -march=native, libm) / tape", time["scalar"] / time["tape"],
        "at least 4, aim 6");
    row("tape / AVX2 by hand", time["tape"] / time["avx2"], "at most 1.5");
    row("tape / AVX2 by hand with FMA", time["tape"] / time["avx2_fma"], "");
    if (time.contains("tape_avx2")) {
        row("scalar C++ / tape restricted to AVX2", time["scalar"] / time["tape_avx2"], "");
        row("tape restricted to AVX2 / AVX2 by hand", time["tape_avx2"] / time["avx2"], "");
    }
    row("scaling on 2 threads", time["threads_1"] / time["threads_2"], "up to 2");
    row("scaling on 4 threads", time["threads_1"] / time["threads_4"], "up to 4");
    row("acceptance check, microseconds per point", time["acceptance"] / 1000, "at most 5");
    return 0;
}
