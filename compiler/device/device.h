// A Vulkan device that runs one compute shader over many points.
//
// Needs no window and no layer. Prefers what the selector names; by default the software device
// (lavapipe), so that results do not depend on the machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::device {

/// What a device promises of one width of floats when a shader asks for it. Nothing here is on
/// by default: without an execution mode a shader gets whatever the device prefers.
struct FloatControls {
    bool can_preserve_denormals = false;
    bool can_flush_denormals = false;
    bool can_round_to_nearest = false;
    bool can_preserve_nan = false;  ///< and infinities, and the sign of zero
};

struct DeviceFacts {
    std::string name;    ///< `llvmpipe (LLVM 15.0.6, 256 bits)`
    std::string driver;  ///< `llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)`
    std::string api;     ///< `1.3.230`
    bool software = false;
    bool float16 = false;  ///< arithmetic and 16-bit storage
    FloatControls controls16;
    FloatControls controls32;
};

/// Every device that Vulkan offers, in its order. Empty (with `why`) when there is no loader,
/// no driver or no compute queue.
std::vector<DeviceFacts> list_devices(std::string& why);

/// What a caller may bound. The defaults suit every device.
struct Limits {
    /// A dispatch that takes longer, the driver's own compilation included, is given up.
    std::chrono::milliseconds time = std::chrono::seconds{60};
    /// Points of one dispatch; more are run in several.
    std::uint32_t points = 1U << 20;
    /// Always copy through a second buffer, as devices with memory of their own need.
    bool always_stage = false;
};

class Device {
public:
    /// `selector`: empty for the default (the first software device, else the first device), a
    /// number from `list_devices`, or part of a name without regard to case. On failure `why`
    /// says what was looked for and what is there.
    static std::optional<Device> open(std::string_view selector, std::string& why,
                                      const Limits& limits = {});

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    const DeviceFacts& facts() const;

    /// Runs a compute shader: storage buffers `input` at binding 0 and `output` at binding 1 of
    /// set 0, a push constant with `count`, ceil(count / 64) workgroups. Returns why it failed,
    /// or nothing. `output` keeps its size, and its numbers where the shader writes none; after a
    /// failure it may hold results of some points.
    ///
    /// Where `count` is beyond `Limits::points` or what the device takes at once, the points are
    /// run in turns: both sizes must then be multiples of `count`, and a shader sees its points
    /// numbered from 0 in every turn.
    ///
    /// May be called from several threads at the same time. On a software device that is worth
    /// it: the driver compiles in the calling thread.
    std::optional<std::string> run(std::span<const std::uint32_t> spirv, std::string_view entry,
                                   std::span<const float> input, std::span<float> output,
                                   std::uint32_t count);

    /// How long one dispatch of a shader takes, in seconds, as often as `seconds` is long: by the
    /// device's own clock, or, on a software device, by the host's around the submission. A first
    /// dispatch, which may still compile, is not among them. `count` is not divided: it must fit
    /// the device at once. Returns why it failed, or nothing.
    std::optional<std::string> time(std::span<const std::uint32_t> spirv, std::string_view entry,
                                    std::span<const float> input, std::size_t outputs,
                                    std::uint32_t count, std::span<double> seconds);

private:
    struct State;
    explicit Device(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace lobe::device
