// Pictures: where their bytes are, and what their channels hold.
#pragma once

#include "scene/buffers.h"

#include <vector>

namespace lobe::scene {

/// `images` of the file, checked but not read.
std::vector<Image> list_images(const View& root);

/// Decodes those images whose index is in `used`. What cannot be read keeps the full range, and is
/// a note; above a limit is an error.
void read_images(const View& root, const std::vector<bool>& used, const Buffers& buffers,
                 const Fetch& fetch, const ReadOptions& options, std::vector<Image>& images);

}  // namespace lobe::scene
