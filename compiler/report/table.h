// A table for terminals and logs: aligned columns, colors only when asked.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::report {

enum class Style : std::uint8_t {
    plain,
    strong,
    good,
    bad,
    faint
};

struct Cell {
    std::string text;
    Style style = Style::plain;
};

struct Column {
    std::string title;
    bool numeric = false;  ///< numbers stand at the right edge
};

/// Rows shorter than the columns end in empty cells.
struct Table {
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
};

/// What the terminal is like. `width` in characters; 0 means without limit.
struct Look {
    bool color = false;
    int width = 0;
};

/// One line for the titles, one per row, each ending in a line break and with no trailing space.
/// The last column gives way when the width is short; columns are never cut inside a character.
std::string render(const Table& table, const Look& look);

/// A piece of text in a style; as it is without color.
std::string styled(std::string_view text, Style style, bool color);

/// Characters of a UTF-8 text.
int length(std::string_view text);

/// `65,536`
std::string grouped(std::uint64_t number);

}  // namespace lobe::report
