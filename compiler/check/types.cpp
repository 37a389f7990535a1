#include "check/types.h"

#include <fmt/format.h>

#include <cmath>

namespace lobe::check {

using ir::Quantity;

ValueType vector_type(int components)
{
    return {Quantity::vector, ir::vector_type(components), Structure::none};
}

bool is_number(const ValueType& type)
{
    return type.structure == Structure::none &&
           (type.quantity == Quantity::number || type.quantity == Quantity::integer);
}

bool is_vector(const ValueType& type)
{
    return type.structure == Structure::none &&
           (type.quantity == Quantity::vector || type.quantity == Quantity::color ||
            type.quantity == Quantity::direction);
}

std::string spell(const ValueType& type)
{
    switch (type.structure) {
    case Structure::geometry: return "geometry";
    case Structure::surface: return "surface";
    case Structure::emitter: return "emitter";
    case Structure::none: break;
    }
    switch (type.quantity) {
    case Quantity::number: return "float";
    case Quantity::integer: return "int";
    case Quantity::boolean: return "bool";
    case Quantity::vector: return fmt::format("float{}", ir::components(type.type));
    case Quantity::color: return "color";
    case Quantity::direction: return "direction";
    }
    return {};
}

std::string describe(const ValueType& type)
{
    if (type.structure == Structure::none) {
        if (type.quantity == Quantity::number) return "a number";
        if (type.quantity == Quantity::integer) return "a whole number";
        if (type.quantity == Quantity::boolean) return "a condition";
    }
    return (type.structure == Structure::emitter ? "an " : "a ") + spell(type);
}

Joined join(const ValueType& a, const ValueType& b)
{
    const auto none = [](Clash clash) { return Joined{std::nullopt, clash}; };
    if (a.structure != Structure::none || b.structure != Structure::none)
        return none(Clash::structure);
    if (a.quantity == Quantity::boolean || b.quantity == Quantity::boolean)
        return none(Clash::boolean);

    if (is_number(a) && is_number(b)) return {a == b ? a : number_type, {}};
    const auto plain = [](const ValueType& type) {
        return type.quantity == Quantity::direction ? vector_type(3) : type;
    };
    if (is_number(a)) return {plain(b), {}};
    if (is_number(b)) return {plain(a), {}};

    const bool color_a = a.quantity == Quantity::color;
    const bool color_b = b.quantity == Quantity::color;
    if (color_a != color_b) {
        const bool direction =
            a.quantity == Quantity::direction || b.quantity == Quantity::direction;
        return none(direction ? Clash::color_direction : Clash::color_vector);
    }
    if (a.type != b.type) return none(Clash::sizes);
    return {plain(a), {}};
}

Fit fit(const ValueType& from, const ValueType& to)
{
    if (from == to) return Fit::exact;
    if (from.structure != Structure::none || to.structure != Structure::none) return Fit::none;
    if (from.quantity == Quantity::integer && to.quantity == Quantity::number) return Fit::exact;
    if (is_number(from) && to.quantity == Quantity::color) return Fit::spread;
    // Every direction is a float3; few float3 are directions.
    if (from.quantity == Quantity::direction && to == vector_type(3)) return Fit::exact;
    return Fit::none;
}

std::string describe(double value, bool brief)
{
    if (value == 0) return "0";
    return brief ? fmt::format("{:.6g}", value) : fmt::format("{}", value);
}

std::string describe(const ir::Range& range)
{
    const bool low = std::isinf(range.low);
    const bool high = std::isinf(range.high);
    return fmt::format("{}{}, {}{}", low ? "(" : "[", low ? "-inf" : describe(range.low, true),
                       high ? "inf" : describe(range.high, true), high ? ")" : "]");
}

}  // namespace lobe::check
