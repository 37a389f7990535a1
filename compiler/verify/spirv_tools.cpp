// SPIRV-Tools as a judge: is this SPIR-V what Vulkan 1.1 allows, and what does `-O` make of it?
#include "verify/judge.h"

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

namespace lobe::verify {
namespace {

constexpr spv_target_env environment = SPV_ENV_VULKAN_1_1;

/// Keeps what is said as it is said. SPIR-V has words, not lines, so `line` stays 0.
spvtools::MessageConsumer keep_in(std::vector<Message>& messages)
{
    return [&messages](spv_message_level_t, const char*, const spv_position_t&, const char* text) {
        messages.push_back({0, text});
    };
}

}  // namespace

Verdict validate(std::span<const std::uint32_t> spirv)
{
    Verdict verdict;
    spvtools::SpirvTools tools{environment};
    tools.SetMessageConsumer(keep_in(verdict.messages));
    verdict.accepted = tools.Validate(spirv.data(), spirv.size());
    return verdict;
}

Verdict optimize(std::span<const std::uint32_t> spirv)
{
    Verdict verdict;
    spvtools::Optimizer optimizer{environment};
    optimizer.SetMessageConsumer(keep_in(verdict.messages));
    optimizer.RegisterPerformancePasses();
    verdict.accepted = optimizer.Run(spirv.data(), spirv.size(), &verdict.spirv);
    if (!verdict.accepted) verdict.spirv.clear();
    return verdict;
}

}  // namespace lobe::verify
