// What is changed in an engine's source tree, as data: where each edit goes and what it says.
//
// The list itself is a text (templates/ue4/engine.edits), so that an engine version that moves a
// line is one line of data. Nothing of an engine is in it but names and single-line anchors. One
// statement per line; indentation means nothing; a line that starts with `#` is a remark. REGEX is
// the rest of the line, TEXT too; words have no blanks in them; people's words are in quotes.
//
//   path SH Engine/Shaders/Private      SH/x is Engine/Shaders/Private/x from here on
//   supports 4.25 4.27                  the first and the last version that the list knows
//   word carrier_f_a "F.a is used"      a word that `when` may ask for: set by the request
//
//   file SH/ShadingCommon.ush           what follows is about this file, up to the next `file`
//     optional                          the tree may lack it: then what follows is skipped
//
// Questions, answered before any edit, in this order of kinds:
//
//   version REGEX                       of the engine: the groups of the one hit, joined by dots
//   version 4.25 REGEX                  or: it is 4.25 if this hits. The first that hits counts
//   probe WORD REGEX                    declares a word and sets it if there is a hit
//   read NAME REGEX                     a value: group 1 of the one hit
//     else TEXT                         the value if there is no hit, or no such file
//   count NAME REGEX                    a value: the number of hits
//   assert "why" REGEX                  must hit, once or as `hits` says; else refused: "why"
//   unique "why" REGEX                  must not hit: `SHADINGMODELID_${MODEL}\b`
//   at_most LIMIT VALUE "why"           VALUE <= LIMIT. Each is a number (12, 0xF) or a value's
//   name equal VALUE VALUE "why"
//
//   edit shading_model_id "the id"      a name, unique in the list, and what it is for people
//     at REGEX                          the anchor
//     last                              several hits are fine, the last one counts
//     flush                             the text keeps to the left margin; without this it gets
//                                       the indentation of the anchor's line
//     before | after                    the text goes before or after the lines of the anchor
//     replace                           the anchor becomes the text; what else stands on its lines
//                                       stays
//     append                            the text goes into the line, in front of the anchor's
//                                       group 1; its lines are joined without anything between
//     clone                             a copy of the anchor's lines follows them, in which the
//                                       text is in the place of group 1; text as for `append`
//     | #define SHADINGMODELID_${MODEL}  the text, each line behind a `|` and one blank
//
//   new SH/${Model}.ush FROM            a whole file: the generated artifact or template FROM
//
// Behind any question, edit, `file` or `new` (for `file`: it holds for all that is about the file):
//
//     when carrier_f_a !has_node        only if these words are set, and those with ! are not
//     since 4.26  until 4.25            only from or up to this version, itself included
//
// and behind a question with a REGEX or an edit:
//
//     scope REGEX                       only from the line that this hits to the brace that closes
//                                       it. Declarations (a `;` comes before the `{`) do not count
//     hits 2  hits 0..1                 how often the anchor must hit (default 1)
//
// Regular expressions are RE2's with multi-line ^ and $, on text with LF line ends; none may match
// nothing. A hit that starts within a comment is none, so code that was commented out disturbs
// nobody. The lines of a hit are those that its first to last printing character are on: blanks
// at its ends do not matter. All anchors see the tree without the model's edits.
//
// `${name}` in a REGEX is replaced by the quoted value. Texts are rendered as templates are
// (emit/template.h: `//% for`; an edit whose text comes out empty is no edit, except `replace`).
// They get the request's values, and
//
//   ${Model} ${MODEL}                   the model's name, and in capitals
//   ${next_id} ${next_id_plus_1}        values read or counted, and their successors if numbers
//   ${0} ${1} …                         what the anchor and its groups matched
//
// PATH and FROM of `new` get all but the groups.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

/// Major and minor, as 4.27.
struct Version {
    int major = 0;
    int minor = 0;
    friend auto operator<=>(const Version&, const Version&) = default;
};
std::optional<Version> parse_version(std::string_view text);

/// When something of the list is asked for.
struct Condition {
    std::vector<std::string> set;      ///< words that must be set
    std::vector<std::string> not_set;  ///< and these must not
    std::optional<Version> since;
    std::optional<Version> until;
};

/// Where to look in a file.
struct Anchor {
    std::string pattern;
    std::string scope;  ///< empty: the whole file
    int least_hits = 1;
    int most_hits = 1;
};

struct Query {
    enum class Kind {
        version,
        probe,
        read,
        count,
        demand,  ///< `assert`
        unique,
        at_most,
        equal
    };
    Kind kind{};
    std::string name;                     ///< of the word or the value; a version that is fixed
    std::string why;                      ///< for people
    std::string left;                     ///< of `at_most` and `equal`: a number or a name
    std::string right;                    ///< "at most left", "equal to left"
    std::optional<std::string> fallback;  ///< `else`
    int file = -1;                        ///< in EditList::files; -1 for at_most and equal
    Anchor anchor;
    Condition condition;
    int line = 0;  ///< in the list
};

enum class Action {
    before,
    after,
    replace,
    append,
    clone
};

struct Edit {
    std::string name;
    std::string purpose;
    int file = -1;  ///< in EditList::files
    Anchor anchor;
    Condition condition;
    bool last = false;
    bool flush = false;
    Action action{};
    std::string text;
    int line = 0;
};

struct NewFile {
    std::string path;
    std::string from;
    Condition condition;
    int line = 0;
};

struct TreeFile {
    std::string path;  ///< from the root of the tree
    bool optional = false;
    Condition condition;
    int line = 0;
};

struct EditList {
    std::map<std::string, std::string, std::less<>> folders;  ///< by the names that `path` gives
    std::vector<TreeFile> files;
    std::vector<Query> queries;
    std::vector<Edit> edits;
    std::vector<NewFile> new_files;
    std::optional<Version> first_version;
    std::optional<Version> last_version;
};

/// The list, or all that is wrong with it, a line `number: words` each.
struct ParsedEdits {
    EditList list;
    std::string error;
};
ParsedEdits parse_edits(std::string_view text);

}  // namespace lobe::engine
