#include "check/draft.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lobe::check {

using ir::ExprId;
using ir::Origin;
using ir::Quantity;

namespace {

constexpr std::size_t after_arguments = std::numeric_limits<std::size_t>::max();

Quantity quantity_of(ir::GeometryField field)
{
    return ir::facts(field).type == ir::Type::vec3 ? Quantity::direction : Quantity::number;
}

Quantity quantity_of(ir::SurfaceField field)
{
    return ir::facts(field).type == ir::Type::vec3 ? Quantity::color : Quantity::number;
}

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
    if (structure == Structure::geometry) geometry_position_ = position;
    if (structure == Structure::surface) surface_position_ = position;
}

ExprId Draft::geometry(ir::GeometryField field, const Span& span)
{
    const ir::FieldFacts& known = ir::facts(field);
    const auto which = static_cast<std::uint32_t>(field);
    return input({std::string{known.name},
                  known.type,
                  quantity_of(field),
                  {known.low, known.high},
                  Origin::geometry,
                  which,
                  span},
                 {geometry_position_, which}, span);
}

ExprId Draft::surface(ir::SurfaceField field, const Span& span)
{
    if (field == ir::SurfaceField::alpha) {
        const ExprId roughness = surface(ir::SurfaceField::roughness, span);
        return function.graph.apply(ir::Op::multiply, {roughness, roughness}, span);
    }
    const ir::FieldFacts& known = ir::facts(field);
    const auto which = static_cast<std::uint32_t>(field);
    return input({std::string{known.name},
                  known.type,
                  quantity_of(field),
                  {known.low, known.high},
                  Origin::surface,
                  which,
                  span},
                 {surface_position_, which}, span);
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
