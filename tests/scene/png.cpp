// PNG files for tests: [PNG] for chunks, [RFC1950] and [RFC1951] for blocks that are stored.
#include "scene/png.h"

namespace lobe::tests {
namespace {

void put32(std::string& bytes, std::uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes.push_back(static_cast<char>(value >> static_cast<unsigned>(shift) & 0xFFU));
}

std::uint32_t crc32(std::string_view bytes)
{
    std::uint32_t crc = 0xFFFFFFFF;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

std::uint32_t adler32(std::string_view bytes)
{
    constexpr std::uint32_t prime = 65521;
    std::uint32_t low = 1;
    std::uint32_t high = 0;
    for (const char byte : bytes) {
        low = (low + static_cast<unsigned char>(byte)) % prime;
        high = (high + low) % prime;
    }
    return high << 16U | low;
}

void put_chunk(std::string& file, std::string_view type, std::string_view data)
{
    put32(file, static_cast<std::uint32_t>(data.size()));
    std::string chunk{type};
    chunk += data;
    file += chunk;
    put32(file, crc32(chunk));
}

/// In blocks of at most 65535 bytes, each with its length and the complement of that.
std::string stored(std::string_view bytes)
{
    constexpr std::size_t longest = 65535;
    std::string stream{"\x78\x01", 2};
    for (std::size_t at = 0; at < bytes.size(); at += longest) {
        const std::string_view block = bytes.substr(at, longest);
        const bool is_last = at + block.size() == bytes.size();
        stream.push_back(is_last ? 1 : 0);
        for (const std::size_t length : {block.size(), block.size() ^ longest}) {
            stream.push_back(static_cast<char>(length & 0xFFU));
            stream.push_back(static_cast<char>(length >> 8U));
        }
        stream += block;
    }
    put32(stream, adler32(bytes));
    return stream;
}

std::string_view view(const std::vector<std::uint8_t>& bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string png(const PngSpec& spec, const std::vector<std::uint8_t>& texels)
{
    std::string header;
    put32(header, spec.width);
    put32(header, spec.height);
    header.push_back(static_cast<char>(spec.bits));
    header.push_back(static_cast<char>(spec.color));
    header.append(3, '\0');
    std::string rows;
    const std::size_t stride = texels.size() / spec.height;
    for (std::size_t row = 0; row < spec.height; ++row) {
        rows.push_back('\0');
        rows += view(texels).substr(row * stride, stride);
    }
    std::string file{"\x89PNG\r\n\x1A\n"};
    put_chunk(file, "IHDR", header);
    if (!spec.palette.empty()) put_chunk(file, "PLTE", view(spec.palette));
    if (!spec.transparency.empty()) put_chunk(file, "tRNS", view(spec.transparency));
    put_chunk(file, "IDAT", stored(rows));
    put_chunk(file, "IEND", "");
    return file;
}

}  // namespace lobe::tests
