// A baked table as the bytes of a file: what engines, other programs and people read.
#pragma once

#include "analyze/environment/baked_table.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace lobe::analyze {

/// dds: DirectDraw Surface with the DX10 header, any format. png: unorm formats; one channel is
///      gray, two are red and green beside a blue of 0. csv: a row per texel, arguments, then the
///      values as stored. h: a C array of what is stored, and how to address it.
enum class TextureFile : std::uint8_t {
    dds,
    png,
    csv,
    h
};

inline constexpr std::array<std::string_view, 4> texture_file_names{"dds", "png", "csv", "h"};
std::optional<TextureFile> find_texture_file(std::string_view name);

/// Why a table cannot be such a file, or empty.
std::string unsuited(const BakedTable& table, TextureFile file);

/// The same bytes for the same table, anywhere. `unsuited` must be empty.
std::string to_file(const BakedTable& table, TextureFile file);

/// `u = cos_o * 0.96875 + 0.015625`: how a shader addresses an axis.
std::string address_of(const TableAxis& axis, std::string_view coordinate);

}  // namespace lobe::analyze
