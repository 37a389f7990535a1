// What a driver's compiler makes of a compute shader for hardware that need not be there.
//
// Mesa's RADV compiles for any AMD chip named in RADV_FORCE_FAMILY, through a device that can do
// nothing else, and VK_KHR_pipeline_executable_properties tells the result. The variable counts
// for a whole process, a name that the driver does not know aborts it, and a driver may hang: so
// each chip is served by a process of its own, which is this executable once more. A plain fork
// would do without the executable's help, but not from a process that has threads: what they held
// locked, in Vulkan's loader or in a driver, stays locked in the child.
//
// The child gets an environment of its own, so that neither the user's settings of the driver nor
// its cache on disk change a number, and nothing of what it prints comes through.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::device {

/// Of one wave that runs the shader once.
struct ShaderStatistics {
    int vector = 0;              ///< vector instructions that are not transcendental
    int transcendental = 0;      ///< exp, log, rcp, rsq, sqrt, sin, cos
    int instructions = 0;        ///< all, scalar and memory ones included
    int latency = 0;             ///< cycles from start to end, by the driver's estimate
    int inverse_throughput = 0;  ///< cycles per wave when there are many, likewise
    int vgprs = 0;
    int waves = 0;  ///< that fit on a SIMD with so many registers
    int spilled = 0;
    int code_bytes = 0;
};

/// The compiler of one chip. One request at a time; use it from one thread.
class ChipCompiler {
public:
    /// `chips`: spellings of one chip, the first that the driver knows is taken: Mesa has renamed
    /// some. On failure `why` says what is missing.
    static std::optional<ChipCompiler> open(std::span<const std::string> chips, std::string& why);

    ChipCompiler(ChipCompiler&&) noexcept;
    ChipCompiler& operator=(ChipCompiler&&) noexcept;
    ~ChipCompiler();

    /// `radv, Mesa 22.3.6`
    const std::string& driver() const;
    /// As the driver calls it: `AMD RADV NAVI21`
    const std::string& chip() const;

    /// Of a shader with entry point `main` and the interface of Device::run. A shader that takes
    /// the driver down, or longer than a minute, is a failure of that shader; the next one finds
    /// the driver started again.
    std::optional<ShaderStatistics> compile(std::span<const std::uint32_t> spirv, std::string& why);

private:
    struct State;
    explicit ChipCompiler(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// To be called first in `main` of every program that opens a ChipCompiler: answers the requests
/// of the process that started this one for that, and returns its exit status then. Nothing
/// otherwise. A program that never called it cannot open one.
std::optional<int> serve_statistics(int argc, const char* const* argv);

}  // namespace lobe::device
