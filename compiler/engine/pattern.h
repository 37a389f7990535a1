// Regular expressions over a file: the one place that knows RE2. It is linear in the text for any
// pattern and needs no stack, where std::regex overflows its own on an engine's files.
#pragma once

#include "engine/code.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace re2 {
class RE2;
}

namespace lobe::engine {

/// What `${name}` stands for; nothing if there is no such value.
using ValueOf = std::function<std::optional<std::string>(std::string_view name)>;

struct Substituted {
    std::string text;
    std::string error;  ///< the first name without a value, or a `${` without its `}`
};
/// `${name}` replaced by values as they are, or quoted for a pattern.
Substituted substitute(std::string_view text, const ValueOf& value_of);
Substituted substitute_quoted(std::string_view pattern, const ValueOf& value_of);

/// From `begin` up to `end` of a text.
struct Stretch {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// What a pattern matched: all of it, then its groups. A group without part in it is nothing.
using Hit = std::vector<std::optional<Stretch>>;

class Pattern {
public:
    /// ^ and $ are those of lines. Bytes are characters, so that any file can be searched.
    explicit Pattern(std::string_view text);
    ~Pattern();

    /// What is wrong with it; empty if nothing.
    std::string error() const;
    int groups() const;
    bool matches_nothing() const;

    /// Hits that do not overlap and do not start within a comment, from left to right.
    std::vector<Hit> find_all(std::string_view text, const std::vector<Part>& parts,
                              Stretch where) const;

private:
    std::unique_ptr<re2::RE2> expression_;
};

}  // namespace lobe::engine
