#include "emit/dialect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::emit {
namespace {

using ir::Op;

Spelling call(std::string_view word, unsigned scalars = 0)
{
    return {.kind = Spelling::Kind::call, .word = word, .scalars = scalars};
}

Spelling infix(std::string_view word, Precedence precedence)
{
    return {.kind = Spelling::Kind::infix, .word = word, .precedence = precedence, .scalars = 3};
}

Spelling prefix(std::string_view word)
{
    return {.kind = Spelling::Kind::prefix, .word = word, .precedence = Precedence::unary};
}

Spelling helper(std::string_view word) { return {.kind = Spelling::Kind::helper, .word = word}; }

/// GLSL's spelling of every operation; HLSL overrides a handful.
Spelling common(Op op)
{
    switch (op) {
    case Op::literal:
    case Op::input:
    case Op::component:
    case Op::construct:
    case Op::call: return {.kind = Spelling::Kind::special};
    case Op::negate: return prefix("-");
    case Op::logical_not: return prefix("!");
    case Op::absolute: return call("abs");
    case Op::sign: return call("sign");
    case Op::floor: return call("floor");
    case Op::square_root: return call("sqrt");
    case Op::inverse_square_root: return call("inversesqrt");
    case Op::exp2: return call("exp2");
    case Op::log2: return call("log2");
    case Op::exp: return call("exp");
    case Op::log: return call("log");
    case Op::sine: return call("sin");
    case Op::cosine: return call("cos");
    case Op::tangent: return call("tan");
    case Op::arc_sine: return call("asin");
    case Op::arc_cosine: return call("acos");
    case Op::arc_tangent: return call("atan");
    case Op::saturate: return {.kind = Spelling::Kind::call, .word = "clamp", .zero_and_one = true};
    case Op::add: return infix("+", Precedence::additive);
    case Op::subtract: return infix("-", Precedence::additive);
    case Op::multiply: return infix("*", Precedence::multiplicative);
    case Op::divide: return infix("/", Precedence::multiplicative);
    case Op::power: return call("pow");
    case Op::guarded_power: return helper("guarded_power");
    case Op::minimum: return call("min", 0b010);
    case Op::maximum: return call("max", 0b010);
    case Op::step: return call("step", 0b001);
    case Op::lerp: return call("mix", 0b100);
    case Op::clamp: return call("clamp", 0b110);
    case Op::smoothstep: return call("smoothstep", 0b011);
    case Op::guarded_smoothstep: return helper("guarded_smoothstep");
    case Op::less: return infix("<", Precedence::relational);
    case Op::less_equal: return infix("<=", Precedence::relational);
    case Op::equal: return infix("==", Precedence::equality);
    case Op::not_equal: return infix("!=", Precedence::equality);
    case Op::logical_and: return infix("&&", Precedence::logical_and);
    case Op::logical_or: return infix("||", Precedence::logical_or);
    case Op::select:
        return {.kind = Spelling::Kind::ternary, .precedence = Precedence::ternary, .scalars = 1};
    case Op::dot: return call("dot");
    case Op::length: return call("length");
    case Op::cross: return call("cross");
    case Op::normalize: return call("normalize");
    case Op::guarded_normalize: return helper("guarded_normalize");
    }
    return {};
}

Dialect make_glsl(std::string_view name)
{
    return {.name = name,
            .types = {"bool", "float", "vec2", "vec3", "vec4"},
            .least_normal = "1.17549435e-38",
            .helpers = "glsl",
            .extension = ".glsl",
            .reserved = glsl_words()};
}

/// Every float a half: for judging what half precision does to a term.
Dialect make_glsl_half()
{
    Dialect half = make_glsl("GLSL 4.50, half precision");
    half.types = {"bool", "float16_t", "f16vec2", "f16vec3", "f16vec4"};
    half.literal_suffix = "hf";
    half.half_literals = true;
    half.least_normal = "6.103515625e-5hf";
    return half;
}

Dialect make_hlsl()
{
    return {.name = "HLSL, shader model 5",
            .types = {"bool", "float", "float2", "float3", "float4"},
            .local_qualifier = "const ",
            .spread_by_cast = true,
            .least_normal = "1.17549435e-38",
            .overrides = {{Op::inverse_square_root, call("rsqrt")},
                          {Op::saturate, call("saturate")},
                          {Op::lerp, call("lerp", 0b100)}},
            .helpers = "hlsl",
            .extension = ".hlsl",
            .reserved = hlsl_words()};
}

/// HLSL as the engine's own shaders write it.
Dialect make_unreal()
{
    Dialect unreal = make_hlsl();
    unreal.name = "Unreal Engine 4";
    unreal.call_open = "( ";
    unreal.call_close = " )";
    unreal.pi = "PI";
    unreal.indent = "\t";
    unreal.names = Case::pascal;
    unreal.helpers = "ue4";
    unreal.extension = ".ush";
    unreal.reserved.merge(unreal_words());
    return unreal;
}

std::string_view geometry_name(ir::GeometryField field)
{
    using Field = ir::GeometryField;
    switch (field) {
    case Field::cos_i: return "NoL";
    case Field::cos_o: return "NoV";
    case Field::cos_h: return "NoH";
    case Field::cos_d: return "VoH";
    case Field::v_dot_l: return "VoL";
    case Field::x_dot_l: return "XoL";
    case Field::y_dot_l: return "YoL";
    case Field::x_dot_v: return "XoV";
    case Field::y_dot_v: return "YoV";
    case Field::x_dot_h: return "XoH";
    case Field::y_dot_h: return "YoH";
    case Field::sin2_h: return "NxH2";
    case Field::one_minus_cos_h: return "OneMinusNoH";
    case Field::one_minus_cos_d: return "OneMinusVoH";
    case Field::l:
    case Field::v:
    case Field::n:
    case Field::x:
    case Field::y:
    case Field::h: return ir::facts(field).name;
    }
    return {};
}

/// The nearest half, ties to even, with every digit it has: glslang cuts half literals off
/// instead of rounding them, and so would take the next lower half for a shortened one. What is not
/// 0 is a normal number, as evaluate has it: a bound above 0 stays one.
std::string exact_half(double value)
{
    constexpr double largest = 65504;
    constexpr double least = 0x1p-14;
    const double size = value == 0 ? 0 : std::clamp(std::fabs(value), least, largest);
    const double step = size == 0 ? least : std::ldexp(1.0, std::ilogb(size) - 10);
    constexpr int decimals = 24;  // of the least half, 2^-24
    std::string text =
        fmt::format("{:.{}f}", std::copysign(std::nearbyint(size / step) * step, value), decimals);
    text.erase(std::max(text.find_last_not_of('0') + 1, text.find('.') + 2));
    return text;
}

}  // namespace

