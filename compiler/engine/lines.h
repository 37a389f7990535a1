// A file's bytes as lines that know how they ended, and back: whoever takes lines out and puts
// lines in keeps every other byte.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

enum class LineEnd : unsigned char {
    none,  ///< only the last line
    lf,
    crlf
};

struct Line {
    std::string text;
    LineEnd end = LineEnd::lf;
    friend bool operator==(const Line&, const Line&) = default;
};

struct Lines {
    bool byte_order_mark = false;
    std::vector<Line> lines;
    friend bool operator==(const Lines&, const Lines&) = default;
};

Lines to_lines(std::string_view bytes);
std::string to_bytes(const Lines& lines);

/// The line and its end behind some bytes.
void put_line(std::string& bytes, const Line& line);
void put_byte_order_mark(std::string& bytes);

/// What most lines end in; LF if there are none.
LineEnd usual_end(const Lines& lines);

/// The lines of a text with LF ends, without them. A last line without one counts.
std::vector<std::string_view> split_lines(std::string_view text);

/// The blanks (and tabs) that a line starts with.
std::string_view indentation(std::string_view line);
bool is_blank(std::string_view line);

}  // namespace lobe::engine
