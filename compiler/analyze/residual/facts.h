// What a scene says about a model's inputs: for every material the values or ranges of parameters
// and surface fields, and why; over the scene which effects are called for, by which material.
//
// The surface is glTF's, read as every engine reads it (surface.h). A model's parameter is what
// `extras.lobe.parameters` gives, else what a ratified extension of the same name gives, else its
// default. A material with layers is what blending their parameters can make of it.
#pragma once

#include "analyze/residual/emitters.h"
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
    std::size_t material = 0;  ///< index into Scene::materials
    std::string name;          ///< of the material, or `material 3`
    double coverage = 0;       ///< its share of the area shown; all together are 1
    /// The surface fields that the model reads, and the parameters that are not at their default.
    std::map<std::string, InputFact> inputs;
    std::vector<bool> calls;  ///< per effect of the module: it may be on
};

struct EffectFact {
    std::string name;
    bool is_on = false;
    std::string why;                      ///< `retroreflection = 4` or `no material calls for it`
    scene::Pointer called_by;             ///< of the first material that does
    std::vector<std::size_t> materials;   ///< that call for it, indices into SceneFacts::materials
    std::vector<std::string> parameters;  ///< that its condition is about
};

struct LightCount {
    scene::Light::Kind kind{};
    std::size_t count = 0;
    bool ranged = false;  ///< one of them has a range: the window is needed
};

/// Which constants of the surface `SceneFacts::called` fixes. A parameter is fixed in both.
enum class SurfaceUse : std::uint8_t {
    /// 0 and 1, which take code away: no metal, all metal. Other constants stay inputs, so that a
    /// shader keeps its signature when an artist picks another color.
    shared,
    /// All: a shader for these materials and no others.
    fixed
};

struct SceneFacts {
    std::string model;
    std::vector<MaterialFacts> materials;  ///< shown and lit ones, in the file's order
    std::vector<EffectFact> effects;       ///< in the module's order
    std::vector<LightCount> lights;        ///< kinds that the scene has, in the enum's order
    std::vector<std::string> light_names;  ///< that they need of models/lights.lobe, sorted
    /// By these names, what all lights of one give to the fields of an emitter: ranges, and
    /// constants where it is 0 or 1, which takes code away. Lengths are in centimeters.
    std::map<std::string, optimize::Called> emitters;
    bool has_environment = false;
    bool has_tangents = false;
    bool double_sided = false;
    bool has_layers = false;
    /// What the file asks for and no parameter of the model takes: `KHR_materials_clearcoat`, and
    /// of which material first.
    std::vector<std::string> not_modeled;
    /// Of the module's parameters, by name.
    std::map<std::string, InputFact> defaults;

    /// What an input of a material is; the name is of a parameter, or of a surface field that the
    /// model reads.
    const InputFact& input(const MaterialFacts& of, const std::string& name) const;

    /// What all these materials (all where empty) have in common: constants they share, hulls of
    /// ranges (with ends of a few digits, as they are the promise that the shader states), effects
    /// that none of them calls for.
    optimize::Called called(const std::vector<std::size_t>& of = {},
                            SurfaceUse surface = SurfaceUse::shared) const;
};

/// The values of a material that call for an effect: `retroreflection = 4`.
std::string why_on(const MaterialFacts& material, const EffectFact& effect);

struct FoundFacts {
    std::optional<SceneFacts> facts;  ///< none where a complaint is an error
    std::vector<scene::Complaint> complaints;
};

/// Values outside the model's ranges, unknown parameters (with the nearest name) and wrong sizes
/// are errors at their pointer, and so is a scene without a lit material. `model` is one of the
/// module's.
FoundFacts find_facts(const scene::Scene& scene, const ir::Module& module,
                      const std::string& model);

}  // namespace lobe::analyze
