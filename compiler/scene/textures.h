// Textures: which picture, how it repeats, and how a material places it.
#pragma once

#include "scene/view.h"

#include <optional>
#include <vector>

namespace lobe::scene {

class Textures {
public:
    /// Reads `samplers` and `textures` of the file, which has `image_count` images.
    Textures(const View& root, std::size_t image_count);

    /// A reference to a texture: an object with `index`. Nothing after a complaint. Its picture is
    /// used from then on.
    std::optional<Texture> read(const View& reference);
    void use(std::size_t image) { used_[image] = true; }
    /// Per image of the file and of `without_image()`: something refers to it.
    const std::vector<bool>& used() const { return used_; }
    /// Pointers of textures that name no picture. They count as images behind the file's.
    const std::vector<Pointer>& without_image() const { return without_image_; }

private:
    struct Entry {
        std::optional<std::size_t> image;
        bool repeats_u = true;
        bool repeats_v = true;
        bool is_filtered = true;
    };
    Entry entry(const View& texture, std::size_t image_count, const std::vector<Entry>& samplers);

    std::vector<Entry> all_;
    std::vector<Pointer> without_image_;
    std::vector<bool> used_;
};

}  // namespace lobe::scene
