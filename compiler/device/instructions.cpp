#include "device/instructions.h"

#include <algorithm>
#include <array>

namespace lobe::device {
namespace {

/// What a quarter of the lanes compute per cycle.
constexpr std::array<std::string_view, 7> transcendentals{"v_exp_",  "v_log_", "v_rcp_", "v_rsq_",
                                                          "v_sqrt_", "v_sin_", "v_cos_"};

std::string_view mnemonic(std::string_view line)
{
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos) return {};
    line.remove_prefix(start);
    return line.substr(0, line.find_first_of(" \t\r"));
}

}  // namespace

VectorInstructions count_vector_instructions(std::string_view assembly)
{
    VectorInstructions count;
    while (!assembly.empty()) {
        const std::size_t end = assembly.find('\n');
        const std::string_view word = mnemonic(assembly.substr(0, end));
        assembly.remove_prefix(end == std::string_view::npos ? assembly.size() : end + 1);
        if (!word.starts_with("v_") || word == "v_nop") continue;
        if (std::ranges::any_of(transcendentals,
                                [&](std::string_view start) { return word.starts_with(start); }))
            ++count.transcendental;
        else
            ++count.plain;
    }
    return count;
}

}  // namespace lobe::device
