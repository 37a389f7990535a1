#include "engine/edits.h"

#include "engine/edit_words.h"
#include "engine/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <utility>

namespace lobe::engine {
namespace {

/// One line at a time. A statement that is wrong is reported and still takes its attributes, so
/// that all errors come out at once.
class Parser {
public:
    ParsedEdits run(std::string_view text)
    {
        for (const std::string_view line : split_lines(text)) {
            ++line_;
            if (!line.empty() && line.back() == '\r')
                statement(line.substr(0, line.size() - 1));
            else
                statement(line);
        }
        finish_edit();
        check_names();
        std::ranges::stable_sort(errors_, {}, &Error::first);
        for (const auto& [number, words] : errors_)
            result_.error += fmt::format("{}: {}\n", number, words);
        if (!errors_.empty()) result_.list = {};
        return std::move(result_);
    }

private:
    using Error = std::pair<int, std::string>;
    enum class About {
        nothing,
        file,
        query,
        edit,
        new_file
    };

    void fail(std::string words) { fail_at(line_, std::move(words)); }
    void fail_at(int line, std::string words) { errors_.emplace_back(line, std::move(words)); }

    Query& query() { return result_.list.queries.back(); }
    Edit& edit() { return result_.list.edits.back(); }
    TreeFile& file() { return result_.list.files.back(); }
    NewFile& new_file() { return result_.list.new_files.back(); }

    void statement(std::string_view line)
    {
        std::string_view rest = trimmed(line);
        if (rest.empty() || rest.starts_with('#')) return;
        if (rest.starts_with('|')) return text_line(line.substr(line.find('|') + 1));
        const std::string_view word = take_word(rest);
        if (!top_statement(word, rest) && !attribute(word, rest) && !edit_attribute(word, rest))
            fail(fmt::format("unknown word `{}`", word));
    }

    bool top_statement(std::string_view word, std::string_view rest)
    {
        if (word == "path")
            path(rest);
        else if (word == "supports")
            supports(rest);
        else if (word == "word")
            declare_word(rest);
        else if (word == "file")
            start_file(rest);
        else if (word == "edit")
            start_edit(rest);
        else if (word == "new")
            start_new_file(rest);
        else
            return question(word, rest);
        return true;
    }

    bool question(std::string_view word, std::string_view rest)
    {
        const auto kind = query_kind(word);
        if (!kind) return false;
        start(About::query);
        result_.list.queries.emplace_back();
        query().kind = *kind;
        query().line = line_;
        switch (query().kind) {
        case Query::Kind::at_most:
        case Query::Kind::equal: comparison(rest); return true;
        case Query::Kind::version:
            if (starts_as_number(rest)) {
                query().name = take_word(rest);
                if (!parse_version(query().name)) fail("a version reads 4.25");
            }
            break;
        case Query::Kind::probe:
        case Query::Kind::read:
        case Query::Kind::count:
            query().name = name_of(take_word(rest));
            (query().kind == Query::Kind::probe ? words_ : values_).push_back(query().name);
            break;
        case Query::Kind::demand:
        case Query::Kind::unique: query().why = quoted(rest); break;
        }
        query().file = current_file();
        query().anchor.pattern = rest;
        const int groups = check_pattern(rest);
        if (query().kind == Query::Kind::read && groups >= 0 && groups != 1)
            fail("`read` takes a value out of one group (make others `(?:…)`)");
        if (query().kind == Query::Kind::version && query().name.empty() && groups == 0)
            fail("`version` takes its numbers out of groups");
        return true;
    }

    void comparison(std::string_view rest)
    {
        query().left = take_word(rest);
        query().right = take_word(rest);
        query().why = quoted(rest);
        if (!rest.empty()) fail("this reads `at_most LIMIT VALUE \"why\"`");
    }

    void path(std::string_view rest)
    {
        start(About::nothing);
        const std::string name{name_of(take_word(rest))};
        if (rest.empty()) fail("`path` gives a short name to a folder");
        result_.list.folders[name] = rest;
    }

    void supports(std::string_view rest)
    {
        start(About::nothing);
        result_.list.first_version = parse_version(take_word(rest));
        result_.list.last_version = parse_version(rest);
        if (!result_.list.first_version || !result_.list.last_version)
            fail("this reads `supports 4.25 4.27`");
    }

