// The stand-in trees of tests/data/engine, and what makes hostile ones of them.
#pragma once

#include "engine/tree.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::engine {

/// The edit list that the compiler ships.
const EditList& shipped_list();

/// Folders of the engine, as the edit list calls them.
inline const std::string shaders = "Engine/Shaders/Private/";
inline const std::string classes = "Engine/Source/Runtime/Engine/Classes/";
inline const std::string materials = "Engine/Source/Runtime/Engine/Private/Materials/";
inline const std::string renderer = "Engine/Source/Runtime/Renderer/Private/";
inline const std::string inspector = "Engine/Source/Editor/PixelInspector/Private/";

/// `4.25`, `4.26` or `4.27`: `common` under the version's own files.
Files engine_tree(const std::string& version);

/// Files of a folder of tests/data/engine, by their paths in it.
Files data_files(const std::string& folder);

/// The tree with `from` in place of the only `to` of a file; the test fails if there is not one.
Files with(Files tree, const std::string& path, std::string_view from, std::string_view to);

/// A fork's tree: ids 12 and 13 are taken by models of its own, everywhere where models are listed.
Files fork_tree(const std::string& version);

/// What a folder of this name holds when all files are in it; `check` says whether all is well
/// there. The folder is gone afterwards.
void in_folder(const Files& files, const std::function<void(const std::string& folder)>& check);

/// The exit status of a command, whose output becomes `output`.
int run(const std::string& command, std::string& output);

}  // namespace lobe::engine
