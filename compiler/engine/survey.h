// What is in the tree before anything is planned: the files of the list, whose regions are in them,
// and whether these are sound.
#pragma once

#include "engine/lines.h"
#include "engine/patch.h"
#include "engine/regions.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::engine {

struct SurveyedFile {
    std::string path;
    std::optional<std::string> bytes;
    Lines text;
    std::ptrdiff_t crlf = 0;  ///< lines that end in CRLF, less those that end in LF
    std::vector<Region> regions;
    bool sound = false;  ///< it is there, a text, and every mark has its other half
};

struct Survey {
    std::vector<SurveyedFile> files;   ///< as in the list
    std::string model;                 ///< whose patch this is about
    std::vector<std::string> earlier;  ///< other models, whose regions are the engine's own text
    std::vector<std::string> later;    ///< models that came on top of this one, or of those
    int regions = 0;                   ///< of the model
};

/// Reads every file of the list.
Survey survey_tree(const Tree& tree, const EditList& list, const std::string& model,
                   std::vector<Obstacle>& obstacles);

/// Regions that people edited, of the model or of later ones.
void check_unedited(const Survey& survey, std::vector<Obstacle>& obstacles);

/// Numbers that are missing or come twice. `lacking` are the files that have fewer regions than
/// they should.
void check_complete(const Survey& survey, const std::vector<std::string>& lacking,
                    std::vector<Obstacle>& obstacles);

/// The files that the model's patch brought along, as its regions name them.
std::vector<std::string> named_new_files(const Survey& survey);

bool is_later(const Survey& survey, const std::string& model);

}  // namespace lobe::engine
