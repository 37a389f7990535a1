#include "analyze/csv.h"

#include <fmt/format.h>

#include <istream>

namespace lobe::analyze {
namespace {

constexpr int end = std::char_traits<char>::eof();

}  // namespace

bool CsvReader::read_quoted(std::string& cell)
{
    const std::size_t opened = next_line_;
    for (int c = in_.get(); c != end; c = in_.get()) {
        if (c == '\n') ++next_line_;
        if (c != '"') {
            cell += static_cast<char>(c);
            continue;
        }
        if (in_.peek() != '"') return true;
        cell += static_cast<char>(in_.get());
    }
    line_ = opened;
    error_ = "a quoted cell is never closed";
    return false;
}

bool CsvReader::next(std::vector<std::string>& cells)
{
    cells.clear();
    if (!error_.empty()) return false;
    if (!begun_) {
        begun_ = true;
        // A byte order mark is no part of the first column's name.
        for (const int mark : {0xEF, 0xBB, 0xBF})
            if (in_.peek() == mark) in_.get();
    }

    line_ = next_line_;
    std::string cell;
    bool quoted = false;
    for (int c = in_.get();; c = in_.get()) {
        if (c == '\r' && in_.peek() == '\n') c = in_.get();
        if (c == end || c == '\n') {
            const bool empty = cells.empty() && cell.empty() && !quoted;
            if (c == '\n') ++next_line_;
            if (empty && c == end) return false;
            if (empty) {
                line_ = next_line_;
                continue;
            }
            cells.push_back(std::move(cell));
            return true;
        }
        if (c == ',') {
            cells.push_back(std::move(cell));
            cell.clear();
            quoted = false;
        } else if (c == '"' && cell.empty() && !quoted) {
            quoted = true;
            if (!read_quoted(cell)) return false;
        } else if (quoted || c == '"') {
            error_ = quoted ? "text follows a quoted cell's closing quote"
                            : "a quote inside a cell that does not begin with one";
            return false;
        } else {
            cell += static_cast<char>(c);
        }
    }
}

void append_cell(std::string& record, std::string_view cell)
{
    if (cell.find_first_of(",\"\r\n") == std::string_view::npos) {
        record += cell;
        return;
    }
    record += '"';
    for (const char c : cell) {
        if (c == '"') record += '"';
        record += c;
    }
    record += '"';
}

}  // namespace lobe::analyze
