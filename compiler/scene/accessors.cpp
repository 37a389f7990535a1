// Accessors: arrays of vectors in buffers. Sizes are compared by subtraction and division, so that
// no sum or product of what the file says can wrap.
#include "scene/accessors.h"

#include "scene/bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace lobe::scene {
namespace {

struct Shape {
    std::size_t rows;
    std::size_t columns;
};

/// SCALAR, VEC2 to VEC4, MAT2 to MAT4.
constexpr std::array<Shape, 7> shapes{{{1, 1}, {2, 1}, {3, 1}, {4, 1}, {2, 2}, {3, 3}, {4, 4}}};

std::size_t size_of(ComponentType type)
{
    switch (type) {
    case ComponentType::int8:
    case ComponentType::uint8: return 1;
    case ComponentType::int16:
    case ComponentType::uint16: return 2;
    case ComponentType::uint32:
    case ComponentType::float32: return 4;
    }
    return 4;
}

/// Columns of a matrix start at multiples of 4 bytes.
std::size_t element_size(const Accessor& accessor)
{
    const std::size_t column = accessor.rows * size_of(accessor.type);
    return accessor.columns == 1 ? column : accessor.columns * ((column + 3) / 4 * 4);
}

/// An accessor may have more elements than memory has bytes if no byte stands behind them.
constexpr std::size_t most_elements = std::size_t{1} << 40;

std::optional<ComponentType> component_type(const View& view)
{
    if (!view.require("componentType")) return std::nullopt;
    const std::size_t code = view.whole("componentType", 0, 5120, 5126);
    if (code == 0) return std::nullopt;
    if (code == 5124) {
        view.member("componentType")->error("5124 is no component type");
        return std::nullopt;
    }
    return static_cast<ComponentType>(code);
}

/// The bytes of `count` elements from `offset` of a window on; nothing after a complaint.
std::optional<std::string_view> cut(const View& view, const Window& window, std::size_t offset,
                                    std::size_t count, std::size_t size, std::size_t stride)
{
    const std::size_t available = window.bytes.size();
    const bool fits = offset <= available && size <= available - offset &&
                      (count - 1) <= (available - offset - size) / stride;
    if (fits) return window.bytes.substr(offset);
    view.error(fmt::format("{} elements of {} bytes, {} apart, do not fit from byte {} on into a "
                           "buffer view of {} bytes",
                           count, size, stride, offset, available));
    return std::nullopt;
}

bool is_aligned(const View& view, std::size_t offset, std::size_t size)
{
    if (offset % size == 0) return true;
    view.error(fmt::format("components of {} bytes begin at byte {} of the buffer", size, offset));
    return false;
}

std::uint32_t index_at(std::string_view bytes, ComponentType type, std::size_t at)
{
    if (type == ComponentType::uint8) return load<std::uint8_t>(bytes, at);
    if (type == ComponentType::uint16) return load<std::uint16_t>(bytes, 2 * at);
    return load<std::uint32_t>(bytes, 4 * at);
}

class Reading {
public:
    Reading(const View& view, const Buffers& buffers) : view_{view}, buffers_{buffers} {}

