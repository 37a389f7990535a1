// Edits to places: which lines of a file each one puts in or takes the place of, and the file with
// all of them in it.
#pragma once

#include "emit/template.h"
#include "engine/edits.h"
#include "engine/patch.h"
#include "engine/search.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::engine {

/// A region to be: it takes the place of lines `from` up to `to`; where these are equal, it goes in
/// front of line `from`.
struct Placement {
    std::string edit;
    std::string anchor;
    std::size_t from = 0;
    std::size_t to = 0;
    std::string indent;  ///< of its marks
    std::vector<std::string> lines;
    int number = 0;                      ///< among all regions of the model
    std::vector<std::string> under;      ///< for the first region: models that were there before
    std::vector<std::string> new_files;  ///< and files that come along
};

/// The places of one edit, one per hit, in order; none where its text is empty or it may be absent.
std::vector<Placement> place(const Edit& edit, const Searched& file, const emit::Record& record,
                             std::vector<Obstacle>& obstacles);

/// Places that get in each other's way, or that the file's text does not allow.
void check_places(const Searched& file, const std::vector<Placement>& places,
                  std::vector<Obstacle>& obstacles);

/// The file's bytes with its regions, `total` of them in the whole tree.
std::string with_regions(const Searched& file, std::vector<Placement> places,
                         const std::string& model, int total);

}  // namespace lobe::engine
