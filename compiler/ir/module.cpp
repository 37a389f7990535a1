#include "ir/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace lobe::ir {

Input field_input(Origin origin, std::uint32_t which, Span span)
{
    const auto made = [&](const FieldFacts& field, Quantity vector) {
        return Input{std::string{field.name},
                     field.type,
                     field.type == Type::vec3 ? vector : Quantity::number,
                     {field.low, field.high},
                     origin,
                     which,
                     span};
    };
    switch (origin) {
    case Origin::geometry:
        return made(facts(static_cast<GeometryField>(which)), Quantity::direction);
    case Origin::surface: return made(facts(static_cast<SurfaceField>(which)), Quantity::color);
    case Origin::emitter: {
        const auto field = static_cast<EmitterField>(which);
        return made(facts(field),
                    field == EmitterField::axis ? Quantity::direction : Quantity::vector);
    }
    case Origin::argument:
    case Origin::parameter: break;
    }
    assert(false && "only structures have fields");
    return {};
}

std::optional<std::uint32_t> Function::find_input(Origin origin, std::uint32_t which) const
{
    for (std::uint32_t i = 0; i < inputs.size(); ++i)
        if (inputs[i].origin == origin && inputs[i].which == which) return i;
    return std::nullopt;
}

std::optional<FunctionId> Module::find(std::string_view function_name) const
{
    for (std::size_t i = 0; i < functions.size(); ++i)
        if (functions[i].name == function_name) return FunctionId{i};
    return std::nullopt;
}

std::vector<FunctionId> Module::roots() const
{
    std::vector<FunctionId> result;
    for (const std::vector<Model>* list : {&models, &lights})
        for (const Model& model : *list)
            for (const ModelOutput& output : model.outputs) result.push_back(output.function);
    if (!result.empty()) return result;

    std::vector<bool> is_condition(functions.size());
    for (const Effect& effect : effects) is_condition[effect.off_when.index] = true;
    for (std::size_t i = 0; i < functions.size(); ++i)
        if (owns(functions[i]) && !is_condition[i] &&
            functions[i].kind != Function::Kind::storage &&
            functions[i].kind != Function::Kind::shade)
            result.push_back(FunctionId{i});
    return result;
}

std::vector<FunctionId> Module::shading_roots() const
{
    std::vector<FunctionId> result;
    for (const Shading& shading : shadings) {
        if (shading.function.valid()) {
            result.push_back(shading.function);
            continue;
        }
        for (const Model* model : {&shading.model, &shading.light})
            for (const ModelOutput& output : model->outputs) result.push_back(output.function);
    }
    return result;
}

std::vector<FunctionId> Module::packing_roots() const
{
    std::vector<FunctionId> result;
    for (const Packing& packing : packings) {
        for (const auto& channel : packing.channels) result.push_back(channel.pack);
        for (const auto& parameter : packing.parameters) result.push_back(parameter.unpack);
    }
    return result;
}

const Gbuffer* Module::find_gbuffer(std::string_view gbuffer_name) const
{
    const auto found = std::ranges::find(gbuffers, gbuffer_name, &Gbuffer::name);
    return found == gbuffers.end() ? nullptr : &*found;
}

std::vector<FunctionId> Module::reachable(const std::vector<FunctionId>& from) const
{
    std::vector<bool> wanted(functions.size());
    for (const FunctionId id : from) wanted[id.index] = true;
    // Callees come first, so one backward sweep reaches everything.
    for (std::size_t i = functions.size(); i-- > 0;) {
        if (!wanted[i]) continue;
        const Function& function = functions[i];
        const auto uses = use_counts(function.graph, function.result);
        for (const ExprId id : function.graph.ids())
            if (uses[id] > 0 && function.graph[id].op == Op::call)
                wanted[function.graph[id].aux] = true;
    }
    std::vector<FunctionId> result;
    for (std::size_t i = 0; i < functions.size(); ++i)
        if (wanted[i]) result.push_back(FunctionId{i});
    return result;
}

