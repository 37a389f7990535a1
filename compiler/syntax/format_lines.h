// Canonical lines: indentation, comments, empty lines, and rows that are aligned or broken; inside
// `syntax` only. What a line says comes from format.cpp and its neighbors.
#pragma once

#include "syntax/format_expression.h"
#include "syntax/tree.h"

#include <string>
#include <string_view>
#include <vector>

namespace lobe::syntax {

/// Words that stay together, and an expression behind them that may be broken.
struct Piece {
    std::string text;
    ExpressionId value = {};
    bool parentheses = false;  ///< around the value
};

/// Pieces that share a column with those of the lines around.
using Cell = std::vector<Piece>;

/// A line of a block. `aligned` lines that follow each other without an empty line share columns.
struct Line {
    const std::vector<Comment>* comments;
    const std::vector<Comment>* trailing;
    bool blank_before = false;
    std::vector<Cell> cells;
    bool aligned = false;
};

template <class Node>
Line line_of(const Node& node, std::vector<Cell> cells, bool aligned)
{
    return {&node.comments, &node.trailing, node.blank_before, std::move(cells), aligned};
}

/// The pieces `a,` `b`: a list that may be broken behind its commas.
Cell list(std::string_view first, const std::vector<std::string>& items);
Cell list(std::string_view first, const std::vector<Identifier>& names);

class LineWriter {
public:
    explicit LineWriter(const Tree& tree) : expressions_(tree) {}

    static constexpr std::size_t step = 2;

    const ExpressionWriter& expressions() const { return expressions_; }
    std::string take() { return std::move(out_); }

    void put(std::string_view text) { out_ += text; }
    void indent(std::size_t columns) { out_.append(columns, ' '); }
    /// One empty line, unless there is one or a block has just been opened.
    void blank_line();
    void end_line(const std::vector<Comment>& trailing);
    void write_comments(const std::vector<Comment>& comments, std::size_t columns);
    std::size_t column() const;
    /// ` value` behind an `=`, or the value on lines of its own where that does not fit.
    void write_value(ExpressionId value, std::size_t columns);

    /// The lines, indented by `columns`.
    void write_lines(const std::vector<Line>& lines, std::size_t columns);
    /// The cells of one line, broken between pieces where they are too wide.
    void write_broken(const std::vector<Cell>& cells, std::size_t columns);
    /// Columns of the cells on one line.
    std::size_t width(const std::vector<Cell>& cells) const;

    std::string type(const TypeClause& clause) const;
    std::string range(const RangeClause& clause) const;

private:
    std::string flat(const Piece& piece) const;
    std::string flat(const std::vector<Cell>& cells, const std::vector<std::size_t>& widths) const;
    std::vector<std::size_t> widths(const Line* begin, const Line* end, std::size_t columns) const;

    ExpressionWriter expressions_;
    std::string out_;
};

}  // namespace lobe::syntax
