// Small packings made by hand, and their functions at work, for tests that need no source text.
#pragma once

#include "evaluate/run.h"
#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::tests {

/// `g`: targets a, b, … of four 8-bit unorm channels each, all free, under one configuration.
ir::Gbuffer plain_gbuffer(int targets);

ir::Parameter scalar(std::string name, ir::Range range, double default_value);

/// All bits of the first channels, one field after another from the most significant bit of a.r
/// down; slots are cut where a channel ends.
ir::Packing laid_out(const ir::Module& module, std::vector<ir::Field> fields);

ir::Field field(std::uint32_t parameter, int bits, ir::Range range, ir::Code code = {});
ir::Code power(int exponent, int pivot);

/// A function of a module over columns of scalars: one result per point, of its first component.
template <class Number>
std::vector<Number> values(const ir::Module& module, ir::FunctionId function,
                           const std::vector<std::vector<Number>>& inputs, std::size_t output = 0)
{
    const evaluate::Tape tape = evaluate::compile(module, module[function]);
    std::vector<const Number*> columns;
    for (const auto& column : inputs) columns.push_back(column.data());
    std::vector<std::vector<Number>> results(tape.outputs.size(),
                                             std::vector<Number>(inputs.at(0).size()));
    std::vector<Number*> outputs;
    for (auto& column : results) outputs.push_back(column.data());
    const evaluate::Columns<Number> in{columns};
    const evaluate::Results<Number> out{outputs};
    if constexpr (std::is_same_v<Number, evaluate::Acceptance>)
        evaluate::run_acceptance(tape, evaluate::Precision::float32, in, out, inputs.at(0).size());
    else
        evaluate::run(tape, in, out, inputs.at(0).size());
    return results.at(output);
}

/// 0, 1, … all that the bits hold.
template <class Number>
std::vector<Number> all_codes(const ir::Field& field)
{
    std::vector<Number> codes;
    for (int code = 0; code < 1 << field.bits; ++code) {
        if constexpr (std::is_same_v<Number, evaluate::Acceptance>)
            codes.push_back({static_cast<double>(code), static_cast<double>(code), false});
        else
            codes.push_back(static_cast<Number>(code));
    }
    return codes;
}

}  // namespace lobe::tests
