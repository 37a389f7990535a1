#include "base/diagnostic.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace lobe {
namespace {

struct Entry {
    std::string_view id;
    std::string_view summary;
};

constexpr std::array registry{
#define LOBE_DIAGNOSTIC(id, name, summary) Entry{id, summary},
#include "base/diagnostics.def"
#undef LOBE_DIAGNOSTIC
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_folded(std::string_view a, std::string_view b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

/// Damerau-Levenshtein distance with adjacent swaps (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

}  // namespace

std::string_view id(Code code) { return registry[static_cast<std::size_t>(code)].id; }

std::string_view summary(Code code) { return registry[static_cast<std::size_t>(code)].summary; }

Severity severity(Code code)
{
    return id(code).front() == 'W' ? Severity::warning : Severity::error;
}

std::optional<Code> find_code(std::string_view text)
{
    for (const Code code : all_codes())
        if (equal_folded(id(code), text)) return code;
    return std::nullopt;
}

const std::vector<Code>& all_codes()
{
    static const std::vector<Code> codes = [] {
        std::vector<Code> all;
        for (std::size_t i = 0; i < registry.size(); ++i) all.push_back(static_cast<Code>(i));
        return all;
    }();
    return codes;
}

void Diagnostics::report(Diagnostic diagnostic)
{
    if (severity(diagnostic.code) == Severity::error) ++errors_;
    all_.push_back(std::move(diagnostic));
}

std::vector<Diagnostic> Diagnostics::sorted() const
{
    auto result = all_;
    std::ranges::stable_sort(result, [](const Diagnostic& a, const Diagnostic& b) {
        return std::tuple{a.primary.span.source, a.primary.span.begin} <
               std::tuple{b.primary.span.source, b.primary.span.begin};
    });
    return result;
}

std::optional<std::string> nearest(std::string_view name,
                                   const std::vector<std::string>& candidates)
{
    // Names longer than this are not misspelt, they are wrong; and the distance is quadratic.
    constexpr std::size_t longest = 64;
    if (name.empty() || name.size() > longest) return std::nullopt;

    std::optional<std::string> best;
    std::size_t best_distance = 3;
    for (const auto& candidate : candidates) {
        if (candidate.size() > longest) continue;
        if (equal_folded(name, candidate)) return candidate;
        const std::size_t edits = distance(name, candidate);
        if (edits < best_distance && edits * 2 < name.size()) {
            best = candidate;
            best_distance = edits;
        }
    }
    return best;
}

}  // namespace lobe
