#include "ir/shade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <tuple>

namespace lobe::ir {
namespace {

const ModelOutput* find_output(const Model& model, std::string_view name)
{
    const auto found = std::ranges::find(model.outputs, name, &ModelOutput::name);
    return found == model.outputs.end() ? nullptr : &*found;
}

Range product(const Range& a, const Range& b)
{
    const auto [low, high] =
        std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
    return {low, high};
}

class Shade {
public:
    Shade(const Module& module, const Model& model, const Model& light)
        : module_(module), model_(model), light_(light)
    {
        for (const Model* part : {&light, &model})
            for (const ModelOutput& output : part->outputs) collect(module[output.function]);
        // What a host has at hand, the light first.
        std::ranges::stable_sort(inputs_, {}, [](const Input& input) {
            return std::tuple{place_of(input.origin), input.which};
        });
    }

    Function function()
    {
        Function& result = function_;
        result.name = shade_name(model_, light_);
        result.kind = Function::Kind::shade;
        result.module = module_.name;
        result.doc = fmt::format("The model `{}` under a light `{}`, to be multiplied by the "
                                 "light's color and intensity.",
                                 model_.name, light_.name);
        result.span = light_.span;
        result.inputs = inputs_;

        const ExprId l = named(part("direction"), "l");
        const ModelOutput* other = find_output(light_, "specular_direction");
        const ExprId mirrored = other == nullptr ? l : named(call(*other, {}), "specular_l");
        const ModelOutput* gain = find_output(light_, "specular_gain");

        std::string formula;
        Sum plain = sum(l, false, formula);
        Sum specular = sum(mirrored, true, formula);
        if (gain != nullptr && specular.value.valid()) {
            const ExprId by = named(call(*gain, {}), "specular_gain");
            specular.value = graph().apply(Op::multiply, {by, specular.value});
            specular.range = product(specular.range, module_[gain->function].range);
        }
        if (plain.value.valid() && specular.value.valid()) {
            plain.value = graph().apply(Op::add, {plain.value, specular.value});
            plain.range = {plain.range.low + specular.range.low,
                           plain.range.high + specular.range.high};
        } else if (specular.value.valid()) {
            plain = specular;
        }
        const ModelOutput& irradiance = *find_output(light_, "irradiance");
        result.result =
            graph().apply(Op::multiply, {named(call(irradiance, {}), "irradiance"), plain.value});
        result.range = product(plain.range, module_[irradiance.function].range);
        result.formula = fmt::format("irradiance * ({})", formula);
        result.quantity = result.type() == Type::vec3 ? Quantity::color : Quantity::number;
        return std::move(function_);
    }

private:
    struct Sum {
        ExprId value;
        Range range{0, 0};
    };

    static int place_of(Origin origin)
    {
        switch (origin) {
        case Origin::emitter: return 0;
        case Origin::geometry: return 1;
        case Origin::surface: return 2;
        case Origin::argument: return 3;
        case Origin::parameter: return 4;
        }
        return 0;
    }

    Graph& graph() { return function_.graph; }

    ExprId named(ExprId value, std::string_view name)
    {
        graph().set_name(value, name);
        return value;
    }

    ExprId part(std::string_view name) { return call(*find_output(light_, name), {}); }

    void add(const Input& input)
    {
        const bool known = std::ranges::any_of(inputs_, [&](const Input& other) {
            return other.origin == input.origin && other.which == input.which &&
                   (input.origin != Origin::argument || other.name == input.name);
        });
        if (!known) inputs_.push_back(input);
    }

    /// What a host has to give for a function: vectors in place of the fields of a geometry.
    void collect(const Function& function)
    {
        for (const Input& input : function.inputs) {
            if (input.origin != Origin::geometry) {
                add(input);
                continue;
            }
            const auto field = static_cast<GeometryField>(input.which);
            add(vector_input(GeometryField::v));
            add(vector_input(GeometryField::n));
            if (!needs_tangents(field)) continue;
            add(vector_input(GeometryField::x));
            add(vector_input(GeometryField::y));
        }
    }

    static Input vector_input(GeometryField field)
    {
        return field_input(Origin::geometry, static_cast<std::uint32_t>(field));
    }

    ExprId input(const Input& wanted)
    {
        for (std::uint32_t i = 0; i < inputs_.size(); ++i)
            if (inputs_[i].origin == wanted.origin && inputs_[i].which == wanted.which &&
                (wanted.origin != Origin::argument || inputs_[i].name == wanted.name))
                return graph().input(i, inputs_[i].type);
        return {};
    }

    Frame frame(ExprId l)
    {
        Frame result;
        result.bare = module_.bare_geometry;
        result.l = l;
        result.v = input(vector_input(GeometryField::v));
        result.n = input(vector_input(GeometryField::n));
        result.x = input(vector_input(GeometryField::x));
        result.y = input(vector_input(GeometryField::y));
        return result;
    }

    ExprId field(GeometryField which, const Frame& from)
    {
        const ExprId value = expand(graph(), which, from);
        if (ir::shape(graph()[value].op) != Shape::leaf) graph().set_name(value, facts(which).name);
        return value;
    }

