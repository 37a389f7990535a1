#include "optimize/residual.h"

#include "ir/insert.h"
#include "optimize/binary.h"
#include "optimize/inline.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"
#include "optimize/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>
#include <string>

namespace lobe::optimize {

using namespace ir;

namespace {

// ---- what is asked for

/// One model and what stores and feeds it. Packings lose their functions: they are built again of
/// what is left.
Module of_model(Module module, std::string_view model)
{
    const bool known = std::ranges::count(module.models, model, &Model::name) > 0;
    if (known) {
        std::erase_if(module.models, [&](const Model& other) { return other.name != model; });
        std::erase_if(module.packings, [&](const Packing& other) {
            return other.model.name != model || other.model.module != module.name;
        });
        std::erase_if(module.engines, [&](const Engine& other) { return other.model != model; });
        std::erase_if(module.shadings,
                      [&](const Shading& other) { return other.model.name != model; });
    }
    for (Packing& packing : module.packings) {
        packing.channels.clear();
        packing.parameters.clear();
        for (Field& field : packing.fields) field.encode = field.decode = {};
    }
    return module;
}

/// Everything that must stay callable, whoever calls it.
std::vector<FunctionId> kept_roots(const Module& module)
{
    std::vector<FunctionId> roots = module.roots();
    std::ranges::copy(module.shading_roots(), std::back_inserter(roots));
    for (const Packing& packing : module.packings) {
        for (const ModelOutput& output : packing.model.outputs) roots.push_back(output.function);
        for (const Field& field : packing.fields)
            if (field.code.kind == Code::Kind::declared) {
                roots.push_back(field.code.encode);
                roots.push_back(field.code.decode);
            }
    }
    return roots;
}

/// Which parameters the code of a module reads, by index: what its roots take.
std::vector<bool> read_parameters(const Module& module)
{
    std::vector<bool> result(module.parameters.size());
    for (const FunctionId root : kept_roots(module))
        for (const Input& input : module[root].inputs)
            if (input.origin == Origin::parameter) result[input.which] = true;
    return result;
}

// ---- effects

/// The condition of an effect, decided without the module around it.
class Condition {
public:
    Condition(const Module& module, const Effect& effect) : alone_(without_functions(module))
    {
        alone_.models.clear();
        alone_.lights.clear();
        alone_.shadings.clear();
        alone_.effects.clear();
        alone_.packings.clear();
        alone_.engines.clear();
        Function function = inline_calls(module, effect.off_when);
        function.module = module.name;
        for (const Input& input : function.inputs) reads_.push_back(input.name);
        alone_.functions.push_back(std::move(function));
    }

    /// The names of the parameters that it is about.
    const std::vector<std::string>& reads() const { return reads_; }
    bool holds(const Settings& settings) const
    {
        const Function decided = specialize(alone_, settings).functions[0];
        return truth(decided.graph, decided.result) == true;
    }

private:
    Module alone_;
    std::vector<std::string> reads_;
};

std::vector<Condition> conditions_of(const Module& module)
{
    std::vector<Condition> conditions;
    for (const Effect& effect : module.effects) conditions.emplace_back(module, effect);
    return conditions;
}

/// Effects that may be off together, and the settings under which they are.
class Effects {
public:
    Effects(const Module& module, const Called& called)
        : module_(module), settings_(called.constants), conditions_(conditions_of(module))
    {
        for (const Effect& effect : module.effects)
            wanted_.push_back(called.off.contains(effect.name));
        off_.resize(conditions_.size());
        for (std::size_t i = 0; i < conditions_.size(); ++i)
            off_[i] = conditions_[i].holds(settings_);
        for (std::size_t i = 0; i < conditions_.size(); ++i)
            if (wanted_[i] && !off_[i]) switch_off(i);
    }

