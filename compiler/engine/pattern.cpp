#include "engine/pattern.h"

#include <fmt/format.h>
#include <re2/re2.h>

#include <algorithm>

namespace lobe::engine {
namespace {

re2::RE2::Options options()
{
    re2::RE2::Options result;
    result.set_encoding(re2::RE2::Options::EncodingLatin1);
    result.set_log_errors(false);
    return result;
}

bool is_comment(Part part) { return part == Part::line_comment || part == Part::block_comment; }

template <class Write>
Substituted substitute_with(std::string_view text, const ValueOf& value_of, const Write& write)
{
    Substituted result;
    for (;;) {
        const auto begin = text.find("${");
        result.text += text.substr(0, begin);
        if (begin == std::string_view::npos) return result;
        const auto end = text.find('}', begin);
        const std::string_view name = text.substr(begin + 2, end - begin - 2);
        const auto value = end == std::string_view::npos ? std::nullopt : value_of(name);
        if (!value) {
            result.error = end == std::string_view::npos ? "`${` without its `}`"
                                                         : fmt::format("no value `{}`", name);
            return result;
        }
        result.text += write(*value);
        text.remove_prefix(end + 1);
    }
}

}  // namespace

Substituted substitute(std::string_view text, const ValueOf& value_of)
{
    return substitute_with(text, value_of, [](const std::string& value) { return value; });
}

Substituted substitute_quoted(std::string_view pattern, const ValueOf& value_of)
{
    return substitute_with(pattern, value_of,
                           [](const std::string& value) { return re2::RE2::QuoteMeta(value); });
}

Pattern::Pattern(std::string_view text)
    : expression_(std::make_unique<re2::RE2>(fmt::format("(?m){}", text), options()))
{
}

Pattern::~Pattern() = default;

std::string Pattern::error() const { return expression_->error(); }

int Pattern::groups() const { return expression_->NumberOfCapturingGroups(); }

bool Pattern::matches_nothing() const
{
    return expression_->ok() && re2::RE2::PartialMatch("", *expression_);
}

std::vector<Hit> Pattern::find_all(std::string_view text, const std::vector<Part>& parts,
                                   Stretch where) const
{
    std::vector<Hit> hits;
    const re2::StringPiece all{text.data(), text.size()};
    std::vector<re2::StringPiece> found(static_cast<std::size_t>(groups()) + 1);
    while (where.begin < where.end &&
           expression_->Match(all, where.begin, where.end, re2::RE2::UNANCHORED, found.data(),
                              static_cast<int>(found.size()))) {
        const auto start = static_cast<std::size_t>(found[0].data() - text.data());
        if (is_comment(parts[start])) {
            where.begin = start;
            while (where.begin < where.end && is_comment(parts[where.begin])) ++where.begin;
            continue;
        }
        Hit hit;
        for (const re2::StringPiece& piece : found)
            if (piece.data() == nullptr) {
                hit.push_back(std::nullopt);
            } else {
                const auto begin = static_cast<std::size_t>(piece.data() - text.data());
                hit.push_back(Stretch{begin, begin + piece.size()});
            }
        // A hit without text comes only from assertions, as `\b`; the search goes on behind it.
        where.begin = std::max(hit[0]->end, start + 1);
        hits.push_back(std::move(hit));
    }
    return hits;
}

}  // namespace lobe::engine