    void declare_word(std::string_view rest)
    {
        start(About::nothing);
        words_.emplace_back(name_of(take_word(rest)));
        quoted(rest);
    }

    void start_file(std::string_view rest)
    {
        start(About::file);
        const std::string path = whole_path(rest);
        for (const TreeFile& other : result_.list.files)
            if (other.path == path) fail(fmt::format("`{}` comes twice", path));
        result_.list.files.push_back({path, false, {}, line_});
    }

    void start_edit(std::string_view rest)
    {
        start(About::edit);
        result_.list.edits.emplace_back();
        edit().line = line_;
        edit().name = name_of(take_word(rest));
        edit().purpose = quoted(rest);
        edit().file = current_file();
        for (const Edit& other : result_.list.edits)
            if (&other != &edit() && other.name == edit().name)
                fail(fmt::format("edit `{}` comes twice, before in line {}", other.name,
                                 other.line));
    }

    void start_new_file(std::string_view rest)
    {
        start(About::new_file);
        const std::string path = whole_path(take_word(rest));
        if (rest.empty()) fail("this reads `new PATH FROM`");
        result_.list.new_files.push_back({path, std::string{rest}, {}, line_});
    }

    bool attribute(std::string_view word, std::string_view rest)
    {
        if (word == "when" || word == "since" || word == "until") {
            Condition* condition = current_condition();
            if (condition == nullptr)
                fail(fmt::format("`{}` stands behind a question, `edit`, `file` or `new`", word));
            else if (word == "when")
                when(*condition, rest);
            else
                bound(word == "since" ? condition->since : condition->until, rest);
        } else if (word == "scope") {
            Anchor* anchor = current_anchor();
            if (anchor == nullptr) fail("`scope` stands behind a question with a REGEX or an edit");
            if (anchor != nullptr) once(anchor->scope, word, rest);
            check_pattern(rest);
        } else if (word == "hits") {
            hits(rest);
        } else if (word == "optional") {
            if (about_ != About::file || !rest.empty())
                fail("`optional` stands alone, behind `file`");
            else
                file().optional = true;
        } else if (word == "else") {
            if (about_ != About::query || query().kind != Query::Kind::read)
                fail("`else` stands behind `read`");
            else
                query().fallback = rest;
        } else {
            return false;
        }
        return true;
    }

    bool edit_attribute(std::string_view word, std::string_view rest)
    {
        const auto action = action_of(word);
        if (!action && word != "at" && word != "last" && word != "flush") return false;
        if (about_ != About::edit) {
            fail(fmt::format("`{}` stands behind `edit`", word));
        } else if (word == "at") {
            once(edit().anchor.pattern, word, rest);
            anchor_groups_ = check_pattern(rest);
        } else if (!rest.empty()) {
            fail(fmt::format("`{}` stands alone in its line", word));
        } else if (word == "last") {
            edit().last = true;
        } else if (word == "flush") {
            edit().flush = true;
        } else {
            if (has_action_) fail("an edit has one action");
            has_action_ = true;
            edit().action = *action;
        }
        return true;
    }

    void text_line(std::string_view text)
    {
        if (about_ != About::edit) return fail("a line of text stands behind an action");
        if (text.starts_with(' ')) text.remove_prefix(1);
        edit().text += text;
        edit().text += '\n';
        has_text_ = true;
    }

    void when(Condition& condition, std::string_view rest)
    {
        if (rest.empty()) fail("`when` names words");
        while (!rest.empty()) {
            std::string_view word = take_word(rest);
            const bool negated = word.starts_with('!');
            if (negated) word.remove_prefix(1);
            asked_words_.emplace_back(line_, std::string{word});
            (negated ? condition.not_set : condition.set).emplace_back(word);
        }
    }

    void bound(std::optional<Version>& version, std::string_view text)
    {
        version = parse_version(text);
        if (!version) fail("a version reads 4.25");
    }

    void hits(std::string_view rest)
    {
        const bool possible = about_ == About::edit ||
                              (about_ == About::query && query().kind == Query::Kind::demand);
        if (!possible) return fail("`hits` stands behind `assert` or an edit");
        Anchor& anchor = *current_anchor();
        if (!read_hits(rest, anchor.least_hits, anchor.most_hits))
            fail("this reads `hits 2` or `hits 0..1`");
    }

