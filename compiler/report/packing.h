// What `lobec pack` shows of a packing: pictures, tables, plots, JSON and a page.
//
// All forms read the same values and compute nothing of their own but sums and scales. Text only;
// whoever calls owns the files. Nothing in them is measured time, so equal results give equal
// bytes.
#pragma once

#include "analyze/packing/codes.h"
#include "analyze/packing/radiance.h"
#include "analyze/packing/suggest.h"
#include "ir/module.h"
#include "report/table.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::report {

/// A packing and what was found out about it.
struct Packed {
    const ir::Module* module = nullptr;  ///< with the packing's gbuffer and functions
    const ir::Packing* packing = nullptr;
    std::vector<ir::Slot> room;  ///< what a packing may use, see analyze::room
    std::vector<analyze::FieldCodes> codes;
    analyze::PackingErrors errors;
    std::optional<double> limit;  ///< what is asked of the worst error, by source or search
    bool met = true;              ///< it stays below

    /// Set when the packing was searched for. If nothing was found, the packing has no fields.
    const analyze::Suggestion* suggestion = nullptr;
    std::optional<double> written_error = {};  ///< worst, of the packing in the source
    int written_bits = 0;

    const ir::Gbuffer& gbuffer() const { return *module->find_gbuffer(packing->gbuffer); }
};

/// Everything, for a terminal.
std::string to_text(const Packed& packed, const Look& look);

/// The targets of the gbuffer with their channels and bits, in ASCII. Fits look.width, or 80.
std::string layout_picture(const Packed& packed, const Look& look);
/// The same as an SVG file, all packings below each other. Needs no other file; light and dark.
std::string to_svg(std::span<const Packed> packings);

/// `6 of 32 bits left: d.a[0..2], d.b[0..2]`
std::string room_left(const Packed& packed);

/// One row per field: place, code, range, default, largest step.
Table field_table(const Packed& packed);
/// One row per parameter and one for all: typical, 95 %, worst.
Table error_table(const Packed& packed);
/// The table with the input that reaches each worst error below its row.
std::string error_listing(const Packed& packed, const Look& look);
/// Where an error is reached, in words: directions as angles, parameters with what is stored.
std::string in_words(const Packed& packed, const analyze::RadianceWitness& witness);

/// Worst error of each parameter by bits, and the code that has it at the bits it got. Only so
/// many columns of bits, around the chosen ones; 0: all.
Table curve_table(const analyze::Suggestion& suggestion, int columns);
/// Error of the whole by bits.
Table trade_table(const analyze::Suggestion& suggestion);
/// What the suggestion gains over 8 linear bits for each parameter, and over the file's packing.
std::string comparison(const Packed& packed);

std::string to_json(std::span<const Packed> packings);
/// A page that needs no other file: inline style and inline SVG, light and dark.
std::string to_page(std::span<const Packed> packings);

/// `0.34 %`, of 0.0034: about three digits.
std::string percent(double fraction);

}  // namespace lobe::report
