// Numbers that a shader and the host both see.
//
// One buffer where the device's memory can be read by the host at full speed (a software or an
// integrated device), else one for each, and copies between them. Only grows.
#pragma once

#include "device/vulkan.h"

#include <span>

namespace lobe::device {

class Channel {
public:
    Channel() = default;
    Channel(VkDevice device, const VkPhysicalDeviceMemoryProperties& memory, bool always_stage);

    /// Room for so many floats. Growing loses what was in it, and changes `buffer`.
    Failure reserve(std::size_t floats);

    void write(std::span<const float> numbers);
    void read(std::span<float> numbers) const;

    /// What the shader is to be given; at least one float long.
    VkBuffer buffer() const { return shader_.buffer.get(); }
    VkDeviceSize bytes() const { return bytes_; }

    /// The copies, if any, that bring what was written to the shader, and back what it wrote.
    void record_upload(VkCommandBuffer commands) const;
    void record_download(VkCommandBuffer commands) const;

private:
    struct Storage {
        OwnedMemory memory;  // declared first, so freed after the buffer
        OwnedBuffer buffer;
        void* mapped = nullptr;
    };

    Failure allocate(VkDeviceSize bytes, VkMemoryPropertyFlags wanted, Storage& storage) const;

    VkDevice device_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    bool is_staged_ = false;
    VkDeviceSize bytes_ = 0;
    Storage shader_;
    Storage staging_;
};

}  // namespace lobe::device