    void once(std::string& field, std::string_view word, std::string_view value)
    {
        if (!field.empty()) fail(fmt::format("`{}` comes twice", word));
        field = value;
    }

    /// Ends what was open.
    void start(About about)
    {
        finish_edit();
        about_ = about;
        has_action_ = false;
        has_text_ = false;
        anchor_groups_ = -1;
    }

    void finish_edit()
    {
        if (about_ != About::edit) return;
        Edit& done = edit();
        if (done.last) {
            done.anchor.least_hits = std::min(done.anchor.least_hits, 1);
            done.anchor.most_hits = INT_MAX;
        }
        const auto missing = [&](std::string_view what) {
            fail_at(done.line, fmt::format("edit `{}` has no {}", done.name, what));
        };
        if (done.anchor.pattern.empty()) missing("`at`");
        if (!has_action_) missing("action: before, after, replace, append or clone");
        if (!has_text_) missing("text: lines behind `|`");
        const bool needs_group = done.action == Action::append || done.action == Action::clone;
        if (has_action_ && needs_group && anchor_groups_ == 0)
            missing("group in its anchor that says where the text goes");
    }

    /// The words of `when` and the values that are compared.
    void check_names()
    {
        const auto declared = [](const std::vector<std::string>& names, std::string_view name) {
            return std::ranges::find(names, name) != names.end();
        };
        for (const auto& [line, word] : asked_words_)
            if (!declared(words_, word))
                fail_at(line, fmt::format("nothing declares the word `{}`", word));
        for (const Query& asked : result_.list.queries) {
            if (asked.kind != Query::Kind::at_most && asked.kind != Query::Kind::equal) continue;
            for (const std::string& operand : {asked.left, asked.right}) {
                std::string_view name = operand;
                if (name.ends_with("_plus_1")) name.remove_suffix(7);
                if (!starts_as_number(name) && !declared(values_, name) &&
                    !declared(values_, operand))
                    fail_at(asked.line, fmt::format("nothing reads a value `{}`", operand));
            }
        }
    }

    /// The groups of a pattern; -1 if it is none.
    int check_pattern(std::string_view text)
    {
        const PatternCheck checked = check_pattern_text(text);
        if (!checked.error.empty()) fail(checked.error);
        return checked.groups;
    }

    std::string_view name_of(std::string_view word)
    {
        if (!is_name(word)) fail(fmt::format("`{}` is no name: letters, digits and _", word));
        return word;
    }

    std::string quoted(std::string_view& rest)
    {
        const auto words = take_quoted(rest);
        if (!words) fail("words for people in quotes are missing");
        return words.value_or("");
    }

    std::string whole_path(std::string_view path)
    {
        const auto slash = path.find('/');
        const auto& folders = result_.list.folders;
        if (slash != std::string_view::npos)
            if (const auto found = folders.find(path.substr(0, slash)); found != folders.end())
                return fmt::format("{}{}", found->second, path.substr(slash));
        if (path.empty()) fail("a path is missing");
        return std::string{path};
    }

    int current_file()
    {
        if (result_.list.files.empty()) fail("this stands behind a `file`");
        return static_cast<int>(result_.list.files.size()) - 1;
    }

    Condition* current_condition()
    {
        switch (about_) {
        case About::file: return &file().condition;
        case About::query: return &query().condition;
        case About::edit: return &edit().condition;
        case About::new_file: return &new_file().condition;
        case About::nothing: break;
        }
        return nullptr;
    }

    Anchor* current_anchor()
    {
        if (about_ == About::edit) return &edit().anchor;
        return about_ == About::query && query().file >= 0 ? &query().anchor : nullptr;
    }

    ParsedEdits result_;
    std::vector<Error> errors_;
    int line_ = 0;
    std::vector<std::string> words_;
    std::vector<std::string> values_;
    std::vector<std::pair<int, std::string>> asked_words_;
    About about_ = About::nothing;
    bool has_action_ = false;
    bool has_text_ = false;
    int anchor_groups_ = -1;
};

}  // namespace

ParsedEdits parse_edits(std::string_view text) { return Parser{}.run(text); }

}  // namespace lobe::engine
