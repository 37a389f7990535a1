// What a texel can hold: the formats of textures that a table is stored in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lobe::analyze {

enum class TexelKind : std::uint8_t {
    unorm8,
    unorm16,
    half,
    float32
};

struct TexelFormat {
    std::string_view name;  ///< `r16g16`
    TexelKind kind{};
    int channels = 0;          ///< 1, 2 or 4
    std::uint32_t dxgi = 0;    ///< DXGI_FORMAT_...
    std::string_view reads{};  ///< as a shader would name it: `R16G16_UNORM`
};

/// `r16g16`, `rg16f`, `rgba8`, …: channels, then bits of each, then `f` for floats. `float`,
/// `half` and `unorm16` fit their channels to `components`, 1 to 4.
std::optional<TexelFormat> find_texel_format(std::string_view name, int components);

/// The accepted names, for a usage message.
std::string texel_format_names();

int bytes_of(TexelKind kind);

/// What is stored for a value, by rounding to nearest (even, for floats): the bits of it, and the
/// value that they read as. A unorm holds [0, 1] and clamps; a half overflows to infinity.
std::uint32_t code_of(double value, TexelKind kind);
double decoded(std::uint32_t code, TexelKind kind);

/// The range of what can be stored without clamping or overflow.
double least_of(TexelKind kind);
double greatest_of(TexelKind kind);

}  // namespace lobe::analyze
