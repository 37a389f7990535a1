// An engine's source tree on disk: read one file at a time, changed as a whole or not at all.
//
// A change is made in three steps, so that it can be killed at any moment:
//
//   1  every new text is written beside its file, `X.lobec-new`, with X's mode
//   2  the journal `.lobec-journal` appears in the tree's root: from here on the change will happen
//   3  the texts are renamed into place, files that go are removed, then the journal
//
// Killed before 2, nothing has changed. Killed after it, the tree may be in between; the next
// `apply` or `revert` finds the journal and finishes first, and every other reading refuses.
#pragma once

#include "engine/patch.h"

#include <functional>
#include <string>
#include <vector>

namespace lobe::cli {

/// The files below `root` as the engine stage reads them. A file without any write permission is
/// refused, whoever asks: version control marks with it what was not checked out.
engine::Tree disk_tree(const std::string& root);

/// True when an earlier change was interrupted after step 2.
bool is_interrupted(const std::string& root);

/// Finishes an interrupted change. Why it failed, or nothing.
std::string finish_interrupted(const std::string& root);

/// Makes all changes. Why it failed, or nothing; then nothing has changed. `before_step` is
/// called before everything that touches the disk: tests stop there.
std::string apply_changes(const std::string& root, const std::vector<engine::Change>& changes,
                          const std::function<void()>& before_step = {});

}  // namespace lobe::cli
