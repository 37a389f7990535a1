// The marks that patch.h describes: finding them in a file, taking regions out, writing new ones.
#pragma once

#include "engine/lines.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

/// Lines `begin` .. `end` of a file, which are its marks.
struct Region {
    std::string model;
    std::string name;
    int number = 0;
    int total = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::vector<std::string> under;      ///< models that were there first, of the `//^` lines
    std::vector<std::string> new_files;  ///< of the `//+` lines
    std::vector<std::string> before;     ///< what stood here, of the `//-` lines
    std::vector<LineEnd> before_ends;
    bool edited = false;         ///< its lines are not what its hash says
    std::vector<Region> inside;  ///< of other models
};

/// A mark without its other half, or one that cannot be read.
struct BrokenMark {
    std::size_t line = 0;  ///< from 0
    std::string what;
};

struct FoundRegions {
    std::vector<Region> regions;  ///< in order, the outermost ones
    std::vector<BrokenMark> broken;
};
FoundRegions find_regions(const Lines& text);

/// `visit(region, depth)` for each of them, outer ones first.
void for_each_region(const std::vector<Region>& regions,
                     const std::function<void(const Region&, int depth)>& visit);

/// The text as it was before these models' regions came in. A region that stands inside of one
/// that goes must go too.
struct Restored {
    Lines text;
    std::vector<std::size_t> origins;  ///< of each line: where it is in the text with the regions
};
Restored without_regions(const Lines& text, const std::vector<Region>& regions,
                         const std::function<bool(const std::string& model)>& goes);

/// Which lines only say what a region is: BEGIN, END and the lines below BEGIN, of all regions.
std::vector<bool> mark_lines(const Lines& text, const std::vector<Region>& regions);

/// A region to write.
struct NewRegion {
    std::string model;
    std::string name;
    int number = 0;
    int total = 0;
    std::string indent;                  ///< of the marks
    std::vector<std::string> under;      ///< models to be named in it
    std::vector<std::string> new_files;  ///< files to be named in it
    std::vector<Line> before;            ///< what it takes the place of; may be empty
    std::vector<std::string> after;
    LineEnd end = LineEnd::lf;  ///< of lines that were not there before
};
void write_region(const NewRegion& region, std::vector<Line>& out);

/// Whether a line would be taken for a mark.
bool looks_like_mark(std::string_view line);

/// The hash in marks: of lines without their ends.
class LineHash {
public:
    void add(std::string_view line);
    /// Eight hexadecimal digits.
    std::string text() const;

private:
    std::uint32_t state_ = 2166136261u;
};

}  // namespace lobe::engine
