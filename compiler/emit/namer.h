// Names that a language takes, each once: what people call a thing, moved out of the way of
// keywords, builtin functions and names given before. Deterministic: the same requests in the
// same order give the same names.
#pragma once

#include "emit/dialect.h"

#include <set>

namespace lobe::emit {

class Namer {
public:
    explicit Namer(const Dialect& dialect) : dialect_(&dialect) {}

    /// For a block among these names: they are taken there, and what is named there is not taken
    /// here. The outer namer outlives it.
    Namer inner() const
    {
        Namer inner{*dialect_};
        inner.outer_ = this;
        return inner;
    }

    /// A name like `wanted` that nothing else has. A reserved word gets a trailing `_`, the second
    /// of its name `_2`. Names starting with `gl_` or holding `__` are reserved in GLSL and avoided
    /// everywhere.
    std::string unique(std::string_view wanted);

    bool is_taken(std::string_view name) const;

private:
    const Dialect* dialect_;
    const Namer* outer_ = nullptr;
    std::set<std::string, std::less<>> taken_;
};

}  // namespace lobe::emit
