// Buffers and their views.
#include "scene/buffers.h"

#include "scene/uri.h"

#include <fmt/format.h>

#include <utility>

namespace lobe::scene {
namespace {

/// More than any file has, and small enough that sums of two cannot overflow.
constexpr std::size_t most_bytes = std::size_t{1} << 48;

}  // namespace

Resource read_resource(const View& uri, const Fetch& fetch, const Limits& limits)
{
    const auto text = uri.text();
    if (!text) return {std::nullopt, true, ""};
    auto resolved = resolve(*text);
    if (const auto* bad = std::get_if<BadUri>(&resolved)) {
        uri.error(bad->message, bad->help);
        return {std::nullopt, true, ""};
    }
    Resource resource;
    if (auto* data = std::get_if<InlineBytes>(&resolved)) {
        resource.bytes = std::move(data->bytes);
    } else {
        const std::string& path = std::get<FilePath>(resolved).path;
        Fetched fetched = fetch ? fetch(path) : Fetched{std::nullopt, "no files are read here"};
        resource.bytes = std::move(fetched.bytes);
        if (!resource.bytes) resource.why = fmt::format("`{}`: {}", path, fetched.why);
    }
    if (resource.bytes && resource.bytes->size() > limits.file_bytes) {
        uri.error(fmt::format("{} bytes are above the limit of {}", resource.bytes->size(),
                              limits.file_bytes));
        return {std::nullopt, true, ""};
    }
    return resource;
}

Buffers::Buffers(const View& root, std::optional<std::string_view> binary, const Fetch& fetch,
                 const Limits& limits)
{
    std::vector<std::optional<std::string_view>> buffers;
    const auto listed = root.array("buffers");
    owned_.resize(listed ? listed->size() : 0);
    for (std::size_t index = 0; index < owned_.size(); ++index) {
        const View buffer = (*listed)[index];
        auto& bytes = buffers.emplace_back();
        if (!buffer.expect_object() || !buffer.require("byteLength")) continue;
        const std::size_t length = buffer.whole("byteLength", 0, 1, most_bytes);
        if (length == 0) continue;
        std::string_view found;
        if (const auto uri = buffer.member("uri")) {
            Resource resource = read_resource(*uri, fetch, limits);
            if (resource.is_broken) continue;
            if (!resource.bytes) {
                uri->error(fmt::format("this buffer cannot be read: {}", resource.why));
                continue;
            }
            owned_[index] = std::move(*resource.bytes);
            found = owned_[index];
        } else if (index == 0 && binary) {
            found = *binary;
        } else {
            buffer.error("this buffer has no `uri`",
                         "only the first buffer of a .glb file may leave it out");
            continue;
        }
        if (found.size() < length)
            buffer.error(
                fmt::format("{} bytes are here, and `byteLength` is {}", found.size(), length));
        else
            bytes = found.substr(0, length);
    }

    const auto views = root.array("bufferViews");
    windows_.resize(views ? views->size() : 0);
    for (std::size_t index = 0; index < windows_.size(); ++index) {
        const View view = (*views)[index];
        if (!view.expect_object() || !view.require("buffer") || !view.require("byteLength"))
            continue;
        const auto buffer = view.index("buffer", buffers.size(), "buffers");
        const std::size_t offset = view.whole("byteOffset", 0, 0, most_bytes);
        const std::size_t length = view.whole("byteLength", 0, 1, most_bytes);
        const std::size_t stride = view.whole("byteStride", 0, 4, 252);
        if (stride % 4 != 0) {
            view.error(fmt::format("a `byteStride` of {} is no multiple of 4", stride));
            continue;
        }
        if (!buffer || !buffers[*buffer] || length == 0) continue;
        const std::string_view bytes = *buffers[*buffer];
        if (offset > bytes.size() || length > bytes.size() - offset)
            view.error(fmt::format("bytes {} to {} are asked of a buffer of {}", offset,
                                   offset + length, bytes.size()));
        else
            windows_[index] = Window{bytes.substr(offset, length), offset, stride};
    }
}

}  // namespace lobe::scene
