// The model as a C++ programmer would write it for one point, in a loop over points.
#include "callisto.h"

#include <algorithm>
#include <cmath>

namespace bench {
namespace {

constexpr float pi = 3.14159265F;

struct Color {
    float r, g, b;
};

Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
Color operator*(Color a, float s) { return {a.r * s, a.g * s, a.b * s}; }
Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }

float lerp(float a, float b, float t) { return a + (b - a) * t; }
Color lerp(float a, Color b, float t)
{
    return {lerp(a, b.r, t), lerp(a, b.g, t), lerp(a, b.b, t)};
}
Color lerp(float a, float b, Color t)
{
    return {lerp(a, b, t.r), lerp(a, b, t.g), lerp(a, b, t.b)};
}

float power(float x, float y) { return y == 0 ? 1 : (x <= 0 ? 0 : std::pow(x, y)); }

float falloff_scale(float x) { return 2 * (1 - x); }

float blend_weight(float one_minus_cos_theta, float n, float cos_phi, float m)
{
    return power(one_minus_cos_theta, 5 * n) * power(cos_phi, 5 * m);
}

float smoothstep(float edge0, float edge1, float x)
{
    if (edge1 <= edge0) return x > edge0 ? 1.0F : 0.0F;
    const float t = std::clamp((x - edge0) / (edge1 - edge0), 0.0F, 1.0F);
    return t * t * (3 - 2 * t);
}

float lobe_ggx(float roughness, float cos_i, float cos_o, float sin2_h)
{
    const float alpha = roughness * roughness;
    const float a2 = alpha * alpha;
    const float d = sin2_h * (1 - a2) + a2;
    const float distribution = a2 / (pi * (d * d));
    const float lambda_i = cos_i + std::sqrt(a2 + (1 - a2) * (cos_i * cos_i));
    const float lambda_o = cos_o + std::sqrt(a2 + (1 - a2) * (cos_o * cos_o));
    return distribution * (1 / (lambda_i * lambda_o));
}

}  // namespace

void callisto_scalar(const CallistoColumns& in, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        const float cos_i = in.cos_i[i];
        const float cos_o = in.cos_o[i];
        const float one_minus_cos_h = in.one_minus_cos_h[i];
        const float one_minus_cos_d = in.one_minus_cos_d[i];
        const float roughness = in.roughness[i];
        const Color diffuse_color{in.diffuse_color_r[i], in.diffuse_color_g[i],
                                  in.diffuse_color_b[i]};
        const Color f0{in.f0_r[i], in.f0_g[i], in.f0_b[i]};
        const Color fresnel_tint{in.diffuse_fresnel_tint_r[i], in.diffuse_fresnel_tint_g[i],
                                 in.diffuse_fresnel_tint_b[i]};
        const Color retro_tint{in.retroreflection_tint_r[i], in.retroreflection_tint_g[i],
                               in.retroreflection_tint_b[i]};
        const Color terminator_tint{in.smooth_terminator_tint_r[i], in.smooth_terminator_tint_g[i],
                                    in.smooth_terminator_tint_b[i]};

        const float alpha_f =
            blend_weight(one_minus_cos_d, falloff_scale(in.diffuse_fresnel_falloff[i]), in.cos_h[i],
                         falloff_scale(in.diffuse_fresnel_tangent_falloff[i]));
        const float alpha_r =
            blend_weight(one_minus_cos_h, falloff_scale(in.retroreflection_falloff[i]), in.cos_d[i],
                         falloff_scale(in.retroreflection_tangent_falloff[i]));
        const Color c1 = lerp(1, fresnel_tint * in.diffuse_fresnel[i], alpha_f) *
                         lerp(1, retro_tint * in.retroreflection[i], alpha_r);

        const float mask = (1 - one_minus_cos_d * one_minus_cos_d * one_minus_cos_d) *
                           (1 - one_minus_cos_h * one_minus_cos_h * one_minus_cos_h);
        const float smooth = smoothstep(0, mask * in.smooth_terminator_length[i], cos_i);
        const Color c2 = lerp(1, smooth, terminator_tint * (mask * in.smooth_terminator[i]));

        Color diffuse{0, 0, 0};
        Color specular{0, 0, 0};
        if (cos_i > 0 && cos_o > 0) {
            const float forward = 1 - std::sqrt(std::max(-in.v_dot_l[i], 0.0F));
            const float alpha = roughness * roughness;
            const float bracket = alpha * (0.19F - 0.55F * cos_i) * forward + cos_i;
            diffuse = diffuse_color * (bracket / pi);

            const float second = std::min(roughness * in.dual_specular_roughness_scale[i], 1.0F);
            const float lobes =
                lerp(lobe_ggx(roughness, cos_i, cos_o, in.sin2_h[i]),
                     lobe_ggx(second, cos_i, cos_o, in.sin2_h[i]), in.dual_specular_opacity[i]);
            const float r = falloff_scale(in.specular_fresnel_falloff[i]);
            const float gain = std::clamp(2 - r, 0.0F, 1.0F) * power(one_minus_cos_d, 5 * r);
            const Color fresnel = f0 + Color{1 - f0.r, 1 - f0.g, 1 - f0.b} * gain;
            specular = fresnel * (lobes * cos_i);
        }
        const Color result = c1 * diffuse * c2 + specular * c2;
        in.r[i] = result.r;
        in.g[i] = result.g;
        in.b[i] = result.b;
    }
}

}  // namespace bench
