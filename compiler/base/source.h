// Source files as the compiler sees them: text with a path, and places in it.
//
// Nothing here reads a disk. Whoever owns files (the command line, a test) adds their text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// A half-open range of bytes in one source. Trivially copyable; `source` indexes `Sources`.
struct Span {
    std::uint32_t source = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    friend bool operator==(const Span&, const Span&) = default;
};

/// The smallest span that holds both. Spans of different sources: the first wins.
Span join(const Span& a, const Span& b);

/// A place as people write it: both counted from 1, columns in characters (UTF-8 code points).
struct Position {
    int line = 1;
    int column = 1;
};

/// One text and the name it goes by in messages (a path relative to where the user stands).
class Source {
public:
    Source(std::string path, std::string text);

    const std::string& path() const { return path_; }
    const std::string& text() const { return text_; }

    /// Line and column of a byte offset; an offset past the end is the end.
    Position position(std::uint32_t offset) const;

    /// The text of a line (from 1) without its line ending; empty past the end.
    std::string_view line(int number) const;

    int line_count() const { return static_cast<int>(line_starts_.size()); }

    /// Byte offset at which a line (from 1) starts.
    std::uint32_t line_start(int number) const;

private:
    std::string path_;
    std::string text_;
    std::vector<std::uint32_t> line_starts_;
};

/// Every source of one compilation, in the order they were added.
class Sources {
public:
    std::uint32_t add(std::string path, std::string text);

    const Source& operator[](std::uint32_t index) const { return sources_[index]; }
    std::size_t size() const { return sources_.size(); }

    Position position(const Span& span) const { return sources_[span.source].position(span.begin); }

    /// `path:line` of where a span begins, as messages and generated comments cite it.
    std::string cite(const Span& span) const;

    /// The text a span covers.
    std::string_view text(const Span& span) const;

private:
    std::vector<Source> sources_;
};

}  // namespace lobe
