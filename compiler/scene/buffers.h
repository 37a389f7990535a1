// Buffers and their views: which bytes of which file an accessor or a picture reads.
#pragma once

#include "scene/view.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::scene {

/// A part of a buffer.
struct Window {
    std::string_view bytes;
    std::size_t offset = 0;  ///< in its buffer, for alignment
    std::size_t stride = 0;  ///< 0: elements without gaps
};

/// Every buffer's bytes, checked against the sizes that the file gives.
class Buffers {
public:
    /// Reads `buffers` and `bufferViews` of the file. `binary` is the chunk of a `.glb`.
    Buffers(const View& root, std::optional<std::string_view> binary, const Fetch& fetch,
            const Limits& limits);
    Buffers(const Buffers&) = delete;  // windows look into this one
    Buffers& operator=(const Buffers&) = delete;

    std::size_t window_count() const { return windows_.size(); }
    /// Nothing where the view is broken: something was said then.
    const std::optional<Window>& window(std::size_t index) const { return windows_[index]; }

private:
    std::vector<std::string> owned_;
    std::vector<std::optional<Window>> windows_;
};

/// The bytes behind a URI member `uri` of `holder`, or nothing and why.
struct Resource {
    std::optional<std::string> bytes;
    bool is_broken = false;  ///< the URI itself cannot be: it was complained of
    std::string why;         ///< it could not be had
};
Resource read_resource(const View& uri, const Fetch& fetch, const Limits& limits);

}  // namespace lobe::scene
