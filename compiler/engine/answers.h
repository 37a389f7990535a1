// What the tree answers to the list's questions: its version, words for `when`, values for texts.
#pragma once

#include "emit/template.h"
#include "engine/edits.h"
#include "engine/patch.h"
#include "engine/search.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lobe::engine {

struct Answers {
    std::optional<Version> version;
    std::string version_text;
    std::vector<std::string> words;                           ///< that are set
    std::vector<std::pair<std::string, std::string>> values;  ///< read or counted
    emit::Record record;                                      ///< all that a text may ask for
};

/// By file of the list; nothing where the tree has none that can be read.
using SearchedFiles = std::vector<std::optional<Searched>>;

bool holds(const Condition& condition, const Answers& answers);

/// Whether what the list says about this file is to be done: the file is there and asked for.
bool is_active(const EditList& list, const SearchedFiles& files, int file, const Answers& answers);

/// What is known without the tree: the request's values and words, the model's name.
Answers first_answers(const Request& request);

/// `${name}` in patterns and paths.
ValueOf value_of(const emit::Record& record);

/// The version and the probed words. False: the list knows nothing about this engine, and all
/// there is to say has been said.
bool ask_what_it_is(const EditList& list, const SearchedFiles& files, Answers& answers,
                    std::vector<Obstacle>& obstacles);

/// Values, then demands on them and the files.
void ask_for_values(const EditList& list, const SearchedFiles& files, Answers& answers,
                    std::vector<Obstacle>& obstacles);

}  // namespace lobe::engine
