// From file names to a scene under a model: what scene, specialize, ladder and render have in
// common.
#pragma once

#include "analyze/residual/facts.h"
#include "cli/program.h"
#include "scene/gltf.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::cli {

/// One checked module, and one of its models.
struct ModelFile {
    Program program;    ///< of one module where `status` is success
    std::string model;  ///< its name
    int status = success;

    const ir::Module& module() const { return program.modules.front(); }
};

/// `models/callisto.lobe` is its first model, `models/callisto.lobe:callisto_lambert` that one.
/// What is wrong is printed.
ModelFile load_model(const Terminal& terminal, const std::string& text);

/// The same for a file and a name (empty: the first model).
ModelFile load_model(const Terminal& terminal, const std::string& file, const std::string& name);

/// A scene and the files that it names, which are looked for beside it. What is wrong is printed;
/// nothing then.
std::optional<scene::Scene> read_scene(const Terminal& terminal, const std::string& path,
                                       const scene::ReadOptions& options);

/// A scene without its pixels and vertices, and what it says about a model.
struct SceneUnderModel {
    scene::Scene scene;
    analyze::SceneFacts facts;
};

/// What is wrong is printed.
std::optional<SceneUnderModel> read_facts(const Terminal& terminal, const std::string& path,
                                          const ModelFile& model);

/// `S.gltf#/materials/3: error: …` to stderr, one line each, and a line of help where there is one.
void print(const Terminal& terminal, const std::string& path,
           const std::vector<scene::Complaint>& complaints);

}  // namespace lobe::cli
