#include "check/builtins.h"

#include <algorithm>
#include <array>
#include <limits>

namespace lobe::check {
namespace {

using ir::Op;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Domain from_zero{0, infinity};
constexpr Domain above_zero{0, infinity, true, false};
constexpr Domain cosine_values{-1, 1};
// The double just below pi/2: within it, the tangent has no pole.
constexpr Domain between_poles{-1.5707963267948966, 1.5707963267948966, true, true};

constexpr std::array builtins{
    Builtin{"abs", Rule::each, 1, Op::absolute, "abs(x)"},
    Builtin{"sign", Rule::each, 1, Op::sign, "sign(x)"},
    Builtin{"floor", Rule::each, 1, Op::floor, "floor(x)"},
    Builtin{"sqrt", Rule::each, 1, Op::square_root, "sqrt(x)", from_zero},
    Builtin{"inversesqrt", Rule::each, 1, Op::inverse_square_root, "inversesqrt(x)", above_zero},
    Builtin{"exp", Rule::each, 1, Op::exp, "exp(x)"},
    Builtin{"exp2", Rule::each, 1, Op::exp2, "exp2(x)"},
    Builtin{"log", Rule::each, 1, Op::log, "log(x)", above_zero},
    Builtin{"log2", Rule::each, 1, Op::log2, "log2(x)", above_zero},
    Builtin{"sin", Rule::each, 1, Op::sine, "sin(x)"},
    Builtin{"cos", Rule::each, 1, Op::cosine, "cos(x)"},
    Builtin{"tan", Rule::each, 1, Op::tangent, "tan(x)", between_poles},
    Builtin{"asin", Rule::each, 1, Op::arc_sine, "asin(x)", cosine_values},
    Builtin{"acos", Rule::each, 1, Op::arc_cosine, "acos(x)", cosine_values},
    Builtin{"atan", Rule::each, 1, Op::arc_tangent, "atan(x)"},
    Builtin{"saturate", Rule::each, 1, Op::saturate, "saturate(x)"},
    Builtin{"min", Rule::each, 2, Op::minimum, "min(a, b)"},
    Builtin{"max", Rule::each, 2, Op::maximum, "max(a, b)"},
    Builtin{"step", Rule::each, 2, Op::step, "step(edge, x)"},
    Builtin{"clamp", Rule::each, 3, Op::clamp, "clamp(x, low, high)"},
    Builtin{"lerp", Rule::each, 3, Op::lerp, "lerp(a, b, t)"},
    Builtin{"smoothstep", Rule::each, 3, Op::guarded_smoothstep, "smoothstep(a, b, x)"},
    Builtin{"pow", Rule::power, 2, Op::guarded_power, "pow(x, y)"},
    Builtin{"dot", Rule::dot, 2, Op::dot, "dot(a, b)"},
    Builtin{"cross", Rule::cross, 2, Op::cross, "cross(a, b)"},
    Builtin{"normalize", Rule::normalize, 1, Op::guarded_normalize, "normalize(v)"},
    Builtin{"length", Rule::length, 1, Op::length, "length(v)"},
    Builtin{"luminance", Rule::luminance, 1, Op::dot, "luminance(c)"},
    Builtin{"float2", Rule::construct, -1, Op::construct, "float2(x, y)"},
    Builtin{"float3", Rule::construct, -1, Op::construct, "float3(x, y, z)"},
    Builtin{"float4", Rule::construct, -1, Op::construct, "float4(x, y, z, w)"},
    Builtin{"color", Rule::construct, -1, Op::construct, "color(r, g, b)"},
    Builtin{"direction", Rule::make_direction, -1, Op::guarded_normalize, "direction(x, y, z)"},
};

constexpr std::array<std::string_view, 3> constants{"pi", "true", "false"};
constexpr std::array<std::string_view, 12> types{"float",     "int",      "bool",    "float2",
                                                 "float3",    "float4",   "unit",    "color",
                                                 "direction", "geometry", "surface", "emitter"};

struct Translation {
    std::string_view other;
    std::string_view ours;
};
constexpr std::array translations{
    Translation{"mix", "lerp"},     Translation{"rsqrt", "inversesqrt"},
    Translation{"vec2", "float2"},  Translation{"vec3", "float3"},
    Translation{"vec4", "float4"},  Translation{"half", "float"},
    Translation{"double", "float"}, Translation{"arccos", "acos"},
    Translation{"arcsin", "asin"},  Translation{"arctan", "atan"},
    Translation{"ln", "log"},       Translation{"PI", "pi"},
    Translation{"rgb", "color"},    Translation{"boolean", "bool"},
    Translation{"power", "pow"},    Translation{"inverse_sqrt", "inversesqrt"},
};

template <class List>
std::vector<std::string> strings(const List& list)
{
    return {list.begin(), list.end()};
}

}  // namespace

const Builtin* find_builtin(std::string_view name)
{
    const auto* found = std::ranges::find(builtins, name, &Builtin::name);
    return found == builtins.end() ? nullptr : found;
}

bool is_builtin_constant(std::string_view name)
{
    return std::ranges::find(constants, name) != constants.end();
}

bool is_type_name(std::string_view name) { return std::ranges::find(types, name) != types.end(); }

bool is_standard_name(std::string_view name)
{
    return find_builtin(name) != nullptr || is_builtin_constant(name) || is_type_name(name);
}

std::vector<std::string> builtin_names()
{
    std::vector<std::string> names;
    for (const Builtin& builtin : builtins) names.emplace_back(builtin.name);
    return names;
}

std::vector<std::string> constant_names() { return strings(constants); }
std::vector<std::string> type_names() { return strings(types); }

std::optional<std::string_view> translated(std::string_view name)
{
    const auto* found = std::ranges::find(translations, name, &Translation::other);
    if (found == translations.end()) return std::nullopt;
    return found->ours;
}

}  // namespace lobe::check
