// What is changed in an engine's source tree, as data: where each edit goes and what it says.
//
// The list itself is a text (templates/ue4/engine.edits), so that an engine version that moves a
// line is one line of data. Nothing of an engine is in it but names and single-line anchors.
//
//   # remark
//   path SH Engine/Shaders/Private            a short name for a folder, at the start of paths
//
//   file SH/ShadingCommon.ush                 a file that edits and reads below are about
//   optional                                  the tree may lack it
//
//   read next_id REGEX                        a value of the tree: the one group of its one hit
//   assert "why" REGEX                        must hit exactly once; else refused with the words
//   unique "why" REGEX                        must not hit: `SHADINGMODELID_${MODEL}\b`
//
//   edit shading_model_id "the id"            a name, unique in the list, and what it is for people
//   when carrier_f_a                          only if this word is set (several: all of them)
//   scope REGEX                               only from this line to the brace that closes it
//   at REGEX                                  the anchor
//   hits 1                                    how often it must hit (default 1); `0..1`: may be
//   absent last                                      several hits are fine; the last one counts do
//   before | after | replace | append | clone | text, with ${values} and //% for        lines to
//   insert; for `append`, the text to insert
//
//   before, after   whole lines before or after the line(s) that the anchor hits
//   replace         the line(s) of the anchor become the text; ${0}, ${1} … are its groups
//   append          the text goes into the line, in front of group 1 of the anchor
//   clone           the anchor's line, followed by a copy in which group 1 is replaced by the text
//
//   new SH/${Model}.ush FROM                  a whole file: the generated artifact or template FROM
//
// Regular expressions are RE2's, with multi-line ^ and $; they match the text with LF line ends.
// `${name}` in them is replaced by the quoted value.
#pragma once

#include "base/embedded.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

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
    std::string file;               ///< whole path, from the root of the tree
    std::vector<std::string> when;  ///< words that must be set
    std::string scope;              ///< empty: the whole file
    std::string anchor;
    int least_hits = 1;
    int most_hits = 1;
    bool last = false;
    Action action{};
    std::string text;
    int line = 0;  ///< in the list
};

/// `read`, `assert`, `unique`
struct Query {
    enum class Kind {
        read,
        demand,
        unique
    };
    Kind kind{};
    std::string name;  ///< of the value; for the others the words for people
    std::string file;
    std::vector<std::string> when;
    std::string scope;
    std::string anchor;
    int line = 0;
};

struct NewFile {
    std::string path;
    std::vector<std::string> when;
    std::string from;
    int line = 0;
};

struct TreeFile {
    std::string path;
    bool optional = false;
};

struct EditList {
    std::vector<TreeFile> files;
    std::vector<Query> queries;
    std::vector<Edit> edits;
    std::vector<NewFile> new_files;
};

/// The list, or what is wrong with it as `line: words`.
struct ParsedEdits {
    EditList list;
    std::string error;
};
ParsedEdits parse_edits(std::string_view text);

}  // namespace lobe::engine
