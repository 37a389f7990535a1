// Where an anchor hits in a file, within its scope.
#pragma once

#include "engine/code.h"
#include "engine/edits.h"
#include "engine/lines.h"
#include "engine/patch.h"
#include "engine/pattern.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

/// A file as anchors see it: LF line ends, and blanks where only marks of other models' regions
/// are, so that an anchor over several lines reaches across them.
struct Searched {
    std::string path;
    Lines lines;
    std::vector<std::size_t> origins;  ///< of each line: where it is in the tree's file
    std::vector<bool> marks;           ///< of each line: it is one of another model's marks
    std::string text;
    std::vector<Part> parts;
    std::vector<std::size_t> starts;  ///< of the lines, in `text`

    std::size_t line_at(std::size_t offset) const;
    /// As people count, in the tree's file.
    int shown_line(std::size_t line) const;
    std::string_view at(Stretch where) const;
};
Searched make_searched(std::string path, Lines lines, std::vector<std::size_t> origins,
                       std::vector<bool> marks);

struct Search {
    std::vector<Hit> hits;
    Stretch where;                     ///< the scope
    bool is_absent = false;            ///< the scope is not there
    std::optional<Obstacle> obstacle;  ///< the scope is not there or not alone; a value is missing
};
Search search(const Searched& file, const Anchor& anchor, const ValueOf& value_of);

/// The lines that the printing characters of a hit are on, first and last.
struct LineRange {
    std::size_t first = 0;
    std::size_t last = 0;
};
LineRange lines_of(const Searched& file, Stretch hit);

/// `once, in line 5` or `3 times, in lines 5, 9 and 12`
std::string shown_hits(const Searched& file, const std::vector<Hit>& hits);

/// `5, 9 and 12`
std::string shown_lines(const Searched& file, const std::vector<Hit>& hits);

}  // namespace lobe::engine
