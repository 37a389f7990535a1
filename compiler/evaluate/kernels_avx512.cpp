// The kernels for processors with AVX512; compiled with its flags, chosen at run time.
#define LOBE_KERNELS avx512
#define LOBE_VECTOR_BYTES 64
#include "evaluate/kernels.inc"
