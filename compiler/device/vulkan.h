// Vulkan's handles as values that clean up after themselves, and its results as text.
#pragma once

#include <vulkan/vulkan.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lobe::device {

/// Why something did not work, or nothing.
using Failure = std::optional<std::string>;

/// `VK_ERROR_DEVICE_LOST`
std::string_view name_of(VkResult result);

/// `vkCreateDevice: VK_ERROR_OUT_OF_HOST_MEMORY`, or nothing on success.
Failure failure_of(std::string_view call, VkResult result);

/// A handle that belongs to a device and is destroyed with this value.
template <typename Handle, auto destroy>
class Owned {
public:
    Owned() = default;
    Owned(VkDevice device, Handle handle) : device_{device}, handle_{handle} {}
    Owned(Owned&& other) noexcept
        : device_{other.device_}, handle_{std::exchange(other.handle_, Handle{})}
    {
    }
    Owned& operator=(Owned&& other) noexcept
    {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned()
    {
        if (handle_ != Handle{}) destroy(device_, handle_, nullptr);
    }

    Handle get() const { return handle_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_{};
};

using OwnedBuffer = Owned<VkBuffer, vkDestroyBuffer>;
using OwnedMemory = Owned<VkDeviceMemory, vkFreeMemory>;
using OwnedShader = Owned<VkShaderModule, vkDestroyShaderModule>;
using OwnedPipeline = Owned<VkPipeline, vkDestroyPipeline>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using OwnedSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using OwnedDescriptorPool = Owned<VkDescriptorPool, vkDestroyDescriptorPool>;
using OwnedCommandPool = Owned<VkCommandPool, vkDestroyCommandPool>;
using OwnedQueryPool = Owned<VkQueryPool, vkDestroyQueryPool>;
using OwnedFence = Owned<VkFence, vkDestroyFence>;

/// The connection to the loader and its drivers, made once and kept until the process ends: a
/// driver that is unloaded leaves memory behind, and takes its time to load again. Null, with
/// `why`, when there is no driver; the next call looks again.
VkInstance instance(std::string& why);

}  // namespace lobe::device
