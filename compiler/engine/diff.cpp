#include "engine/diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace lobe::engine {
namespace {

constexpr std::size_t context = 3;

/// Lines with their ends, so that the same words with another end are another line.
std::vector<std::string_view> lines_with_ends(std::string_view text)
{
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return lines;
}

/// Lines `old_begin` up to `old_end` become `new_begin` up to `new_end`.
struct Difference {
    std::size_t old_begin;
    std::size_t old_end;
    std::size_t new_begin;
    std::size_t new_end;
};

using Lines = std::vector<std::string_view>;

/// The shortest edit by the greedy algorithm of [Myers86]: row d holds how far down each diagonal
/// d edits lead.
class Comparison {
public:
    Comparison(const Lines& before, const Lines& after) : old_(before), new_(after) {}

    std::vector<Difference> run()
    {
        std::size_t begin = 0;
        const std::size_t shorter = std::min(old_.size(), new_.size());
        while (begin < shorter && old_[begin] == new_[begin]) ++begin;
        std::size_t same_tail = 0;
        while (same_tail < shorter - begin &&
               old_[old_.size() - 1 - same_tail] == new_[new_.size() - 1 - same_tail])
            ++same_tail;
        offset_ = begin;
        rows_ = static_cast<std::ptrdiff_t>(old_.size() - same_tail - begin);
        columns_ = static_cast<std::ptrdiff_t>(new_.size() - same_tail - begin);
        if (rows_ == 0 && columns_ == 0) return {};
        // Memory grows with the square of the edits; past this many nobody reads them one by one.
        constexpr std::ptrdiff_t most_edits = 2000;
        for (std::ptrdiff_t edits = 0; edits <= std::min(most_edits, rows_ + columns_); ++edits)
            if (extend(edits)) return trace(edits);
        return {{begin, old_.size() - same_tail, begin, new_.size() - same_tail}};
    }

private:
    /// How far in the old lines diagonal `diagonal` = old - new leads with this many edits.
    std::ptrdiff_t& reach(std::ptrdiff_t edits, std::ptrdiff_t diagonal)
    {
        return reach_[static_cast<std::size_t>(edits)][static_cast<std::size_t>(diagonal + edits)];
    }

    /// Whether the best way to this diagonal inserts a line (else it deletes one).
    bool inserts(std::ptrdiff_t edits, std::ptrdiff_t diagonal)
    {
        return diagonal == -edits || (diagonal != edits && reach(edits - 1, diagonal - 1) <
                                                               reach(edits - 1, diagonal + 1));
    }

    std::ptrdiff_t start(std::ptrdiff_t edits, std::ptrdiff_t diagonal)
    {
        if (edits == 0) return 0;
        return inserts(edits, diagonal) ? reach(edits - 1, diagonal + 1)
                                        : reach(edits - 1, diagonal - 1) + 1;
    }

    bool extend(std::ptrdiff_t edits)
    {
        reach_.emplace_back(static_cast<std::size_t>(2 * edits + 1));
        for (std::ptrdiff_t diagonal = -edits; diagonal <= edits; diagonal += 2) {
            std::ptrdiff_t row = start(edits, diagonal);
            while (row < rows_ && row - diagonal < columns_ && row >= diagonal &&
                   old_[offset_ + static_cast<std::size_t>(row)] ==
                       new_[offset_ + static_cast<std::size_t>(row - diagonal)])
                ++row;
            reach(edits, diagonal) = row;
            if (row >= rows_ && row - diagonal >= columns_) return true;
        }
        return false;
    }

    /// Back from the end; neighboring edits become one difference.
    std::vector<Difference> trace(std::ptrdiff_t edits)
    {
        std::vector<Difference> result;
        std::ptrdiff_t diagonal = rows_ - columns_;
        for (; edits > 0; --edits) {
            const bool inserted = inserts(edits, diagonal);
            const auto row = static_cast<std::size_t>(start(edits, diagonal)) + offset_;
            const auto column =
                static_cast<std::size_t>(start(edits, diagonal) - diagonal) + offset_;
            const Difference step = inserted ? Difference{row, row, column - 1, column}
                                             : Difference{row - 1, row, column, column};
            if (!result.empty() && result.back().old_begin == step.old_end &&
                result.back().new_begin == step.new_end) {
                result.back().old_begin = step.old_begin;
                result.back().new_begin = step.new_begin;
            } else {
                result.push_back(step);
            }
            diagonal += inserted ? 1 : -1;
        }
        std::ranges::reverse(result);
        return result;
    }

