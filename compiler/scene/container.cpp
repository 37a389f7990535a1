// A `.glb` file, little-endian:
//
//   0    "glTF"      4  version 2     8  length of the file
//   12   length of a chunk's data, a multiple of 4     16  its type     20  its data, and so on
//
// The first chunk is the JSON; the second, where there is one, the buffer without a URI. What
// follows is for extensions.
#include "scene/container.h"

#include "scene/bytes.h"

#include <fmt/format.h>

namespace lobe::scene {
namespace {

constexpr std::size_t header_size = 12;
constexpr std::size_t chunk_header_size = 8;
constexpr std::uint32_t json_type = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t binary_type = 0x004E4942;  // "BIN"

}  // namespace

std::optional<Container> open_container(std::string_view bytes, Complaints& complaints)
{
    if (!bytes.starts_with("glTF")) return Container{bytes, std::nullopt};
    const auto refuse = [&](std::string message) {
        complaints.error("", std::move(message));
        return std::nullopt;
    };
    if (bytes.size() < header_size) return refuse("the header of this .glb file is cut off");
    if (const auto version = load<std::uint32_t>(bytes, 4); version != 2)
        return refuse(fmt::format("this .glb file is of version {}; 2 is read", version));
    if (const auto length = load<std::uint32_t>(bytes, 8); length != bytes.size())
        return refuse(fmt::format("this .glb file gives its length as {} bytes, and has {}", length,
                                  bytes.size()));

    Container container;
    std::size_t at = header_size;
    for (int chunk = 0; at < bytes.size(); ++chunk) {
        if (bytes.size() - at < chunk_header_size)
            return refuse(fmt::format("chunk {} of this .glb file is cut off", chunk));
        const std::size_t length = load<std::uint32_t>(bytes, at);
        const auto type = load<std::uint32_t>(bytes, at + 4);
        at += chunk_header_size;
        if (length > bytes.size() - at)
            return refuse(fmt::format("chunk {} of this .glb file has {} bytes, and {} are left",
                                      chunk, length, bytes.size() - at));
        if (length % 4 != 0)
            return refuse(fmt::format("chunk {} of this .glb file has {} bytes, no multiple of 4",
                                      chunk, length));
        const std::string_view data = bytes.substr(at, length);
        if (chunk == 0 && type != json_type)
            return refuse("the first chunk of this .glb file is not its JSON");
        if (chunk == 0)
            container.json = data;
        else if (type == json_type || (type == binary_type && chunk != 1))
            return refuse(fmt::format("chunk {} of this .glb file is out of its place", chunk));
        else if (chunk == 1 && type == binary_type)
            container.binary = data;
        at += length;
    }
    if (container.json.data() == nullptr) return refuse("this .glb file has no chunk");
    return container;
}

}  // namespace lobe::scene
