// What tables are made of: terms by their definitions, and split sums.
#include "analyze/environment/baked_table.h"
#include "analyze/environment/split_sum.h"
#include "analyze/tasks.h"
#include "evaluate/parallel.h"
#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace lobe::analyze {
namespace {

using evaluate::Real;
using Columns = std::vector<std::vector<double>>;

constexpr int bits = 113;
constexpr std::size_t batch = 256;

/// `body(begin, size)` for every batch of `count` places, on all threads.
template <class Body>
void for_each_batch(std::size_t count, unsigned jobs, const Body& body)
{
    for_each_task((count + batch - 1) / batch, jobs, [&](std::size_t task) {
        const std::size_t begin = task * batch;
        body(begin, std::min(batch, count - begin));
    });
}

/// A term's tape, and which of its inputs are the axes; the others are fixed.
struct BakeTape {
    evaluate::Tape tape;
    std::vector<std::optional<std::size_t>> axis;  ///< per input of the tape
    std::vector<double> fixed;
};

Columns run(const BakeTape& term, std::span<const Place> places, unsigned jobs)
{
    Columns out(term.tape.outputs.size(), std::vector<double>(places.size()));
    for_each_batch(places.size(), jobs, [&](std::size_t begin, std::size_t size) {
        std::vector<std::vector<Real>> inputs;
        std::vector<const Real*> in;
        for (std::size_t i = 0; i < term.axis.size(); ++i) {
            std::vector<Real> column;
            for (std::size_t k = begin; k < begin + size; ++k)
                column.emplace_back(!term.axis[i]        ? term.fixed[i]
                                    : *term.axis[i] == 0 ? places[k].x
                                                         : places[k].y,
                                    bits);
            inputs.push_back(std::move(column));
        }
        for (const auto& column : inputs) in.push_back(column.data());
        std::vector<std::vector<Real>> results(out.size(), std::vector<Real>(size, Real{bits}));
        std::vector<Real*> results_at;
        for (auto& column : results) results_at.push_back(column.data());
        evaluate::run_real(term.tape, bits, in, results_at, size);
        for (std::size_t k = 0; k < out.size(); ++k)
            for (std::size_t i = 0; i < size; ++i) out[k][begin + i] = results[k][i].to_double();
    });
    return out;
}

TableAxis axis_named(std::string name, double low, double high)
{
    TableAxis axis;
    axis.name = std::move(name);
    axis.low = axis.least = low;
    axis.high = axis.greatest = high;
    return axis;
}

}  // namespace

std::optional<BakeSubject> term_to_bake(const ir::Module& module, ir::FunctionId term,
                                        unsigned jobs, std::string& why)
{
    const ir::Function& function = module[term];
    const auto subject = std::make_shared<BakeTape>();
    subject->tape = evaluate::compile(module, function);
    BakeSubject out;
    out.name = function.name;
    out.how = "the definition, in MPFR at 113 bits";

    if (function.quantity == ir::Quantity::boolean) {
        why = fmt::format("`{}` is true or false, and a table holds numbers", function.name);
        return std::nullopt;
    }
    std::vector<std::string> names;
    for (const evaluate::TapeInput& scalar : subject->tape.inputs) {
        const ir::Input& input = function.inputs[scalar.input];
        subject->fixed.push_back(0);
        if (input.origin == ir::Origin::parameter) {
            const std::vector<double>& standard = module.parameters[input.which].default_value;
            const auto component = static_cast<std::size_t>(scalar.component);
            subject->fixed.back() = standard[std::min(component, standard.size() - 1)];
            subject->axis.emplace_back();
            continue;
        }
        names.push_back(scalar.name);
        subject->axis.emplace_back(out.axes.size());
        if (input.quantity != ir::Quantity::number) {
            why = fmt::format("`{}` depends on `{}`, and a table is over one or two real numbers",
                              function.name, input.name);
            return std::nullopt;
        }
        if (!std::isfinite(input.range.low) || !std::isfinite(input.range.high)) {
            why = fmt::format("`{}` has no range: a table needs two ends", input.name);
            return std::nullopt;
        }
        if (!(input.range.low < input.range.high)) {
            why = fmt::format("`{}` can only be {}: there is nothing to tabulate", input.name,
                              input.range.low);
            return std::nullopt;
        }
        out.axes.push_back(axis_named(scalar.name, input.range.low, input.range.high));
    }
    if (out.axes.empty() || out.axes.size() > 2) {
        why = fmt::format("`{}` depends on {}, and a table is over one or two real numbers",
                          function.name,
                          names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", ")));
        return std::nullopt;
    }
    out.components = subject->tape.output_names;
    out.texels = [subject, jobs](std::span<const Place> places) {
        return run(*subject, places, jobs);
    };
    out.exact = out.texels;
    return out;
}

BakeSubject split_sum_to_bake(std::string name, Visibility visibility, std::uint32_t samples,
                              unsigned jobs)
{
    BakeSubject out;
    out.name = std::move(name);
    out.how = samples == 0 ? "exact quadrature"
                           : fmt::format("the mean of {} importance samples", samples);
    out.components = {"scale", "bias"};
    out.axes = {axis_named("cos_o", 0, 1), axis_named("roughness", 1.0 / 64, 1)};
    const auto subject = std::make_shared<const Visibility>(std::move(visibility));
    const auto values = [subject, jobs](std::span<const Place> places, std::uint32_t count) {
        Columns columns(2, std::vector<double>(places.size()));
        for_each_task(places.size(), jobs, [&](std::size_t i) {
            const Place at = places[i];
            const ScaleAndBias both = count == 0 ? split_sum(*subject, at.y, at.x)
                                                 : sampled_split_sum(*subject, at.y, at.x, count);
            columns[0][i] = both.scale;
            columns[1][i] = both.bias;
        });
        return columns;
    };
    out.texels = [values, samples](std::span<const Place> places) {
        return values(places, samples);
    };
    out.exact = [values](std::span<const Place> places) { return values(places, 0); };
    return out;
}

}  // namespace lobe::analyze
