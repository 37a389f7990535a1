// The words that the list of edits is made of.
#pragma once

#include "engine/edits.h"

#include <optional>
#include <string>
#include <string_view>

namespace lobe::engine {

/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);

/// The first word; the rest stays, trimmed.
std::string_view take_word(std::string_view& rest);

/// What is in quotes in front; nothing, and the rest as it was, if nothing is.
std::optional<std::string> take_quoted(std::string_view& rest);

/// Letters, digits and `_`.
bool is_name(std::string_view text);
bool starts_as_number(std::string_view text);

/// A number from 0; false if the text is none.
bool read_int(std::string_view text, int& value);

/// `2` and `0..1`
bool read_hits(std::string_view text, int& least, int& most);

std::optional<Query::Kind> query_kind(std::string_view word);
std::optional<Action> action_of(std::string_view word);

/// What a regular expression of the list is, with any values in it.
struct PatternCheck {
    int groups = -1;  ///< -1: it is none
    std::string error;
};
PatternCheck check_pattern_text(std::string_view text);

}  // namespace lobe::engine