    const Lines& old_;
    const Lines& new_;
    std::size_t offset_ = 0;
    std::ptrdiff_t rows_ = 0;
    std::ptrdiff_t columns_ = 0;
    std::vector<std::vector<std::ptrdiff_t>> reach_;
};

void put_line(std::string& out, char sign, std::string_view line)
{
    out += sign;
    out += line;
    if (!line.ends_with('\n')) out += "\n\\ No newline at end of file\n";
}

/// `12,3`; in front of the first line it is line 0.
std::string shown_range(std::size_t begin, std::size_t size)
{
    return fmt::format("{},{}", size == 0 ? begin : begin + 1, size);
}

/// Differences `first` up to `last`, which are close enough for one hunk.
void put_hunk(std::string& out, const Lines& before, const Lines& after,
              const std::vector<Difference>& all, std::size_t first, std::size_t last)
{
    const std::size_t lead = std::min(context, all[first].old_begin);
    const std::size_t old_begin = all[first].old_begin - lead;
    const std::size_t new_begin = all[first].new_begin - lead;
    const std::size_t trail = std::min(context, before.size() - all[last - 1].old_end);
    const std::size_t old_end = all[last - 1].old_end + trail;
    const std::size_t new_end = all[last - 1].new_end + trail;
    out += fmt::format("@@ -{} +{} @@\n", shown_range(old_begin, old_end - old_begin),
                       shown_range(new_begin, new_end - new_begin));
    std::size_t at = old_begin;
    for (std::size_t i = first; i < last; ++i) {
        for (; at < all[i].old_begin; ++at) put_line(out, ' ', before[at]);
        for (; at < all[i].old_end; ++at) put_line(out, '-', before[at]);
        for (std::size_t line = all[i].new_begin; line < all[i].new_end; ++line)
            put_line(out, '+', after[line]);
    }
    for (; at < old_end; ++at) put_line(out, ' ', before[at]);
}

/// A path as git writes it: in quotes if it has bytes that would be misread.
std::string shown_path(const std::string& path)
{
    const auto is_plain = [](char c) { return c >= ' ' && c < '\x7f' && c != '"' && c != '\\'; };
    if (std::ranges::all_of(path, is_plain)) return path;
    std::string quoted = "\"";
    for (const char c : path)
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (is_plain(c))
            quoted += c;
        else
            quoted += fmt::format("\\{:03o}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    return quoted + '"';
}

void put_change(std::string& out, const Change& change)
{
    const std::string old_path = shown_path("a/" + change.path);
    const std::string new_path = shown_path("b/" + change.path);
    const Lines before = lines_with_ends(change.before ? *change.before : std::string_view{});
    const Lines after = lines_with_ends(change.after ? *change.after : std::string_view{});
    const std::vector<Difference> all = Comparison{before, after}.run();
    const bool same_presence = change.before.has_value() == change.after.has_value();
    if (all.empty() && same_presence) return;

    out += fmt::format("diff --git {} {}\n", old_path, new_path);
    if (!change.before) out += "new file mode 100644\n";
    if (!change.after) out += "deleted file mode 100644\n";
    if (all.empty()) return;
    // A tab ends a name with blanks in it, as git writes it.
    const std::string_view tab = change.path.find(' ') == std::string::npos ? "" : "\t";
    out += change.before ? fmt::format("--- {}{}\n", old_path, tab) : "--- /dev/null\n";
    out += change.after ? fmt::format("+++ {}{}\n", new_path, tab) : "+++ /dev/null\n";
    for (std::size_t first = 0; first < all.size();) {
        std::size_t last = first + 1;
        while (last < all.size() && all[last].old_begin - all[last - 1].old_end <= 2 * context)
            ++last;
        put_hunk(out, before, after, all, first, last);
        first = last;
    }
}

}  // namespace

std::string unified_diff(const std::vector<Change>& changes)
{
    std::string out;
    for (const Change& change : changes) put_change(out, change);
    return out;
}

}  // namespace lobe::engine
