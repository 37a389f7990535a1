// PNG and JPEG bytes to texels.
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

}  // namespace lobe::scene
