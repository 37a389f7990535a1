// The drawing of diagnostics for people.
#include "base/render.h"
#include "base/source_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace lobe {
namespace {

/// Lines wider than this are cut to a window around what is marked.
constexpr int widest = 140;
/// Columns kept before the first mark of a cut line.
constexpr int context = 30;
/// Lines of more bytes are cut to about as many before their columns are counted.
constexpr std::size_t longest = 4096;

enum class Ink {
    plain,
    strong,
    gutter,
    error,
    warning,
    fix,
};

std::string_view escape(Ink ink)
{
    switch (ink) {
    case Ink::plain: return "";
    case Ink::strong: return "\x1b[1m";
    case Ink::gutter: return "\x1b[1;34m";
    case Ink::error: return "\x1b[1;31m";
    case Ink::warning: return "\x1b[1;33m";
    case Ink::fix: return "\x1b[1;32m";
    }
    return "";
}

/// A label, or one line's part of it, in bytes of the line.
struct Mark {
    std::size_t begin = 0;
    std::size_t end = 0;
    char stroke = '^';  ///< 0 marks nothing, but is where to look
    Ink ink = Ink::plain;
    std::string text;
};

/// A mark where it is drawn.
struct Stroke {
    int begin = 0;
    int end = 0;
    const Mark* mark = nullptr;
};

/// The part of a very long line around its last mark, which is the primary one where there is one.
struct Part {
    std::size_t begin = 0;
    std::string_view text;
};

Part part_around(std::string_view line, const Mark& mark)
{
    if (line.size() <= longest) return {0, line};
    std::size_t begin = std::min(mark.begin, line.size());
    begin -= std::min(begin, longest / 2);
    while (begin > 0 && (static_cast<unsigned char>(line[begin]) & 0xC0) == 0x80) --begin;
    return {begin, line.substr(begin, longest)};
}

/// One row below a source line: characters with their inks.
class Row {
public:
    void put(int column, std::string_view text, Ink ink)
    {
        for (const char c : text) put(column++, c, ink);
    }
    void put(int column, char c, Ink ink)
    {
        const auto at = static_cast<std::size_t>(std::max(column, 0));
        if (cells_.size() <= at) cells_.resize(at + 1, {' ', Ink::plain});
        cells_[at] = {c, ink};
    }
    int size() const { return static_cast<int>(cells_.size()); }

    std::string text(bool color) const
    {
        std::string result;
        Ink ink = Ink::plain;
        for (const auto& [c, cell_ink] : cells_) {
            if (color && cell_ink != ink) {
                if (ink != Ink::plain) result += "\x1b[0m";
                result += escape(cell_ink);
                ink = cell_ink;
            }
            result += c;
        }
        if (ink != Ink::plain) result += "\x1b[0m";
        return result;
    }

private:
    std::vector<std::pair<char, Ink>> cells_;
};

class Drawing {
public:
    Drawing(const Sources& sources, const Diagnostic& diagnostic, bool color)
        : sources_(sources), diagnostic_(diagnostic), color_(color)
    {
    }

    std::string draw()
    {
        const bool error = severity(diagnostic_.code) == Severity::error;
        own_ink_ = error ? Ink::error : Ink::warning;
        out_ += paint(fmt::format("{}[{}]", error ? "error" : "warning", id(diagnostic_.code)),
                      own_ink_);
        out_ += paint(": " + diagnostic_.message, Ink::strong) + "\n";
        choose_gutter();
        if (has_place(diagnostic_.primary.span)) draw_sources();
        for (const std::string& note : diagnostic_.notes) remark("note", note);
        for (const std::string& help : diagnostic_.helps) remark("help", help);
        if (diagnostic_.fix && has_place(diagnostic_.fix->span)) draw_fix(*diagnostic_.fix);
        return std::move(out_);
    }

private:
    using Marks = std::map<int, std::vector<Mark>>;  ///< by line

    bool has_place(const Span& span) const { return span.source < sources_.size(); }

    /// Something about a whole file has no line to show.
    bool is_about_file() const
    {
        const Label& primary = diagnostic_.primary;
        return primary.span.end == 0 && primary.text.empty() && diagnostic_.secondary.empty();
    }

    std::string paint(std::string_view text, Ink ink) const
    {
        if (!color_ || ink == Ink::plain) return std::string{text};
        return fmt::format("{}{}\x1b[0m", escape(ink), text);
    }

    const Source& source_of(const Span& span) const { return sources_[span.source]; }

