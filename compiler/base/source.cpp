#include "base/source.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe {

Span join(const Span& a, const Span& b)
{
    if (a.source != b.source) return a;
    return {a.source, std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

Source::Source(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text))
{
    line_starts_.push_back(0);
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
}

Position Source::position(std::uint32_t offset) const
{
    offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    const auto line = static_cast<std::size_t>(after - line_starts_.begin());
    int column = 1;
    for (std::uint32_t i = line_starts_[line - 1]; i < offset; ++i)
        if ((static_cast<unsigned char>(text_[i]) & 0xC0) != 0x80) ++column;
    return {static_cast<int>(line), column};
}

std::string_view Source::line(int number) const
{
    if (number < 1 || number > line_count()) return {};
    const std::size_t begin = line_starts_[static_cast<std::size_t>(number - 1)];
    std::size_t end =
        number < line_count() ? line_starts_[static_cast<std::size_t>(number)] - 1 : text_.size();
    if (end > begin && text_[end - 1] == '\r') --end;
    return std::string_view{text_}.substr(begin, end - begin);
}

std::uint32_t Source::line_start(int number) const
{
    return line_starts_[static_cast<std::size_t>(std::clamp(number, 1, line_count()) - 1)];
}

std::uint32_t Sources::add(std::string path, std::string text)
{
    sources_.emplace_back(std::move(path), std::move(text));
    return static_cast<std::uint32_t>(sources_.size() - 1);
}

std::string Sources::cite(const Span& span) const
{
    return fmt::format("{}:{}", sources_[span.source].path(), position(span).line);
}

std::string_view Sources::text(const Span& span) const
{
    const std::string_view text = sources_[span.source].text();
    const std::size_t begin = std::min<std::size_t>(span.begin, text.size());
    const std::size_t end = std::clamp<std::size_t>(span.end, begin, text.size());
    return text.substr(begin, end - begin);
}

}  // namespace lobe
