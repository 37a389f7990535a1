// NoContraction on all floating-point arithmetic of a SPIR-V module.
//
// What `precise` on every variable would do, and to dot products too, which `precise` leaves out:
// neither spirv-opt nor the driver may re-associate, fuse or cancel what carries the decoration,
// so a device computes the operations that the text wrote, in that order. The decorations go to
// the end of the annotations; everything else stays as it is, ids included.
#include "verify/judge.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>

namespace lobe::verify {
namespace {

constexpr std::size_t header_words = 5;

struct Instruction {
    spv::Op op{};
    std::span<const std::uint32_t> words;  ///< with the first, which holds the opcode
};

/// The instructions in order, or none at all if the words are no SPIR-V.
std::vector<Instruction> instructions_of(std::span<const std::uint32_t> spirv)
{
    if (spirv.size() < header_words || spirv.front() != spv::MagicNumber) return {};
    std::vector<Instruction> result;
    std::span<const std::uint32_t> rest = spirv.subspan(header_words);
    while (!rest.empty()) {
        const std::size_t length = rest.front() >> spv::WordCountShift;
        if (length == 0 || length > rest.size()) return {};
        result.push_back(
            {static_cast<spv::Op>(rest.front() & spv::OpCodeMask), rest.first(length)});
        rest = rest.subspan(length);
    }
    return result;
}

/// The floating-point arithmetic instructions of the specification's section of that name: what
/// NoContraction may be put on. Their result is always the second word.
bool is_float_arithmetic(spv::Op op)
{
    switch (op) {
    case spv::OpFNegate:
    case spv::OpFAdd:
    case spv::OpFSub:
    case spv::OpFMul:
    case spv::OpFDiv:
    case spv::OpFRem:
    case spv::OpFMod:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
    case spv::OpVectorTimesMatrix:
    case spv::OpMatrixTimesVector:
    case spv::OpMatrixTimesMatrix:
    case spv::OpOuterProduct:
    case spv::OpDot: return true;
    default: return false;
    }
}

/// Everything that the logical layout of a module puts before types, constants and code.
bool is_before_types(spv::Op op)
{
    switch (op) {
    case spv::OpNop:
    case spv::OpCapability:
    case spv::OpExtension:
    case spv::OpExtInstImport:
    case spv::OpMemoryModel:
    case spv::OpEntryPoint:
    case spv::OpExecutionMode:
    case spv::OpExecutionModeId:
    case spv::OpString:
    case spv::OpSource:
    case spv::OpSourceContinued:
    case spv::OpSourceExtension:
    case spv::OpName:
    case spv::OpMemberName:
    case spv::OpModuleProcessed:
    case spv::OpDecorate:
    case spv::OpDecorateId:
    case spv::OpDecorateString:
    case spv::OpMemberDecorate:
    case spv::OpMemberDecorateString:
    case spv::OpDecorationGroup:
    case spv::OpGroupDecorate:
    case spv::OpGroupMemberDecorate: return true;
    default: return false;
    }
}

/// Ids that have the decoration, by themselves or through a decoration group.
std::vector<std::uint32_t> decorated_ids(const std::vector<Instruction>& instructions)
{
    std::vector<std::uint32_t> ids;
    for (const Instruction& each : instructions)
        if (each.op == spv::OpDecorate && each.words[2] == spv::DecorationNoContraction)
            ids.push_back(each.words[1]);
    const std::vector<std::uint32_t> direct = ids;
    for (const Instruction& each : instructions)
        if (each.op == spv::OpGroupDecorate && std::ranges::count(direct, each.words[1]) != 0)
            ids.insert(ids.end(), each.words.begin() + 2, each.words.end());
    std::ranges::sort(ids);
    return ids;
}

}  // namespace

std::vector<std::uint32_t> forbid_contraction(std::span<const std::uint32_t> spirv)
{
    const std::vector<Instruction> instructions = instructions_of(spirv);
    const std::vector<std::uint32_t> decorated = decorated_ids(instructions);
    std::vector<std::uint32_t> added;
    std::size_t end_of_annotations = header_words;
    bool in_annotations = true;
    for (const Instruction& each : instructions) {
        in_annotations = in_annotations && is_before_types(each.op);
        if (in_annotations) end_of_annotations += each.words.size();
        if (!is_float_arithmetic(each.op)) continue;
        const std::uint32_t result = each.words[2];
        if (std::ranges::binary_search(decorated, result)) continue;
        constexpr std::uint32_t length = 3;
        added.insert(added.end(), {(length << spv::WordCountShift) | spv::OpDecorate, result,
                                   spv::DecorationNoContraction});
    }
    std::vector<std::uint32_t> words{spirv.begin(), spirv.end()};
    if (!added.empty())
        words.insert(words.begin() + static_cast<std::ptrdiff_t>(end_of_annotations), added.begin(),
                     added.end());
    return words;
}

}  // namespace lobe::verify
