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
    case InstructionSet::avx512:
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0;
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

namespace {

/// One of the three of a kind, by instruction set.
template <class Table>
const Table& choose(InstructionSet set, const Table& narrow, [[maybe_unused]] const Table* wide,
                    [[maybe_unused]] const Table* widest_of_all)
{
    assert(available(set));
    switch (set) {
    case InstructionSet::baseline: break;
    case InstructionSet::avx2: return *wide;
    case InstructionSet::avx512: return *widest_of_all;
    }
    return narrow;
}

#if defined(LOBE_X86_KERNELS)
#define LOBE_TABLES(name) baseline::name, &avx2::name, &avx512::name
#else
#define LOBE_TABLES(name) baseline::name, nullptr, nullptr
#endif

}  // namespace

template <class Number>
const KernelTable<Number>& kernels(InstructionSet set)
{
    if constexpr (std::is_same_v<Number, float>)
        return choose(set, LOBE_TABLES(float_kernels));
    else
        return choose(set, LOBE_TABLES(double_kernels));
}

const FusedTable& fused_kernels(InstructionSet set)
{
    return choose(set, LOBE_TABLES(fused_kernels));
}

template const KernelTable<float>& kernels(InstructionSet);
template const KernelTable<double>& kernels(InstructionSet);

#undef LOBE_TABLES

}  // namespace lobe::evaluate
