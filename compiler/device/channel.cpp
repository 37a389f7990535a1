// Chooses memory, copies numbers in and out.
#include "device/channel.h"

#include <algorithm>
#include <cstring>

namespace lobe::device {
namespace {

constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags coherent =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags cached = coherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;

bool has_type(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t type,
              VkMemoryPropertyFlags wanted)
{
    return (memory.memoryTypes[type].propertyFlags & wanted) == wanted;
}

bool has_any_type(const VkPhysicalDeviceMemoryProperties& memory, VkMemoryPropertyFlags wanted)
{
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if (has_type(memory, type, wanted)) return true;
    return false;
}

/// The first memory type among the bits of `allowed` that has all of `wanted`.
std::optional<std::uint32_t> find_type(const VkPhysicalDeviceMemoryProperties& memory,
                                       std::uint32_t allowed, VkMemoryPropertyFlags wanted)
{
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if ((allowed >> type & 1U) != 0 && has_type(memory, type, wanted)) return type;
    return std::nullopt;
}

}  // namespace

Channel::Channel(VkDevice device, const VkPhysicalDeviceMemoryProperties& memory, bool always_stage)
    : device_{device}, memory_{memory}, is_staged_{always_stage ||
                                                   !has_any_type(memory, local | cached)}
{
}

Failure Channel::allocate(VkDeviceSize bytes, VkMemoryPropertyFlags wanted, Storage& storage) const
{
    VkBufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    create.size = bytes;
    create.usage = usage;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkResult result = vkCreateBuffer(device_, &create, nullptr, &buffer);
    if (auto failure = failure_of("vkCreateBuffer", result)) return failure;
    storage = {};
    storage.buffer = {device_, buffer};

    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_, buffer, &needs);
    // Vulkan promises a coherent type for every buffer; that it is cached, or local, it does not.
    auto type = find_type(memory_, needs.memoryTypeBits, wanted);
    if (!type) type = find_type(memory_, needs.memoryTypeBits, wanted & coherent);
    if (!type) return "the device has no memory for a storage buffer that its host can see";

    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = *type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    result = vkAllocateMemory(device_, &allocation, nullptr, &memory);
    if (auto failure = failure_of("vkAllocateMemory", result)) return failure;
    storage.memory = {device_, memory};
    result = vkBindBufferMemory(device_, buffer, memory, 0);
    if (auto failure = failure_of("vkBindBufferMemory", result)) return failure;
    if ((wanted & coherent) == 0) return std::nullopt;
    result = vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &storage.mapped);
    return failure_of("vkMapMemory", result);
}

Failure Channel::reserve(std::size_t floats)
{
    const VkDeviceSize bytes = std::max<std::size_t>(floats, 1) * sizeof(float);
    if (bytes <= bytes_) return std::nullopt;
    bytes_ = 0;
    if (auto failure = allocate(bytes, is_staged_ ? local : local | cached, shader_))
        return failure;
    if (is_staged_)
        if (auto failure = allocate(bytes, cached, staging_)) return failure;
    bytes_ = bytes;
    return std::nullopt;
}

void Channel::write(std::span<const float> numbers)
{
    if (!numbers.empty())
        std::memcpy(is_staged_ ? staging_.mapped : shader_.mapped, numbers.data(),
                    numbers.size_bytes());
}

void Channel::read(std::span<float> numbers) const
{
    if (!numbers.empty())
        std::memcpy(numbers.data(), is_staged_ ? staging_.mapped : shader_.mapped,
                    numbers.size_bytes());
}

void Channel::record_upload(VkCommandBuffer commands) const
{
    if (!is_staged_) return;
    const VkBufferCopy all{.srcOffset = 0, .dstOffset = 0, .size = bytes_};
    vkCmdCopyBuffer(commands, staging_.buffer.get(), shader_.buffer.get(), 1, &all);
}

void Channel::record_download(VkCommandBuffer commands) const
{
    if (!is_staged_) return;
    const VkBufferCopy all{.srcOffset = 0, .dstOffset = 0, .size = bytes_};
    vkCmdCopyBuffer(commands, shader_.buffer.get(), staging_.buffer.get(), 1, &all);
}

}  // namespace lobe::device
