#include "engine/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace lobe::engine {
namespace {

using Kind = Query::Kind;

bool contains(const std::vector<std::string>& list, const std::string& item)
{
    return std::ranges::find(list, item) != list.end();
}

std::string shown(const Version& version)
{
    return fmt::format("{}.{}", version.major, version.minor);
}

/// `12` and `0xF`
std::optional<long long> number_of(std::string_view text)
{
    const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    if (hexadecimal) text.remove_prefix(2);
    long long value = 0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, hexadecimal ? 16 : 10);
    if (error != std::errc{} || end != text.data() + text.size() || text.starts_with('-') ||
        value == std::numeric_limits<long long>::max())
        return std::nullopt;
    return value;
}

/// Asks one question after another.
class Questioner {
public:
    Questioner(const EditList& list, const SearchedFiles& files, Answers& answers,
               std::vector<Obstacle>& obstacles)
        : list_(list), files_(files), answers_(answers), obstacles_(obstacles)
    {
    }

    bool version()
    {
        std::string looked_in;
        const Query* asked = nullptr;
        int line = 0;
        for (const Query& query : list_.queries) {
            if (query.kind != Kind::version) continue;
            asked = &query;
            if (!looked_in.empty()) looked_in += ", ";
            looked_in += path(query);
            if (!is_asked(query)) continue;
            const auto hits = hits_of(query);
            if (!hits || hits->size() != 1) continue;
            answers_.version_text =
                query.name.empty() ? joined_groups(query, hits->front()) : query.name;
            answers_.version = parse_version(answers_.version_text);
            line = file(query).shown_line(lines_of(file(query), *hits->front()[0]).first);
            if (answers_.version) break;
        }
        if (looked_in.empty()) return true;
        if (!answers_.version) {
            fail(*asked, 0, "the engine's version cannot be told",
                 fmt::format("it is looked for in {}", looked_in));
            return false;
        }
        if ((list_.first_version && *answers_.version < *list_.first_version) ||
            (list_.last_version && *answers_.version > *list_.last_version)) {
            fail(*asked, line, fmt::format("this is engine {}", answers_.version_text),
                 fmt::format("patches are known for {} to {}", shown(*list_.first_version),
                             shown(*list_.last_version)));
            return false;
        }
        return true;
    }

    void probes()
    {
        for (const Query& query : list_.queries) {
            if (query.kind != Kind::probe || !is_asked(query)) continue;
            const auto hits = hits_of(query, Missing::scope_is_fine);
            if (hits && !hits->empty()) answers_.words.push_back(query.name);
        }
    }

    void values()
    {
        for (const Query& query : list_.queries) {
            if (query.kind != Kind::read && query.kind != Kind::count) continue;
            const TreeFile& listed = list_.files[static_cast<std::size_t>(query.file)];
            if (!holds(query.condition, answers_) || !holds(listed.condition, answers_)) continue;
            if (files_[static_cast<std::size_t>(query.file)])
                set_value(query, query.kind == Kind::read ? read(query) : count(query));
            else if (query.fallback || !listed.optional)
                set_value(query, query.fallback);
        }
    }

    void demands()
    {
        for (const Query& query : list_.queries) {
            const bool compares = query.kind == Kind::at_most || query.kind == Kind::equal;
            if (compares && holds(query.condition, answers_)) compare(query);
            if (query.kind == Kind::demand && is_asked(query)) demand(query);
            if (query.kind == Kind::unique && is_asked(query)) unique(query);
        }
    }

private:
    enum class Missing {
        is_an_obstacle,
        scope_is_fine
    };

    const std::string& path(const Query& query) const
    {
        return list_.files[static_cast<std::size_t>(query.file)].path;
    }

    const Searched& file(const Query& query) const
    {
        return *files_[static_cast<std::size_t>(query.file)];
    }

    bool is_asked(const Query& query) const
    {
        return is_active(list_, files_, query.file, answers_) && holds(query.condition, answers_);
    }

