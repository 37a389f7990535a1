// Asks every physical device what it is and what it can do; picks one.
#include "device/physical.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lobe::device {
namespace {

std::vector<std::string> extensions_of(VkPhysicalDevice device)
{
    std::uint32_t size = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &size, nullptr);
    std::vector<VkExtensionProperties> properties(size);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &size, properties.data());
    std::vector<std::string> names;
    for (const VkExtensionProperties& each : properties) names.emplace_back(each.extensionName);
    return names;
}

std::optional<std::uint32_t> compute_family(VkPhysicalDevice device)
{
    std::uint32_t size = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &size, nullptr);
    std::vector<VkQueueFamilyProperties> families(size);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &size, families.data());
    for (std::uint32_t i = 0; i < size; ++i)
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) return i;
    return std::nullopt;
}

/// Puts `structure` at the head of the list that `head` starts.
template <typename Head, typename Structure>
void chain(Head& head, Structure& structure, VkStructureType type)
{
    structure.sType = type;
    structure.pNext = head.pNext;
    head.pNext = &structure;
}

std::optional<PhysicalDevice> describe(VkPhysicalDevice handle)
{
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(handle, &properties);
    const auto family = compute_family(handle);
    if (properties.apiVersion < VK_API_VERSION_1_1 || !family) return std::nullopt;

    const std::vector<std::string> extensions = extensions_of(handle);
    const auto has = [&](std::string_view extension, std::uint32_t core_since) {
        return properties.apiVersion >= core_since ||
               std::ranges::find(extensions, extension) != extensions.end();
    };

    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    VkPhysicalDeviceDriverProperties driver{};
    if (has(VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME, VK_API_VERSION_1_2))
        chain(all, driver, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    VkPhysicalDeviceFloatControlsProperties controls{};
    if (has(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME, VK_API_VERSION_1_2))
        chain(all, controls, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES);
    vkGetPhysicalDeviceProperties2(handle, &all);

    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    VkPhysicalDevice16BitStorageFeatures storage{};
    chain(features, storage, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES);
    VkPhysicalDeviceShaderFloat16Int8Features arithmetic{};
    if (has(VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME, VK_API_VERSION_1_2))
        chain(features, arithmetic, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES);
    vkGetPhysicalDeviceFeatures2(handle, &features);

    PhysicalDevice device;
    device.handle = handle;
    device.queue_family = *family;
    device.limits = properties.limits;
    vkGetPhysicalDeviceMemoryProperties(handle, &device.memory);
    device.float16_by_extension = properties.apiVersion < VK_API_VERSION_1_2;

    const std::uint32_t version = properties.apiVersion;
    device.facts.name = properties.deviceName;
    device.facts.driver = driver.driverInfo[0] != '\0'
                              ? fmt::format("{}, {}", driver.driverName, driver.driverInfo)
                              : std::string{driver.driverName};
    device.facts.api = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version),
                                   VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
    device.facts.software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    device.facts.float16 =
        arithmetic.shaderFloat16 == VK_TRUE && storage.storageBuffer16BitAccess == VK_TRUE;
    device.facts.controls16 = {
        .can_preserve_denormals = controls.shaderDenormPreserveFloat16 == VK_TRUE,
        .can_flush_denormals = controls.shaderDenormFlushToZeroFloat16 == VK_TRUE,
        .can_round_to_nearest = controls.shaderRoundingModeRTEFloat16 == VK_TRUE,
        .can_preserve_nan = controls.shaderSignedZeroInfNanPreserveFloat16 == VK_TRUE};
    device.facts.controls32 = {
        .can_preserve_denormals = controls.shaderDenormPreserveFloat32 == VK_TRUE,
        .can_flush_denormals = controls.shaderDenormFlushToZeroFloat32 == VK_TRUE,
        .can_round_to_nearest = controls.shaderRoundingModeRTEFloat32 == VK_TRUE,
        .can_preserve_nan = controls.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE};
    return device;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool contains_without_case(std::string_view text, std::string_view part)
{
    return std::search(text.begin(), text.end(), part.begin(), part.end(),
                       [](char a, char b) { return lower(a) == lower(b); }) != text.end();
}

/// `0 llvmpipe (LLVM 15.0.6, 256 bits); 1 NVIDIA H100`
std::string names_of(const std::vector<PhysicalDevice>& devices)
{
    std::string names;
    for (std::size_t i = 0; i < devices.size(); ++i)
        names += fmt::format("{}{} {}", i == 0 ? "" : "; ", i, devices[i].facts.name);
    return names;
}

}  // namespace

std::vector<PhysicalDevice> physical_devices(std::string& why)
{
    const VkInstance vulkan = instance(why);
    if (vulkan == VK_NULL_HANDLE) return {};
    std::uint32_t size = 0;
    std::vector<VkPhysicalDevice> handles;
    VkResult result = vkEnumeratePhysicalDevices(vulkan, &size, nullptr);
    if (result == VK_SUCCESS) {
        handles.resize(size);
        result = vkEnumeratePhysicalDevices(vulkan, &size, handles.data());
        handles.resize(size);
    }
    std::vector<PhysicalDevice> devices;
    for (const VkPhysicalDevice handle : handles)
        if (auto device = describe(handle)) devices.push_back(std::move(*device));
    if (!devices.empty()) return devices;
    if (auto failure = failure_of("vkEnumeratePhysicalDevices", result))
        why = std::move(*failure);
    else
        why = fmt::format("of {} Vulkan devices none has Vulkan 1.1 and a compute queue; the "
                          "package `mesa-vulkan-drivers` has one that needs no graphics card",
                          handles.size());
    return devices;
}

std::optional<std::size_t> select_device(const std::vector<PhysicalDevice>& devices,
                                         std::string_view selector, std::string& why)
{
    if (selector.empty()) {
        const auto software = std::ranges::find_if(
            devices, [](const PhysicalDevice& device) { return device.facts.software; });
        return software == devices.end()
                   ? 0
                   : static_cast<std::size_t>(std::distance(devices.begin(), software));
    }
    std::size_t number = 0;
    const auto [end, error] =
        std::from_chars(selector.data(), selector.data() + selector.size(), number);
    const bool is_number = error == std::errc{} && end == selector.data() + selector.size();
    if (is_number && number < devices.size()) return number;
    // `4090` is no position but part of a name.
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (contains_without_case(devices[i].facts.name, selector)) return i;
    why = fmt::format("no Vulkan device is number or is named `{}`; there are: {}", selector,
                      names_of(devices));
    return std::nullopt;
}

}  // namespace lobe::device
