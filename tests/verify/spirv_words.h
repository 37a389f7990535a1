// The instructions of a SPIR-V module, for tests to count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lobe::verify {

// Opcodes and operands of the SPIR-V specification that tests ask for.
inline constexpr std::uint32_t op_decorate = 71;
inline constexpr std::uint32_t op_f_add = 129;
inline constexpr std::uint32_t op_f_mul = 133;
inline constexpr std::uint32_t op_f_div = 136;
inline constexpr std::uint32_t op_dot = 148;
inline constexpr std::uint32_t op_ext_inst = 12;
inline constexpr std::uint32_t decoration_no_contraction = 42;

/// The words of every instruction with this opcode.
inline std::vector<std::vector<std::uint32_t>> instructions(std::span<const std::uint32_t> spirv,
                                                            std::uint32_t opcode)
{
    constexpr std::size_t header_words = 5;
    std::vector<std::vector<std::uint32_t>> found;
    for (std::size_t i = header_words; i < spirv.size(); i += spirv[i] >> 16U) {
        const auto words = spirv.subspan(i, spirv[i] >> 16U);
        if ((spirv[i] & 0xFFFFU) == opcode) found.emplace_back(words.begin(), words.end());
    }
    return found;
}

inline std::vector<std::uint32_t> ids_without_contraction(std::span<const std::uint32_t> spirv)
{
    std::vector<std::uint32_t> ids;
    for (const auto& decoration : instructions(spirv, op_decorate))
        if (decoration[2] == decoration_no_contraction) ids.push_back(decoration[1]);
    return ids;
}

}  // namespace lobe::verify
