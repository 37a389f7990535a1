// A search for a packing: bits and code of every parameter, so that the worst radiance error is
// least for the bits there are, or the bits are least for an error.
//
// Each parameter gets a curve, its worst error by bits, over the codes in which its default (and
// the values it must keep exactly) decode without rounding. The bits are shared out by an exact
// search over the curves (which take the errors of parameters to add up), and the layouts that
// come out are measured as a whole. So the shares are optimal under that assumption; the layout
// that is suggested is then improved bit by bit where measuring disagrees with it, and the error
// that is printed is the measured one.
#pragma once

#include "analyze/packing/radiance.h"
#include "ir/module.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

struct SuggestOptions {
    std::vector<std::uint32_t> parameters;  ///< to place: indices into Module::parameters
    std::vector<ir::Slot> room;             ///< the bits that may be used, in order
    std::optional<double> error;            ///< fewest bits that stay below it; none: least error
    RadianceOptions radiance;
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// One parameter in some bits, with its best code.
struct CurvePoint {
    int bits = 0;            ///< of each component
    bool is_signed = false;  ///< snorm
    ir::Code code;
    double error = 0;  ///< worst, this parameter stored alone
};
struct Curve {
    std::uint32_t parameter = 0;
    std::vector<CurvePoint> points;  ///< by bits; only where the default is exact
};
/// The best layout of so many bits.
struct TradePoint {
    int bits = 0;
    std::vector<int> shares;  ///< bits per curve
    double predicted = 0;     ///< sum over the curves
    double measured = 0;      ///< as a whole
};

struct Suggestion {
    ir::Module module;  ///< the module, with the suggested packing as its last one, functions built
    bool found = false;   ///< there is a layout, and it stays below the error asked for
    std::string why_not;  ///< when not: why. Then the best layout there is, if any
    std::vector<std::string> give_ups;  ///< each with what it would gain, best first
    std::vector<Curve> curves;
    std::vector<TradePoint> trade;  ///< by bits, up to the room there is
    PackingErrors errors;           ///< of the suggested packing
    PackingErrors linear;           ///< of 8 linear bits for each parameter, over the same box
    std::string text;               ///< the packing block, as the source would have it
};

/// `module` is as checked, not optimized. `from` gives model, gbuffer, ranges of fields, measured
/// ranges and exact values; its fields and bits are not kept. `packing` indexes Module::packings.
Suggestion suggest(const ir::Module& module, std::size_t packing, const SuggestOptions& options);

/// The bits of channels that a packing may use everywhere it has to work: free channels, and those
/// whose holders it goes without. In the order of the gbuffer.
std::vector<ir::Slot> room(const ir::Gbuffer& gbuffer, const ir::Packing& packing);

}  // namespace lobe::analyze
