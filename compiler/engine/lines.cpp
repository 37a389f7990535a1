#include "engine/lines.h"

#include <algorithm>

namespace lobe::engine {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

}  // namespace

Lines to_lines(std::string_view bytes)
{
    Lines result;
    if (bytes.starts_with(byte_order_mark)) {
        result.byte_order_mark = true;
        bytes.remove_prefix(byte_order_mark.size());
    }
    result.lines.reserve(static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n')) +
                         1);
    while (!bytes.empty()) {
        const auto end = bytes.find('\n');
        if (end == std::string_view::npos) {
            result.lines.push_back({std::string{bytes}, LineEnd::none});
            break;
        }
        const bool crlf = end > 0 && bytes[end - 1] == '\r';
        result.lines.push_back({std::string{bytes.substr(0, crlf ? end - 1 : end)},
                                crlf ? LineEnd::crlf : LineEnd::lf});
        bytes.remove_prefix(end + 1);
    }
    return result;
}

std::string to_bytes(const Lines& lines)
{
    std::size_t size = byte_order_mark.size();
    for (const Line& line : lines.lines) size += line.text.size() + 2;
    std::string bytes;
    bytes.reserve(size);
    if (lines.byte_order_mark) put_byte_order_mark(bytes);
    for (const Line& line : lines.lines) put_line(bytes, line);
    return bytes;
}

void put_line(std::string& bytes, const Line& line)
{
    bytes += line.text;
    if (line.end == LineEnd::crlf) bytes += '\r';
    if (line.end != LineEnd::none) bytes += '\n';
}

void put_byte_order_mark(std::string& bytes) { bytes += byte_order_mark; }

LineEnd usual_end(const Lines& lines)
{
    const auto ends_in = [&](LineEnd end) {
        return std::ranges::count(lines.lines, end, &Line::end);
    };
    return ends_in(LineEnd::crlf) > ends_in(LineEnd::lf) ? LineEnd::crlf : LineEnd::lf;
}

std::vector<std::string_view> split_lines(std::string_view text)
{
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const auto end = text.find('\n');
        lines.push_back(text.substr(0, end));
        if (end == std::string_view::npos) break;
        text.remove_prefix(end + 1);
    }
    return lines;
}

std::string_view indentation(std::string_view line)
{
    return line.substr(0, std::min(line.find_first_not_of(" \t"), line.size()));
}

bool is_blank(std::string_view line)
{
    return line.find_first_not_of(" \t\r\n\f\v") == std::string_view::npos;
}

}  // namespace lobe::engine
