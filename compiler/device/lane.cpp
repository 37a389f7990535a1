// Buffers, pipeline and command buffer of one lane.
#include "device/lane.h"

#include <array>
#include <limits>

namespace lobe::device {
std::shared_ptr<Lane> Lane::open(const PhysicalDevice& physical, bool always_stage,
                                 std::string& why)
{
    constexpr float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = physical.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkPhysicalDevice16BitStorageFeatures storage{};
    storage.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES;
    storage.storageBuffer16BitAccess = VK_TRUE;
    VkPhysicalDeviceShaderFloat16Int8Features arithmetic{};
    arithmetic.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES;
    arithmetic.pNext = &storage;
    arithmetic.shaderFloat16 = VK_TRUE;
    const char* const extension = VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME;

    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    if (physical.facts.float16) {
        create.pNext = &arithmetic;
        create.enabledExtensionCount = physical.float16_by_extension ? 1 : 0;
        create.ppEnabledExtensionNames = &extension;
    }
    VkDevice device = VK_NULL_HANDLE;
    const VkResult result = vkCreateDevice(physical.handle, &create, nullptr, &device);
    if (auto failure = failure_of("vkCreateDevice", result)) {
        why = std::move(*failure);
        return nullptr;
    }
    std::shared_ptr<Lane> lane{new Lane{physical, device}};
    lane->input_ = Channel{device, physical.memory, always_stage};
    lane->output_ = Channel{device, physical.memory, always_stage};
    Failure failure = lane->prepare_descriptors();
    if (!failure) failure = lane->prepare_commands(physical.queue_family);
    if (!failure) return lane;
    why = std::move(*failure);
    return nullptr;
}

Lane::Lane(const PhysicalDevice& physical, VkDevice device) : device_{device}
{
    vkGetDeviceQueue(device, physical.queue_family, 0, &queue_);
}

Failure Lane::prepare_descriptors()
{
    const VkDevice device = device_.handle;
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
    set_layout_ = {device, set_layout};

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
    pipeline_layout_ = {device, pipeline_layout};

    VkDescriptorPoolSize size{};
    size.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    size.descriptorCount = bindings.size();
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    result = vkCreateDescriptorPool(device, &pool, nullptr, &descriptors);
    if (auto failure = failure_of("vkCreateDescriptorPool", result)) return failure;
    descriptors_ = {device, descriptors};

    VkDescriptorSetAllocateInfo sets{};
    sets.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    sets.descriptorPool = descriptors;
    sets.descriptorSetCount = 1;
    sets.pSetLayouts = &set_layout;
    result = vkAllocateDescriptorSets(device, &sets, &set_);
    return failure_of("vkAllocateDescriptorSets", result);
}

Failure Lane::prepare_commands(std::uint32_t queue_family)
{
    const VkDevice device = device_.handle;
    VkCommandPoolCreateInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    commands.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    commands.queueFamilyIndex = queue_family;
    VkCommandPool command_pool = VK_NULL_HANDLE;
    VkResult result = vkCreateCommandPool(device, &commands, nullptr, &command_pool);
    if (auto failure = failure_of("vkCreateCommandPool", result)) return failure;
    command_pool_ = {device, command_pool};

    VkCommandBufferAllocateInfo buffers{};
    buffers.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffers.commandPool = command_pool;
    buffers.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffers.commandBufferCount = 1;
    result = vkAllocateCommandBuffers(device, &buffers, &commands_);
    if (auto failure = failure_of("vkAllocateCommandBuffers", result)) return failure;

    VkFenceCreateInfo fences{};
    fences.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    result = vkCreateFence(device, &fences, nullptr, &fence);
    if (auto failure = failure_of("vkCreateFence", result)) return failure;
    fence_ = {device, fence};
    return std::nullopt;
}

Failure Lane::load(std::span<const std::uint32_t> spirv, std::string_view entry)
{
    const VkDevice device = device_.handle;
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
    compute.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    compute.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    compute.stage.module = module;
    compute.stage.pName = entry_name.c_str();
    compute.layout = pipeline_layout_.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    result = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &compute, nullptr, &pipeline);
    if (auto failure = failure_of("vkCreateComputePipelines", result)) return failure;
    pipeline_ = {device, pipeline};
    return std::nullopt;
}

Failure Lane::upload(std::span<const float> input, std::span<const float> output)
{
    if (auto failure = input_.reserve(input.size())) return failure;
    if (auto failure = output_.reserve(output.size())) return failure;
    input_.write(input);
    output_.write(output);
    point_descriptors_at_buffers();
    return std::nullopt;
}

void Lane::download(std::span<float> output) const { output_.read(output); }

void Lane::point_descriptors_at_buffers()
{
    const std::array<VkDescriptorBufferInfo, 2> buffers{
        VkDescriptorBufferInfo{input_.buffer(), 0, VK_WHOLE_SIZE},
        VkDescriptorBufferInfo{output_.buffer(), 0, VK_WHOLE_SIZE}};
    std::array<VkWriteDescriptorSet, 2> writes{};
    for (std::uint32_t i = 0; i < writes.size(); ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = set_;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        writes[i].pBufferInfo = &buffers[i];
    }
    vkUpdateDescriptorSets(device_.handle, writes.size(), writes.data(), 0, nullptr);
}

Failure Lane::record(std::uint32_t groups, std::uint32_t count)
{
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkResult result = vkBeginCommandBuffer(commands_, &begin);
    if (auto failure = failure_of("vkBeginCommandBuffer", result)) return failure;

    const auto wait = [this](VkPipelineStageFlags before, VkAccessFlags written,
                             VkPipelineStageFlags after, VkAccessFlags read) {
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = written;
        barrier.dstAccessMask = read;
        vkCmdPipelineBarrier(commands_, before, after, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    };
    constexpr VkPipelineStageFlags copy = VK_PIPELINE_STAGE_TRANSFER_BIT;
    constexpr VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    constexpr VkPipelineStageFlags host = VK_PIPELINE_STAGE_HOST_BIT;
    constexpr VkAccessFlags shader_access = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;

    input_.record_upload(commands_);
    output_.record_upload(commands_);
    wait(copy, VK_ACCESS_TRANSFER_WRITE_BIT, compute, shader_access);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_layout_.get(), 0, 1,
                            &set_, 0, nullptr);
    vkCmdPushConstants(commands_, pipeline_layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof count, &count);
    vkCmdDispatch(commands_, groups, 1, 1);
    wait(compute, VK_ACCESS_SHADER_WRITE_BIT, copy | host,
         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_HOST_READ_BIT);
    output_.record_download(commands_);
    wait(copy, VK_ACCESS_TRANSFER_WRITE_BIT, host, VK_ACCESS_HOST_READ_BIT);
    return failure_of("vkEndCommandBuffer", vkEndCommandBuffer(commands_));
}

Failure Lane::dispatch(std::uint32_t groups, std::uint32_t count)
{
    if (auto failure = record(groups, count)) return failure;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    const VkFence fence = fence_.get();
    VkResult result = vkQueueSubmit(queue_, 1, &submit, fence);
    if (auto failure = failure_of("vkQueueSubmit", result)) return failure;
    result = vkWaitForFences(device_.handle, 1, &fence, VK_TRUE,
                             std::numeric_limits<std::uint64_t>::max());
    if (auto failure = failure_of("vkWaitForFences", result)) return failure;
    return failure_of("vkResetFences", vkResetFences(device_.handle, 1, &fence));
}

}  // namespace lobe::device
