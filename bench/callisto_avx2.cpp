// The model in AVX2 as one would write it by hand: eight points at a time, everything in
// registers, exp2 and log2 as polynomials, logarithms shared between powers of one base. With and
// without fused multiply-add, which the tape does without for equal bits on every machine.
#include "callisto.h"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>

namespace bench {
namespace {

struct Eight {
    __m256 v;
    Eight(__m256 value) : v{value} {}
    Eight(float value) : v{_mm256_set1_ps(value)} {}
};

Eight operator+(Eight a, Eight b) { return _mm256_add_ps(a.v, b.v); }
Eight operator-(Eight a, Eight b) { return _mm256_sub_ps(a.v, b.v); }
Eight operator*(Eight a, Eight b) { return _mm256_mul_ps(a.v, b.v); }
Eight operator/(Eight a, Eight b) { return _mm256_div_ps(a.v, b.v); }
Eight root(Eight a) { return _mm256_sqrt_ps(a.v); }
Eight smaller(Eight a, Eight b) { return _mm256_min_ps(a.v, b.v); }
Eight larger(Eight a, Eight b) { return _mm256_max_ps(a.v, b.v); }
Eight above(Eight a, Eight b) { return _mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ); }
Eight choose(Eight mask, Eight yes, Eight no) { return _mm256_blendv_ps(no.v, yes.v, mask.v); }
Eight kept(Eight mask, Eight value) { return _mm256_and_ps(mask.v, value.v); }
Eight load(const float* from) { return _mm256_loadu_ps(from); }

template <bool use_fma>
Eight fused(Eight a, Eight b, Eight c)
{
    if constexpr (use_fma) return _mm256_fmadd_ps(a.v, b.v, c.v);
    return a * b + c;
}

/// Relative error 2^-22, no denormal results.
template <bool use_fma>
Eight exp2(Eight x)
{
    x = smaller(larger(x, -126.0F), 128.0F);
    const __m256 whole = _mm256_round_ps(x.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
    const Eight f = x - Eight{whole};
    Eight p = fused<use_fma>(f, 1.5353354e-4F, 1.3398874e-3F);
    p = fused<use_fma>(p, f, 9.6184373e-3F);
    p = fused<use_fma>(p, f, 5.5503324e-2F);
    p = fused<use_fma>(p, f, 2.4022648e-1F);
    p = fused<use_fma>(p, f, 6.9314720e-1F);
    p = fused<use_fma>(p, f, 1.0F);
    const __m256i n = _mm256_slli_epi32(_mm256_cvtps_epi32(whole), 23);
    return _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(p.v), n));
}

/// Of normal numbers; 0 gives about -127.
template <bool use_fma>
Eight log2(Eight x)
{
    const __m256i half_root = _mm256_set1_epi32(0x3f3504f3);
    const __m256i bits = _mm256_sub_epi32(_mm256_castps_si256(x.v), half_root);
    const Eight exponent = _mm256_cvtepi32_ps(_mm256_srai_epi32(bits, 23));
    const __m256i fraction =
        _mm256_add_epi32(_mm256_and_si256(bits, _mm256_set1_epi32(0x7fffff)), half_root);
    const Eight f = Eight{_mm256_castsi256_ps(fraction)} - 1.0F;
    Eight q = fused<use_fma>(f, -0.10994956F, 0.18617509F);
    q = fused<use_fma>(q, f, -0.19106285F);
    q = fused<use_fma>(q, f, 0.20460063F);
    q = fused<use_fma>(q, f, -0.23961739F);
    q = fused<use_fma>(q, f, 0.28856741F);
    q = fused<use_fma>(q, f, -0.36069665F);
    q = fused<use_fma>(q, f, 0.48089824F);
    q = fused<use_fma>(q, f, -0.72134735F);
    q = fused<use_fma>(q, f, 1.4426950F);
    return fused<use_fma>(f, q, exponent);
}

/// x^y from log2 x, 1 where y is 0.
template <bool use_fma>
Eight power(Eight log, Eight x, Eight y)
{
    const Eight positive = kept(above(x, 0.0F), exp2<use_fma>(y * log));
    return choose(_mm256_cmp_ps(y.v, _mm256_setzero_ps(), _CMP_EQ_OQ), 1.0F, positive);
}

template <bool use_fma>
Eight lerp(Eight a, Eight b, Eight t)
{
    return fused<use_fma>(b - a, t, a);
}

template <bool use_fma>
Eight lobe_ggx(Eight roughness, Eight cos_i, Eight cos_o, Eight sin2_h)
{
    const Eight alpha = roughness * roughness;
    const Eight a2 = alpha * alpha;
    const Eight rest = 1.0F - a2;
    const Eight d = fused<use_fma>(sin2_h, rest, a2);
    const Eight lambda_i = cos_i + root(fused<use_fma>(rest, cos_i * cos_i, a2));
    const Eight lambda_o = cos_o + root(fused<use_fma>(rest, cos_o * cos_o, a2));
    return a2 / (3.14159265F * (d * d) * (lambda_i * lambda_o));
}