    /// Nothing if the scope is not there; that has been said then.
    std::optional<std::vector<Hit>> hits_of(const Query& query,
                                            Missing missing = Missing::is_an_obstacle)
    {
        Search found = search(file(query), query.anchor, value_of(answers_.record));
        if (found.obstacle) {
            if (missing == Missing::is_an_obstacle) {
                found.obstacle->edit = query.name;
                obstacles_.push_back(std::move(*found.obstacle));
            }
            return std::nullopt;
        }
        return std::move(found.hits);
    }

    std::string joined_groups(const Query& query, const Hit& hit) const
    {
        std::string text;
        for (std::size_t group = 1; group < hit.size(); ++group) {
            if (!hit[group]) continue;
            if (!text.empty()) text += '.';
            text += file(query).at(*hit[group]);
        }
        return text;
    }

    std::optional<std::string> read(const Query& query)
    {
        const auto hits = hits_of(query);
        if (!hits) return std::nullopt;
        if (hits->size() == 1 && hits->front()[1]) {
            places_.push_back(
                {&query, file(query).shown_line(file(query).line_at(hits->front()[1]->begin))});
            return std::string{file(query).at(*hits->front()[1])};
        }
        if (hits->empty() && query.fallback) return query.fallback;
        fail(query,
             hits->empty() ? "this value is not there"
                           : fmt::format("this value is there {}", shown_hits(file(query), *hits)),
             fmt::format("look for it in the file, and change line {} of the list", query.line),
             *hits);
        return std::nullopt;
    }

    std::optional<std::string> count(const Query& query)
    {
        const auto hits = hits_of(query);
        return hits ? std::optional{fmt::format("{}", hits->size())} : std::nullopt;
    }

    /// Without a value there is an obstacle; what asks for it gets 0, so that it is the only one.
    void set_value(const Query& query, const std::optional<std::string>& value)
    {
        const std::string text = value.value_or("0");
        const auto known = std::ranges::find(answers_.values, query.name,
                                             &std::pair<std::string, std::string>::first);
        if (known == answers_.values.end())
            answers_.values.emplace_back(query.name, text);
        else if (value && known->second != text)
            fail(query,
                 fmt::format("`{}` is {} here and {} elsewhere", query.name, text, known->second),
                 "make them agree");
        answers_.record.texts[query.name] = text;
        if (const auto number = number_of(text))
            answers_.record.texts[query.name + "_plus_1"] = fmt::format("{}", *number + 1);
        if (!value) unknown_.push_back(query.name);
    }

    std::optional<long long> operand(const std::string& text) const
    {
        const std::string* value = answers_.record.texts.find(text);
        return number_of(value != nullptr ? *value : text);
    }

    static bool is_of(const std::string& operand, const std::string& value)
    {
        return operand == value || operand == value + "_plus_1";
    }

    bool is_unknown(const std::string& name) const
    {
        return std::ranges::any_of(
            unknown_, [&](const std::string& unknown) { return is_of(name, unknown); });
    }

    void compare(const Query& query)
    {
        if (is_unknown(query.left) || is_unknown(query.right)) return;
        const auto left = operand(query.left);
        const auto right = operand(query.right);
        const auto shown_operand = [](const std::string& name, std::optional<long long> value) {
            if (number_of(name)) return name;
            return value ? fmt::format("`{}` = {}", name, *value)
                         : fmt::format("`{}`, which is no number", name);
        };
        const bool fine =
            left && right && (query.kind == Kind::at_most ? *right <= *left : *right == *left);
        const auto place = std::ranges::find_if(places_, [&](const Place& known) {
            return is_of(query.right, known.query->name) || is_of(query.left, known.query->name);
        });
        const bool has_place = place != places_.end();
        if (!fine)
            fail(has_place ? *place->query : query, has_place ? place->line : 0,
                 fmt::format("{}: {} should be {} {}", query.why, shown_operand(query.right, right),
                             query.kind == Kind::at_most ? "at most" : "equal to",
                             shown_operand(query.left, left)),
                 "make room in the engine first: its models and this one do not fit together");
    }

