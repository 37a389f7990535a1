// Rows of plain values as text and back, for a store: one line per row, fields between tabs.
//
// Doubles are written with the digits that read back as them. Texts hold neither tabs nor line
// breaks: they are names and lists of inputs that this folder wrote.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

namespace lobe::analyze {

/// Appends a row.
template <class... Fields>
void write_line(std::string& text, const Fields&... fields)
{
    std::size_t left = sizeof...(fields);
    ((text += fmt::format("{}{}", fields, --left == 0 ? '\n' : '\t')), ...);
}

/// Reads what `write_line` wrote, field by field. A text that is something else gives zeros.
class LineReader {
public:
    explicit LineReader(std::string_view text) : rest_(text) {}

    bool done() const { return rest_.empty(); }

    template <class Field>
    void operator()(Field& field)
    {
        const std::size_t size = rest_.find_first_of("\t\n");
        const std::string_view found = rest_.substr(0, size);
        rest_.remove_prefix(size < rest_.size() ? size + 1 : rest_.size());
        if constexpr (std::is_same_v<Field, std::string>)
            field = found;
        else if constexpr (std::is_same_v<Field, bool>)
            field = found == "true";
        else
            std::from_chars(found.data(), found.data() + found.size(), field);
    }

private:
    std::string_view rest_;
};

}  // namespace lobe::analyze