    const Settings& settings() const { return settings_; }
    bool is_off(std::size_t effect) const { return off_[effect]; }
    const std::vector<std::string>& reads(std::size_t effect) const
    {
        return conditions_[effect].reads();
    }

private:
    /// The defaults of the condition's parameters, but of those that an effect reads that is on;
    /// if that keeps off what is off already.
    void switch_off(std::size_t effect)
    {
        Settings tried = settings_;
        for (const Parameter& parameter : module_.parameters) {
            if (!reads(effect, parameter.name)) continue;
            bool shared = false;
            for (std::size_t i = 0; i < conditions_.size(); ++i)
                shared |= !wanted_[i] && !off_[i] && reads(i, parameter.name);
            if (!shared) tried[parameter.name] = parameter.default_value;
        }
        bool holds = conditions_[effect].holds(tried);
        for (std::size_t i = 0; i < conditions_.size(); ++i)
            holds = holds && (!off_[i] || conditions_[i].holds(tried));
        if (!holds) return;
        settings_ = std::move(tried);
        off_[effect] = true;
    }

    bool reads(std::size_t effect, const std::string& parameter) const
    {
        return std::ranges::count(conditions_[effect].reads(), parameter) > 0;
    }

    const Module& module_;
    Settings settings_;
    std::vector<Condition> conditions_;
    std::vector<bool> wanted_;
    std::vector<bool> off_;
};

// ---- what is left

/// Packings and engines without what nothing reads. A packing without fields goes, and with it what
/// feeds it.
void keep_parameters(Module& module, const std::vector<bool>& left)
{
    const auto is_gone = [&](std::uint32_t parameter) { return !left[parameter]; };
    for (Packing& packing : module.packings) {
        std::erase_if(packing.fields, [&](const Field& field) { return is_gone(field.parameter); });
        std::erase_if(packing.exact,
                      [&](const ExactRequirement& exact) { return is_gone(exact.parameter); });
        std::erase_if(packing.measured, [&](const MeasuredRange& range) {
            const auto found = std::ranges::find(module.parameters, range.name, &Parameter::name);
            return found != module.parameters.end() &&
                   is_gone(static_cast<std::uint32_t>(found - module.parameters.begin()));
        });
    }
    std::erase_if(module.packings, [](const Packing& packing) { return packing.fields.empty(); });
    for (Engine& engine : module.engines) {
        std::erase_if(engine.pins,
                      [&](const Engine::PinUse& use) { return is_gone(use.parameter); });
        if (engine.node) std::erase_if(engine.node->parameters, is_gone);
        if (engine.node && engine.node->parameters.empty()) engine.node.reset();
    }
    std::erase_if(module.engines, [&](const Engine& engine) {
        return std::ranges::none_of(module.packings, [&](const Packing& packing) {
            return packing.gbuffer == engine.gbuffer && packing.model.name == engine.model;
        });
    });
}

/// A function that only calls another one with what it got: what was around the call is gone.
bool only_forwards(const Function& function)
{
    const Graph& graph = function.graph;
    return graph[function.result].op == Op::call &&
           std::ranges::all_of(graph.operands(function.result),
                               [&](ExprId id) { return graph[id].op == Op::input; });
}

/// Callers call what these call.
Module without_forwarding(const Module& module)
{
    const std::vector<bool> is_root = root_flags(module);
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        return [&](ExprId id) {
            const ExprId copy = rebuild.copy(id);
            const Expr& expr = rebuild.graph[copy];
            if (expr.op != Op::call || is_root[expr.aux]) return copy;
            const Function& callee = rebuild.rebuilt(FunctionId{expr.aux});
            if (!only_forwards(callee)) return copy;
            const auto operands = rebuild.graph.operands(copy);
            return inline_body(rebuild.graph, callee,
                               std::vector(operands.begin(), operands.end()));
        };
    });
}

/// Without functions that nothing calls any more.
Module without_unused(const Module& module)
{
    std::vector<FunctionId> roots = kept_roots(module);
    for (const Effect& effect : module.effects) roots.push_back(effect.off_when);
    std::vector<bool> kept(module.functions.size());
    for (const FunctionId id : module.reachable(roots)) kept[id.index] = true;
    return keep_functions(module, kept);
}

