// What a value is: its quantity and shape, in the words of the language, and which operators
// join which quantities.
#pragma once

#include "ir/module.h"

#include <optional>
#include <string>

namespace lobe::check {

/// Structures are passed to terms and have members; they are not values.
enum class Structure {
    none,
    geometry,
    surface,
    emitter
};

struct ValueType {
    ir::Quantity quantity = ir::Quantity::number;
    ir::Type type = ir::Type::scalar;
    Structure structure = Structure::none;

    friend bool operator==(const ValueType&, const ValueType&) = default;
};

inline constexpr ValueType number_type{ir::Quantity::number, ir::Type::scalar, Structure::none};
inline constexpr ValueType integer_type{ir::Quantity::integer, ir::Type::scalar, Structure::none};
inline constexpr ValueType boolean_type{ir::Quantity::boolean, ir::Type::boolean, Structure::none};
inline constexpr ValueType color_type{ir::Quantity::color, ir::Type::vec3, Structure::none};
inline constexpr ValueType direction_type{ir::Quantity::direction, ir::Type::vec3, Structure::none};
ValueType vector_type(int components);

bool is_number(const ValueType& type);  ///< one real or whole number
bool is_vector(const ValueType& type);  ///< float2, float3, float4, color or direction

/// With its article: "a number", "a color", "a float3".
std::string describe(const ValueType& type);
/// As it is written: `float`, `color`, `float3`.
std::string spell(const ValueType& type);

/// Why two types cannot be joined by a componentwise operator.
enum class Clash {
    boolean,
    structure,
    color_direction,
    color_vector,
    sizes
};

/// The type of componentwise arithmetic on two values, or why there is none. Numbers spread;
/// directions become plain vectors, for their sum is no direction.
struct Joined {
    std::optional<ValueType> type;
    Clash clash{};
};
Joined join(const ValueType& a, const ValueType& b);

/// How a value of one type gets to a place that asks for another.
enum class Fit {
    exact,   ///< as it is
    spread,  ///< a number to every channel of a color
    none,
};
Fit fit(const ValueType& from, const ValueType& to);

/// `[0, 1]`; infinite ends are open.
std::string describe(const ir::Range& range);
/// The shortest decimal that reads back; six digits when `brief`.
std::string describe(double value, bool brief = false);

}  // namespace lobe::check