Module without_functions(const Module& module)
{
    return {.name = module.name,
            .path = module.path,
            .doc = module.doc,
            .sources = module.sources,
            .tiers = module.tiers,
            .parameters = module.parameters,
            .functions = {},
            .effects = module.effects,
            .models = module.models,
            .lights = module.lights,
            .shadings = module.shadings,
            .gbuffers = module.gbuffers,
            .packings = module.packings,
            .engines = module.engines,
            .remarks = module.remarks,
            .bare_geometry = module.bare_geometry};
}

Function without_body(const Function& function)
{
    return {.name = function.name,
            .kind = function.kind,
            .module = function.module,
            .doc = function.doc,
            .citations = function.citations,
            .span = function.span,
            .inputs = {},
            .graph = {},
            .result = {},
            .quantity = function.quantity,
            .declared_range = function.declared_range,
            .range = function.range,
            .form_of = function.form_of,
            .form_name = function.form_name,
            .formula = function.formula};
}

Function entry_point(const Module& module, FunctionId id)
{
    const Function& callee = module[id];
    Function entry = callee;
    entry.graph = {};
    entry.inputs.clear();

    const auto add_input = [&entry](Input input) {
        const auto index = static_cast<std::uint32_t>(entry.inputs.size());
        entry.inputs.push_back(input);
        return entry.graph.input(index, input.type, input.span);
    };
    const auto add_vector = [&add_input](GeometryField field) {
        return add_input(field_input(Origin::geometry, static_cast<std::uint32_t>(field)));
    };

    bool geometry = false;
    bool tangents = false;
    Frame frame;
    frame.bare = module.bare_geometry;
    for (const Input& input : callee.inputs)
        if (input.origin == Origin::geometry) {
            geometry = true;
            const auto field = static_cast<GeometryField>(input.which);
            tangents |= needs_tangents(field);
            frame.expect(field);
        }
    if (geometry) {
        frame.l = add_vector(GeometryField::l);
        frame.v = add_vector(GeometryField::v);
        frame.n = add_vector(GeometryField::n);
    }
    if (tangents) {
        frame.x = add_vector(GeometryField::x);
        frame.y = add_vector(GeometryField::y);
    }

    std::vector<ExprId> operands;
    for (const Input& input : callee.inputs)
        operands.push_back(input.origin == Origin::geometry
                               ? expand(entry.graph, static_cast<GeometryField>(input.which), frame)
                               : add_input(input));
    entry.result = entry.graph.call(id, callee.type(), operands, callee.span);
    return entry;
}

