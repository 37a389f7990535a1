#include "analyze/environment/texture_file.h"

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

void big(std::string& out, std::uint32_t value, int bytes)
{
    for (int i = bytes; i-- > 0;) out += static_cast<char>((value >> (8 * i)) & 0xffU);
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

// ---- PNG: the signature, IHDR, IDAT with an uncompressed zlib stream, IEND

std::uint32_t crc32(std::string_view bytes)
{
    std::uint32_t crc = 0xffffffffU;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0);
    }
    return ~crc;
}

std::uint32_t adler32(std::string_view bytes)
{
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const char byte : bytes) {
        a = (a + static_cast<unsigned char>(byte)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

void chunk(std::string& out, std::string_view type, const std::string& content)
{
    big(out, static_cast<std::uint32_t>(content.size()), 4);
    const std::string checked = std::string{type} + content;
    out += checked;
    big(out, crc32(checked), 4);
}

std::string to_png(const BakedTable& table)
{
    const int depth = bytes_of(table.format.kind);
    const auto channels = static_cast<std::size_t>(table.format.channels);
    const std::size_t shown = channels == 2 ? 3 : channels;
    constexpr std::uint32_t gray = 0, rgb = 2, rgba = 6;

    std::string raw;
    for (std::size_t row = 0; row < table.height(); ++row) {
        raw += '\0';  // no filter
        for (std::size_t column = 0; column < table.width(); ++column)
            for (std::size_t channel = 0; channel < shown; ++channel)
                big(raw,
                    channel < channels
                        ? table.codes[(row * table.width() + column) * channels + channel]
                        : 0,
                    depth);
    }
    std::string stream = "\x78\x01";
    constexpr std::size_t largest_block = 65535;
    for (std::size_t begin = 0; begin < raw.size(); begin += largest_block) {
        const std::size_t size = std::min(largest_block, raw.size() - begin);
        stream += begin + size == raw.size() ? '\1' : '\0';
        little(stream, static_cast<std::uint32_t>(size), 2);
        little(stream, ~static_cast<std::uint32_t>(size), 2);
        stream += raw.substr(begin, size);
    }
    big(stream, adler32(raw), 4);

    std::string header;
    big(header, static_cast<std::uint32_t>(table.width()), 4);
    big(header, static_cast<std::uint32_t>(table.height()), 4);
    big(header, static_cast<std::uint32_t>(8 * depth), 1);
    big(header, shown == 1 ? gray : shown == 3 ? rgb : rgba, 1);
    big(header, 0, 3);

    std::string out = "\x89PNG\r\n\x1a\n";
    chunk(out, "IHDR", header);
    chunk(out, "IDAT", stream);
    chunk(out, "IEND", {});
    return out;
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
