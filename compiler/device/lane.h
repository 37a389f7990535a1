// One logical device with one queue: what a thread needs to itself while it runs a shader.
//
// A lane keeps its buffers, which only grow, so that a run costs a pipeline and a dispatch. Used
// by one thread at a time, it needs no lock.
#pragma once

#include "device/channel.h"
#include "device/shader.h"

#include <memory>
#include <span>

namespace lobe::device {

class Lane {
public:
    /// Null, with `why`, on failure.
    static std::shared_ptr<Lane> open(const PhysicalDevice& physical, bool always_stage,
                                      std::string& why);
    Lane(const Lane&) = delete;
    Lane& operator=(const Lane&) = delete;

    /// Makes the pipeline of the dispatches that follow.
    Failure load(std::span<const std::uint32_t> spirv, std::string_view entry);

    /// Copies what a dispatch reads, and what it may leave as it is, into the buffers.
    Failure upload(std::span<const float> input, std::span<const float> output);

    /// Runs the pipeline and waits for its end, however long that takes. Touches nothing but this.
    Failure dispatch(std::uint32_t groups, std::uint32_t count);

    /// How long the last dispatch took: by the device's own clock, or, on a software device, from
    /// its submission to its end.
    double seconds() const { return seconds_; }

    void download(std::span<float> output) const;

private:
    Lane(const PhysicalDevice& physical, OwnedDevice device);
    Failure prepare_descriptors();
    Failure prepare_commands(std::uint32_t queue_family);
    Failure prepare_clock(const PhysicalDevice& physical);
    void point_descriptors_at_buffers();
    Failure record(std::uint32_t groups, std::uint32_t count);

    // In order of creation: the members that come after the device's handle are destroyed first.
    OwnedDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    Layouts layouts_;
    OwnedDescriptorPool descriptors_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    OwnedCommandPool command_pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    OwnedFence fence_;
    OwnedQueryPool clock_;  ///< two times, where the device has a clock of its own
    double seconds_per_tick_ = 0;
    double seconds_ = 0;
    Channel input_;
    Channel output_;
    OwnedPipeline pipeline_;
};

}  // namespace lobe::device