/// The words of a formula, in its order.
std::vector<std::string> words_of(const std::string& formula)
{
    std::vector<std::string> words;
    bool inside = false;
    for (const char c : formula) {
        const bool letter =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9');
        if (letter && !inside) words.emplace_back();
        if (letter) words.back() += c;
        inside = letter;
    }
    return words;
}

/// Formulas are bodies as they were written. The parameters that they name and that are no inputs
/// any more have a value, which is said behind them.
void tell_values(Module& module, const Settings& settings, const std::vector<bool>& left)
{
    for (Function& function : module.functions) {
        std::string values;
        std::set<std::string> told;
        for (const std::string& word : words_of(function.formula)) {
            const auto parameter = std::ranges::find(module.parameters, word, &Parameter::name);
            const auto value = settings.find(word);
            if (parameter == module.parameters.end() || value == settings.end() ||
                left[static_cast<std::size_t>(parameter - module.parameters.begin())] ||
                !told.insert(word).second)
                continue;
            const bool is_one = value->second.size() == 1;
            values +=
                fmt::format("{} {} = {}{}{}", values.empty() ? ", where" : ",", word,
                            is_one ? "" : "(", fmt::join(value->second, ", "), is_one ? "" : ")");
        }
        function.formula += values;
    }
}

/// What is stored comes back in steps of its codes, so its range stays the declared one.
Limits limits_of(const Module& module, const Called& called)
{
    Limits limits = called.ranges;
    for (const Packing& packing : module.packings)
        for (const Field& field : packing.fields)
            limits.erase(module.parameters[field.parameter].name);
    return limits;
}

}  // namespace

Residual residual(const Module& module, const Called& called, std::string_view model)
{
    Residual result;
    Module current = without_unused(of_model(module, model));
    // No pass reads them, and every pass would copy them.
    std::vector<Gbuffer> gbuffers = std::move(current.gbuffers);
    current.gbuffers.clear();
    const Effects effects{current, called};

    // First the effects alone, so that it is known what only they read.
    Settings of_effects;
    for (std::size_t i = 0; i < current.effects.size(); ++i)
        if (effects.is_off(i))
            for (const std::string& name : effects.reads(i))
                if (const auto set = effects.settings().find(name); set != effects.settings().end())
                    of_effects.insert(*set);
    current = specialize(current, of_effects);
    const std::vector<bool> called_for = read_parameters(current);

    current = specialize(current, effects.settings());
    const std::vector<bool> left_now = read_parameters(current);
    keep_parameters(current, left_now);
    current = choose_ends(narrow(current, limits_of(current, called)), called.binary);
    current = specialize(current, {});

    std::vector<Effect> on;
    for (std::size_t i = 0; i < current.effects.size(); ++i) {
        if (effects.is_off(i))
            result.off.push_back(current.effects[i].name);
        else
            on.push_back(current.effects[i]);
    }
    current.effects = std::move(on);

    // Narrower ranges may have decided what a parameter was read for.
    const std::vector<bool> left = read_parameters(current);
    keep_parameters(current, left);
    for (std::size_t i = 0; i < left.size(); ++i) {
        const std::string& name = current.parameters[i].name;
        (left[i]                                              ? result.left
         : called_for[i] && effects.settings().contains(name) ? result.fixed
                                                              : result.absent)
            .push_back(name);
    }

    current = without_unused(without_forwarding(current));
    tell_values(current, effects.settings(), left);
    current.gbuffers = std::move(gbuffers);
    for (Packing& packing : current.packings)
        build_functions(current, packing, *current.find_gbuffer(packing.gbuffer));
    assert(!verify(current));
    result.settings = effects.settings();
    result.module = std::move(current);
    return result;
}

}  // namespace lobe::optimize
