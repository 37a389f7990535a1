// How a compute shader meets the host: two storage buffers, a count, one pipeline.
//
// The same whether the shader is run (lane.h) or only compiled for what the driver says of it
// (statistics.h).
#pragma once

#include "device/physical.h"

#include <cstdint>
#include <span>

namespace lobe::device {

/// A device's handle; everything that belongs to the device must be destroyed before it.
struct OwnedDevice {
    VkDevice handle = VK_NULL_HANDLE;
    OwnedDevice() = default;
    explicit OwnedDevice(VkDevice device) : handle{device} {}
    OwnedDevice(OwnedDevice&& other) noexcept : handle{std::exchange(other.handle, VK_NULL_HANDLE)}
    {
    }
    OwnedDevice& operator=(OwnedDevice&& other) noexcept
    {
        std::swap(handle, other.handle);
        return *this;
    }
    ~OwnedDevice()
    {
        if (handle != VK_NULL_HANDLE) vkDestroyDevice(handle, nullptr);
    }
};

/// A logical device with one queue, and float16 where there is it. With `explains`, pipelines say
/// what their compiler made of them (VK_KHR_pipeline_executable_properties).
Failure make_device(const PhysicalDevice& physical, bool explains, OwnedDevice& device);

/// Storage buffers at bindings 0 and 1 of set 0, a push constant of 32 bits.
struct Layouts {
    OwnedSetLayout set;
    OwnedPipelineLayout pipeline;
};
Failure make_layouts(VkDevice device, Layouts& layouts);

Failure make_pipeline(VkDevice device, const Layouts& layouts, std::span<const std::uint32_t> spirv,
                      std::string_view entry, VkPipelineCreateFlags flags, OwnedPipeline& pipeline);

}  // namespace lobe::device