    std::optional<Accessor> accessor()
    {
        if (!view_.expect_object() || !view_.require("count") || !view_.require("type"))
            return std::nullopt;
        Accessor accessor;
        accessor.pointer = view_.pointer();
        const auto type = component_type(view_);
        accessor.is_normalized = view_.flag("normalized", false);
        accessor.count = view_.whole("count", 0, 1, most_elements);
        const auto choice =
            view_.choice("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
        if (!type || !choice || accessor.count == 0) return std::nullopt;
        const Shape& shape = shapes[*choice];
        accessor.type = *type;
        accessor.rows = shape.rows;
        accessor.columns = shape.columns;
        if (accessor.is_normalized && size_of(*type) == 4) {
            view_.error("only components of 8 and 16 bits are normalized");
            return std::nullopt;
        }
        if (!bytes(accessor) || !sparse(accessor)) return std::nullopt;
        return accessor;
    }

private:
    bool bytes(Accessor& accessor)
    {
        if (!view_.member("bufferView")) {
            if (view_.member("byteOffset"))
                view_.error("`byteOffset` is given without `bufferView`");
            return true;
        }
        const auto index = view_.index("bufferView", buffers_.window_count(), "bufferViews");
        if (!index || !buffers_.window(*index)) return false;
        const Window& window = *buffers_.window(*index);
        const std::size_t offset =
            view_.whole("byteOffset", 0, 0, std::numeric_limits<std::uint32_t>::max());
        const std::size_t size = element_size(accessor);
        const std::size_t stride = window.stride == 0 ? size : window.stride;
        if (stride < size) {
            view_.error(fmt::format("elements of {} bytes are {} apart", size, stride));
            return false;
        }
        if (!is_aligned(view_, window.offset + offset, size_of(accessor.type))) return false;
        const auto bytes = cut(view_, window, offset, accessor.count, size, stride);
        if (!bytes) return false;
        accessor.has_view = true;
        accessor.window = {*bytes, window.offset + offset, stride};
        return true;
    }

    bool sparse(Accessor& accessor)
    {
        if (!view_.member("sparse")) return true;
        const auto given = view_.object("sparse");
        if (!given || !given->require("count") || !given->require("indices") ||
            !given->require("values"))
            return false;
        Sparse sparse;
        sparse.count = given->whole("count", 0, 1, accessor.count);
        const auto indices = given->object("indices");
        const auto values = given->object("values");
        if (sparse.count == 0 || !indices || !values) return false;
        const auto type = component_type(*indices);
        if (!type) return false;
        if (*type != ComponentType::uint8 && *type != ComponentType::uint16 &&
            *type != ComponentType::uint32) {
            indices->error("indices are unsigned integers");
            return false;
        }
        sparse.index_type = *type;
        const auto index_bytes = part(*indices, sparse.count, size_of(*type), size_of(*type));
        const auto value_bytes =
            part(*values, sparse.count, element_size(accessor), size_of(accessor.type));
        if (!index_bytes || !value_bytes) return false;
        sparse.indices = *index_bytes;
        sparse.values = *value_bytes;
        for (std::size_t at = 0; at < sparse.count; ++at) {
            const std::uint32_t index = index_at(sparse.indices, sparse.index_type, at);
            const bool grows =
                at == 0 || index > index_at(sparse.indices, sparse.index_type, at - 1);
            if (grows && index < accessor.count) continue;
            indices->error(grows
                               ? fmt::format("index {} is past the accessor's end, which has {}",
                                             index, accessor.count)
                               : fmt::format("index {} comes after a larger or equal one", index));
            return false;
        }
        accessor.sparse = sparse;
        return true;
    }

    std::optional<std::string_view> part(const View& view, std::size_t count, std::size_t size,
                                         std::size_t alignment) const
    {
        if (!view.require("bufferView")) return std::nullopt;
        const auto index = view.index("bufferView", buffers_.window_count(), "bufferViews");
        if (!index || !buffers_.window(*index)) return std::nullopt;
        const Window& window = *buffers_.window(*index);
        const std::size_t offset =
            view.whole("byteOffset", 0, 0, std::numeric_limits<std::uint32_t>::max());
        if (!is_aligned(view, window.offset + offset, alignment)) return std::nullopt;
        return cut(view, window, offset, count, size, size);
    }

    const View& view_;
    const Buffers& buffers_;
};

/// [glTF2] "Animations" has the same rules for normalized integers; -128 counts as -127.
float component(std::string_view bytes, const Accessor& accessor, std::size_t at)
{
    const bool is_normalized = accessor.is_normalized;
    switch (accessor.type) {
    case ComponentType::int8: {
        const auto code = static_cast<float>(load<std::int8_t>(bytes, at));
        return is_normalized ? std::max(code / 127.0F, -1.0F) : code;
    }
    case ComponentType::uint8: {
        const auto code = static_cast<float>(load<std::uint8_t>(bytes, at));
        return is_normalized ? code / 255.0F : code;
    }
    case ComponentType::int16: {
        const auto code = static_cast<float>(load<std::int16_t>(bytes, at));
        return is_normalized ? std::max(code / 32767.0F, -1.0F) : code;
    }
    case ComponentType::uint16: {
        const auto code = static_cast<float>(load<std::uint16_t>(bytes, at));
        return is_normalized ? code / 65535.0F : code;
    }
    case ComponentType::uint32: return static_cast<float>(load<std::uint32_t>(bytes, at));
    case ComponentType::float32: break;
    }
    return load<float>(bytes, at);
}

}  // namespace

Accessors::Accessors(const View& root, const Buffers& buffers)
{
    const auto listed = root.array("accessors");
    all_.resize(listed ? listed->size() : 0);
    for (std::size_t index = 0; index < all_.size(); ++index)
        all_[index] = Reading{(*listed)[index], buffers}.accessor();
}

std::optional<std::vector<float>> read_floats(const Accessor& accessor, Complaints& complaints)
{
    const std::size_t width = accessor.rows;
    const std::size_t step = size_of(accessor.type);
    std::vector<float> values(accessor.count * width);
    const auto copy = [&](std::string_view bytes, std::size_t from, std::size_t to) {
        for (std::size_t row = 0; row < width; ++row)
            values[to * width + row] = component(bytes, accessor, from + row * step);
    };
    if (accessor.has_view)
        for (std::size_t at = 0; at < accessor.count; ++at)
            copy(accessor.window.bytes, at * accessor.window.stride, at);
    if (const auto& sparse = accessor.sparse)
        for (std::size_t at = 0; at < sparse->count; ++at)
            copy(sparse->values, at * element_size(accessor),
                 index_at(sparse->indices, sparse->index_type, at));
    const auto broken =
        std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
    if (broken == values.end()) return values;
    complaints.error(accessor.pointer,
                     fmt::format("element {} is not finite",
                                 static_cast<std::size_t>(broken - values.begin()) / width));
    return std::nullopt;
}

std::vector<std::uint32_t> read_integers(const Accessor& accessor)
{
    std::vector<std::uint32_t> values(accessor.count);
    const std::size_t stride = accessor.window.stride;
    const std::size_t size = size_of(accessor.type);
    if (accessor.has_view)
        for (std::size_t at = 0; at < accessor.count; ++at)
            values[at] = index_at(accessor.window.bytes.substr(at * stride), accessor.type, 0);
    if (const auto& sparse = accessor.sparse)
        for (std::size_t at = 0; at < sparse->count; ++at)
            values[index_at(sparse->indices, sparse->index_type, at)] =
                index_at(sparse->values.substr(at * size), accessor.type, 0);
    return values;
}

}  // namespace lobe::scene
