// Radiance to a picture that a screen can show.
#pragma once

#include "render/vector.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe::render {

/// Linear radiance, row by row from the top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Vector3> radiance;
};

/// The factor that brings a picture's log-average luminance to 0.18; pixels of no light do not
/// count. Reinhard et al. 2002, Photographic Tone Reproduction for Digital Images, equations 1, 2.
float exposure(const Picture& picture);

/// 8 bits per channel, sRGB. Luminance through Reinhard's equation 4 with the brightest pixel, or 4
/// times middle gray's white, as white; what leaves the gamut then is desaturated no further than
/// clamped.
std::vector<std::uint8_t> displayed(const Picture& picture, float exposure);

/// The difference of two pictures, per channel, in 8-bit codes after display, `gain` times as large
/// around middle gray.
std::vector<std::uint8_t> difference(const std::vector<std::uint8_t>& a,
                                     const std::vector<std::uint8_t>& b, int gain);

/// Pictures of one height, side by side.
struct Panel {
    int width = 0;
    std::vector<std::uint8_t> rgb;
};
Panel beside(const std::vector<Panel>& panels, int height);

/// As a PNG file's bytes.
std::string png(const Panel& panel, int height);

}  // namespace lobe::render
