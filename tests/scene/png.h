// PNG files for tests, uncompressed inside, of any color type.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::tests {

/// How PNG numbers what its texels are.
enum class PngColor : std::uint8_t {
    gray = 0,
    rgb = 2,
    palette = 3,
    gray_alpha = 4,
    rgba = 6
};

struct PngSpec {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    int bits = 8;
    PngColor color = PngColor::rgba;
    std::vector<std::uint8_t> palette{};       ///< red, green and blue of every entry
    std::vector<std::uint8_t> transparency{};  ///< the bytes of its chunk
};

/// `texels` are the rows' bytes as the file has them, without the filters' bytes.
std::string png(const PngSpec& spec, const std::vector<std::uint8_t>& texels);

}  // namespace lobe::tests
