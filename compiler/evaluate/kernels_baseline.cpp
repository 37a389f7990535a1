// The kernels for what every machine of this kind has; on x86-64 that is SSE2.
#define LOBE_KERNELS baseline
#define LOBE_VECTOR_BYTES 16
#include "evaluate/kernels.inc"

namespace lobe::evaluate {

// The same functions on one vector, of which one lane counts.
#define LOBE_ONE(name)                                                                             \
    double name##_one(double x)                                                                    \
    {                                                                                              \
        return baseline::name##_of(baseline::constant(baseline::Doubles{}, x))[0];                 \
    }
LOBE_ONE(exp2)
LOBE_ONE(log2)
LOBE_ONE(exp)
LOBE_ONE(log)
LOBE_ONE(sine)
LOBE_ONE(cosine)
LOBE_ONE(tangent)
LOBE_ONE(arc_sine)
LOBE_ONE(arc_cosine)
LOBE_ONE(arc_tangent)
#undef LOBE_ONE

double power_one(double x, double y)
{
    using namespace baseline;
    return power_of(constant(Doubles{}, x), constant(Doubles{}, y))[0];
}

}  // namespace lobe::evaluate
