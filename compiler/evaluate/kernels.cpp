#include "evaluate/kernels.h"

#include <cassert>
#include <type_traits>

namespace lobe::evaluate {

bool available(InstructionSet set)
{
    switch (set) {
    case InstructionSet::baseline: return true;
#if defined(LOBE_X86_KERNELS)
    case InstructionSet::avx2: return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::avx512: return __builtin_cpu_supports("avx512f") != 0;
#else
    case InstructionSet::avx2:
    case InstructionSet::avx512: return false;
#endif
    }
    return false;
}

InstructionSet widest()
{
    for (const auto set : {InstructionSet::avx512, InstructionSet::avx2})
        if (available(set)) return set;
    return InstructionSet::baseline;
}

template <class Number>
const KernelTable<Number>& kernels(InstructionSet set)
{
    assert(available(set));
    constexpr bool is_float = std::is_same_v<Number, float>;
    const auto choose = [](const auto& floats, const auto& doubles) -> const KernelTable<Number>& {
        if constexpr (is_float)
            return floats;
        else
            return doubles;
    };
    switch (set) {
#if defined(LOBE_X86_KERNELS)
    case InstructionSet::avx2: return choose(avx2::float_kernels, avx2::double_kernels);
    case InstructionSet::avx512: return choose(avx512::float_kernels, avx512::double_kernels);
#else
    case InstructionSet::avx2:
    case InstructionSet::avx512:
#endif
    case InstructionSet::baseline: break;
    }
    return choose(baseline::float_kernels, baseline::double_kernels);
}

template const KernelTable<float>& kernels(InstructionSet);
template const KernelTable<double>& kernels(InstructionSet);

}  // namespace lobe::evaluate
