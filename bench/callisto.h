// One shading model three ways, over the same columns: as scalar C++ with the platform's libm, as
// AVX2 code written by hand, and (in tape_speed.cpp) as the tape of models/callisto.lobe.
//
// The formulas are those of the model after optimize: Callisto over Proxima plus two GGX lobes,
// per channel, every input varying.
#pragma once

#include <cstddef>

namespace bench {

struct CallistoColumns {
#define LOBE_INPUT(field, name, low, high) const float* field = nullptr;
#include "callisto_inputs.def"
#undef LOBE_INPUT
    float* r = nullptr;
    float* g = nullptr;
    float* b = nullptr;
};

/// Diffuse plus specular. Compiled with -O3 -march=native.
void callisto_scalar(const CallistoColumns& columns, std::size_t count);

/// The same in explicit AVX2, with exp2 and log2 of its own. `count` is a multiple of 8.
void callisto_avx2(const CallistoColumns& columns, std::size_t count);
/// With fused multiply-add.
void callisto_avx2_fma(const CallistoColumns& columns, std::size_t count);

}  // namespace bench
