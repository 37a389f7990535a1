// PNG and JPEG bytes to texels, and texels to PNG bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::scene {

/// Texels row by row from the top, four components each, as stored: palettes and missing channels
/// filled in, no transfer function undone, none of a file's own color corrections applied.
struct Raster {
    int width = 0;
    int height = 0;
    bool is_wide = false;  ///< components of 16 bits, the high byte first; else of 8
    std::vector<std::uint8_t> bytes;
};

struct Picture {
    std::optional<Raster> raster;
    std::string why;              ///< there is none
    bool is_above_limit = false;  ///< because of `most_texels`
};

/// The size is looked at before anything is decoded. A picture that is broken anywhere is not
/// decoded in part.
Picture decode(std::string_view bytes, std::size_t most_texels);

/// Texels to be written, row by row from the top: gray, RGB or RGBA by the number of components.
struct PngTexels {
    int width = 0;  ///< 1 at least, and so is the height
    int height = 0;
    int components = 3;    ///< 1, 3 or 4
    bool is_wide = false;  ///< components of 16 bits, the high byte first; else of 8
    std::vector<std::uint8_t> bytes;
};

/// The bytes of a file. `is_packed`: compressed; else the rows stand in it as they are, for readers
/// that are simple.
std::string encode_png(const PngTexels& texels, bool is_packed);

}  // namespace lobe::scene
