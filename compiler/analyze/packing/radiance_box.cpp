#include "analyze/packing/radiance_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using ir::GeometryField;
using ir::Origin;
using ir::SurfaceField;

/// Builds the sum of functions over the union of their inputs.
class Sum {
public:
    Sum(const ir::Module& module, const std::vector<ir::FunctionId>& outputs, Channels channels,
        GeometryAs geometry)
        : module_{module}, of_fields_{geometry == GeometryAs::fields}
    {
        for (const ir::FunctionId output : outputs) note(module_[output]);
        if (geometry_) {
            frame_.l = vector(GeometryField::l);
            frame_.v = vector(GeometryField::v);
            frame_.n = vector(GeometryField::n);
        }
        if (tangents_) {
            frame_.x = vector(GeometryField::x);
            frame_.y = vector(GeometryField::y);
        }
        for (const ir::FunctionId output : outputs) add(output);
        function.quantity = module_[outputs.front()].quantity;
        if (channels == Channels::first && ir::components(function.type()) > 1) {
            function.result = function.graph.component(function.result, 0);
            function.quantity = ir::Quantity::number;
        }
    }

    ir::Function function;

private:
    void note(const ir::Function& output)
    {
        for (const ir::Input& input : output.inputs) {
            if (input.origin == Origin::geometry && !of_fields_) {
                geometry_ = true;
                tangents_ |= ir::needs_tangents(static_cast<GeometryField>(input.which));
            }
            roughness_ |= input.origin == Origin::surface &&
                          input.which == static_cast<std::uint32_t>(SurfaceField::roughness);
        }
    }

    ir::ExprId vector(GeometryField field)
    {
        const ir::FieldFacts& known = ir::facts(field);
        return input({std::string{known.name},
                      known.type,
                      ir::Quantity::direction,
                      {known.low, known.high},
                      Origin::geometry,
                      static_cast<std::uint32_t>(field),
                      {},
                      false});
    }

    ir::ExprId input(const ir::Input& input)
    {
        auto index = find(input);
        if (!index) {
            index = static_cast<std::uint32_t>(function.inputs.size());
            function.inputs.push_back(input);
        }
        ir::Range& range = function.inputs[*index].range;
        range = {std::max(range.low, input.range.low), std::min(range.high, input.range.high)};
        return function.graph.input(*index, input.type);
    }

    /// Arguments are told apart by their names.
    std::optional<std::uint32_t> find(const ir::Input& input) const
    {
        if (input.origin != Origin::argument) return function.find_input(input.origin, input.which);
        for (std::uint32_t i = 0; i < function.inputs.size(); ++i)
            if (function.inputs[i].origin == Origin::argument &&
                function.inputs[i].name == input.name)
                return i;
        return std::nullopt;
    }

    ir::ExprId operand(const ir::Input& wanted)
    {
        if (wanted.origin == Origin::geometry && !of_fields_)
            return ir::expand(function.graph, static_cast<GeometryField>(wanted.which), frame_);
        const bool alpha = wanted.origin == Origin::surface &&
                           wanted.which == static_cast<std::uint32_t>(SurfaceField::alpha);
        if (!alpha || !roughness_) return input(wanted);
        const ir::FieldFacts& known = ir::facts(SurfaceField::roughness);
        const ir::ExprId rough = input({std::string{known.name},
                                        known.type,
                                        ir::Quantity::number,
                                        {known.low, known.high},
                                        Origin::surface,
                                        static_cast<std::uint32_t>(SurfaceField::roughness),
                                        {},
                                        false});
        return function.graph.apply(ir::Op::multiply, {rough, rough});
    }

    void add(ir::FunctionId id)
    {
        std::vector<ir::ExprId> operands;
        for (const ir::Input& wanted : module_[id].inputs) operands.push_back(operand(wanted));
        const ir::ExprId part = function.graph.call(id, module_[id].type(), operands);
        function.result = function.result.valid()
                              ? function.graph.apply(ir::Op::add, {function.result, part})
                              : part;
    }

    const ir::Module& module_;
    bool of_fields_ = false;
    bool geometry_ = false;
    bool tangents_ = false;
    bool roughness_ = false;
    ir::Frame frame_;
};

ir::Range intersection(const ir::Range& a, const ir::Range& b)
{
    const ir::Range both{std::max(a.low, b.low), std::min(a.high, b.high)};
    return both.low <= both.high ? both : a;
}

const ir::Range* measured(const ir::Packing& packing, std::string_view name)
{
    for (const ir::MeasuredRange& range : packing.measured)
        if (range.name == name) return &range.range;
    return nullptr;
}

/// The range of a surface field. One of roughness says something of alpha, and the other way round.
ir::Range surface_range(const ir::Packing& packing, const ir::Input& input)
{
    ir::Range range = input.range;
    if (const ir::Range* over = measured(packing, input.name)) range = intersection(range, *over);
    const ir::Range* rough = measured(packing, "roughness");
    const ir::Range* alpha = measured(packing, "alpha");
    if (input.name == "alpha" && rough != nullptr)
        range = intersection(range, {rough->low * rough->low, rough->high * rough->high});
    if (input.name == "roughness" && alpha != nullptr)
        range = intersection(range, {std::sqrt(alpha->low), std::sqrt(alpha->high)});
    return range;
}