    ExprId call(const ModelOutput& output, const Frame& from)
    {
        const Function& callee = module_[output.function];
        std::vector<ExprId> operands;
        for (const Input& wanted : callee.inputs) {
            operands.push_back(wanted.origin == Origin::geometry && from.l.valid()
                                   ? field(static_cast<GeometryField>(wanted.which), from)
                                   : input(wanted));
        }
        return graph().call(output.function, callee.type(), operands, callee.span);
    }

    /// The outputs of one kind, lit from one direction. Adds them to what is written of the whole.
    Sum sum(ExprId l, bool mirrored, std::string& formula)
    {
        Frame from = frame(l);
        std::vector<const ModelOutput*> outputs;
        for (const ModelOutput& output : model_.outputs) {
            if (follows_mirror(output) != mirrored) continue;
            outputs.push_back(&output);
            for (const Input& wanted : module_[output.function].inputs)
                if (wanted.origin == Origin::geometry)
                    from.expect(static_cast<GeometryField>(wanted.which));
        }
        const bool gained = mirrored && find_output(light_, "specular_gain") != nullptr;
        Sum result;
        std::string text;
        for (const ModelOutput* output : outputs) {
            const ExprId value = call(*output, from);
            const Range& range = module_[output->function].range;
            result.value =
                result.value.valid() ? graph().apply(Op::add, {result.value, value}) : value;
            result.range = {result.range.low + range.low, result.range.high + range.high};
            text += (text.empty() ? "" : " + ") + output->name;
        }
        if (outputs.empty()) return result;
        if (gained)
            text = outputs.size() > 1 ? fmt::format("specular_gain * ({})", text)
                                      : fmt::format("specular_gain * {}", text);
        formula += (formula.empty() ? "" : " + ") + text;
        return result;
    }

    const Module& module_;
    const Model& model_;
    const Model& light_;
    std::vector<Input> inputs_;
    Function function_;
};

/// Another module's functions behind those of one, under names that are free.
class Adoption {
public:
    Adoption(Module& to, const Module& from) : to_(to), from_(from), moved_(from.functions.size())
    {
    }

    void adopt(FunctionId id)
    {
        const Function& old = from_[id];
        Function function = old;
        function.graph = {};
        std::vector<ExprId> copied;
        for (const ExprId expr : old.graph.ids()) {
            std::vector<ExprId> operands;
            for (const ExprId operand : old.graph.operands(expr))
                operands.push_back(copied[operand.index]);
            copied.push_back(old.graph[expr].op == Op::call
                                 ? function.graph.call(moved(FunctionId{old.graph[expr].aux}),
                                                       old.graph[expr].type, operands,
                                                       old.graph.span(expr))
                                 : function.graph.copy(old.graph, expr, operands));
        }
        function.result = copied[old.result.index];
        if (function.form_of.valid()) function.form_of = moved(function.form_of);
        if (to_.find(function.name)) function.name = from_.name + "_" + function.name;
        for (const Citation& citation : function.citations) cite(citation.source);
        moved_[id.index] = FunctionId{to_.functions.size()};
        to_.functions.push_back(std::move(function));
    }

    FunctionId moved(FunctionId id) const { return moved_[id.index]; }

private:
    void cite(const std::string& name)
    {
        if (std::ranges::find(to_.sources, name, &Source::name) != to_.sources.end()) return;
        to_.sources.push_back(*std::ranges::find(from_.sources, name, &Source::name));
    }

    Module& to_;
    const Module& from_;
    std::vector<FunctionId> moved_;
};

}  // namespace

Module join_lights(const Module& module, const Module& lights, std::string_view model)
{
    Module result = module;
    Adoption adoption{result, lights};
    std::vector<FunctionId> roots;
    for (const Model& light : lights.lights)
        for (const ModelOutput& output : light.outputs) roots.push_back(output.function);
    for (const FunctionId id : lights.reachable(roots)) adoption.adopt(id);
    for (const Model& lit : module.models) {
        if (!model.empty() && lit.name != model) continue;
        for (Model light : lights.lights) {
            for (ModelOutput& output : light.outputs)
                output.function = adoption.moved(output.function);
            result.shadings.push_back({lit, std::move(light), {}});
        }
    }
    assert(!verify(result));
    return result;
}

bool follows_mirror(const ModelOutput& output)
{
    return output.name != "diffuse" && output.name != "transmission";
}

std::string shade_name(const Model& model, const Model& light)
{
    return fmt::format("shade_{}_{}", model.name, light.name);
}

Function shade(const Module& module, const Model& model, const Model& light)
{
    return Shade{module, model, light}.function();
}

Module with_shades(Module module)
{
    for (Shading& shading : module.shadings) {
        if (shading.function.valid()) continue;
        Function function = shade(module, shading.model, shading.light);
        shading.function = FunctionId{module.functions.size()};
        module.functions.push_back(std::move(function));
    }
    assert(!verify(module));
    return module;
}

}  // namespace lobe::ir
