// Names that a language takes, each once: what people call a thing, moved out of the way of
// keywords, builtin functions and names given before. Deterministic: the same requests in the
// same order give the same names.
#pragma once

#include "emit/dialect.h"

namespace lobe::emit {

class Namer {
public:
    explicit Namer(const Dialect& dialect) : dialect_(&dialect) {}

    /// A name like `wanted` that nothing else has. A reserved word gets a trailing `_`, the second
    /// of its name `_2`. Names starting with `gl_` or holding `__` are reserved in GLSL and avoided
    /// everywhere.
    std::string unique(std::string_view wanted);

    bool is_taken(std::string_view name) const;

private:
    const Dialect* dialect_;
    std::set<std::string, std::less<>> taken_;
};

}  // namespace lobe::emit
