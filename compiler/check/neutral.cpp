#include "check/neutral.h"

#include <algorithm>
#include <array>

namespace lobe::check {

Condition::Condition(const ir::Module& module, const ir::Effect& effect)
    : module_(module), function_(module[effect.off_when]),
      tape_(evaluate::compile(module, function_))
{
    for (const evaluate::TapeInput& input : tape_.inputs)
        defaults_.push_back(
            parameter_of(input).default_value[static_cast<std::size_t>(input.component)]);
    for (const ir::ExprId id : function_.graph.ids())
        if (function_.graph[id].op == ir::Op::literal)
            literals_.push_back(function_.graph.literal_of(id).value);
}

std::vector<double> Condition::neutral_values(const ir::Field& field) const
{
    std::vector<double> result;
    const auto input = find(field);
    if (!input) return result;
    std::vector<double> tried{defaults_[*input]};
    tried.insert(tried.end(), literals_.begin(), literals_.end());
    const ir::Range& range = module_.parameters[field.parameter].range;
    for (const double value : tried) {
        if (value < range.low || value > range.high) continue;
        std::vector<double> at = defaults_;
        at[*input] = value;
        if (is_off(at) && std::ranges::find(result, value) == result.end()) result.push_back(value);
    }
    return result;
}

bool Condition::stays_off(const ir::Field& field, const Acceptance& read) const
{
    std::vector<Acceptance> at;
    for (const double value : defaults_) at.push_back(point(value));
    at[find(field).value()] = read;
    std::vector<const Acceptance*> columns;
    for (const Acceptance& value : at) columns.push_back(&value);
    Acceptance result;
    const std::array<Acceptance*, 1> outputs{&result};
    evaluate::run_acceptance(tape_, evaluate::Precision::float32, columns, outputs, 1);
    return result.low > 0 && !result.undefined;
}

const ir::Parameter& Condition::parameter_of(const evaluate::TapeInput& input) const
{
    return module_.parameters[function_.inputs[input.input].which];
}

std::optional<std::size_t> Condition::find(const ir::Field& field) const
{
    for (std::size_t i = 0; i < tape_.inputs.size(); ++i) {
        const evaluate::TapeInput& input = tape_.inputs[i];
        if (function_.inputs[input.input].which == field.parameter &&
            input.component == field.component)
            return i;
    }
    return std::nullopt;
}

bool Condition::is_off(const std::vector<double>& at) const
{
    std::vector<const double*> columns;
    for (const double& value : at) columns.push_back(&value);
    double result = 0;
    const std::array<double*, 1> outputs{&result};
    evaluate::run(tape_, evaluate::Columns<double>{columns}, evaluate::Results<double>{outputs}, 1);
    return result != 0;
}

std::vector<Condition> conditions_of(const ir::Module& module)
{
    std::vector<Condition> conditions;
    for (const ir::Effect& effect : module.effects) conditions.emplace_back(module, effect);
    return conditions;
}

}  // namespace lobe::check