namespace {

std::optional<std::string> verify_function(const Module& module, std::size_t index)
{
    const Function& function = module.functions[index];
    const auto broken = [&](std::string what) {
        return fmt::format("function {}: {}", function.name, what);
    };
    if (!function.result.valid() || function.result.index >= function.graph.size())
        return broken("has no result");
    for (const ExprId id : function.graph.ids()) {
        const Expr& expr = function.graph[id];
        if (expr.op == Op::input) {
            if (expr.aux >= function.inputs.size()) return broken("reads an input it lacks");
            if (function.inputs[expr.aux].type != expr.type)
                return broken(
                    fmt::format("reads input {} as another type", function.inputs[expr.aux].name));
        }
        if (expr.op == Op::call) {
            if (expr.aux >= index) return broken("calls a function that does not come before it");
            const Function& callee = module.functions[expr.aux];
            if (callee.inputs.size() != expr.count)
                return broken(fmt::format("passes {} operands to {}, which takes {}", expr.count,
                                          callee.name, callee.inputs.size()));
            if (callee.type() != expr.type)
                return broken(fmt::format("takes the result of {} as another type", callee.name));
            for (std::size_t i = 0; i < callee.inputs.size(); ++i)
                if (function.graph[function.graph.operands(id)[i]].type != callee.inputs[i].type)
                    return broken(fmt::format("passes another type to {} of {}",
                                              callee.inputs[i].name, callee.name));
        }
    }
    return std::nullopt;
}

std::optional<std::string> verify_packing(const Module& module, const Packing& packing)
{
    const auto broken = [&](std::string_view what) {
        return fmt::format("the packing of {} on {} {}", packing.model.name, packing.gbuffer, what);
    };
    const auto is_function = [&](FunctionId id) { return id.index < module.functions.size(); };
    const auto is_parameter = [&](std::uint32_t i) { return i < module.parameters.size(); };
    const Gbuffer* gbuffer = module.find_gbuffer(packing.gbuffer);
    if (gbuffer == nullptr) return broken("has a gbuffer that the module lacks");
    if (packing.supported.size() != gbuffer->configurations())
        return broken("supports configurations of another gbuffer");
    for (const ModelOutput& output : packing.model.outputs)
        if (!is_function(output.function)) return broken("has an output without a function");
    for (const Field& field : packing.fields) {
        if (!is_parameter(field.parameter)) return broken("stores a parameter that is not there");
        int bits = 0;
        for (const Slot& slot : field.slots) {
            if (slot.channel >= gbuffer->channels.size())
                return broken("has a slot in a channel that is not there");
            bits += slot.bits;
        }
        if (bits != field.bits) return broken("has a field of other bits than its slots");
        if (!is_function(field.encode) || !is_function(field.decode))
            return broken("has a field without functions");
    }
    for (const ExactRequirement& exact : packing.exact)
        if (!is_parameter(exact.parameter)) return broken("requires what is not there");
    for (const auto& channel : packing.channels)
        if (!is_function(channel.pack)) return broken("has a channel without a function");
    for (const auto& parameter : packing.parameters)
        if (!is_parameter(parameter.parameter) || !is_function(parameter.unpack))
            return broken("has a parameter without a function");
    return std::nullopt;
}

std::optional<std::string> verify_engine(const Module& module, const Engine& engine)
{
    const auto broken = [&](std::string_view what) {
        return fmt::format("the engine block of {} for {} {}", engine.gbuffer, engine.model, what);
    };
    const Gbuffer* gbuffer = module.find_gbuffer(engine.gbuffer);
    if (gbuffer == nullptr) return broken("has a gbuffer that the module lacks");
    const auto is_parameter = [&](std::uint32_t i) { return i < module.parameters.size(); };
    for (const Engine::PinUse& use : engine.pins)
        if (use.pin >= gbuffer->pins.size() || !is_parameter(use.parameter))
            return broken("feeds what is not there");
    if (engine.node && !std::ranges::all_of(engine.node->parameters, is_parameter))
        return broken("has an input for what is not there");
    return std::nullopt;
}

}  // namespace

std::optional<std::string> verify(const Module& module)
{
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            if (module.functions[i].name == module.functions[j].name)
                return fmt::format("two functions are named {}", module.functions[i].name);
        if (auto broken = verify_function(module, i)) return broken;
    }
    const auto verify_outputs = [&](const Model& model) -> std::optional<std::string> {
        for (const ModelOutput& output : model.outputs)
            if (output.function.index >= module.functions.size())
                return fmt::format("{} has an output without a function", model.name);
        return std::nullopt;
    };
    for (const std::vector<Model>* list : {&module.models, &module.lights})
        for (const Model& model : *list)
            if (auto broken = verify_outputs(model)) return broken;
    for (const Shading& shading : module.shadings)
        for (const Model* model : {&shading.model, &shading.light})
            if (auto broken = verify_outputs(*model)) return broken;
    for (const Packing& packing : module.packings)
        if (auto broken = verify_packing(module, packing)) return broken;
    for (const Engine& engine : module.engines)
        if (auto broken = verify_engine(module, engine)) return broken;
    return std::nullopt;
}

}  // namespace lobe::ir
