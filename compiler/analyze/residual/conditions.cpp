#include "analyze/residual/conditions.h"

#include "evaluate/run.h"
#include "optimize/inline.h"
#include "optimize/specialize.h"
#include "optimize/truth.h"

#include <algorithm>

namespace lobe::analyze {

using evaluate::Interval;

Conditions::Conditions(const ir::Module& module)
{
    for (const ir::Effect& effect : module.effects) {
        Condition& condition = effects_.emplace_back();
        condition.alone = ir::without_functions(module);
        condition.alone.effects.clear();
        condition.alone.models.clear();
        condition.alone.lights.clear();
        condition.alone.shadings.clear();
        condition.alone.packings.clear();
        condition.alone.engines.clear();
        ir::Function function = optimize::inline_calls(module, effect.off_when);
        function.module = condition.alone.name;
        for (const ir::Input& input : function.inputs)
            condition.parameters.push_back(module.parameters[input.which].name);
        condition.alone.functions.push_back(std::move(function));
        condition.tape = evaluate::compile(condition.alone, condition.alone.functions[0]);
    }
}

bool Conditions::can_be_on(std::size_t effect, const std::map<std::string, InputFact>& facts,
                           const std::map<std::string, InputFact>& defaults)
{
    Condition& condition = effects_[effect];
    std::vector<double> ends;
    for (const std::string& name : condition.parameters) {
        const auto found = facts.find(name);
        const InputFact& fact = found == facts.end() ? defaults.at(name) : found->second;
        for (const ir::Range& range : fact.components) {
            ends.push_back(range.low);
            ends.push_back(range.high);
        }
    }
    const auto [known, is_new] = condition.known.try_emplace(ends);
    if (is_new) known->second = decide(condition, ends);
    return known->second;
}

bool Conditions::decide(const Condition& condition, const std::vector<double>& ends)
{
    const ir::Function& function = condition.alone.functions[0];
    // Where the first component of each input is among the pairs of ends.
    std::vector<std::size_t> first;
    std::size_t at = 0;
    for (const ir::Input& input : function.inputs) {
        first.push_back(at);
        at += static_cast<std::size_t>(ir::components(input.type));
    }

    std::vector<Interval> values;
    for (const evaluate::TapeInput& input : condition.tape.inputs) {
        const std::size_t pair = first[input.input] + static_cast<std::size_t>(input.component);
        values.push_back({ends[2 * pair], ends[2 * pair + 1]});
    }
    std::vector<const Interval*> columns;
    for (const Interval& value : values) columns.push_back(&value);
    Interval off{0, 1};
    Interval* const result = &off;
    evaluate::run(condition.tape, columns, {&result, 1}, 1);
    if (off.low > 0) return false;
    if (off.high == 0) return true;

    // Products of decimals are no doubles: what intervals leave open may be exact.
    optimize::Settings constants;
    for (std::size_t i = 0; i < function.inputs.size(); ++i) {
        std::vector<double> value;
        const auto components = static_cast<std::size_t>(ir::components(function.inputs[i].type));
        for (std::size_t pair = first[i]; pair < first[i] + components; ++pair)
            if (ends[2 * pair] == ends[2 * pair + 1]) value.push_back(ends[2 * pair]);
        if (value.size() == components) constants[condition.parameters[i]] = std::move(value);
    }
    const ir::Module fixed = optimize::specialize(condition.alone, constants);
    const auto truth = optimize::truth(fixed.functions[0].graph, fixed.functions[0].result);
    return truth != true;
}

}  // namespace lobe::analyze
