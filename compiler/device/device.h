// A Vulkan device that runs one compute shader over many points.
//
// Needs no window and no layer. Prefers what the selector names; by default the software device
// (lavapipe), so that results do not depend on the machine.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::device {

struct DeviceFacts {
    std::string name;     ///< `llvmpipe (LLVM 15.0.6, 256 bits)`
    std::string driver;   ///< `llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)`
    std::string api;      ///< `1.3.230`
    bool software = false;
    bool float16 = false;  ///< arithmetic and 16-bit storage
};

/// Every device that Vulkan offers, in its order. Empty (with `why`) when there is no loader,
/// no driver or no compute queue.
std::vector<DeviceFacts> list_devices(std::string& why);

class Device {
public:
    /// `selector`: empty for the default (the first software device, else the first device), a
    /// number from `list_devices`, or part of a name without regard to case. On failure `why`
    /// says what was looked for and what is there.
    static std::optional<Device> open(std::string_view selector, std::string& why);

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    const DeviceFacts& facts() const;

    /// Runs a compute shader: storage buffers `input` at binding 0 and `output` at binding 1 of
    /// set 0, a push constant with `count`, ceil(count / 64) workgroups. Returns why it failed,
    /// or nothing. `output` keeps its size.
    std::optional<std::string> run(std::span<const std::uint32_t> spirv, std::string_view entry,
                                   std::span<const float> input, std::span<float> output,
                                   std::uint32_t count);

private:
    struct State;
    explicit Device(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace lobe::device
