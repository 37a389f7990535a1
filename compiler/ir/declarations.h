// What a module declares besides functions: what values mean, parameters, models.
#pragma once

#include "base/source.h"
#include "ir/graph.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe::ir {

/// What a value means; `Type` is only what it is made of. Colors and directions never mix.
enum class Quantity : std::uint8_t {
    number,
    integer,
    boolean,
    vector,
    color,
    direction
};

/// Closed interval of every component. Infinite ends mean: unbounded.
struct Range {
    double low;
    double high;
    friend bool operator==(const Range&, const Range&) = default;
};

struct Parameter {
    std::string name;
    Type type{};
    Quantity quantity{};
    Range range{};
    std::vector<double> default_value;  ///< one per component
    std::string tier;                   ///< empty when none was given
    std::string label;
    std::string doc;
    std::string module;
    Span span;
};

/// `source slides = "…"`
struct Source {
    std::string name;
    std::string text;
    Span span;
};

struct ModelOutput {
    std::string name;  ///< `diffuse`
    FunctionId function;
};

/// A `model`, or a `light`, whose outputs are `direction` and `irradiance` and, where they differ
/// from these and from 1, `specular_direction` and `specular_gain`.
struct Model {
    std::string name;
    std::string doc;
    std::string module;
    Span span;
    std::vector<ModelOutput> outputs;
};

}  // namespace lobe::ir
