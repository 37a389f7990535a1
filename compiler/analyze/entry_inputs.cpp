#include "analyze/entry_inputs.h"

#include "evaluate/tape.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {

EntryInputs::EntryInputs(const ir::Module& module, ir::FunctionId function, const Grid& grid)
    : entry_(ir::entry_point(module, function)), scalars_(scalars_of(module, entry_, grid))
{
    for (const ir::Input& input : entry_.inputs) {
        const int size = ir::components(input.type);
        if (input.origin == ir::Origin::geometry) {
            geometry_ = true;
            tangents_ |= static_cast<ir::GeometryField>(input.which) == ir::GeometryField::x;
        }
        if (input.quantity != ir::Quantity::direction)
            values_.push_back({names_.size(), static_cast<std::size_t>(size), input.name,
                               input.origin == ir::Origin::parameter, input.which});
        for (int k = 0; k < size; ++k)
            names_.push_back(input.name +
                             evaluate::component_suffix(input.type, input.quantity, k));
    }
    // The entry point calls the function with one operand per input.
    const ir::Function& callee = module[function];
    const auto operands = entry_.graph.operands(entry_.result);
    for (std::size_t i = 0; i < callee.inputs.size(); ++i) {
        const ir::Input& input = callee.inputs[i];
        if (input.origin != ir::Origin::geometry) continue;
        for (int k = 0; k < ir::components(input.type); ++k)
            fields_.push_back(
                {input.name + evaluate::component_suffix(input.type, input.quantity, k),
                 operands[i], static_cast<std::size_t>(k)});
    }
}

const EntryInputs::Value* EntryInputs::find(std::string_view name) const
{
    const auto at = std::ranges::find(values_, name, &Value::name);
    return at == values_.end() ? nullptr : &*at;
}

std::optional<std::size_t> EntryInputs::find(ir::GeometryField vector) const
{
    std::size_t column = 0;
    for (const ir::Input& input : entry_.inputs) {
        if (input.origin == ir::Origin::geometry &&
            static_cast<ir::GeometryField>(input.which) == vector)
            return column;
        column += static_cast<std::size_t>(ir::components(input.type));
    }
    return std::nullopt;
}

EntryInputs::Values EntryInputs::neutral() const
{
    Values values;
    for (const Scalar& scalar : scalars_) values.push_back(scalar.neutral);
    place(values, {{}, {0, 0, 1}, {0, 0, 1}});
    return values;
}

void EntryInputs::place(Values& values, const Directional& at) const
{
    std::size_t column = 0;
    for (const ir::Input& input : entry_.inputs) {
        if (input.quantity == ir::Quantity::direction) {
            const Vector& vector = input.origin == ir::Origin::geometry
                                       ? vector_of(at, static_cast<ir::GeometryField>(input.which))
                                       : at.l;
            values[column] = vector.x;
            values[column + 1] = vector.y;
            values[column + 2] = vector.z;
        }
        column += static_cast<std::size_t>(ir::components(input.type));
    }
}

void EntryInputs::set(Values& values, const Value& which, double to)
{
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(which.first), which.size, to);
}

std::string EntryInputs::describe(const Values& values) const
{
    std::string text;
    std::size_t column = 0;
    for (const ir::Input& input : entry_.inputs) {
        const auto size = static_cast<std::size_t>(ir::components(input.type));
        std::string value;
        bool neutral = input.origin == ir::Origin::parameter;
        for (std::size_t k = 0; k < size; ++k, ++column) {
            neutral &= values[column] == scalars_[column].neutral;
            // As a float, which is what a shader gets; zeros without a sign.
            value +=
                fmt::format("{}{}", k == 0 ? "" : ", ", static_cast<float>(values[column]) + 0.0F);
        }
        if (neutral) continue;
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", input.name,
                            size == 1 ? value : "(" + value + ")");
    }
    return text;
}

}  // namespace lobe::analyze
