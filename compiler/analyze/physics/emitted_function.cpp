#include "analyze/physics/emitted_function.h"

#include "analyze/agreement/agreement.h"
#include "analyze/agreement/judgement.h"
#include "analyze/heads.h"
#include "analyze/kept_lines.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

const emit::Target& target() { return *emit::find_target("glsl450"); }

std::vector<std::vector<float>> floats(const std::vector<std::vector<double>>& columns)
{
    std::vector<std::vector<float>> out;
    for (const auto& column : columns) {
        auto& rounded = out.emplace_back();
        rounded.reserve(column.size());
        for (const double value : column) rounded.push_back(static_cast<float>(value));
    }
    return out;
}

}  // namespace

EntryInputs::Values EmittedFunction::Batch::point(std::size_t index) const
{
    EntryInputs::Values values;
    for (const auto& column : columns_) values.push_back(column[index]);
    return values;
}

EmittedFunction::EmittedFunction(const ir::Module& module, const Sources& sources,
                                 ir::FunctionId function, device::Device* device)
    : inputs_(module, function, grid_of(evaluate::Precision::float32)),
      tape_(evaluate::compile(module, inputs_.entry())), device_(device),
      harness_(emit::harness(module, sources, function, target(), emit::Precision::float32))
{
}

std::string EmittedFunction::key() const
{
    std::string key = harness_.artifact.text + evaluate::dump(tape_);
    for (const Scalar& scalar : inputs_.scalars())
        write_line(key, scalar.low, scalar.high, scalar.neutral);
    if (device_ != nullptr) write_line(key, device_->facts().name, device_->facts().driver);
    return key;
}

std::string EmittedFunction::emitted(const Batch& batch, ResultColumns& results)
{
    const std::size_t count = batch.size();
    const std::vector<std::vector<float>> columns = floats(batch.columns());
    results.assign(components(), std::vector<double>(count));
    if (device_ == nullptr) {
        std::vector<std::vector<float>> out(components(), std::vector<float>(count));
        evaluate::run(tape_, evaluate::Columns<float>{heads(columns)},
                      evaluate::Results<float>{heads(out)}, count);
        for (std::size_t k = 0; k < out.size(); ++k) std::ranges::copy(out[k], results[k].begin());
        return {};
    }
    if (spirv_.empty()) spirv_ = spirv_of(harness_.artifact.text, target(), harness_.entry);
    if (spirv_.empty()) return "a judge refused it";
    std::vector<float> points(columns.size() * count);
    for (std::size_t i = 0; i < columns.size(); ++i)
        for (std::size_t at = 0; at < count; ++at) points[at * columns.size() + i] = columns[i][at];
    std::vector<float> out;
    if (const auto why = execute(*device_, points, count, harness_, spirv_, out)) return *why;
    for (std::size_t k = 0; k < components(); ++k)
        for (std::size_t at = 0; at < count; ++at) results[k][at] = out[at * components() + k];
    return {};
}

ResultColumns EmittedFunction::exact(const Batch& batch) const
{
    return run(batch.columns(), batch.size());
}

ResultColumns EmittedFunction::exact_at_floats(const Batch& batch) const
{
    std::vector<std::vector<double>> columns = batch.columns();
    for (auto& column : columns)
        for (double& value : column) value = static_cast<double>(static_cast<float>(value));
    return run(columns, batch.size());
}

ResultColumns EmittedFunction::allowed(const Batch& batch) const
{
    const std::size_t count = batch.size();
    std::vector<std::vector<evaluate::Acceptance>> columns;
    for (const auto& column : floats(batch.columns())) {
        auto& out = columns.emplace_back();
        for (const float value : column) out.push_back({value, value, false});
    }
    std::vector<std::vector<evaluate::Acceptance>> accepted(
        components(), std::vector<evaluate::Acceptance>(count));
    evaluate::run_acceptance(tape_, evaluate::Precision::float32, heads(columns), heads(accepted),
                             count);
    const ResultColumns exact = exact_at_floats(batch);
    ResultColumns out(components(), std::vector<double>(count));
    for (std::size_t k = 0; k < components(); ++k)
        for (std::size_t at = 0; at < count; ++at) {
            const evaluate::Acceptance& value = accepted[k][at];
            out[k][at] = value.undefined
                             ? std::numeric_limits<double>::infinity()
                             : std::max(value.high - exact[k][at], exact[k][at] - value.low);
        }
    return out;
}

ResultColumns EmittedFunction::run(const std::vector<std::vector<double>>& columns,
                                   std::size_t count) const
{
    ResultColumns results(components(), std::vector<double>(count));
    evaluate::run(tape_, evaluate::Columns<double>{heads(columns)},
                  evaluate::Results<double>{heads(results)}, count);
    return results;
}

}  // namespace lobe::analyze
