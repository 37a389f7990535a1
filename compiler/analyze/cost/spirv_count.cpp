#include "analyze/cost/spirv_count.h"

#include <map>

namespace lobe::analyze {
namespace {

// Numbers of the SPIR-V specification, section 3.42, and of GLSL.std.450.
constexpr std::uint32_t op_ext_inst = 12;
constexpr std::uint32_t op_type_bool = 20;
constexpr std::uint32_t op_type_float = 22;
constexpr std::uint32_t op_type_vector = 23;
constexpr std::uint32_t op_dot = 148;
constexpr std::uint32_t ext_length = 66;
constexpr std::uint32_t ext_normalize = 69;
constexpr std::size_t header_words = 5;

/// Operations whose result has one operation per component: of floats and of conditions.
bool is_arithmetic(std::uint32_t op)
{
    switch (op) {
    case 127:  // OpFNegate
    case 129:  // OpFAdd
    case 131:  // OpFSub
    case 133:  // OpFMul
    case 136:  // OpFDiv
    case 140:  // OpFRem
    case 141:  // OpFMod
    case 142:  // OpVectorTimesScalar
    case 164:  // OpLogicalEqual
    case 165:  // OpLogicalNotEqual
    case 166:  // OpLogicalOr
    case 167:  // OpLogicalAnd
    case 168:  // OpLogicalNot
    case 169:  // OpSelect
        return true;
    default: return op >= 180 && op <= 191;  // OpFOrdEqual .. OpFUnordGreaterThanEqual
    }
}

}  // namespace

int count_arithmetic(std::span<const std::uint32_t> spirv)
{
    struct Type {
        bool counts = false;  ///< floats and conditions; not integers
        int components = 1;
    };
    std::map<std::uint32_t, Type> types;
    std::map<std::uint32_t, std::uint32_t> type_of;
    int count = 0;
    for (std::size_t at = header_words; at < spirv.size();) {
        const std::uint32_t op = spirv[at] & 0xffff;
        const std::size_t size = spirv[at] >> 16;
        if (size == 0 || at + size > spirv.size()) break;
        const auto words = spirv.subspan(at, size);
        at += size;
        if (op == op_type_bool || op == op_type_float) {
            types[words[1]] = {true, 1};
        } else if (op == op_type_vector) {
            types[words[1]] = {types[words[2]].counts, static_cast<int>(words[3])};
        } else if (size >= 3) {
            const auto type = types.find(words[1]);
            if (type == types.end() || !type->second.counts) continue;
            type_of[words[2]] = words[1];
            const int components = type->second.components;
            const auto operand = [&](std::size_t index) {
                return index < size ? types[type_of[words[index]]].components : 1;
            };
            if (op == op_dot)
                count += 2 * operand(3) - 1;
            else if (op == op_ext_inst && size > 4 && words[4] == ext_length)
                count += 2 * operand(5);  // a dot product and a root
            else if (op == op_ext_inst && size > 4 && words[4] == ext_normalize)
                count += 3 * components;  // a dot product, a root, a multiplication each
            else if (op == op_ext_inst || is_arithmetic(op))
                count += components;
        }
    }
    return count;
}

}  // namespace lobe::analyze
