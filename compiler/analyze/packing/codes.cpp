#include "analyze/packing/codes.h"

#include "evaluate/run.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

/// A function of one scalar over many values, in float.
std::vector<float> apply(const ir::Module& module, ir::FunctionId function,
                         const std::vector<float>& values)
{
    const evaluate::Tape tape = evaluate::compile(module, module[function]);
    std::vector<float> results(values.size());
    const float* inputs[] = {values.data()};
    float* outputs[] = {results.data()};
    // A function that ignores its argument has a tape without inputs.
    evaluate::run(tape, std::span{inputs}.first(tape.inputs.size()), outputs, values.size());
    return results;
}

FieldCodes codes_of(const ir::Module& module, const ir::Field& field)
{
    FieldCodes out;
    out.default_value =
        module.parameters[field.parameter].default_value[static_cast<std::size_t>(field.component)];

    std::vector<float> codes;
    for (int code = 0; code <= field.last_code(); ++code) codes.push_back(static_cast<float>(code));
    const std::vector<float> values = apply(module, field.decode, codes);

    out.default_code = static_cast<int>(
        apply(module, field.encode, {static_cast<float>(out.default_value)}).front());
    out.default_code = std::clamp(out.default_code, 0, field.last_code());
    out.default_decoded = values[static_cast<std::size_t>(out.default_code)];

    out.low = *std::ranges::min_element(values);
    out.high = *std::ranges::max_element(values);
    out.codes = 1;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double step = static_cast<double>(values[i]) - values[i - 1];
        out.codes += values[i] != values[i - 1] ? 1 : 0;
        if (step <= out.largest_step) continue;
        out.largest_step = step;
        out.largest_step_from = values[i - 1];
    }
    return out;
}

}  // namespace

std::vector<FieldCodes> field_codes(const ir::Module& module, const ir::Packing& packing)
{
    std::vector<FieldCodes> out;
    for (const ir::Field& field : packing.fields) out.push_back(codes_of(module, field));
    return out;
}

}  // namespace lobe::analyze