template <bool use_fma>
void evaluate(const CallistoColumns& in, std::size_t count)
{
    for (std::size_t i = 0; i < count; i += 8) {
        const auto at = [i](const float* column) { return load(column + i); };
        const Eight cos_i = at(in.cos_i);
        const Eight cos_o = at(in.cos_o);
        const Eight cos_h = at(in.cos_h);
        const Eight cos_d = at(in.cos_d);
        const Eight one_minus_cos_h = at(in.one_minus_cos_h);
        const Eight one_minus_cos_d = at(in.one_minus_cos_d);
        const Eight roughness = at(in.roughness);

        const auto exponent = [&](const float* falloff) { return 10.0F * (1.0F - at(falloff)); };
        const Eight log_d = log2<use_fma>(one_minus_cos_d);
        const Eight alpha_f =
            power<use_fma>(log_d, one_minus_cos_d, exponent(in.diffuse_fresnel_falloff)) *
            power<use_fma>(log2<use_fma>(cos_h), cos_h,
                           exponent(in.diffuse_fresnel_tangent_falloff));
        const Eight alpha_r = power<use_fma>(log2<use_fma>(one_minus_cos_h), one_minus_cos_h,
                                             exponent(in.retroreflection_falloff)) *
                              power<use_fma>(log2<use_fma>(cos_d), cos_d,
                                             exponent(in.retroreflection_tangent_falloff));

        const Eight mask = (1.0F - one_minus_cos_d * one_minus_cos_d * one_minus_cos_d) *
                           (1.0F - one_minus_cos_h * one_minus_cos_h * one_minus_cos_h);
        const Eight edge = mask * at(in.smooth_terminator_length);
        const Eight t = smaller(larger(cos_i / edge, 0.0F), 1.0F);
        const Eight step = kept(above(cos_i, 0.0F), 1.0F);
        const Eight smooth = choose(above(edge, 0.0F), t * t * (3.0F - (t + t)), step);
        const Eight strength = mask * at(in.smooth_terminator);

        const Eight lit = _mm256_and_ps(above(cos_i, 0.0F).v, above(cos_o, 0.0F).v);
        const Eight forward = 1.0F - root(larger(0.0F - at(in.v_dot_l), 0.0F));
        const Eight alpha = roughness * roughness;
        const Eight bracket =
            fused<use_fma>(alpha * (0.19F - 0.55F * cos_i), forward, cos_i) * 0.318309886F;
        const Eight diffuse = kept(lit, bracket);

        const Eight sin2_h = at(in.sin2_h);
        const Eight second = smaller(roughness * at(in.dual_specular_roughness_scale), 1.0F);
        const Eight lobes = lerp<use_fma>(lobe_ggx<use_fma>(roughness, cos_i, cos_o, sin2_h),
                                          lobe_ggx<use_fma>(second, cos_i, cos_o, sin2_h),
                                          at(in.dual_specular_opacity));
        const Eight falloff = at(in.specular_fresnel_falloff);
        const Eight gain =
            smaller(falloff + falloff, 1.0F) *
            power<use_fma>(log_d, one_minus_cos_d, exponent(in.specular_fresnel_falloff));
        const Eight specular = kept(lit, lobes * cos_i);

        const Eight fresnel_gain = at(in.diffuse_fresnel);
        const Eight retro_gain = at(in.retroreflection);
        const auto channel = [&](const float* color, const float* f0, const float* fresnel_tint,
                                 const float* retro_tint, const float* terminator_tint,
                                 float* result) {
            const Eight c1 = lerp<use_fma>(1.0F, fresnel_gain * at(fresnel_tint), alpha_f) *
                             lerp<use_fma>(1.0F, retro_gain * at(retro_tint), alpha_r);
            const Eight c2 = lerp<use_fma>(1.0F, smooth, strength * at(terminator_tint));
            const Eight fresnel = lerp<use_fma>(at(f0), 1.0F, gain);
            const Eight sum = fused<use_fma>(c1 * at(color), diffuse, fresnel * specular);
            _mm256_storeu_ps(result + i, (sum * c2).v);
        };
        channel(in.diffuse_color_r, in.f0_r, in.diffuse_fresnel_tint_r, in.retroreflection_tint_r,
                in.smooth_terminator_tint_r, in.r);
        channel(in.diffuse_color_g, in.f0_g, in.diffuse_fresnel_tint_g, in.retroreflection_tint_g,
                in.smooth_terminator_tint_g, in.g);
        channel(in.diffuse_color_b, in.f0_b, in.diffuse_fresnel_tint_b, in.retroreflection_tint_b,
                in.smooth_terminator_tint_b, in.b);
    }
}

}  // namespace

void callisto_avx2(const CallistoColumns& columns, std::size_t count)
{
    evaluate<false>(columns, count);
}

void callisto_avx2_fma(const CallistoColumns& columns, std::size_t count)
{
    evaluate<true>(columns, count);
}

}  // namespace bench
#endif
