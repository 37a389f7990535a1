// Whole files that come with a patch. The first line says whose they are and hashes the rest, so
// that one that people changed, or made themselves, is never overwritten or removed.
#pragma once

#include "engine/answers.h"
#include "engine/edits.h"
#include "engine/lines.h"
#include "engine/patch.h"

#include <string>
#include <vector>

namespace lobe::engine {

/// A file that the patched tree has.
struct PlannedFile {
    std::string path;
    Lines lines;  ///< with LF ends
};

/// Those of the list, rendered.
std::vector<PlannedFile> new_files(const EditList& list, const Request& request,
                                   const Answers& answers, std::vector<Obstacle>& obstacles);

/// What makes the tree have the planned files and not the `former` ones. `crlf`: what a file that
/// is not there yet ends its lines in.
std::vector<Change> change_new_files(const Tree& tree, const std::string& model,
                                     const std::vector<PlannedFile>& planned,
                                     const std::vector<std::string>& former, bool crlf,
                                     std::vector<Obstacle>& obstacles);

/// Paths that a former patch may have made, by the list, whatever its conditions say: where values
/// are missing a path is left out.
std::vector<std::string> possible_new_files(const EditList& list, const Answers& answers);

}  // namespace lobe::engine