/// Rounded inwards, so that every float between the ends keeps the promise of the range.
void set_range(Coordinate& coordinate, ir::Range range)
{
    constexpr double largest = std::numeric_limits<float>::max();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    range = {std::clamp(range.low, -largest, largest), std::clamp(range.high, -largest, largest)};
    coordinate.low = static_cast<float>(range.low);
    coordinate.high = static_cast<float>(range.high);
    if (coordinate.low < range.low) coordinate.low = std::nextafter(coordinate.low, infinity);
    if (coordinate.high > range.high) coordinate.high = std::nextafter(coordinate.high, -infinity);
    if (coordinate.high < coordinate.low) coordinate.high = coordinate.low;
}

void set_parameter(Coordinate& coordinate, const ir::Module& module, const ir::Packing& packing,
                   const ir::Input& input, int component)
{
    const ir::Parameter& parameter = module.parameters[input.which];
    const ir::Range* over = measured(packing, parameter.name);
    for (std::size_t i = 0; i < packing.fields.size(); ++i) {
        const ir::Field& field = packing.fields[i];
        if (field.parameter != input.which || field.component != component) continue;
        coordinate.field = i;
        set_range(coordinate, over != nullptr ? intersection(field.range, *over) : field.range);
        return;
    }
    if (over != nullptr) {
        set_range(coordinate, intersection(parameter.range, *over));
    } else {
        const double value = parameter.default_value[static_cast<std::size_t>(component)];
        coordinate.low = coordinate.high = static_cast<float>(value);
    }
}

/// Where the axes stay. Those that move are set by whoever makes points.
void set_vector(Coordinate& coordinate, GeometryField field, int component)
{
    const auto axis = [&](int which) {
        coordinate.low = coordinate.high = component == which ? 1.0F : 0.0F;
    };
    switch (field) {
    case GeometryField::x: return axis(0);
    case GeometryField::y: return axis(1);
    case GeometryField::n: return axis(2);
    default: coordinate.low = -1; coordinate.high = 1;
    }
}

/// Per input of the tape: something is computed of it.
std::vector<bool> slots_read(const evaluate::Tape& tape)
{
    std::vector<bool> read(tape.slots);
    for (const evaluate::Instruction& step : tape.code) {
        const evaluate::Slot operands[] = {step.a, step.b, step.c, step.d};
        for (int i = 0; i < evaluate::arity(step.op); ++i) read[operands[i]] = true;
    }
    for (const evaluate::Slot output : tape.outputs) read[output] = true;
    return read;
}

}  // namespace

ir::Function radiance_of(const ir::Module& module, const std::vector<ir::FunctionId>& outputs,
                         Channels channels, GeometryAs geometry)
{
    return Sum{module, outputs, channels, geometry}.function;
}

namespace {

RadianceBox box_of(const ir::Module& module, const ir::Packing& packing,
                   const ir::Function& radiance)
{
    RadianceBox box;
    box.tape = evaluate::compile(module, radiance);
    const std::vector<bool> read = slots_read(box.tape);
    for (const evaluate::TapeInput& scalar : box.tape.inputs) {
        const ir::Input& input = radiance.inputs[scalar.input];
        const std::size_t index = box.coordinates.size();
        Coordinate& coordinate = box.coordinates.emplace_back();
        coordinate.name = scalar.name;
        coordinate.whole =
            input.quantity == ir::Quantity::integer || input.quantity == ir::Quantity::boolean;
        switch (input.origin) {
        case Origin::geometry: {
            const auto field = static_cast<GeometryField>(input.which);
            set_vector(coordinate, field, scalar.component);
            if (scalar.component != 0) break;
            if (field == GeometryField::l) box.light = index;
            if (field == GeometryField::v) box.view = index;
            break;
        }
        case Origin::parameter:
            set_parameter(coordinate, module, packing, input, scalar.component);
            break;
        case Origin::surface: set_range(coordinate, surface_range(packing, input)); break;
        case Origin::emitter:
        case Origin::argument: set_range(coordinate, input.range); break;
        }
        if (scalar.name == "roughness") box.roughness = index;
        if (scalar.name == "alpha") box.alpha = index;
        const bool varies = coordinate.low < coordinate.high && read[index];
        if (input.origin != Origin::geometry && varies) box.values.push_back(index);
    }
    return box;
}

}  // namespace

RadianceBox whole_box(const ir::Module& module, const ir::Function& radiance)
{
    ir::Packing nothing;
    for (const ir::Parameter& parameter : module.parameters)
        nothing.measured.push_back({parameter.name, parameter.range, {}});
    return box_of(module, nothing, radiance);
}

RadianceBox radiance_box(const ir::Module& module, const ir::Packing& packing, Channels channels)
{
    std::vector<ir::FunctionId> outputs;
    for (const ir::ModelOutput& output : packing.model.outputs) outputs.push_back(output.function);
    return box_of(module, packing, radiance_of(module, outputs, channels));
}

}  // namespace lobe::analyze
