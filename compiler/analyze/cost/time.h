// Nanoseconds: what an evaluation takes where it really runs. Numbers of one machine at one
// moment, unlike everything else here.
#pragma once

#include "analyze/cost/shaders.h"
#include "device/device.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace lobe::analyze {

/// Times chains on a device, the whole of which works on them: the slope of two chains per
/// evaluation, without their links, which are timed alike.
class DeviceClock {
public:
    explicit DeviceClock(device::Device device) : device_{std::move(device)} {}

    /// Nothing where the device does not compute in the format.
    std::optional<double> nanoseconds(const Chain& chain);

private:
    std::optional<double> slope(const emit::Evaluation& evaluation, emit::NumberFormat format,
                                int copies, int chains);
    std::optional<double> link(const Chain& chain);

    device::Device device_;
    std::map<std::pair<emit::NumberFormat, int>, double>
        links_;                                   ///< by how many numbers they return
    std::map<emit::NumberFormat, double> reads_;  ///< of one number more to read
};

/// On one core, in blocks that stay in its first cache. Nothing for packed half, which the CPU has
/// not. The functions of a subject are run one after the other: tapes share nothing.
std::optional<double> tape_nanoseconds(const CostSubject& subject);

}  // namespace lobe::analyze
