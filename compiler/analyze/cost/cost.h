// What a function costs, and where: on AMD's families by the driver's own compiler, in nanoseconds
// where it really runs, in SPIR-V instructions everywhere.
//
// Costs are marginal: of one more evaluation in a shader that already runs. A chain of n and one of
// 2n evaluations, each fed by the one before, are compiled; their difference is n evaluations and n
// links, and the links' own cost is measured alike and taken away. docs/cost.md tells more.
#pragma once

#include "analyze/store.h"
#include "analyze/verify.h"
#include "ir/module.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

/// Generations of AMD hardware whose compiler runs without the hardware.
enum class Family : std::uint8_t {
    gcn4,   ///< polaris10
    gcn5,   ///< vega10
    rdna1,  ///< navi10
    rdna2,  ///< navi21
    rdna3   ///< gfx1100
};
inline constexpr std::array all_families{Family::gcn4, Family::gcn5, Family::rdna1, Family::rdna2,
                                         Family::rdna3};
std::string_view name(Family family);   ///< `rdna2`, as typed after --on
std::string_view title(Family family);  ///< `RDNA2 (navi21)`
std::optional<Family> find_family(std::string_view name);

/// What every number of a function is computed in. `packed16` does two evaluations at once in
/// f16vec2; its costs are of one of the two.
enum class Format : std::uint8_t {
    float32,
    float16,
    packed16
};
std::string_view name(Format format);  ///< `float`, `half`, `packed half`

struct FamilyCost {
    double valu = 0;                ///< vector instructions that are no transcendental ones
    double transcendental = 0;      ///< exp2, log2, reciprocal, roots, sine
    double issue = 0;               ///< cycles in which a wave keeps its unit's issue busy
    double inverse_throughput = 0;  ///< the driver's estimates, cycles
    double latency = 0;
    int vgprs = 0;  ///< of a shader with one evaluation
    int waves = 0;  ///< that fit on a SIMD with so many registers
};

struct Cost {
    std::map<Family, FamilyCost> families;     ///< of those that were asked for; or empty
    int spirv_instructions = 0;                ///< arithmetic per component, after spirv-opt -O
    std::optional<double> device_nanoseconds;  ///< of one evaluation on the device
    std::optional<double> tape_nanoseconds;    ///< of one evaluation on one core
};

/// Functions of a module that are evaluated together (the outputs of a model), so that what they
/// share is paid for once.
struct CostSubject {
    const ir::Module* module = nullptr;  ///< through optimize or spell
    std::vector<ir::FunctionId> functions;
    Format format{};
    bool from_vectors = false;  ///< with l, v, n as inputs, else the fields that are read
};

struct CostOptions {
    bool statistics = true;  ///< of the driver, per family
    std::vector<Family> families{all_families.begin(), all_families.end()};  ///< of these
    bool nanoseconds = false;  ///< really run; never kept in the store
    std::string device;        ///< for nanoseconds; see device::Device::open
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

struct Costs {
    std::vector<Cost> costs;    ///< one per subject
    std::string no_statistics;  ///< why there are none; empty: there are, or none were asked for
    std::string driver;         ///< `radv, Mesa 22.3.6`
    std::string device;         ///< that nanoseconds are of
    std::string no_device;      ///< why there are none of a device, like `no_statistics`
};

/// Results are the same whatever the number of threads, but for nanoseconds.
Costs measure_costs(std::span<const CostSubject> subjects, const Sources& sources,
                    const CostOptions& options, const Store& store);

/// The number by which a choice is judged on a family: issue cycles. 0 where it was not measured.
double issue_on(const Cost& cost, Family family);

}  // namespace lobe::analyze
