// The kernels for processors with AVX2; compiled with its flags, chosen at run time.
#define LOBE_KERNELS avx2
#define LOBE_VECTOR_BYTES 32
#include "evaluate/kernels.inc"
