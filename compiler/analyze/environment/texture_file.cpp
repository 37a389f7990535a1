#include "analyze/environment/texture_file.h"

#include "scene/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>

namespace lobe::analyze {
namespace {

void little(std::string& out, std::uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xffU);
}

// ---- DDS: "DDS ", DDS_HEADER, DDS_HEADER_DXT10, texels

std::string to_dds(const BakedTable& table)
{
    constexpr std::uint32_t caps = 0x1, height = 0x2, width = 0x4, pitch = 0x8,
                            pixel_format = 0x1000;
    constexpr std::uint32_t four_cc = 0x4, texture = 0x1000, texture_2d = 3;
    const auto texel =
        static_cast<std::uint32_t>(bytes_of(table.format.kind) * table.format.channels);
    std::string out = "DDS ";
    const auto word = [&out](std::uint32_t value) { little(out, value, 4); };
    word(124);
    word(caps | height | width | pitch | pixel_format);
    word(static_cast<std::uint32_t>(table.height()));
    word(static_cast<std::uint32_t>(table.width()));
    word(static_cast<std::uint32_t>(table.width()) * texel);
    for (int i = 0; i < 2 + 11; ++i) word(0);  // depth, mip maps (none), reserved
    word(32);
    word(four_cc);
    out += "DX10";
    for (int i = 0; i < 5; ++i) word(0);
    word(texture);
    for (int i = 0; i < 4; ++i) word(0);
    word(table.format.dxgi);
    word(texture_2d);
    word(0);
    word(1);  // one slice
    word(0);
    for (const std::uint32_t code : table.codes) little(out, code, bytes_of(table.format.kind));
    return out;
}

// ---- PNG

std::string to_png(const BakedTable& table)
{
    const auto channels = static_cast<std::size_t>(table.format.channels);
    const std::size_t shown = channels == 2 ? 3 : channels;
    scene::PngTexels texels;
    texels.width = static_cast<int>(table.width());
    texels.height = static_cast<int>(table.height());
    texels.components = static_cast<int>(shown);
    texels.is_wide = table.format.kind == TexelKind::unorm16;
    for (std::size_t texel = 0; texel < table.width() * table.height(); ++texel)
        for (std::size_t channel = 0; channel < shown; ++channel) {
            const std::uint32_t code =
                channel < channels ? table.codes[texel * channels + channel] : 0;
            if (texels.is_wide) texels.bytes.push_back(static_cast<std::uint8_t>(code >> 8));
            texels.bytes.push_back(static_cast<std::uint8_t>(code));
        }
    return scene::encode_png(texels, false);
}

// ---- text

std::string to_csv(const BakedTable& table)
{
    const BakeSubject& subject = table.subject;
    std::string out;
    for (const TableAxis& axis : subject.axes) out += axis.name + ',';
    out += fmt::format("{}\n", fmt::join(subject.components, ","));
    for (std::size_t texel = 0; texel < table.width() * table.height(); ++texel) {
        const std::array<std::size_t, 2> at{texel % table.width(), texel / table.width()};
        for (std::size_t i = 0; i < subject.axes.size(); ++i)
            out += fmt::format("{},", subject.axes[i].at(static_cast<double>(at[i])));
        for (std::size_t k = 0; k < subject.components.size(); ++k)
            out += fmt::format("{}{}", k == 0 ? "" : ",", table.stored(texel, k));
        out += '\n';
    }
    return out;
}

std::string identifier(std::string name)
{
    for (char& each : name)
        if (std::isalnum(static_cast<unsigned char>(each)) == 0) each = '_';
    return name;
}

std::string to_header(const BakedTable& table)
{
    const BakeSubject& subject = table.subject;
    const std::string name = identifier(subject.name);
    const bool is_float = table.format.kind == TexelKind::float32;
    std::string out = fmt::format("// {}: {} by {} texels, {}, row by row. Made by lobec table.\n",
                                  subject.name, table.width(), table.height(), table.format.reads);
    for (std::size_t i = 0; i < subject.axes.size(); ++i)
        out += fmt::format("//   {}\n", address_of(subject.axes[i], i == 0 ? "u" : "v"));
    out += fmt::format("// Channels: {}.\n#pragma once\n\n", fmt::join(subject.components, ", "));
    out += fmt::format("#define {0}_WIDTH {1}\n#define {0}_HEIGHT {2}\n\n", name, table.width(),
                       table.height());
    out += fmt::format("static const {} {}[{}] = {{\n",
                       is_float                                 ? "float"
                       : table.format.kind == TexelKind::unorm8 ? "unsigned char"
                                                                : "unsigned short",
                       name, table.codes.size());
    constexpr std::size_t most = 96;
    std::string line = "   ";
    for (const std::uint32_t code : table.codes) {
        const float number = std::bit_cast<float>(code);
        const std::string text =
            is_float
                ? fmt::format(" {}{}f,", number,
                              fmt::format("{}", number).find_first_of(".e") == std::string::npos
                                  ? ".0"
                                  : "")
                : fmt::format(" {},", code);
        if (line.size() + text.size() > most) {
            out += line + '\n';
            line = "   ";
        }
        line += text;
    }
    out += line + "\n};\n";
    return out;
}

}  // namespace

std::optional<TextureFile> find_texture_file(std::string_view name)
{
    const auto* const found = std::ranges::find(texture_file_names, name);
    if (found == texture_file_names.end()) return std::nullopt;
    return static_cast<TextureFile>(found - texture_file_names.begin());
}

std::string unsuited(const BakedTable& table, TextureFile file)
{
    const bool unorm =
        table.format.kind == TexelKind::unorm8 || table.format.kind == TexelKind::unorm16;
    if (file == TextureFile::png && !unorm)
        return fmt::format("a PNG holds unorm values, and {} are floats; a .dds holds them",
                           table.format.reads);
    return {};
}

std::string to_file(const BakedTable& table, TextureFile file)
{
    switch (file) {
    case TextureFile::dds: return to_dds(table);
    case TextureFile::png: return to_png(table);
    case TextureFile::csv: return to_csv(table);
    case TextureFile::h: break;
    }
    return to_header(table);
}

std::string address_of(const TableAxis& axis, std::string_view coordinate)
{
    std::string out = fmt::format("{} = {}", coordinate, axis.name);
    if (axis.scale() != 1) out += fmt::format(" * {:.9g}", axis.scale());
    if (axis.offset() != 0)
        out += fmt::format(" {} {:.9g}", axis.offset() < 0 ? '-' : '+', std::fabs(axis.offset()));
    return out;
}

}  // namespace lobe::analyze
