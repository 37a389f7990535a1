#include "analyze/environment/texel_format.h"

#include "evaluate/half.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

/// Two spellings of each: as APIs have it, and short.
struct Named {
    TexelFormat format;
    std::string_view alias;
};

constexpr std::array formats{
    Named{{"r8", TexelKind::unorm8, 1, 61, "R8_UNORM"}, "r8"},
    Named{{"r8g8", TexelKind::unorm8, 2, 49, "R8G8_UNORM"}, "rg8"},
    Named{{"rgba8", TexelKind::unorm8, 4, 28, "R8G8B8A8_UNORM"}, "r8g8b8a8"},
    Named{{"r16", TexelKind::unorm16, 1, 56, "R16_UNORM"}, "r16"},
    Named{{"r16g16", TexelKind::unorm16, 2, 35, "R16G16_UNORM"}, "rg16"},
    Named{{"rgba16", TexelKind::unorm16, 4, 11, "R16G16B16A16_UNORM"}, "r16g16b16a16"},
    Named{{"r16f", TexelKind::half, 1, 54, "R16_FLOAT"}, "r16f"},
    Named{{"rg16f", TexelKind::half, 2, 34, "R16G16_FLOAT"}, "r16g16f"},
    Named{{"rgba16f", TexelKind::half, 4, 10, "R16G16B16A16_FLOAT"}, "r16g16b16a16f"},
    Named{{"r32f", TexelKind::float32, 1, 41, "R32_FLOAT"}, "r32f"},
    Named{{"rg32f", TexelKind::float32, 2, 16, "R32G32_FLOAT"}, "r32g32f"},
    Named{{"rgba32f", TexelKind::float32, 4, 2, "R32G32B32A32_FLOAT"}, "r32g32b32a32f"},
};

struct Fitting {
    std::string_view name;
    TexelKind kind{};
};
constexpr std::array fitting{
    Fitting{"unorm8", TexelKind::unorm8}, Fitting{"unorm16", TexelKind::unorm16},
    Fitting{"half", TexelKind::half}, Fitting{"float", TexelKind::float32}};

int significant_bits_of_unorm(TexelKind kind) { return kind == TexelKind::unorm8 ? 8 : 16; }

double greatest_code(TexelKind kind) { return std::exp2(significant_bits_of_unorm(kind)) - 1; }

/// The bits of a number that is a half.
std::uint32_t half_bits(double value)
{
    const std::uint32_t sign = std::signbit(value) ? 0x8000U : 0;
    const double size = std::fabs(value);
    if (std::isnan(value)) return sign | 0x7e00U;
    if (std::isinf(value)) return sign | 0x7c00U;
    if (size < evaluate::least_normal_half) return sign | static_cast<std::uint32_t>(size * 0x1p24);
    const int exponent = std::ilogb(size);
    const auto fraction = static_cast<std::uint32_t>((std::scalbn(size, -exponent) - 1) * 0x1p10);
    return sign | (static_cast<std::uint32_t>(exponent + 15) << 10U) | fraction;
}

double half_value(std::uint32_t bits)
{
    const double sign = (bits & 0x8000U) != 0 ? -1 : 1;
    const auto exponent = static_cast<int>((bits >> 10U) & 0x1fU);
    const double fraction = (bits & 0x3ffU) * 0x1p-10;
    if (exponent == 0x1f)
        return fraction == 0 ? sign * HUGE_VAL : std::numeric_limits<double>::quiet_NaN();
    return sign *
           (exponent == 0 ? std::scalbn(fraction, -14) : std::scalbn(1 + fraction, exponent - 15));
}

}  // namespace

std::optional<TexelFormat> find_texel_format(std::string_view name, int components)
{
    for (const Named& each : formats)
        if (each.format.name == name || each.alias == name) return each.format;
    for (const Fitting& each : fitting)
        if (each.name == name)
            for (const Named& format : formats)
                if (format.format.kind == each.kind && format.format.channels >= components)
                    return format.format;
    return std::nullopt;
}

std::string texel_format_names()
{
    std::string out;
    for (const Named& each : formats) {
        out += each.format.name;
        out += ", ";
    }
    for (const Fitting& each : fitting) {
        out += each.name;
        if (each.name != fitting.back().name) out += ", ";
    }
    return out;
}

int bytes_of(TexelKind kind)
{
    return kind == TexelKind::unorm8 ? 1 : kind == TexelKind::float32 ? 4 : 2;
}

std::uint32_t code_of(double value, TexelKind kind)
{
    switch (kind) {
    case TexelKind::half:
        return half_bits(evaluate::round_to_half(value, evaluate::HalfMode::keep_denormals));
    case TexelKind::float32: return std::bit_cast<std::uint32_t>(static_cast<float>(value));
    case TexelKind::unorm8:
    case TexelKind::unorm16: break;
    }
    return static_cast<std::uint32_t>(
        std::floor(std::clamp(value, 0.0, 1.0) * greatest_code(kind) + 0.5));
}

double decoded(std::uint32_t code, TexelKind kind)
{
    switch (kind) {
    case TexelKind::half: return half_value(code);
    case TexelKind::float32: return std::bit_cast<float>(code);
    case TexelKind::unorm8:
    case TexelKind::unorm16: break;
    }
    return code / greatest_code(kind);
}

double least_of(TexelKind kind)
{
    return kind == TexelKind::half      ? -evaluate::largest_half
           : kind == TexelKind::float32 ? -double{std::numeric_limits<float>::max()}
                                        : 0;
}

double greatest_of(TexelKind kind)
{
    return kind == TexelKind::half      ? evaluate::largest_half
           : kind == TexelKind::float32 ? double{std::numeric_limits<float>::max()}
                                        : 1;
}

}  // namespace lobe::analyze
