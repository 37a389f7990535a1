// Every code that a packing can store, unpacked and packed again: nothing may move.
//
// Comes in: a packing, through optimize, and a device. Goes out: which codes came back, on the CPU
// by the evaluator, on the device by the file as emitted for a target, and by the contract, which
// says for how many no conforming device can do otherwise. What has to come back is counted out in
// whole numbers and shares no code with any of them.
#pragma once

#include "analyze/agreement/agreement.h"
#include "analyze/agreement/judgement.h"
#include "ir/module.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A channel that came back with another code than it must.
struct LostCode {
    std::string channel;         ///< `d.b`
    std::string stored;          ///< what went in: `d.r = 127/255, d.b = 37/255`
    std::uint32_t expected = 0;  ///< code
    double returned = 0;         ///< as it would be stored, times the last code
};

/// What came back on one machine, by points.
struct Trip {
    std::size_t lost = 0;        ///< some channel came back with another code
    std::size_t outside = 0;     ///< some value is outside its acceptance interval
    std::size_t other_bits = 0;  ///< what is to be stored has other bits than on the CPU
    std::optional<LostCode> example;

    bool ok() const { return lost == 0 && outside == 0; }
};

/// One packing on one target.
struct RoundTrip {
    std::string packing;  ///< `callisto on ue4`
    std::string target;
    std::size_t channels = 0;
    std::size_t codes = 0;     ///< of all channels, and of fields that lie in more than one
    std::size_t points = 0;    ///< three for each code: the float nearest to it and its neighbors
    std::size_t promised = 0;  ///< points where the contract allows nothing but the right codes
    Trip processor;
    std::vector<Judgement> judgements;  ///< of the shader that was run
    std::string failure;                ///< why the device could not run it; empty: it could
    bool executed = false;
    Trip direct;     ///< as the front end made it
    Trip optimized;  ///< after spirv-opt -O

    bool ok() const;
};

/// What has to come back, and what the CPU and the contract make of it: the same for all targets.
struct TripReference {
    std::vector<std::string> names;       ///< of Packing::channels
    std::vector<std::uint32_t> last;      ///< code of each
    std::size_t outputs = 0;              ///< floats per point: what is stored, then the values
    std::vector<float> input;             ///< what the channels of point 0 read, of point 1, …
    std::vector<std::uint32_t> expected;  ///< codes of the channels of point 0, of point 1, …
    std::vector<float> results;           ///< of the CPU, as the device's
    std::vector<evaluate::Acceptance> allowed;
    RoundTrip outcome;  ///< without target, judgements and device

    std::size_t points() const { return outcome.points; }
};
TripReference trip_reference(const ir::Module& module, std::size_t packing);

/// Without a device only the judges have a say.
RoundTrip round_trip(const ir::Module& module, const Sources& sources, std::size_t packing,
                     const emit::Target& target, const TripReference& reference,
                     device::Device* device);

/// Results of a device, point by point, against the reference.
Trip compare(const TripReference& reference, std::span<const float> results);

}  // namespace lobe::analyze