    int last_line(const Span& span) const
    {
        // A span that ends with a line break ends on the line that it breaks.
        const std::uint32_t end = span.end > span.begin ? span.end - 1 : span.end;
        return source_of(span).position(end).line;
    }

    void choose_gutter()
    {
        int line = 1;
        const auto see = [&](const Span& span) {
            if (has_place(span)) line = std::max(line, last_line(span));
        };
        see(diagnostic_.primary.span);
        for (const Label& label : diagnostic_.secondary) see(label.span);
        if (diagnostic_.fix) see(diagnostic_.fix->span);
        gutter_ = static_cast<int>(std::to_string(line).size());
    }

    void row(std::string_view number, std::string_view text)
    {
        out_ += paint(fmt::format("{:>{}} |", number, gutter_), Ink::gutter);
        if (!text.empty()) out_ += fmt::format(" {}", text);
        out_ += '\n';
    }

    // ---- source lines and what is marked in them

    void draw_sources()
    {
        const Label& primary = diagnostic_.primary;
        draw_place("-->", primary.span);
        if (is_about_file()) return;
        std::set<std::uint32_t> others;
        for (const Label& label : diagnostic_.secondary)
            if (has_place(label.span) && label.span.source != primary.span.source)
                others.insert(label.span.source);

        draw_lines(primary.span.source);
        for (const std::uint32_t other : others) {
            const auto first =
                std::find_if(diagnostic_.secondary.begin(), diagnostic_.secondary.end(),
                             [&](const Label& label) { return label.span.source == other; });
            draw_place(":::", first->span);
            draw_lines(other);
        }
    }

    void draw_place(std::string_view arrow, const Span& span)
    {
        out_ += std::string(static_cast<std::size_t>(gutter_), ' ') + paint(arrow, Ink::gutter);
        if (is_about_file()) {
            out_ += fmt::format(" {}\n", source_of(span).path());
            return;
        }
        const Position place = sources_.position(span);
        out_ += fmt::format(" {}:{}:{}\n", source_of(span).path(), place.line, place.column);
        row("", "");
    }

    void draw_lines(std::uint32_t source)
    {
        Marks marks;
        for (const Label& label : diagnostic_.secondary)
            if (label.span.source == source) mark(marks, label, '-', Ink::gutter);
        if (diagnostic_.primary.span.source == source)
            mark(marks, diagnostic_.primary, '^', own_ink_);

        int previous = 0;
        for (const auto& [number, line_marks] : marks) {
            if (previous != 0 && number > previous + 1) out_ += "...\n";
            draw_line(number, sources_[source].line(number), line_marks);
            previous = number;
        }
    }

    /// Adds the marks of a label: one, or for a label over several lines one on its first line
    /// and one, with the text, on its last.
    void mark(Marks& marks, const Label& label, char stroke, Ink ink) const
    {
        const Source& source = source_of(label.span);
        const int first = source.position(label.span.begin).line;
        const int last = std::max(first, last_line(label.span));
        const std::size_t begin = label.span.begin - source.line_start(first);
        const std::size_t end = label.span.end - source.line_start(last);
        if (first == last) {
            marks[first].push_back({begin, end, stroke, ink, label.text});
            return;
        }
        marks[first].push_back({begin, source.line(first).size(), stroke, ink, ""});
        const std::size_t indent = source.line(last).find_first_not_of(" \t");
        marks[last].push_back({std::min(indent, end), end, stroke, ink, label.text});
    }

    void draw_line(int number, std::string_view text, const std::vector<Mark>& marks)
    {
        const Part part = part_around(text, marks.back());
        const SourceView view{part.text};
        std::vector<Stroke> strokes;
        for (const Mark& mark : marks) {
            const int begin = view.column(mark.begin - std::min(mark.begin, part.begin));
            const int end = view.column(mark.end - std::min(mark.end, part.begin));
            strokes.push_back({begin, std::max(end, begin + 1), &mark});
        }
        const auto [first, last] = window(view, strokes);
        row(std::to_string(number), view.window(first, last));
        const int shift = SourceView::shift(first);
        for (Stroke& stroke : strokes) {
            // What was cut off is where the dots are.
            if (stroke.end <= first) stroke = {shift, shift + SourceView::ellipsis, stroke.mark};
            if (stroke.begin >= last)
                stroke = {last, last + SourceView::ellipsis, stroke.mark};
            else if (stroke.end > last)
                stroke.end = last;
            stroke.begin = std::max(stroke.begin, shift) - shift;
            stroke.end = std::max(stroke.end - shift, stroke.begin + 1);
        }
        std::erase_if(strokes, [](const Stroke& stroke) { return stroke.mark->stroke == 0; });
        if (!strokes.empty()) draw_strokes(std::move(strokes));
    }

