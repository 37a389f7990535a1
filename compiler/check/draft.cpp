#include "check/draft.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lobe::check {

using ir::ExprId;
using ir::Origin;

namespace {

constexpr std::size_t after_arguments = std::numeric_limits<std::size_t>::max();

}  // namespace

ExprId Draft::input(ir::Input input, Key key, const Span& span)
{
    const auto found = function.find_input(input.origin, input.which);
    if (found) return function.graph.input(*found, input.type, span);
    const auto index = static_cast<std::uint32_t>(function.inputs.size());
    const ir::Type type = input.type;
    function.inputs.push_back(std::move(input));
    keys_.push_back(key);
    return function.graph.input(index, type, span);
}

ExprId Draft::add_argument(const Argument& argument, std::size_t position)
{
    return input({argument.name, argument.type.type.type, argument.type.type.quantity,
                  argument.type.range, Origin::argument, static_cast<std::uint32_t>(position),
                  argument.span},
                 {position, 0}, argument.span);
}

void Draft::set_structure_position(Structure structure, std::size_t position)
{
    if (structure == Structure::geometry) {
        takes_geometry_ = true;
        geometry_ = {position, 0};
    }
    if (structure == Structure::surface) surface_ = {position, 0};
    if (structure != Structure::emitter) return;
    emitter_ = {position, 0};
    // Its v and n are a geometry's, and stand behind its own fields where no geometry is taken.
    const auto fields = static_cast<std::uint32_t>(ir::EmitterField::distance_squared) + 1;
    if (!takes_geometry_) geometry_ = {position, fields};
}

ExprId Draft::field(Origin origin, std::uint32_t which, Key key, const Span& span)
{
    key.which += which;
    return input(ir::field_input(origin, which, span), key, span);
}

ExprId Draft::geometry(ir::GeometryField field, const Span& span)
{
    return this->field(Origin::geometry, static_cast<std::uint32_t>(field), geometry_, span);
}

ExprId Draft::surface(ir::SurfaceField field, const Span& span)
{
    if (field == ir::SurfaceField::alpha) {
        const ExprId roughness = surface(ir::SurfaceField::roughness, span);
        return function.graph.apply(ir::Op::multiply, {roughness, roughness}, span);
    }
    return this->field(Origin::surface, static_cast<std::uint32_t>(field), surface_, span);
}

ExprId Draft::emitter(ir::EmitterField field, const Span& span)
{
    using Field = ir::EmitterField;
    ir::EmitterFrame frame;
    switch (field) {
    case Field::v: return geometry(ir::GeometryField::v, span);
    case Field::n: return geometry(ir::GeometryField::n, span);
    case Field::l:
    case Field::distance_squared: frame.to_light = emitter(Field::to_light, span); break;
    case Field::r:
        frame.v = geometry(ir::GeometryField::v, span);
        frame.n = geometry(ir::GeometryField::n, span);
        break;
    case Field::to_light:
    case Field::axis:
    case Field::radius:
    case Field::half_length:
    case Field::inverse_range:
    case Field::cos_inner:
    case Field::cos_outer:
        return this->field(Origin::emitter, static_cast<std::uint32_t>(field), emitter_, span);
    }
    const ExprId result = ir::expand(function.graph, field, frame);
    function.graph.set_name(result, ir::facts(field).name);
    return result;
}

ExprId Draft::parameter(const ir::Parameter& parameter, std::uint32_t index, const Span& span)
{
    return input({parameter.name, parameter.type, parameter.quantity, parameter.range,
                  Origin::parameter, index, parameter.span},
                 {after_arguments, index}, span);
}

ir::Function Draft::finish() const
{
    const ir::Graph& from = function.graph;
    const auto uses = ir::use_counts(from, function.result);
    std::vector<bool> live(function.inputs.size());
    for (const ExprId id : from.ids())
        if (from[id].op == ir::Op::input && uses[id] > 0) live[from[id].aux] = true;

    std::vector<std::uint32_t> order(function.inputs.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [this](std::uint32_t i) { return keys_[i]; });

    ir::Function result = function;
    result.inputs.clear();
    result.graph = {};
    std::vector<std::uint32_t> moved_input(order.size());
    for (const std::uint32_t i : order) {
        if (!live[i] && function.inputs[i].origin != Origin::argument) continue;
        moved_input[i] = static_cast<std::uint32_t>(result.inputs.size());
        result.inputs.push_back(function.inputs[i]);
    }

    std::vector<ExprId> moved(from.size());
    for (const ExprId id : from.ids()) {
        if (uses[id] == 0) continue;
        if (from[id].op == ir::Op::input) {
            moved[id.index] =
                result.graph.input(moved_input[from[id].aux], from[id].type, from.span(id));
            continue;
        }
        std::vector<ExprId> operands;
        for (const ExprId operand : from.operands(id)) operands.push_back(moved[operand.index]);
        moved[id.index] = result.graph.copy(from, id, operands);
    }
    result.result = moved[function.result.index];
    return result;
}

}  // namespace lobe::check
