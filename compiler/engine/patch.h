// An engine's tree and what a model wants of it in; the changed files, or everything that stands in
// the way, out. Knows text, no .lobe: values come as words and strings.
//
// Every edit is a region of its own, between marked lines:
//
//   // BEGIN lobe Callisto 3/41 shading_model_id 5f2c01ab
//   //- #define SHADINGMODELID_NUM   12          what stood here, if anything did
//   #define SHADINGMODELID_CALLISTO  12
//   #define SHADINGMODELID_NUM       13
//   // END lobe Callisto shading_model_id
//
// so a tree can be brought back to its bytes from itself alone. 3/41 counts the regions of the
// model over the whole tree: fewer than 41 are a patch that was applied in half. The last word is
// the hash of the lines inside; another hash is a hand that edited them. Regenerating takes
// all regions of the model out and puts them in anew; nothing outside of them is touched. Line
// ends, a missing last newline and everything else about a file stay as they are.
//
// A new file starts with `// lobe Callisto new 5f2c01ab`, the hash of the lines below. The first
// region names the new files, a line `//+ path` each below its BEGIN, so that a file that the model
// no longer has goes when the patch is regenerated or reverted.
//
// Several models can be in one tree, one on top of the other: ids and the lines that count them
// depend on who came first. The first region names the models below it, a line `//^ model` each.
// To each model the regions of those below are the engine's own text (where it changes a line of
// theirs, its region stands inside of that one); a model with others on top can be checked, and is
// changed or reverted only after they are.
#pragma once

#include "emit/template.h"
#include "engine/edits.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

/// A source tree, by paths from its root with `/`.
struct Tree {
    /// The bytes of a file; nothing if there is none or it cannot be read.
    std::function<std::optional<std::string>(const std::string& path)> read;
    /// Why a file that `read` cannot be written; empty if it can. May be empty itself.
    std::function<std::string(const std::string& path)> refuses_write;
};

/// What the edits say: values for `${…}`, lists for `//% for`, words for `when`.
struct Request {
    std::string model;  ///< as in the marks: `Callisto`
    emit::Record values;
    std::vector<std::string> words;  ///< `carrier_f_a`, `has_node`
    /// Whole files by the name that `new … FROM` uses; templates are looked up where there is none.
    std::vector<std::pair<std::string, std::string>> files;
};

/// One file before and after. No `before`: it is new; no `after`: it goes.
struct Change {
    std::string path;
    std::optional<std::string> before;
    std::optional<std::string> after;
};

/// Why nothing is done, one entry per obstacle.
struct Obstacle {
    std::string file;    ///< from the root of the tree
    int line = 0;        ///< 0: none in particular
    std::string edit;    ///< name of the edit, the region or the value, if it is about one
    std::string anchor;  ///< its regular expression, if that is what failed
    std::string what;    ///< what was seen
    std::string help;    ///< what to do
};

struct Plan {
    std::vector<Change> changes;  ///< that differ from the tree, sorted by path
    std::vector<Obstacle> obstacles;
    std::vector<std::pair<std::string, std::string>> read;  ///< values found: `next_id`, `12`
    std::string version;                                    ///< `4.27`, from the tree
    int regions = 0;                                        ///< that the patched tree has
};

/// The tree with the model's edits in it, as they should be now. Obstacles: then no changes.
Plan plan_patch(const Tree& tree, const EditList& list, const Request& request);

/// The tree without the model's regions and new files. Works without the model's source: only its
/// name is read from the request.
Plan plan_revert(const Tree& tree, const EditList& list, const Request& request);

}  // namespace lobe::engine
