#include "analyze/stability_cases.h"

#include "analyze/hazards/search.h"
#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

namespace lobe::tests {
namespace {

std::optional<std::uint32_t> add_file(Sources& sources, const std::string& path)
{
    std::ifstream in{path, std::ios::binary};
    if (!in) return std::nullopt;
    return sources.add(path, {std::istreambuf_iterator<char>{in}, {}});
}

StabilityCase read(const std::string& name)
{
    StabilityCase out;
    Diagnostics diagnostics;
    const auto root = add_file(out.sources, "data/stability/" + name + ".lobe");
    INFO(name);
    REQUIRE(root);
    auto module = front(
        out.sources, *root,
        [](Sources& all, std::string_view imported, std::string_view) {
            return add_file(all, "../models/" + std::string{imported} + ".lobe");
        },
        diagnostics);
    INFO(render_text(out.sources, diagnostics));
    REQUIRE(module);
    CHECK(diagnostics.all().empty());
    out.module = std::move(*module);
    return out;
}

ir::FunctionId function_of(const StabilityCase& which, const std::string& name)
{
    INFO(name);
    const auto function = which.module.find(name);
    REQUIRE(function);
    return *function;
}

}  // namespace

const StabilityCase& stability_case(const std::string& name)
{
    static std::map<std::string, StabilityCase> known;
    const auto place = known.find(name);
    if (place != known.end()) return place->second;
    return known.emplace(name, read(name)).first->second;
}

Errors errors_of(const StabilityCase& which, const std::string& function,
                 optimize::Spelling spelling, evaluate::Precision precision)
{
    const ir::FunctionId id = function_of(which, function);
    const analyze::HazardSpace space{which.module, id, precision};
    const auto line =
        analyze::watch(optimize::spell(which.module, spelling), id, space.inputs().names());
    const auto truth = analyze::watch(optimize::spell(which.module, optimize::Spelling::stable), id,
                                      space.inputs().names());
    const analyze::Points points =
        analyze::points(which.module, space.inputs().entry(), std::size_t{1} << 15, precision);

    Errors out;
    std::vector<double> scaled;
    analyze::Trace trace{line, precision};
    analyze::Trace exact{truth, precision};
    std::vector<double> point(points.columns.size());
    for (std::size_t index = 0; index < points.size(); ++index) {
        for (std::size_t i = 0; i < point.size(); ++i)
            point[i] = static_cast<double>(points.columns[i][index]);
        trace.run(point);
        exact.run(point);
        double worst = 0;
        bool finite = true;
        for (std::size_t k = 0; k < line.tape.outputs.size(); ++k) {
            const double result = trace.device(line.tape.outputs[k]);
            const double wanted = exact.exact(truth.tape.outputs[k]);
            finite = finite && std::isfinite(result);
            const double error = std::fabs(result - wanted);
            worst = std::max(worst, analyze::scaled_error(result, wanted));
            if (std::fabs(wanted) >= trace.grid().least_normal)
                out.relative = std::max(out.relative, error / std::fabs(wanted));
            out.absolute = std::max(out.absolute, error);
        }
        if (!finite) ++out.not_finite;
        scaled.push_back(worst);
    }
    std::ranges::sort(scaled);
    out.greatest = scaled.back();
    out.often = scaled[scaled.size() * 99 / 100];
    return out;
}

std::vector<double> exact_results(const StabilityCase& which, const std::string& function,
                                  const std::vector<double>& inputs)
{
    const ir::FunctionId id = function_of(which, function);
    const analyze::HazardSpace space{which.module, id, evaluate::Precision::float32};
    REQUIRE(inputs.size() == space.inputs().names().size());
    const auto line = analyze::watch(optimize::spell(which.module, optimize::Spelling::stable), id,
                                     space.inputs().names());
    analyze::Trace trace{line, evaluate::Precision::float32};
    trace.run(inputs);
    std::vector<double> out;
    for (const evaluate::Slot slot : line.tape.outputs) out.push_back(trace.exact(slot));
    return out;
}

}  // namespace lobe::tests
