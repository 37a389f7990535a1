#include "engine/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace lobe::engine {
namespace {

constexpr std::string_view begin_mark = "// BEGIN lobe";
constexpr std::string_view end_mark = "// END lobe";
constexpr std::string_view before_mark = "//-";
constexpr std::string_view new_file_mark = "//+";
constexpr std::string_view under_mark = "//^";

std::string_view unindented(std::string_view line) { return line.substr(indentation(line).size()); }

/// What follows a mark; nothing if the line does not start with it.
std::optional<std::string_view> behind(std::string_view line, std::string_view mark)
{
    line = unindented(line);
    if (!line.starts_with(mark)) return std::nullopt;
    line.remove_prefix(mark.size());
    if (!line.empty() && line.front() != ' ' && line.front() != '\t') return std::nullopt;
    return line;
}

std::vector<std::string_view> words_of(std::string_view text)
{
    std::vector<std::string_view> words;
    while (!is_blank(text)) {
        text = unindented(text);
        const auto end = std::min(text.find_first_of(" \t"), text.size());
        words.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return words;
}

bool read_number(std::string_view text, int& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && value > 0;
}

bool read_count(std::string_view text, Region& region)
{
    const auto slash = text.find('/');
    return slash != std::string_view::npos && read_number(text.substr(0, slash), region.number) &&
           read_number(text.substr(slash + 1), region.total) && region.number <= region.total;
}

/// A region whose END has not come yet.
struct Open {
    Region region;
    std::string hash;
};

std::optional<Open> read_begin(std::string_view words, std::size_t line)
{
    const auto parts = words_of(words);
    Open open;
    if (parts.size() != 4 || !read_count(parts[1], open.region)) return std::nullopt;
    open.region.model = parts[0];
    open.region.name = parts[2];
    open.region.begin = line;
    open.hash = parts[3];
    return open;
}

/// The lines below a BEGIN that start with this mark, from `at` on; each without it.
std::vector<std::string> read_marked(const Lines& text, std::string_view mark, std::size_t& at)
{
    std::vector<std::string> result;
    for (; at < text.lines.size(); ++at) {
        const auto rest = behind(text.lines[at].text, mark);
        if (!rest) break;
        result.emplace_back(rest->substr(std::min<std::size_t>(1, rest->size())));
    }
    return result;
}

/// What stands below a BEGIN and is no text of the edit; the line where that starts.
std::size_t read_former(const Lines& text, Region& region)
{
    std::size_t at = region.begin + 1;
    region.under = read_marked(text, under_mark, at);
    region.new_files = read_marked(text, new_file_mark, at);
    const std::size_t first = at;
    region.before = read_marked(text, before_mark, at);
    const std::string_view indent = indentation(text.lines[region.begin].text);
    for (std::string& line : region.before) line.insert(0, indent);
    for (std::size_t line = first; line < at; ++line)
        region.before_ends.push_back(text.lines[line].end);
    return at;
}

void copy_without(const Lines& text, std::size_t from, std::size_t to,
                  const std::vector<Region>& regions,
                  const std::function<bool(const std::string& model)>& goes, Restored& out)
{
    const auto copy = [&](std::size_t end) {
        for (; from < end; ++from) {
            out.text.lines.push_back(text.lines[from]);
            out.origins.push_back(from);
        }
    };
    for (const Region& region : regions) {
        copy(region.begin);
        if (goes(region.model)) {
            for (std::size_t i = 0; i < region.before.size(); ++i) {
                out.text.lines.push_back({region.before[i], region.before_ends[i]});
                out.origins.push_back(region.begin);
            }
            if (!region.before.empty()) out.text.lines.back().end = text.lines[region.end].end;
        } else {
            copy_without(text, region.begin, region.end + 1, region.inside, goes, out);
        }
        from = region.end + 1;
    }
    copy(to);
}

std::string hash_of(const Lines& text, const Region& region)
{
    Restored own;
    copy_without(
        text, region.begin + 1, region.end, region.inside, [](const std::string&) { return true; },
        own);
    LineHash hash;
    for (const Line& line : own.text.lines) hash.add(line.text);
    return hash.text();
}

/// One pass over the lines; regions nest, so the open ones are a stack.
class Finder {
public:
    explicit Finder(const Lines& text) : text_(text) {}

    FoundRegions run()
    {
        for (std::size_t at = 0; at < text_.lines.size(); ++at) {
            const std::string_view line = text_.lines[at].text;
            if (const auto words = behind(line, begin_mark))
                at = begin(*words, at);
            else if (const auto closing = behind(line, end_mark))
                end(*closing, at);
        }
        close_down_to(0);
        std::ranges::stable_sort(result_.broken, {}, &BrokenMark::line);
        return std::move(result_);
    }

private:
    /// The line to go on behind.
    std::size_t begin(std::string_view words, std::size_t line)
    {
        auto open = read_begin(words, line);
        if (!open) {
            result_.broken.push_back({line, "a BEGIN that cannot be read"});
            return line;
        }
        for (std::size_t depth = 0; depth < open_.size(); ++depth)
            if (open_[depth].region.model == open->region.model) close_down_to(depth);
        const std::size_t next = read_former(text_, open->region);
        open_.push_back(std::move(*open));
        return next - 1;
    }

    void end(std::string_view words, std::size_t line)
    {
        const auto parts = words_of(words);
        std::size_t depth = open_.size();
        if (parts.size() == 2)
            while (depth > 0 && (open_[depth - 1].region.model != parts[0] ||
                                 open_[depth - 1].region.name != parts[1]))
                --depth;
        if (parts.size() != 2 || depth == 0) {
            result_.broken.push_back({line, "an END without its BEGIN"});
            return;
        }
        close_down_to(depth);
        Open open = std::move(open_.back());
        open_.pop_back();
        open.region.end = line;
        open.region.edited = hash_of(text_, open.region) != open.hash;
        (open_.empty() ? result_.regions : open_.back().region.inside)
            .push_back(std::move(open.region));
    }

    /// What is open above this depth never got an END.
    void close_down_to(std::size_t depth)
    {
        while (open_.size() > depth) {
            const Region& region = open_.back().region;
            result_.broken.push_back(
                {region.begin, fmt::format("the BEGIN of region `{}` of {} without its END",
                                           region.name, region.model)});
            open_.pop_back();
        }
    }

    const Lines& text_;
    std::vector<Open> open_;
    FoundRegions result_;
};

void visit_regions(const std::vector<Region>& regions, int depth,
                   const std::function<void(const Region&, int)>& visit)
{
    for (const Region& region : regions) {
        visit(region, depth);
        visit_regions(region.inside, depth + 1, visit);
    }
}

}  // namespace

FoundRegions find_regions(const Lines& text) { return Finder{text}.run(); }

void for_each_region(const std::vector<Region>& regions,
                     const std::function<void(const Region&, int)>& visit)
{
    visit_regions(regions, 0, visit);
}

Restored without_regions(const Lines& text, const std::vector<Region>& regions,
                         const std::function<bool(const std::string& model)>& goes)
{
    Restored result;
    result.text.byte_order_mark = text.byte_order_mark;
    result.text.lines.reserve(text.lines.size());
    result.origins.reserve(text.lines.size());
    copy_without(text, 0, text.lines.size(), regions, goes, result);
    return result;
}

std::vector<bool> mark_lines(const Lines& text, const std::vector<Region>& regions)
{
    std::vector<bool> marks(text.lines.size());
    for_each_region(regions, [&](const Region& region, int) {
        const std::size_t former =
            region.under.size() + region.new_files.size() + region.before.size();
        for (std::size_t line = region.begin; line <= region.begin + former; ++line)
            marks[line] = true;
        marks[region.end] = true;
    });
    return marks;
}

void write_region(const NewRegion& region, std::vector<Line>& out)
{
    std::vector<Line> inside;
    for (const std::string& model : region.under)
        inside.push_back({fmt::format("{}{} {}", region.indent, under_mark, model), region.end});
    for (const std::string& path : region.new_files)
        inside.push_back({fmt::format("{}{} {}", region.indent, new_file_mark, path), region.end});
    for (const Line& line : region.before) {
        const std::string_view rest = std::string_view{line.text}.substr(region.indent.size());
        inside.push_back(
            {fmt::format("{}{}{}{}", region.indent, before_mark, rest.empty() ? "" : " ", rest),
             line.end == LineEnd::none ? region.end : line.end});
    }
    for (const std::string& line : region.after) inside.push_back({line, region.end});

    LineHash hash;
    for (const Line& line : inside) hash.add(line.text);
    out.push_back({fmt::format("{}{} {} {}/{} {} {}", region.indent, begin_mark, region.model,
                               region.number, region.total, region.name, hash.text()),
                   region.end});
    out.insert(out.end(), inside.begin(), inside.end());
    out.push_back({fmt::format("{}{} {} {}", region.indent, end_mark, region.model, region.name),
                   region.before.empty() ? region.end : region.before.back().end});
}

bool looks_like_mark(std::string_view line)
{
    return behind(line, begin_mark) || behind(line, end_mark) || behind(line, before_mark) ||
           behind(line, new_file_mark) || behind(line, under_mark);
}

void LineHash::add(std::string_view line)
{
    // FNV-1a, chosen because its definition fits here: readers of a patched tree may check it.
    const auto step = [&](char byte) {
        state_ = (state_ ^ static_cast<unsigned char>(byte)) * 16777619u;
    };
    for (const char byte : line) step(byte);
    step('\n');
}

std::string LineHash::text() const { return fmt::format("{:08x}", state_); }

}  // namespace lobe::engine
