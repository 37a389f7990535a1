// Connects to the Vulkan loader and spells out its results.
#include "device/vulkan.h"

#include <fmt/format.h>

#include <mutex>

namespace lobe::device {

std::string_view name_of(VkResult result)
{
    switch (result) {
    case VK_SUCCESS: return "VK_SUCCESS";
    case VK_NOT_READY: return "VK_NOT_READY";
    case VK_TIMEOUT: return "VK_TIMEOUT";
    case VK_INCOMPLETE: return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED: return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS: return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FRAGMENTED_POOL: return "VK_ERROR_FRAGMENTED_POOL";
    case VK_ERROR_OUT_OF_POOL_MEMORY: return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_INVALID_SHADER_NV: return "VK_ERROR_INVALID_SHADER_NV";
    case VK_ERROR_UNKNOWN: return "VK_ERROR_UNKNOWN";
    default: return {};  // of windows, videos and extensions that are not used here
    }
}

Failure failure_of(std::string_view call, VkResult result)
{
    if (result == VK_SUCCESS) return std::nullopt;
    if (const std::string_view name = name_of(result); !name.empty())
        return fmt::format("{}: {}", call, name);
    return fmt::format("{}: VkResult {}", call, static_cast<int>(result));
}

VkInstance instance(std::string& why)
{
    static std::mutex mutex;
    static VkInstance kept = VK_NULL_HANDLE;
    const std::lock_guard lock{mutex};
    if (kept != VK_NULL_HANDLE) return kept;

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "lobe";
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    const VkResult result = vkCreateInstance(&create, nullptr, &kept);
    // The loader's way to say that it found no driver that it could load.
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        why = "no Vulkan driver is installed; the package `mesa-vulkan-drivers` has one that "
              "needs no graphics card";
    else if (auto failure = failure_of("vkCreateInstance", result))
        why = std::move(*failure);
    return result == VK_SUCCESS ? kept : VK_NULL_HANDLE;
}

}  // namespace lobe::device