Spelling Dialect::spelling(Op op) const
{
    for (const auto& [overridden, spelling] : overrides)
        if (overridden == op) return spelling;
    return common(op);
}

std::string Dialect::literal(const ir::Literal& literal) const
{
    if (literal.text == "pi") return pi.empty() ? this->literal(literal.value) : std::string{pi};
    return this->literal(literal.value);
}

std::string Dialect::literal(double value) const
{
    if (half_literals) return exact_half(value) + std::string{literal_suffix};
    // No float is larger; a shading language has no name for infinity.
    constexpr double largest = std::numeric_limits<float>::max();
    const auto nearest = static_cast<float>(std::fmin(std::fmax(value, -largest), largest));
    std::string text = fmt::format("{}", nearest);
    const auto e = text.find('e');
    std::string mantissa = text.substr(0, e);
    if (mantissa.find('.') == std::string::npos) mantissa += ".0";
    if (e == std::string::npos) return mantissa + std::string{literal_suffix};
    // `1e-07`, `1e+30`: one sign at most, no leading zeros.
    std::string exponent = text.substr(e + 1);
    const bool negative = exponent.front() == '-';
    exponent.erase(0, exponent.find_first_not_of("+-0"));
    return fmt::format("{}e{}{}{}", mantissa, negative ? "-" : "", exponent, literal_suffix);
}

std::string Dialect::styled(std::string_view name_in_lobe) const
{
    if (names == Case::snake) return std::string{name_in_lobe};
    std::string result;
    bool upper = true;
    for (const char c : name_in_lobe) {
        if (c == '_') {
            upper = true;
            continue;
        }
        const bool letter = c >= 'a' && c <= 'z';
        result += upper && letter ? static_cast<char>(c - 'a' + 'A') : c;
        upper = false;
    }
    return result;
}

const Dialect& dialect(const Target& target, Precision precision)
{
    static const Dialect glsl = make_glsl("GLSL");
    static const Dialect half = make_glsl_half();
    static const Dialect hlsl = make_hlsl();
    static const Dialect unreal = make_unreal();
    if (target.language != Language::hlsl) return precision == Precision::float16 ? half : glsl;
    return target.name == "ue4" ? unreal : hlsl;
}

std::string input_name(const Dialect& dialect, const ir::Input& input)
{
    if (input.origin == ir::Origin::geometry)
        return dialect.styled(geometry_name(static_cast<ir::GeometryField>(input.which)));
    // An argument that repeats a field of the geometry means the same thing.
    if (input.origin == ir::Origin::argument)
        if (const auto field = ir::find_geometry_field(input.name))
            return dialect.styled(geometry_name(*field));
    return dialect.styled(input.name);
}

}  // namespace lobe::emit
