// Colors of pictures as numbers: the curve of sRGB, and how bright its primaries are.
#pragma once

#include "scene/scene.h"

#include <cmath>

namespace lobe::scene {

/// What a stored value in [0, 1] stands for, linear. It rises, and keeps 0 and 1. [IEC61966-2-1]
inline float linear_of_srgb(float stored)
{
    return stored <= 0.04045F ? stored / 12.92F : std::pow((stored + 0.055F) / 1.055F, 2.4F);
}

/// Of a linear color, in the unit of its channels. [IEC61966-2-1]
inline float luminance(const Vector3& linear)
{
    return 0.2126F * linear[0] + 0.7152F * linear[1] + 0.0722F * linear[2];
}

}  // namespace lobe::scene
