// Device, layouts and pipeline of a compute shader.
#include "device/shader.h"

#include <array>
#include <vector>

namespace lobe::device {

Failure make_device(const PhysicalDevice& physical, bool explains, OwnedDevice& device)
{
    constexpr float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = physical.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    std::vector<const char*> extensions;

    VkPhysicalDevice16BitStorageFeatures storage{};
    storage.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES;
    storage.storageBuffer16BitAccess = VK_TRUE;
    VkPhysicalDeviceShaderFloat16Int8Features arithmetic{};
    arithmetic.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES;
    arithmetic.pNext = &storage;
    arithmetic.shaderFloat16 = VK_TRUE;
    if (physical.facts.float16) {
        create.pNext = &arithmetic;
        if (physical.float16_by_extension)
            extensions.push_back(VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME);
    }
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables{};
    executables.sType =
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    executables.pipelineExecutableInfo = VK_TRUE;
    if (explains) {
        executables.pNext = const_cast<void*>(create.pNext);
        create.pNext = &executables;
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    }
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    VkDevice handle = VK_NULL_HANDLE;
    const VkResult result = vkCreateDevice(physical.handle, &create, nullptr, &handle);
    if (auto failure = failure_of("vkCreateDevice", result)) return failure;
    device = OwnedDevice{handle};
    return std::nullopt;
}

Failure make_layouts(VkDevice device, Layouts& layouts)
{
    std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    VkDescriptorSetLayoutCreateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = bindings.size();
    set.pBindings = bindings.data();
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkResult result = vkCreateDescriptorSetLayout(device, &set, nullptr, &set_layout);
    if (auto failure = failure_of("vkCreateDescriptorSetLayout", result)) return failure;
    layouts.set = {device, set_layout};

    VkPushConstantRange push{};
    push.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    push.size = sizeof(std::uint32_t);
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    VkPipelineLayout pipeline_layout = VK_NULL_HANDLE;
    result = vkCreatePipelineLayout(device, &layout, nullptr, &pipeline_layout);
    if (auto failure = failure_of("vkCreatePipelineLayout", result)) return failure;
    layouts.pipeline = {device, pipeline_layout};
    return std::nullopt;
}

Failure make_pipeline(VkDevice device, const Layouts& layouts, std::span<const std::uint32_t> spirv,
                      std::string_view entry, VkPipelineCreateFlags flags, OwnedPipeline& pipeline)
{
    VkShaderModuleCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    create.codeSize = spirv.size_bytes();
    create.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult result = vkCreateShaderModule(device, &create, nullptr, &module);
    if (auto failure = failure_of("vkCreateShaderModule", result)) return failure;
    const OwnedShader shader{device, module};

    const std::string entry_name{entry};
    VkComputePipelineCreateInfo compute{};
    compute.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    compute.flags = flags;
    compute.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    compute.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    compute.stage.module = module;
    compute.stage.pName = entry_name.c_str();
    compute.layout = layouts.pipeline.get();
    VkPipeline handle = VK_NULL_HANDLE;
    result = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &compute, nullptr, &handle);
    if (auto failure = failure_of("vkCreateComputePipelines", result)) return failure;
    pipeline = {device, handle};
    return std::nullopt;
}

}  // namespace lobe::device
