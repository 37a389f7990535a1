// Comma-separated text, RFC 4180: one record at a time in, one record at a time out.
//
// Reads LF and CRLF, quoted cells with doubled quotes and line ends inside them, a UTF-8 byte
// order mark, and a last record without a line end. Holds one record, so a table may be larger
// than memory.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

class CsvReader {
public:
    explicit CsvReader(std::istream& in) : in_(in) {}

    /// The next record's cells; false at the end of the text or on an error. Empty lines are
    /// skipped.
    bool next(std::vector<std::string>& cells);

    /// The line that the last record began on, from 1.
    std::size_t line() const { return line_; }
    /// What was wrong with the text; empty while nothing is.
    const std::string& error() const { return error_; }

private:
    bool read_quoted(std::string& cell);

    std::istream& in_;
    std::size_t line_ = 0;
    std::size_t next_line_ = 1;
    std::string error_;
    bool begun_ = false;
};

/// Appends a cell to a record, quoted if it has to be.
void append_cell(std::string& record, std::string_view cell);

}  // namespace lobe::analyze