    /// Which columns of a line to show: all, or those around the last mark.
    static std::pair<int, int> window(const SourceView& view, const std::vector<Stroke>& strokes)
    {
        if (view.width() <= widest) return {0, view.width() + 1};
        int begin = strokes.back().begin;
        int end = std::min(strokes.back().end, begin + widest - context);
        for (const Stroke& stroke : strokes) {
            const int from = std::min(begin, stroke.begin);
            const int to = std::max(end, stroke.end);
            if (to - from > widest - context) continue;
            begin = from;
            end = to;
        }
        const int first = begin <= context ? 0 : begin - context;
        return {first, first + widest};
    }

    /// Underlines all marks; the text of the rightmost stands beside it, the others' texts hang
    /// below, from right to left.
    void draw_strokes(std::vector<Stroke> strokes)
    {
        Row underline;
        for (const Stroke& stroke : strokes)
            for (int column = stroke.begin; column < stroke.end; ++column)
                underline.put(column, stroke.mark->stroke, stroke.mark->ink);

        std::stable_sort(strokes.begin(), strokes.end(), [](const Stroke& a, const Stroke& b) {
            return a.end != b.end ? a.end < b.end : a.begin < b.begin;
        });
        const Mark& rightmost = *strokes.back().mark;
        if (!rightmost.text.empty())
            underline.put(underline.size() + 1, rightmost.text, rightmost.ink);
        row("", underline.text(color_));

        strokes.pop_back();
        std::erase_if(strokes, [](const Stroke& stroke) { return stroke.mark->text.empty(); });
        std::stable_sort(strokes.begin(), strokes.end(),
                         [](const Stroke& a, const Stroke& b) { return a.begin < b.begin; });
        for (bool bars_only = true; !strokes.empty(); bars_only = false) {
            Row hanging;
            for (const Stroke& stroke : strokes) hanging.put(stroke.begin, '|', stroke.mark->ink);
            if (!bars_only) {
                const Stroke& last = strokes.back();
                hanging.put(last.begin, last.mark->text, last.mark->ink);
                strokes.pop_back();
            }
            row("", hanging.text(color_));
        }
    }

    // ---- remarks and the fix

    void remark(std::string_view kind, std::string_view text)
    {
        const std::string lead(static_cast<std::size_t>(gutter_) + 1, ' ');
        const std::string hang(static_cast<std::size_t>(gutter_) + 5 + kind.size(), ' ');
        out_ += lead + paint("=", Ink::gutter) + " " + paint(fmt::format("{}:", kind), Ink::strong);
        for (bool first = true; first || !text.empty(); first = false) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            out_ += fmt::format("{} {}\n", first ? "" : hang.substr(1), text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    }

    void draw_fix(const Fix& fix)
    {
        remark("help", fix.text);
        const Source& source = source_of(fix.span);
        const int first = source.position(fix.span.begin).line;
        const std::uint32_t last_byte = std::max(fix.span.begin, fix.span.end);
        const int last = source.position(last_byte).line;
        const std::string_view head = source.line(first).substr(
            0, std::min<std::size_t>(fix.span.begin - source.line_start(first),
                                     source.line(first).size()));
        const std::string_view tail_line = source.line(last);
        const std::string_view tail = tail_line.substr(
            std::min<std::size_t>(last_byte - source.line_start(last), tail_line.size()));

        constexpr int most_lines = 6;
        std::string_view rest = fix.replacement;
        for (int number = first; number < first + most_lines; ++number) {
            const std::size_t end = rest.find('\n');
            const bool ends = end == std::string_view::npos;
            const std::string_view written = rest.substr(0, end);
            const std::string_view before = number == first ? head : std::string_view{};
            const std::string line =
                fmt::format("{}{}{}", before, written, ends ? tail : std::string_view{});
            const char stroke = written.empty() ? '\0' : '~';
            draw_line(number, line,
                      {{before.size(), before.size() + written.size(), stroke, Ink::fix, ""}});
            if (ends) return;
            rest.remove_prefix(end + 1);
        }
    }

    const Sources& sources_;
    const Diagnostic& diagnostic_;
    bool color_;
    Ink own_ink_ = Ink::plain;
    int gutter_ = 1;
    std::string out_;
};

}  // namespace

std::string render_text(const Sources& sources, const Diagnostics& diagnostics, bool color)
{
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics.sorted()) {
        if (!result.empty()) result += '\n';
        result += Drawing{sources, diagnostic, color}.draw();
    }
    return result;
}

}  // namespace lobe