    void demand(const Query& query)
    {
        const auto hits = hits_of(query);
        if (!hits) return;
        const auto least = static_cast<std::size_t>(query.anchor.least_hits);
        const auto most = static_cast<std::size_t>(query.anchor.most_hits);
        if (hits->size() >= least && hits->size() <= most) return;
        const std::string seen =
            hits->empty() ? "not found" : fmt::format("found {}", shown_hits(file(query), *hits));
        fail(query, fmt::format("{}: {}", query.why, seen),
             fmt::format("line {} of the list asks for it; the edits are right only with it",
                         query.line),
             *hits);
    }

    void unique(const Query& query)
    {
        const auto hits = hits_of(query);
        if (!hits || hits->empty()) return;
        const bool one = hits->size() == 1;
        fail(query,
             fmt::format("{}: `{}` is taken, in line{} {}", query.why,
                         file(query).at(*hits->front()[0]), one ? "" : "s",
                         shown_lines(file(query), *hits)),
             "take it out if a model was added by hand there, or rename yours", *hits);
    }

    void fail(const Query& query, std::string what, std::string help,
              const std::vector<Hit>& hits = {})
    {
        const bool is_somewhere = query.file >= 0 && !hits.empty();
        fail(query,
             is_somewhere ? file(query).shown_line(lines_of(file(query), *hits[0][0]).first) : 0,
             std::move(what), std::move(help));
    }

    void fail(const Query& query, int line, std::string what, std::string help)
    {
        obstacles_.push_back({query.file >= 0 ? path(query) : std::string{}, line, query.name,
                              query.anchor.pattern, std::move(what), std::move(help)});
    }

    const EditList& list_;
    const SearchedFiles& files_;
    Answers& answers_;
    std::vector<Obstacle>& obstacles_;
    struct Place {
        const Query* query;
        int line;
    };
    std::vector<Place> places_;  // of the values that were read
    std::vector<std::string> unknown_;
};

}  // namespace

bool holds(const Condition& condition, const Answers& answers)
{
    const auto is_set = [&](const std::string& word) { return contains(answers.words, word); };
    if (condition.since && !(answers.version && *answers.version >= *condition.since)) return false;
    if (condition.until && !(answers.version && *answers.version <= *condition.until)) return false;
    return std::ranges::all_of(condition.set, is_set) &&
           std::ranges::none_of(condition.not_set, is_set);
}

bool is_active(const EditList& list, const SearchedFiles& files, int file, const Answers& answers)
{
    const auto index = static_cast<std::size_t>(file);
    return file >= 0 && files[index] && holds(list.files[index].condition, answers);
}

Answers first_answers(const Request& request)
{
    Answers answers;
    answers.words = request.words;
    answers.record = request.values;
    std::string capitals = request.model;
    for (char& c : capitals)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    for (const auto& [name, value] : {std::pair{"Model", request.model}, {"MODEL", capitals}})
        if (answers.record.texts.find(name) == nullptr) answers.record.texts[name] = value;
    return answers;
}

ValueOf value_of(const emit::Record& record)
{
    return [&record](std::string_view name) -> std::optional<std::string> {
        const std::string* value = record.texts.find(name);
        return value != nullptr ? std::optional{*value} : std::nullopt;
    };
}

bool ask_what_it_is(const EditList& list, const SearchedFiles& files, Answers& answers,
                    std::vector<Obstacle>& obstacles)
{
    Questioner questioner{list, files, answers, obstacles};
    if (!questioner.version()) return false;
    questioner.probes();
    return true;
}

void ask_for_values(const EditList& list, const SearchedFiles& files, Answers& answers,
                    std::vector<Obstacle>& obstacles)
{
    Questioner questioner{list, files, answers, obstacles};
    questioner.values();
    questioner.demands();
}

}  // namespace lobe::engine
