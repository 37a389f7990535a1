// What a scene says about a model's inputs: for every material the values or ranges of parameters
// and surface fields, and why; over the scene which effects are called for, by which material.
//
// The surface is glTF's, read as every engine reads it: base color, metallic and roughness as they
// are; `specular` by 0.08 specular = f0 of KHR_materials_ior and KHR_materials_specular, 0.5 where
// neither is there. Roughness below the least that the language knows counts as that. A model's
// parameter is what `extras.lobe.parameters` gives, else what a ratified extension of the same name
// gives, else its default.
#pragma once

#include "ir/module.h"
#include "optimize/residual.h"
#include "scene/gltf.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// What one input can be.
struct InputFact {
    std::vector<ir::Range> components;
    bool is_binary = false;    ///< 0 or 1 and nothing between
    scene::Pointer called_by;  ///< what said so; empty: a default
    bool is_default = false;   ///< exactly the parameter's default
    bool is_constant() const;
    std::vector<double> value() const;  ///< of a constant
};

/// One material, under one model.
struct MaterialFacts {
    std::size_t material = 0;                 ///< index into Scene::materials
    std::string name;                         ///< of the material, or `material 3`
    double coverage = 0;                      ///< its share of the area shown; all together are 1
    std::map<std::string, InputFact> inputs;  ///< parameters and surface fields, by name
    std::vector<bool> calls;                  ///< per effect of the module: it may be on
};

struct EffectFact {
    std::string name;
    bool is_on = false;
    std::string why;                     ///< `retroreflection = 4` or `no material calls for it`
    scene::Pointer called_by;            ///< of the first material that does
    std::vector<std::size_t> materials;  ///< that call for it, indices into SceneFacts::materials
};

struct LightCount {
    scene::Light::Kind kind{};
    std::size_t count = 0;
    bool ranged = false;  ///< one of them has a range: the window is needed
};

struct SceneFacts {
    std::string model;
    std::vector<MaterialFacts> materials;  ///< shown ones, in the file's order
    std::vector<EffectFact> effects;       ///< in the module's order
    std::vector<LightCount> lights;        ///< kinds that the scene has, in the enum's order
    bool has_environment = false;
    bool has_tangents = false;
    bool double_sided = false;
    bool has_layers = false;
    std::vector<std::string> not_modeled;  ///< extensions that no parameter of the model takes

    /// What all these materials (all where empty) have in common: constants they share, hulls of
    /// ranges, effects that none of them calls for.
    optimize::Called called(const std::vector<std::size_t>& of = {}) const;
};

struct FoundFacts {
    std::optional<SceneFacts> facts;  ///< none where a complaint is an error
    std::vector<scene::Complaint> complaints;
};

/// Values outside the model's ranges, unknown parameters (with the nearest name) and wrong sizes
/// are errors at their pointer. `model` is one of the module's.
FoundFacts find_facts(const scene::Scene& scene, const ir::Module& module,
                      const std::string& model);

}  // namespace lobe::analyze
