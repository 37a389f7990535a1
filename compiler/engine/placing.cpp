#include "engine/placing.h"

#include "engine/answers.h"
#include "engine/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace lobe::engine {
namespace {

/// What all of these lines start with, of blanks.
std::string common_indentation(const std::vector<Line>& lines, std::size_t from, std::size_t to)
{
    std::string_view common = indentation(lines[from].text);
    for (std::size_t line = from + 1; line < to; ++line) {
        const std::string_view other = indentation(lines[line].text);
        const auto differ = std::ranges::mismatch(common, other);
        common = common.substr(0, static_cast<std::size_t>(differ.in1 - common.begin()));
    }
    return std::string{common};
}

bool ends_in_backslash(std::string_view line)
{
    const auto last = line.find_last_not_of(" \t\r");
    return last != std::string_view::npos && line[last] == '\\';
}

/// One edit in one file.
class Placer {
public:
    Placer(const Edit& edit, const Searched& file, const emit::Record& record,
           std::vector<Obstacle>& obstacles)
        : edit_(edit), file_(file), lines_(file.lines.lines), record_(record), obstacles_(obstacles)
    {
    }

    std::vector<Placement> run()
    {
        const auto hits = find();
        if (!hits) return {};
        if (edit_.action == Action::append)
            append(*hits);
        else
            for (const Hit& hit : *hits) place(hit);
        return std::move(places_);
    }

private:
    /// As many hits as there should be.
    std::optional<std::vector<Hit>> find()
    {
        Search found = search(file_, edit_.anchor, value_of(record_));
        if (found.obstacle) {
            if (edit_.anchor.least_hits == 0 && found.is_absent) return std::nullopt;
            found.obstacle->edit = edit_.name;
            obstacles_.push_back(std::move(*found.obstacle));
            return std::nullopt;
        }
        const auto least = static_cast<std::size_t>(edit_.anchor.least_hits);
        const auto most = static_cast<std::size_t>(edit_.anchor.most_hits);
        std::vector<Hit>& hits = found.hits;
        if (hits.size() < least) return missing(hits, found.where);
        if (hits.size() > most)
            return fail(
                lines_of(file_, *hits[0][0]).first,
                fmt::format("the anchor hits {}; {} expected", shown_hits(file_, hits),
                            most == 1 ? "once is" : fmt::format("{} are", most)),
                fmt::format(
                    "make the anchor of the edit in line {} of the list narrower, or give it a "
                    "`scope`",
                    edit_.line));
        if (edit_.last && hits.size() > 1) hits.erase(hits.begin(), hits.end() - 1);
        return std::move(hits);
    }

    std::nullopt_t missing(const std::vector<Hit>& hits, Stretch where)
    {
        std::string what = hits.empty()
                               ? "the anchor does not hit"
                               : fmt::format("the anchor hits {}; at least {} are expected",
                                             shown_hits(file_, hits), edit_.anchor.least_hits);
        std::size_t line = lines_.size();
        if (!edit_.anchor.scope.empty()) {
            line = file_.line_at(where.begin);
            what += fmt::format(", in lines {}-{}", file_.shown_line(line),
                                file_.shown_line(file_.line_at(where.end - 1)));
        }
        return fail(line, std::move(what),
                    fmt::format("find out what became of that line, and change the anchor of the "
                                "edit in line {} of the list",
                                edit_.line));
    }

    std::nullopt_t fail(std::size_t line, std::string what, std::string help)
    {
        obstacles_.push_back({file_.path, file_.shown_line(line), edit_.name, edit_.anchor.pattern,
                              std::move(what), std::move(help)});
        return std::nullopt;
    }

    /// The lines of the edit's text for this hit; nothing if it cannot be rendered.
    std::optional<std::vector<std::string>> text(const Hit& hit)
    {
        emit::Record record = record_;
        for (std::size_t group = 0; group < hit.size(); ++group)
            record.texts[fmt::format("{}", group)] =
                hit[group] ? std::string{file_.at(*hit[group])} : std::string{};
        const emit::Rendered rendered =
            emit::render(edit_.name, edit_.text, record, emit::Unused::fine);
        if (!rendered.error.empty())
            return fail(
                lines_of(file_, *hit[0]).first,
                fmt::format("the text of the edit: {}", rendered.error),
                fmt::format("change the text of the edit in line {} of the list", edit_.line));
        std::vector<std::string> result;
        for (std::string_view line : split_lines(rendered.text)) {
            if (line.ends_with('\r')) line.remove_suffix(1);
            result.emplace_back(line);
        }
        return result;
    }

    std::optional<std::string> joined_text(const Hit& hit)
    {
        const auto parts = text(hit);
        if (!parts) return std::nullopt;
        std::string joined;
        for (const std::string& part : *parts) joined += part;
        return joined;
    }

