#include "emit/template.h"

#include "base/embedded.h"
#include "base/hash_index.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <functional>

namespace lobe::emit {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view without_trailing_blanks(std::string_view text)
{
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::size_t indent_of(std::string_view text)
{
    std::size_t indent = 0;
    while (indent < text.size() && is_blank(text[indent])) ++indent;
    return indent;
}

std::string_view trim(std::string_view text)
{
    return without_trailing_blanks(text.substr(indent_of(text)));
}

std::vector<std::string_view> split(std::string_view text, char separator)
{
    std::vector<std::string_view> parts;
    for (;;) {
        const auto end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

/// Which values were asked for: membership only, by address.
class Used {
public:
    void insert(const void* value)
    {
        if (contains(value)) return;
        index_.add(hash(value), values_.size());
        values_.push_back(value);
    }
    bool contains(const void* value) const
    {
        return index_
            .find(hash(value), [&](std::uint32_t position) { return values_[position] == value; })
            .has_value();
    }

private:
    static std::size_t hash(const void* value)
    {
        return mix_hash(0, std::hash<const void*>{}(value));
    }

    std::vector<const void*> values_;
    HashIndex index_;
};

class Renderer {
public:
    Renderer(std::string_view name, std::string_view text, const Record& values)
        : name_(name), lines_(split(text, '\n')), values_(values)
    {
        if (!lines_.empty() && lines_.back().empty()) lines_.pop_back();
    }

    Rendered run(Unused unused)
    {
        const std::size_t end = block(0, true);
        if (ok() && end < lines_.size()) fail(end, "`end` without `for`");
        std::vector<std::string_view> path;
        if (ok() && unused == Unused::an_error) find_unused(values_, path);
        if (!ok()) result_.text.clear();
        return std::move(result_);
    }

private:
    bool ok() const { return result_.error.empty(); }

    void fail(std::size_t line, std::string what)
    {
        if (ok()) result_.error = fmt::format("{}:{}: {}", name_, line + 1, what);
    }

    /// Renders (or, when not live, skips) lines from `at` up to an `end` or the last line, and
    /// returns where it stopped.
    std::size_t block(std::size_t at, bool live)
    {
        while (ok() && at < lines_.size()) {
            const std::string_view line = trim(lines_[at]);
            if (!line.starts_with("//%")) {
                if (live) text_line(at);
                ++at;
                continue;
            }
            const std::string_view directive = trim(line.substr(3));
            if (directive.starts_with('#'))
                ++at;
            else if (directive == "end")
                return at;
            else if (directive.starts_with("for "))
                at = loop(at, directive, live);
            else
                fail(at, fmt::format("unknown directive `{}`", directive));
        }
        return at;
    }

    std::size_t loop(std::size_t at, std::string_view directive, bool live)
    {
        const auto words = split(directive, ' ');
        if (words.size() != 4 || words[2] != "in") {
            fail(at, "a loop reads `for x in xs`");
            return at;
        }
        const std::vector<Record>* list = live ? find_list(words[3], at) : nullptr;
        std::size_t end = at + 1;
        if (list == nullptr || list->empty()) {
            end = block(at + 1, false);
        } else {
            for (const Record& record : *list) {
                const int first = line_;
                scopes_.emplace_back(words[1], &record);
                end = block(at + 1, true);
                scopes_.pop_back();
                if (record.tag >= 0 && line_ > first)
                    result_.marks.push_back({record.tag, first, line_ - 1});
            }
        }
        if (ok() && end >= lines_.size()) fail(at, "`for` without `end`");
        return end + 1;
    }

    void text_line(std::size_t at)
    {
        const std::string_view line = lines_[at];
        const std::string_view bare = trim(line);
        const bool alone =
            bare.starts_with("${") && bare.ends_with('}') && bare.find('}') == bare.size() - 1;
        if (alone) {
            const std::string* value = find_text(bare.substr(2, bare.size() - 3), at);
            if (value == nullptr || value->empty()) return;
            const std::string_view indent = line.substr(0, indent_of(line));
            for (const std::string_view part : split(*value, '\n')) {
                if (!part.empty()) result_.text += indent;
                put(part);
            }
            return;
        }

        std::string& text = scratch_;
        text.clear();
        std::string_view rest = line;
        for (;;) {
            const auto begin = rest.find("${");
            text += rest.substr(0, begin);
            if (begin == std::string_view::npos) break;
            const auto end = rest.find('}', begin);
            if (end == std::string_view::npos) return fail(at, "`${` without `}`");
            const std::string* value = find_text(rest.substr(begin + 2, end - begin - 2), at);
            if (value == nullptr) return;
            if (value->find('\n') != std::string::npos)
                return fail(at, "a value of many lines must stand alone on its line");
            text += *value;
            rest.remove_prefix(end + 1);
        }
        put(without_trailing_blanks(text));
    }

    void put(std::string_view line)
    {
        result_.text += line;
        result_.text += '\n';
        ++line_;
    }

    /// The record a path starts from, and its last name.
    std::pair<const Record*, std::string_view> resolve(std::string_view path)
    {
        const auto dot = path.find('.');
        if (dot == std::string_view::npos) return {&values_, path};
        for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
            if (scope->first == path.substr(0, dot)) return {scope->second, path.substr(dot + 1)};
        return {nullptr, path};
    }

    const std::string* find_text(std::string_view path, std::size_t at)
    {
        const auto [record, field] = resolve(path);
        if (record != nullptr)
            if (const std::string* found = record->texts.find(field)) {
                used_.insert(found);
                return found;
            }
        fail(at, fmt::format("unknown name `{}`", path));
        return nullptr;
    }

    const std::vector<Record>* find_list(std::string_view path, std::size_t at)
    {
        const auto [record, field] = resolve(path);
        if (record != nullptr)
            if (const std::vector<Record>* found = record->lists.find(field)) {
                used_.insert(found);
                return found;
            }
        fail(at, fmt::format("unknown list `{}`", path));
        return nullptr;
    }

    /// `path` are the names of the lists that lead here.
    void find_unused(const Record& record, std::vector<std::string_view>& path)
    {
        const auto unused = [&](const std::string& field) {
            std::string lists;
            for (const std::string_view list : path) lists += fmt::format("{}.", list);
            if (ok()) result_.error = fmt::format("{}: unused value `{}{}`", name_, lists, field);
        };
        for (const auto& [field, text] : record.texts)
            if (!used_.contains(&text)) unused(field);
        for (const auto& [field, list] : record.lists) {
            if (!used_.contains(&list)) unused(field);
            path.push_back(field);
            for (const Record& element : list) find_unused(element, path);
            path.pop_back();
        }
    }

    std::string_view name_;
    std::vector<std::string_view> lines_;
    const Record& values_;
    std::vector<std::pair<std::string_view, const Record*>> scopes_;
    Used used_;
    std::string scratch_;  // the line on its way
    int line_ = 1;
    Rendered result_;
};

}  // namespace

Rendered render(std::string_view name, std::string_view text, const Record& values, Unused unused)
{
    return Renderer{name, text, values}.run(unused);
}

std::optional<std::string_view> embedded_template(std::string_view path)
{
    for (const Embedded& file : embedded_templates())
        if (file.name == path) return file.text;
    return std::nullopt;
}

Rendered render_embedded(std::string_view path, const Record& values)
{
    const auto text = embedded_template(path);
    Rendered result;
    if (!text)
        result.error = fmt::format("templates/{}: no such template", path);
    else
        result = render(fmt::format("templates/{}", path), *text, values);
    if (!result.error.empty()) {
        fmt::print(stderr, "{}\n", result.error);
        std::abort();
    }
    return result;
}

}  // namespace lobe::emit
