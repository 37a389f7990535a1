// The physical devices that can run a compute shader, with what there is to know of each.
#pragma once

#include "device/device.h"
#include "device/vulkan.h"

#include <vector>

namespace lobe::device {

struct PhysicalDevice {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;  ///< the first one that computes
    VkPhysicalDeviceLimits limits{};
    VkPhysicalDeviceMemoryProperties memory{};
    bool float16_by_extension = false;  ///< float16 needs its extension enabled, being Vulkan 1.1
    DeviceFacts facts;
};

/// Those with Vulkan 1.1 and a compute queue, in Vulkan's order. Empty, with `why`, if there is
/// none.
std::vector<PhysicalDevice> physical_devices(std::string& why);

/// The position of what `selector` means; see Device::open. `devices` is not empty.
std::optional<std::size_t> select_device(const std::vector<PhysicalDevice>& devices,
                                         std::string_view selector, std::string& why);

}  // namespace lobe::device
