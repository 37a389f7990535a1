// A packing as a picture before it is drawn: which bits of which channel hold what. The terminal
// and the SVG draw the same layout.
//
// The engine's configuration that is drawn is the one nearest to its defaults that the packing
// supports.
#pragma once

#include "report/packing.h"

#include <string>
#include <string_view>
#include <vector>

namespace lobe::report {

/// Neighboring bits with one content.
struct Piece {
    enum class Holds : std::uint8_t {
        field,    ///< of the packing
        nothing,  ///< free for it
        engine,   ///< the engine's own content
        closed    ///< empty, but not to be had
    };
    Holds holds = Holds::closed;
    int low = 0;
    int bits = 0;
    std::string label;      ///< `retroreflection`, `free`, `base_color`
    std::string detail;     ///< what there is to say about it besides
    std::size_t field = 0;  ///< of a field: index into Packing::fields
};

struct ChannelLayout {
    std::size_t channel = 0;  ///< index into Gbuffer::channels
    ir::Format format;
    std::vector<Piece> pieces;  ///< most significant first
    /// Some of it is the packing's, or could be.
    bool is_open() const;
};

struct TargetLayout {
    std::size_t target = 0;
    std::vector<ChannelLayout> channels;
};

struct Layout {
    std::size_t configuration = 0;
    std::vector<TargetLayout> targets;
    int bits = 0;                ///< that the packing has, used or not
    std::vector<ir::Slot> left;  ///< unused ones
};

Layout layout_of(const Packed& packed);

/// A name on lines of so many characters, broken at underscores and inside words only where a
/// word is longer than a line; nothing if it needs more than `most` lines or cannot be read.
std::vector<std::string> on_lines(std::string_view name, int width, int most);

/// Folds a text at spaces to look.width, or 80; every line starts with so many spaces.
std::string folded(const std::string& text, std::size_t indent, const Look& look);

/// Names that did not fit their boxes: a key stands there, and the legend says what it means.
class Legend {
public:
    std::string key_of(const std::string& label);
    /// `1 smooth_terminator`
    std::vector<std::string> lines() const;

private:
    std::vector<std::string> labels_;
};

/// `d.a[0..2]`, `d.a`
std::string describe(const ir::Gbuffer& gbuffer, const ir::Slot& slot, int channel_bits);

/// `d.b[4..7], d.a`
std::string slots_of(const Packed& packed, const ir::Field& field);

}  // namespace lobe::report