    void place(const Hit& hit)
    {
        const LineRange range = lines_of(file_, *hit[0]);
        if (edit_.action == Action::clone) return clone(hit, range);
        auto new_lines = text(hit);
        if (!new_lines) return;
        if (edit_.action == Action::replace) return replace(*hit[0], range, std::move(*new_lines));
        if (new_lines->empty()) return;
        const std::string indent = text_indentation(range.first);
        indent_all(*new_lines, indent);
        const std::size_t at = edit_.action == Action::before ? range.first : range.last + 1;
        insert(at, indent, std::move(*new_lines));
    }

    std::string text_indentation(std::size_t line) const
    {
        return edit_.flush ? std::string{} : std::string{indentation(lines_[line].text)};
    }

    static void indent_all(std::vector<std::string>& lines, const std::string& indent)
    {
        for (std::string& line : lines)
            if (!line.empty()) line.insert(0, indent);
    }

    void replace(Stretch hit, LineRange range, std::vector<std::string> new_lines)
    {
        const std::size_t first = file_.starts[range.first];
        const std::size_t last = file_.starts[range.last];
        std::string_view head{lines_[range.first].text};
        head = head.substr(0, hit.begin > first ? hit.begin - first : 0);
        std::string_view tail{lines_[range.last].text};
        tail = tail.substr(std::min(tail.size(), hit.end > last ? hit.end - last : 0));

        const bool keeps_head = !is_blank(head);
        const bool keeps_tail = !is_blank(tail);
        if (new_lines.empty() && (keeps_head || keeps_tail)) new_lines.emplace_back();
        const std::string bare_first = new_lines.empty() ? std::string{} : new_lines.front();
        indent_all(new_lines, text_indentation(range.first));
        if (keeps_head) new_lines.front() = std::string{head} + bare_first;
        if (keeps_tail) new_lines.back() += tail;
        add(range.first, range.last + 1, common_indentation(lines_, range.first, range.last + 1),
            std::move(new_lines));
    }

    /// Hits may share a line, which is changed as a whole then.
    void append(const std::vector<Hit>& hits)
    {
        struct Insertion {
            std::size_t line;
            std::size_t column;
            std::string text;
        };
        std::vector<Insertion> insertions;
        for (const Hit& hit : hits) {
            const auto added = joined_text(hit);
            if (!added) return;
            if (!hit[1]) {
                fail(lines_of(file_, *hit[0]).first, "group 1 of the anchor is no part of the hit",
                     fmt::format("change the anchor of the edit in line {} of the list",
                                 edit_.line));
                return;
            }
            const std::size_t line = file_.line_at(hit[1]->begin);
            if (!added->empty())
                insertions.push_back({line, hit[1]->begin - file_.starts[line], *added});
        }
        for (std::size_t i = 0; i < insertions.size();) {
            const std::size_t line = insertions[i].line;
            std::string changed = lines_[line].text;
            std::size_t shift = 0;
            for (; i < insertions.size() && insertions[i].line == line; ++i) {
                changed.insert(insertions[i].column + shift, insertions[i].text);
                shift += insertions[i].text.size();
            }
            add(line, line + 1, std::string{indentation(lines_[line].text)}, {changed});
        }
    }

    void clone(const Hit& hit, LineRange range)
    {
        const auto other = joined_text(hit);
        if (!other || other->empty()) return;
        const std::size_t first = file_.starts[range.first];
        if (!hit[1] || hit[1]->begin < first) {
            fail(range.first, "group 1 of the anchor is no part of the lines to copy",
                 fmt::format("change the anchor of the edit in line {} of the list", edit_.line));
            return;
        }
        const std::size_t end = file_.starts[range.last] + lines_[range.last].text.size();
        std::string copy = file_.text.substr(first, end - first);
        copy.replace(hit[1]->begin - first, hit[1]->end - hit[1]->begin, *other);
        std::vector<std::string> new_lines;
        for (const std::string_view line : split_lines(copy)) new_lines.emplace_back(line);
        insert(range.last + 1, std::string{indentation(lines_[range.first].text)},
               std::move(new_lines));
    }

    /// Behind a last line without an end nothing can be put: that line becomes part of the region.
    void insert(std::size_t at, std::string indent, std::vector<std::string> new_lines)
    {
        if (at == lines_.size() && lines_.back().end == LineEnd::none) {
            new_lines.insert(new_lines.begin(), lines_.back().text);
            add(at - 1, at, std::string{indentation(lines_.back().text)}, std::move(new_lines));
        } else {
            add(at, at, std::move(indent), std::move(new_lines));
        }
    }

    void add(std::size_t from, std::size_t to, std::string indent,
             std::vector<std::string> new_lines)
    {
        Placement& place = places_.emplace_back();
        place.edit = edit_.name;
        place.anchor = edit_.anchor.pattern;
        place.from = from;
        place.to = to;
        place.indent = std::move(indent);
        place.lines = std::move(new_lines);
    }

