// Does what a device computed agree with what the function means?
//
// Results of a device, held against the acceptance interval of their own inputs: that is
// conformance. How far they are from the exact value is quality, measured beside it.
#pragma once

#include "analyze/agreement/reference.h"
#include "device/device.h"
#include "emit/emit.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// What was run: the judges' SPIR-V as it is, or what their optimizer made of it.
enum class Route : std::uint8_t {
    direct,
    optimized
};
std::string_view name(Route route);

/// One point at which something is to be said.
struct Witness {
    std::size_t point = 0;
    int component = 0;
    double result = 0;  ///< of the device
    double exact = 0;   ///< confirmed with MPFR
    double low = 0;     ///< of the acceptance interval
    double high = 0;
    std::string inputs;  ///< `roughness = 0.5, l = (0, 0, 1)`
    std::string kind;    ///< `l = v; values at their ends`
};

/// A greatest error, and where. `size` is 0 and there is no witness when nothing was compared.
struct WorstError {
    double size = 0;
    std::optional<Witness> at;
};

/// The results of one run against the reference.
struct Agreement {
    std::size_t points = 0;
    std::size_t undefined = 0;       ///< points where the contract lets some component be anything
    std::size_t outside = 0;         ///< points with a component outside its acceptance interval
    std::size_t not_a_number = 0;    ///< defined points with a NaN; they are outside as well
    std::size_t infinite = 0;        ///< defined points with an infinity, allowed there or not
    std::optional<Witness> example;  ///< the outside point farthest from its interval
    WorstError relative;             ///< of exact values of at least the least normal float
    WorstError absolute;
    WorstError ulp;  ///< in units in the last place of the larger of result and exact value
    double ulp_of_99_percent = 0;  ///< 99 % of the defined components are at most this far off

    bool agrees() const { return outside == 0; }
};

/// `results` are a device's, as a harness writes them: the components of point 0, of point 1, …
Agreement compare(const Reference& reference, std::span<const float> results);

/// Only the count of outside points, and nothing else of `compare`: for mutants.
std::size_t count_outside(const Reference& reference, std::span<const float> results);

/// Runs SPIR-V over the reference's points. Why it failed, or nothing; `results` are resized.
std::optional<std::string> execute(device::Device& device, const Reference& reference,
                                   const emit::Harness& harness,
                                   std::span<const std::uint32_t> spirv,
                                   std::vector<float>& results);

/// The same over any `count` points, `interleaved`.
std::optional<std::string> execute(device::Device& device, std::span<const float> points,
                                   std::size_t count, const emit::Harness& harness,
                                   std::span<const std::uint32_t> spirv,
                                   std::vector<float>& results);

/// The precision that emit speaks of, and the table that evaluate reads for it.
evaluate::Precision table_of(emit::Precision precision);

}  // namespace lobe::analyze
