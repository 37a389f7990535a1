// The standard library: functions, constructors and constants that every file may use.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::check {

/// How a function's result follows from its arguments.
enum class Rule {
    each,            ///< componentwise; arguments are joined as by arithmetic
    dot,             ///< two vectors of one kind to a number
    cross,           ///< two float3 to a float3
    normalize,       ///< a float3 to a direction; 0 stays 0
    length,          ///< a vector to a number
    luminance,       ///< a color to a number
    power,           ///< as the operator `^`
    construct,       ///< the constructors float2, float3, float4 and color
    make_direction,  ///< normalize of three numbers or a float3
};

/// Where a function is defined over the real numbers.
struct Domain {
    double low;
    double high;
    bool low_open = false;
    bool high_open = false;
};

struct Builtin {
    std::string_view name;
    Rule rule{};
    int arity = 1;  ///< -1: see the rule
    ir::Op op{};    ///< what it lowers to, where that is one operation
    std::string_view signature;
    std::optional<Domain> domain = std::nullopt;  ///< of the first argument; everywhere if absent
};

const Builtin* find_builtin(std::string_view name);
/// `pi`, `true`, `false`.
bool is_builtin_constant(std::string_view name);
bool is_type_name(std::string_view name);
/// Functions, constants and types: what no declaration may hide.
bool is_standard_name(std::string_view name);

std::vector<std::string> builtin_names();
std::vector<std::string> constant_names();
std::vector<std::string> type_names();

/// What another shading language calls it: `mix` is `lerp` here.
std::optional<std::string_view> translated(std::string_view name);

}  // namespace lobe::check
