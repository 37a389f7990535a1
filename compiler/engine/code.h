// As much of C++ and HLSL as edits need: what is a comment, and which brace closes which.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace lobe::engine {

enum class Part : unsigned char {
    code,
    literal,       ///< inside a string or character literal, without its quotes' first
    line_comment,  ///< without its first character, so that an anchor may start at a comment
    block_comment  ///< likewise
};

/// What each byte belongs to. Line ends are LF.
std::vector<Part> parts_of(std::string_view text);

/// Where the definition that starts at or after `from` ends: behind the line of the brace that
/// closes its first one. Nothing for a declaration (`;` comes first) and for a brace that never
/// closes. Of `#if` and its `#else`s each continues at the depth before the `#if`.
std::optional<std::size_t> end_of_definition(std::string_view text, const std::vector<Part>& parts,
                                             std::size_t from);

}  // namespace lobe::engine
