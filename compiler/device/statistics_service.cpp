// The child: a device for one chip, and one pipeline after the other.
#include "device/statistics_service.h"

#include "device/declared.h"
#include "device/instructions.h"
#include "device/shader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace lobe::device {
namespace {

/// A parent that has nothing to ask for a while is no reason to give up.
constexpr std::chrono::milliseconds forever = std::chrono::hours{24};

constexpr VkPipelineCreateFlags explain =
    VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
    VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;

template <class T>
T load_function(VkDevice device, const char* name)
{
    return reinterpret_cast<T>(vkGetDeviceProcAddr(device, name));
}

class Explainer {
public:
    Failure open()
    {
        std::string why;
        const auto devices = physical_devices(why);
        const auto found = std::ranges::find_if(devices, [](const PhysicalDevice& device) {
            return device.facts.driver.starts_with("radv");
        });
        if (found == devices.end())
            return why.empty() ? "no Vulkan driver here compiles for AMD; the package "
                                 "`mesa-vulkan-drivers` has one that needs no graphics card"
                               : why;
        facts_ = found->facts;
        if (auto failure = make_device(*found, true, device_)) return failure;
        if (auto failure = make_layouts(device_.handle, layouts_)) return failure;
        statistics_ = load_function<PFN_vkGetPipelineExecutableStatisticsKHR>(
            device_.handle, "vkGetPipelineExecutableStatisticsKHR");
        texts_ = load_function<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
            device_.handle, "vkGetPipelineExecutableInternalRepresentationsKHR");
        if (statistics_ == nullptr || texts_ == nullptr)
            return fmt::format("`{}` does not tell what it makes of a shader", facts_.driver);
        return std::nullopt;
    }

    const DeviceFacts& facts() const { return facts_; }

    Failure explain_shader(std::span<const std::uint32_t> spirv, ShaderStatistics& out) const
    {
        const auto declared = declared_by(spirv, "main");
        if (!declared || !declared->has_entry) return "the shader has no compute entry `main`";
        OwnedPipeline pipeline;
        if (auto failure =
                make_pipeline(device_.handle, layouts_, spirv, "main", explain, pipeline))
            return failure;
        if (auto failure = read_statistics(pipeline.get(), out)) return failure;
        return count_instructions(pipeline.get(), out);
    }

private:
    static VkPipelineExecutableInfoKHR first_executable(VkPipeline pipeline)
    {
        VkPipelineExecutableInfoKHR info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
        info.pipeline = pipeline;
        return info;
    }

    Failure read_statistics(VkPipeline pipeline, ShaderStatistics& out) const
    {
        const VkPipelineExecutableInfoKHR info = first_executable(pipeline);
        std::uint32_t size = 0;
        statistics_(device_.handle, &info, &size, nullptr);
        VkPipelineExecutableStatisticKHR empty{};
        empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
        std::vector<VkPipelineExecutableStatisticKHR> all(size, empty);
        const VkResult result = statistics_(device_.handle, &info, &size, all.data());
        if (auto failure = failure_of("vkGetPipelineExecutableStatisticsKHR", result))
            return failure;
        const struct {
            const char* name;
            int& value;
        } wanted[] = {{"Instructions", out.instructions},
                      {"Latency", out.latency},
                      {"Inverse Throughput", out.inverse_throughput},
                      {"VGPRs", out.vgprs},
                      {"Subgroups per SIMD", out.waves},
                      {"Spilled VGPRs", out.spilled},
                      {"Code size", out.code_bytes}};
        for (const auto& [name, value] : wanted) {
            const auto found = std::ranges::find_if(
                all, [name = name](const auto& each) { return std::strcmp(each.name, name) == 0; });
            if (found == all.end())
                return fmt::format("`{}` does not tell `{}`", facts_.driver, name);
            value = static_cast<int>(found->value.u64);
        }
        return std::nullopt;
    }

    Failure count_instructions(VkPipeline pipeline, ShaderStatistics& out) const
    {
        const VkPipelineExecutableInfoKHR info = first_executable(pipeline);
        std::uint32_t size = 0;
        texts_(device_.handle, &info, &size, nullptr);
        VkPipelineExecutableInternalRepresentationKHR empty{};
        empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
        std::vector<VkPipelineExecutableInternalRepresentationKHR> all(size, empty);
        VkResult result = texts_(device_.handle, &info, &size, all.data());
        if (auto failure = failure_of("vkGetPipelineExecutableInternalRepresentationsKHR", result))
            return failure;
        // Only what is asked for is copied: the representations before the last are long.
        std::string assembly;
        for (auto& each : all)
            if (std::strcmp(each.name, "Assembly") == 0) {
                assembly.resize(each.dataSize);
                each.pData = assembly.data();
            } else {
                each.pData = nullptr;
            }
        if (assembly.empty()) return fmt::format("`{}` has no disassembler", facts_.driver);
        result = texts_(device_.handle, &info, &size, all.data());
        if (auto failure = failure_of("vkGetPipelineExecutableInternalRepresentationsKHR", result))
            return failure;
        const VectorInstructions count = count_vector_instructions(assembly);
        out.vector = count.plain;
        out.transcendental = count.transcendental;
        return std::nullopt;
    }

    DeviceFacts facts_;
    OwnedDevice device_;
    Layouts layouts_;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics_ = nullptr;
    PFN_vkGetPipelineExecutableInternalRepresentationsKHR texts_ = nullptr;
};

Message answer(Word word, std::string bytes)
{
    return {static_cast<std::uint32_t>(word), std::move(bytes)};
}

}  // namespace

int serve(int socket)
{
    // A driver's remarks go nowhere, and what it reads is nothing.
    const int conversation = ::fcntl(socket, F_DUPFD_CLOEXEC, 3);
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (conversation < 0 || nowhere < 0) return 2;
    for (int standard = 0; standard <= 2; ++standard) ::dup2(nowhere, standard);

    Explainer explainer;
    if (auto failure = explainer.open()) {
        send(conversation, answer(Word::failed, *failure));
        return 1;
    }
    const DeviceFacts& facts = explainer.facts();
    if (!send(conversation, answer(Word::ready, facts.driver + "\n" + facts.name))) return 1;
    while (const auto request = receive(conversation, forever)) {
        std::vector<std::uint32_t> spirv(request->bytes.size() / sizeof(std::uint32_t));
        std::memcpy(spirv.data(), request->bytes.data(), spirv.size() * sizeof(std::uint32_t));
        ShaderStatistics statistics;
        const auto failure = explainer.explain_shader(spirv, statistics);
        if (!send(conversation, failure ? answer(Word::failed, *failure)
                                        : answer(Word::done, bytes_of(statistics))))
            break;
    }
    return 0;
}

}  // namespace lobe::device
