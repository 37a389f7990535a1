#include "render/picture.h"

#include "scene/color.h"
#include "scene/pictures.h"

#include <algorithm>
#include <cmath>

namespace lobe::render {
namespace {

/// IEC 61966-2-1.
std::uint8_t encoded(float linear)
{
    const float x = std::clamp(linear, 0.0F, 1.0F);
    const float code = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(code * 255));
}

}  // namespace

float exposure(const Picture& picture)
{
    double sum = 0;
    std::size_t count = 0;
    for (const Vector3& pixel : picture.radiance)
        if (const float light = scene::luminance(pixel); light > 0 && std::isfinite(light)) {
            sum += std::log(light);
            ++count;
        }
    return count == 0 ? 1.0F
                      : static_cast<float>(0.18 / std::exp(sum / static_cast<double>(count)));
}

std::vector<std::uint8_t> displayed(const Picture& picture, float exposure)
{
    float white = 4;
    for (const Vector3& pixel : picture.radiance)
        white = std::max(white, exposure * scene::luminance(pixel));
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * picture.radiance.size());
    for (const Vector3& pixel : picture.radiance) {
        const float light = exposure * scene::luminance(pixel);
        const float scale = exposure * (1 + light / (white * white)) / (1 + light);
        for (const float channel : pixel) rgb.push_back(encoded(channel * scale));
    }
    return rgb;
}

std::vector<std::uint8_t> difference(const std::vector<std::uint8_t>& a,
                                     const std::vector<std::uint8_t>& b, int gain)
{
    std::vector<std::uint8_t> out;
    out.reserve(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out.push_back(static_cast<std::uint8_t>(std::clamp(128 + gain * (a[i] - b[i]), 0, 255)));
    return out;
}

Panel beside(const std::vector<Panel>& panels, int height)
{
    Panel whole;
    for (const Panel& panel : panels) whole.width += panel.width;
    for (int y = 0; y < height; ++y)
        for (const Panel& panel : panels) {
            const auto row = panel.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(y) * panel.width;
            whole.rgb.insert(whole.rgb.end(), row, row + 3 * std::ptrdiff_t{panel.width});
        }
    return whole;
}

std::string png(const Panel& panel, int height)
{
    return scene::encode_png({panel.width, height, 3, false, panel.rgb}, true);
}

}  // namespace lobe::render