    const Edit& edit_;
    const Searched& file_;
    const std::vector<Line>& lines_;
    const emit::Record& record_;
    std::vector<Obstacle>& obstacles_;
    std::vector<Placement> places_;
};

void refuse(const Searched& file, const Placement& place, std::size_t line, std::string what,
            std::string help, std::vector<Obstacle>& obstacles)
{
    obstacles.push_back({file.path, file.shown_line(std::min(line, file.lines.lines.size() - 1)),
                         place.edit, place.anchor, std::move(what), std::move(help)});
}

/// What may not be next to a region, or in it.
void check_text_around(const Searched& file, const Placement& place,
                       std::vector<Obstacle>& obstacles)
{
    const std::vector<Line>& lines = file.lines.lines;
    const auto fail = [&](std::size_t line, std::string what, std::string help) {
        refuse(file, place, line, std::move(what), std::move(help), obstacles);
    };
    const auto continues = [&](std::size_t behind) {
        return behind > 0 && ends_in_backslash(lines[behind - 1].text);
    };
    if (continues(place.from) || continues(place.to))
        fail((continues(place.from) ? place.from : place.to) - 1,
             "a line that ends in a backslash continues where the region goes",
             "move the anchor before or behind the whole macro");
    else if (!place.lines.empty() && ends_in_backslash(place.lines.back()))
        fail(place.from, "the text of the edit ends in a backslash", "end it in whole lines");

    // The line end in front of the region's first line.
    const std::size_t front =
        place.from > 0 ? file.starts[place.from - 1] + lines[place.from - 1].text.size() : 0;
    if (place.from > 0 && file.parts[front] == Part::block_comment)
        fail(place.from, "the region would stand inside of a comment",
             "move the anchor to where code is");

    const auto marks = file.marks.begin();
    const auto from = marks + static_cast<std::ptrdiff_t>(place.from);
    const auto to = marks + static_cast<std::ptrdiff_t>(place.to);
    if (const auto mark = std::find(from, to, true); mark != to)
        fail(static_cast<std::size_t>(mark - marks),
             "the lines to be changed reach over a mark of another model's region",
             "revert that model, patch this one, then patch that one again");
    if (std::ranges::any_of(place.lines, looks_like_mark))
        fail(place.from, "the text of the edit has a line that looks like a region's mark",
             "word that line differently");
}

}  // namespace

std::vector<Placement> place(const Edit& edit, const Searched& file, const emit::Record& record,
                             std::vector<Obstacle>& obstacles)
{
    return Placer{edit, file, record, obstacles}.run();
}

void check_places(const Searched& file, const std::vector<Placement>& places,
                  std::vector<Obstacle>& obstacles)
{
    for (const Placement& place : places) {
        check_text_around(file, place, obstacles);
        for (const Placement& other : places) {
            // Of two that take the place of lines the later one is named; what goes in between
            // lines is named if these are changed together.
            const bool collides = place.from == place.to
                                      ? other.from < place.from && place.from < other.to
                                      : &other < &place && other.from != other.to &&
                                            other.from < place.to && place.from < other.to;
            if (collides)
                refuse(file, place, place.from,
                       fmt::format("edit `{}` changes the same lines", other.edit),
                       "make one edit of the two in the list", obstacles);
        }
    }
}

std::string with_regions(const Searched& file, std::vector<Placement> places,
                         const std::string& model, int total)
{
    // By place, what goes in front of a line before what takes its place; else the list's order.
    std::ranges::stable_sort(places, {}, [](const Placement& place) {
        return std::pair{place.from, place.from != place.to};
    });
    const std::vector<Line>& lines = file.lines.lines;
    const LineEnd usual = usual_end(file.lines);
    std::string bytes;
    bytes.reserve(file.text.size() + file.text.size() / 8);
    if (file.lines.byte_order_mark) put_byte_order_mark(bytes);
    std::vector<Line> written;
    std::size_t at = 0;
    for (const Placement& place : places) {
        for (; at < place.from; ++at) put_line(bytes, lines[at]);
        NewRegion region;
        region.model = model;
        region.name = place.edit;
        region.number = place.number;
        region.total = total;
        region.indent = place.indent;
        region.under = place.under;
        region.new_files = place.new_files;
        region.after = place.lines;
        region.end = usual;
        for (; at < place.to; ++at) region.before.push_back(lines[at]);
        const std::size_t neighbor = std::min(place.from, lines.size() - 1);
        if (lines[neighbor].end != LineEnd::none) region.end = lines[neighbor].end;
        written.clear();
        write_region(region, written);
        for (const Line& line : written) put_line(bytes, line);
    }
    for (; at < lines.size(); ++at) put_line(bytes, lines[at]);
    return bytes;
}

}  // namespace lobe::engine
