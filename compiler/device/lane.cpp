// Buffers, pipeline and command buffer of one lane.
#include "device/lane.h"

#include <array>
#include <chrono>
#include <limits>

namespace lobe::device {

std::shared_ptr<Lane> Lane::open(const PhysicalDevice& physical, bool always_stage,
                                 std::string& why)
{
    OwnedDevice device;
    if (auto failure = make_device(physical, false, device)) {
        why = std::move(*failure);
        return nullptr;
    }
    const VkDevice handle = device.handle;
    std::shared_ptr<Lane> lane{new Lane{physical, std::move(device)}};
    lane->input_ = Channel{handle, physical.memory, always_stage};
    lane->output_ = Channel{handle, physical.memory, always_stage};
    Failure failure = make_layouts(handle, lane->layouts_);
    if (!failure) failure = lane->prepare_descriptors();
    if (!failure) failure = lane->prepare_commands(physical.queue_family);
    if (!failure) failure = lane->prepare_clock(physical);
    if (!failure) return lane;
    why = std::move(*failure);
    return nullptr;
}

Lane::Lane(const PhysicalDevice& physical, OwnedDevice device) : device_{std::move(device)}
{
    vkGetDeviceQueue(device_.handle, physical.queue_family, 0, &queue_);
}

Failure Lane::prepare_descriptors()
{
    const VkDevice device = device_.handle;
    VkDescriptorPoolSize size{};
    size.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    size.descriptorCount = 2;
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    VkResult result = vkCreateDescriptorPool(device, &pool, nullptr, &descriptors);
    if (auto failure = failure_of("vkCreateDescriptorPool", result)) return failure;
    descriptors_ = {device, descriptors};

    const VkDescriptorSetLayout set_layout = layouts_.set.get();
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

Failure Lane::prepare_clock(const PhysicalDevice& physical)
{
    if (physical.facts.software || physical.limits.timestampComputeAndGraphics != VK_TRUE)
        return std::nullopt;
    VkQueryPoolCreateInfo times{};
    times.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    times.queryType = VK_QUERY_TYPE_TIMESTAMP;
    times.queryCount = 2;
    VkQueryPool pool = VK_NULL_HANDLE;
    const VkResult result = vkCreateQueryPool(device_.handle, &times, nullptr, &pool);
    if (auto failure = failure_of("vkCreateQueryPool", result)) return failure;
    clock_ = {device_.handle, pool};
    seconds_per_tick_ = static_cast<double>(physical.limits.timestampPeriod) * 1e-9;
    return std::nullopt;
}

Failure Lane::load(std::span<const std::uint32_t> spirv, std::string_view entry)
{
    return make_pipeline(device_.handle, layouts_, spirv, entry, 0, pipeline_);
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
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layouts_.pipeline.get(), 0,
                            1, &set_, 0, nullptr);
    vkCmdPushConstants(commands_, layouts_.pipeline.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof count, &count);
    const bool timed = clock_.get() != VK_NULL_HANDLE;
    if (timed) {
        vkCmdResetQueryPool(commands_, clock_.get(), 0, 2);
        vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, clock_.get(), 0);
    }
    vkCmdDispatch(commands_, groups, 1, 1);
    if (timed)
        vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, clock_.get(), 1);
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
    const auto start = std::chrono::steady_clock::now();
    VkResult result = vkQueueSubmit(queue_, 1, &submit, fence);
    if (auto failure = failure_of("vkQueueSubmit", result)) return failure;
    result = vkWaitForFences(device_.handle, 1, &fence, VK_TRUE,
                             std::numeric_limits<std::uint64_t>::max());
    if (auto failure = failure_of("vkWaitForFences", result)) return failure;
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (clock_.get() != VK_NULL_HANDLE) {
        std::array<std::uint64_t, 2> ticks{};
        result = vkGetQueryPoolResults(device_.handle, clock_.get(), 0, 2, sizeof ticks,
                                       ticks.data(), sizeof ticks[0],
                                       VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (auto failure = failure_of("vkGetQueryPoolResults", result)) return failure;
        seconds_ = static_cast<double>(ticks[1] - ticks[0]) * seconds_per_tick_;
    }
    return failure_of("vkResetFences", vkResetFences(device_.handle, 1, &fence));
}

}  // namespace lobe::device
