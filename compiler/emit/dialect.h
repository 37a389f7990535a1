// Shading languages as tables: a language is a value, and the writer is one loop over it.
//
// A dialect says how types, operations and literals are spelled, and which words are taken.
// What a file looks like around the functions is a template's business.
#pragma once

#include "emit/emit.h"

#include <array>
#include <unordered_set>

namespace lobe::emit {

/// How tightly an expression's text binds, loosest first. `primary` needs no parentheses anywhere.
enum class Precedence : std::uint8_t {
    ternary,
    logical_or,
    logical_and,
    equality,
    relational,
    additive,
    multiplicative,
    unary,
    primary,
};

struct Spelling {
    enum class Kind : std::uint8_t {
        call,
        infix,
        prefix,
        ternary,
        helper,
        special
    };

    Kind kind{};
    std::string_view word = {};  ///< function, operator, or the helper's file and default name
    Precedence precedence = Precedence::primary;
    /// Bit i: operand i may stay a scalar where the result is a vector, if all operands of the
    /// mask do. Every other scalar is spread to a vector.
    unsigned scalars = 0;
    bool zero_and_one = false;  ///< a call that ends in the arguments 0, 1
};

/// Asked for membership only, never walked into output.
using Words = std::unordered_set<std::string_view>;

/// How identifiers are written.
enum class Case : std::uint8_t {
    snake,
    pascal
};

struct Dialect {
    std::string_view name = {};
    std::array<std::string_view, 5> types = {};  ///< ORDER ir::Type
    std::string_view literal_suffix = {};
    bool half_literals = false;             ///< every digit of the nearest half; see `literal`
    std::string_view local_qualifier = {};  ///< `const ` where a local may be const
    std::string_view call_open = "(";
    std::string_view call_close = ")";
    bool spread_by_cast = false;         ///< `(float3)x` rather than `vec3(x)`
    std::string_view pi = {};            ///< the name of pi, or empty: write the number
    std::string_view least_normal = {};  ///< the smallest normal number of the scalar type
    std::string_view indent = "    ";
    Case names{};
    std::vector<std::pair<ir::Op, Spelling>> overrides = {};  ///< where it differs from `common`
    std::string_view helpers = {};    ///< folder of templates/ with the guarded helpers
    std::string_view extension = {};  ///< of the helper templates
    Words reserved = {};              ///< keywords, builtin functions, the engine's macros

    Spelling spelling(ir::Op op) const;
    std::string_view type(ir::Type type) const { return types[static_cast<std::size_t>(type)]; }
    /// The shortest decimal that reads back as the float nearest to the literal, with a point.
    std::string literal(const ir::Literal& literal) const;
    std::string literal(double value) const;
    /// A .lobe name as this language's people write it: `diffuse_fresnel`, `DiffuseFresnel`.
    std::string styled(std::string_view name) const;
};

/// The dialect of a target. Half precision exists for GLSL 4.50 alone.
const Dialect& dialect(const Target& target, Precision precision = Precision::float32);

/// What readers of shaders call an input: NoL for cos_i, Roughness or roughness.
std::string input_name(const Dialect& dialect, const ir::Input& input);

/// Words that are taken, per language (reserved.cpp).
Words glsl_words();
Words hlsl_words();
Words unreal_words();

}  // namespace lobe::emit
