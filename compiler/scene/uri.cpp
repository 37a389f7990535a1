// What a URI of a scene stands for. [RFC3986] for paths, [RFC2397] for data, [RFC4648] for base64.
#include "scene/uri.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace lobe::scene {
namespace {

constexpr std::string_view alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t no_digit = 0xFF;

constexpr std::array<std::uint8_t, 256> digits_of()
{
    std::array<std::uint8_t, 256> digits{};
    digits.fill(no_digit);
    for (std::size_t digit = 0; digit < alphabet.size(); ++digit)
        digits[static_cast<unsigned char>(alphabet[digit])] = static_cast<std::uint8_t>(digit);
    return digits;
}

/// Nothing where a character is none of the alphabet's or the length cannot be. Padding may be
/// left out.
std::optional<std::string> decode_base64(std::string_view text)
{
    static constexpr auto digits = digits_of();
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char character : text) {
        const std::uint8_t digit = digits[static_cast<unsigned char>(character)];
        if (digit == no_digit) return std::nullopt;
        bits = (bits << 6U | digit) & 0xFFFFU;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<char>(bits >> static_cast<unsigned>(held) & 0xFFU));
    }
    return bytes;
}

std::optional<int> hex_digit(char character)
{
    if (character >= '0' && character <= '9') return character - '0';
    if (character >= 'a' && character <= 'f') return character - 'a' + 10;
    if (character >= 'A' && character <= 'F') return character - 'A' + 10;
    return std::nullopt;
}

std::optional<std::string> decode_percent(std::string_view text)
{
    std::string decoded;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] != '%') {
            decoded.push_back(text[at]);
            continue;
        }
        if (text.size() - at < 3) return std::nullopt;
        const auto high = hex_digit(text[at + 1]);
        const auto low = hex_digit(text[at + 2]);
        if (!high || !low) return std::nullopt;
        decoded.push_back(static_cast<char>(*high * 16 + *low));
        at += 2;
    }
    return decoded;
}

bool has_scheme(std::string_view uri)
{
    const std::size_t end = uri.find_first_of(":/?#");
    return end != uri.npos && uri[end] == ':';
}

}  // namespace

std::variant<InlineBytes, FilePath, BadUri> resolve(std::string_view uri)
{
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(',');
        if (comma == uri.npos) return BadUri{"this data URI has no comma before its data", ""};
        if (!uri.substr(0, comma).ends_with(";base64"))
            return BadUri{"this data URI is not in base64", "write `;base64` before the comma"};
        auto bytes = decode_base64(uri.substr(comma + 1));
        if (!bytes) return BadUri{"the data of this URI are no base64", ""};
        return InlineBytes{std::move(*bytes)};
    }
    const std::string beside = "name a file below the scene's folder by a relative path";
    if (has_scheme(uri)) return BadUri{"this URI has a scheme, and only files are read", beside};
    const auto decoded = decode_percent(uri);
    if (!decoded) return BadUri{"a `%` in this URI has no two hexadecimal digits behind it", ""};
    if (decoded->starts_with('/')) return BadUri{"this path is absolute", beside};
    const auto is_barred = [](char character) {
        return character == '\\' || static_cast<unsigned char>(character) < 0x20;
    };
    if (std::ranges::any_of(*decoded, is_barred))
        return BadUri{"this path has a backslash or a control character", "folders end in `/`"};

    std::vector<std::string_view> kept;
    for (std::size_t begin = 0; begin <= decoded->size();) {
        const std::size_t end = std::min(decoded->find('/', begin), decoded->size());
        const std::string_view part = std::string_view{*decoded}.substr(begin, end - begin);
        begin = end + 1;
        if (part.empty() || part == ".") continue;
        if (part != "..") {
            kept.push_back(part);
        } else if (kept.empty()) {
            return BadUri{"this path leaves the scene's folder", beside};
        } else {
            kept.pop_back();
        }
    }
    if (kept.empty()) return BadUri{"this path names no file", beside};
    // `C:` would be a drive elsewhere.
    if (kept.front().find(':') != kept.front().npos)
        return BadUri{"the first folder of this path has a colon", beside};
    std::string path;
    for (const std::string_view part : kept) path.append(path.empty() ? "" : "/").append(part);
    return FilePath{path};
}

}  // namespace lobe::scene
