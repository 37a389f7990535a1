#include "analyze/residual/facts.h"

#include "analyze/residual/conditions.h"
#include "analyze/residual/parameters.h"
#include "analyze/residual/reach.h"
#include "analyze/residual/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace lobe::analyze {
namespace {

using scene::Complaint;

/// As many as a reader of a file gives.
constexpr std::size_t most_complaints = 100;

/// The surface fields that the outputs of a model read, in the order of the language.
std::vector<ir::SurfaceField> fields_of(const ir::Module& module, const std::string& model)
{
    std::set<ir::SurfaceField> fields;
    for (const ir::Model& each : module.models)
        if (each.name == model)
            for (const ir::ModelOutput& output : each.outputs)
                for (const ir::Input& input : module[output.function].inputs)
                    if (input.origin == ir::Origin::surface)
                        fields.insert(static_cast<ir::SurfaceField>(input.which));
    return {fields.begin(), fields.end()};
}

class Finder {
public:
    Finder(const scene::Scene& scene, const ir::Module& module, const std::string& model)
        : scene_{scene}, module_{module}, fields_{fields_of(module, model)},
          conditions_{module}, colors_{vertex_colors(scene)}
    {
        facts_.model = model;
        facts_.defaults = default_facts(module);
    }

    FoundFacts run()
    {
        std::vector<std::size_t> shown = scene_.shown_materials();
        // The format's default material stands in no file; where nothing shows it there is none.
        if (scene_.instances.empty())
            std::erase_if(shown, [this](std::size_t m) { return is_default(m); });
        const std::size_t before = shown.size();
        std::erase_if(shown, [this](std::size_t m) {
            const scene::Material& material = scene_.materials[m];
            if (material.is_unlit) note_once("KHR_materials_unlit", material);
            return material.is_unlit;
        });
        const std::vector<double> areas = scene_.coverage();
        double all = 0;
        for (const std::size_t index : shown) all += areas[index];
        for (const std::size_t index : shown)
            add(index, all > 0 ? areas[index] / all : 1.0 / static_cast<double>(shown.size()));
        if (facts_.materials.empty() && errors_.empty())
            errors_.push_back({true, "", "no material to shade",
                               before == 0 ? "the scene has no materials, and no primitive "
                                             "that shows the format's default one"
                                           : "all of them are KHR_materials_unlit"});
        FoundFacts out;
        const bool ok = errors_.empty();
        if (errors_.size() > most_complaints) {
            const std::size_t more = errors_.size() - most_complaints;
            errors_.resize(most_complaints);
            errors_.push_back({true, "", fmt::format("{} more like these", more), ""});
        }
        out.complaints = std::move(errors_);
        out.complaints.insert(out.complaints.end(), notes_.begin(), notes_.end());
        if (!ok) return out;
        tell_effects();
        tell_scene(shown);
        out.facts = std::move(facts_);
        return out;
    }

private:
    bool is_default(std::size_t material) const
    {
        return scene_.materials[material].pointer.empty();
    }

    void add(std::size_t index, double coverage)
    {
        const scene::Material& material = scene_.materials[index];
        MaterialFacts facts;
        facts.material = index;
        facts.name = !material.name.empty() ? material.name
                     : is_default(index)    ? "default material"
                                            : fmt::format("material {}", index);
        facts.coverage = coverage;
        const Blend& blend = blend_of(index);
        errors_.insert(errors_.end(), blend.complaints.begin(), blend.complaints.end());
        facts_.has_layers = facts_.has_layers || !material.layers.empty();
        facts.inputs = blend.inputs;
        RawSurface raw = blend.raw;
        raw.base_color = colored(std::move(raw.base_color), colors_[index]);
        std::erase_if(facts.inputs, [](const auto& named) { return named.second.is_default; });
        for (const ir::SurfaceField field : fields_)
            facts.inputs[std::string{ir::facts(field).name}] = surface_field(raw, field);
        if (raw.exceeds_specular && std::ranges::count(fields_, ir::SurfaceField::specular) > 0)
            note_once("KHR_materials_specular beyond what `specular` says", material);
        for (const std::string& extension : not_modeled(scene_, material, module_))
            note_once(extension, material);
        for (std::size_t effect = 0; effect < module_.effects.size(); ++effect)
            facts.calls.push_back(conditions_.can_be_on(effect, facts.inputs, facts_.defaults));
        facts_.materials.push_back(std::move(facts));
    }

    /// What a material and the layers over it can be blended to, layers of layers too.
    struct Blend {
        RawSurface raw;
        std::map<std::string, InputFact> inputs;
        std::vector<Complaint> complaints;  ///< of the material itself
    };

    const Blend& blend_of(std::size_t material)
    {
        // A stack of our own: layers may be as deep as a scene has materials.
        std::vector<std::size_t> open{material};
        while (!open.empty()) {
            const std::size_t at = open.back();
            const std::size_t before = open.size();
            for (const scene::Layer& layer : scene_.materials[at].layers)
                if (!blends_.contains(layer.material)) open.push_back(layer.material);
            if (open.size() > before) continue;
            open.pop_back();
            if (blends_.contains(at)) continue;
            Blend& blend = blends_[at];
            blend.raw = raw_surface(scene_, scene_.materials[at]);
            blend.inputs =
                given_parameters(scene_, scene_.materials[at], module_, blend.complaints);
            for (const scene::Layer& layer : scene_.materials[at].layers)
                blend_in(blends_.at(layer.material), blend);
        }
        return blends_.at(material);
    }

    void blend_in(const Blend& layer, Blend& below) const
    {
        const auto otherwise = [this](const std::string& name) { return facts_.defaults.at(name); };
        below.raw = hull(below.raw, layer.raw);
        for (const auto& [name, fact] : layer.inputs)
            below.inputs.try_emplace(name, otherwise(name));
        for (auto& [name, fact] : below.inputs) {
            const auto found = layer.inputs.find(name);
            fact = hull(fact, found == layer.inputs.end() ? otherwise(name) : found->second);
        }
    }

    void note_once(const std::string& what, const scene::Material& material)
    {
        if (!noted_.insert(what).second) return;
        facts_.not_modeled.push_back(what);
        notes_.push_back({false, material.pointer,
                          fmt::format("{} is in no parameter of `{}`", what, module_.name), ""});
    }

    void tell_effects()
    {
        for (std::size_t i = 0; i < module_.effects.size(); ++i) {
            EffectFact effect;
            effect.name = module_.effects[i].name;
            for (std::size_t m = 0; m < facts_.materials.size(); ++m)
                if (facts_.materials[m].calls[i]) effect.materials.push_back(m);
            effect.is_on = !effect.materials.empty();
            effect.why = "no material calls for it";
            effect.parameters = conditions_.parameters_of(i);
            if (effect.is_on) {
                const MaterialFacts& first = facts_.materials[effect.materials.front()];
                effect.why = why_on(first, effect);
                for (const std::string& name : effect.parameters)
                    if (effect.called_by.empty() && first.inputs.contains(name))
                        effect.called_by = first.inputs.at(name).called_by;
            }
            facts_.effects.push_back(std::move(effect));
        }
    }

    void tell_scene(const std::vector<std::size_t>& shown)
    {
        using Kind = scene::Light::Kind;
        for (const Kind kind :
             {Kind::directional, Kind::point, Kind::spot, Kind::sphere, Kind::tube}) {
            LightCount count{kind, 0, false};
            for (const scene::Light& light : scene_.lights)
                if (light.kind == kind) {
                    ++count.count;
                    count.ranged = count.ranged || light.range.has_value();
                }
            if (count.count > 0) facts_.lights.push_back(count);
        }
        facts_.emitters = emitter_facts(scene_.lights);
        for (const auto& [name, emitter] : facts_.emitters) facts_.light_names.push_back(name);
        facts_.has_environment = scene_.environment.has_value();
        facts_.has_tangents = std::ranges::any_of(scene_.meshes, &scene::Mesh::has_tangents);
        facts_.double_sided = std::ranges::any_of(
            shown, [&](std::size_t index) { return scene_.materials[index].double_sided; });
    }

    const scene::Scene& scene_;
    const ir::Module& module_;
    std::vector<ir::SurfaceField> fields_;
    Conditions conditions_;
    std::vector<VertexColors> colors_;  ///< by material
    std::map<std::size_t, Blend> blends_;
    SceneFacts facts_;
    std::vector<Complaint> errors_;
    std::vector<Complaint> notes_;
    std::set<std::string> noted_;
};

bool is_zero_or_one(double value) { return value == 0 || value == 1; }

}  // namespace

std::string why_on(const MaterialFacts& material, const EffectFact& effect)
{
    std::string why;
    for (const std::string& name : effect.parameters) {
        const auto found = material.inputs.find(name);
        if (found == material.inputs.end()) continue;
        why += fmt::format("{}{} {}{}", why.empty() ? "" : ", ", name,
                           found->second.is_constant() ? "= " : "", in_words(found->second));
    }
    return why.empty() ? "on at the defaults" : why;
}

const InputFact& SceneFacts::input(const MaterialFacts& of, const std::string& name) const
{
    const auto found = of.inputs.find(name);
    return found == of.inputs.end() ? defaults.at(name) : found->second;
}

optimize::Called SceneFacts::called(const std::vector<std::size_t>& of, SurfaceUse surface) const
{
    std::vector<std::size_t> chosen = of;
    if (chosen.empty()) {
        chosen.resize(materials.size());
        std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    }
    std::set<std::string> names;
    for (const auto& [name, fact] : defaults) names.insert(name);
    for (const auto& [name, fact] : materials[chosen.front()].inputs) names.insert(name);

    optimize::Called out;
    for (const std::string& name : names) {
        const InputFact& first = input(materials[chosen.front()], name);
        ir::Range range = first.components.front();
        bool same = true;
        bool binary = true;
        for (const std::size_t index : chosen) {
            const InputFact& fact = input(materials[index], name);
            for (std::size_t k = 0; k < fact.components.size(); ++k) {
                const ir::Range& component = fact.components[k];
                same = same && component.low == component.high && component == first.components[k];
                range = {std::min(range.low, component.low), std::max(range.high, component.high)};
            }
            binary = binary && fact.is_binary;
        }
        const bool is_parameter = defaults.contains(name);
        if (same && (is_parameter || surface == SurfaceUse::fixed ||
                     std::ranges::all_of(first.value(), is_zero_or_one)))
            out.constants[name] = first.value();
        else
            out.ranges[name] = in_digits(range);
        if (binary) out.binary.insert(name);
    }
    for (std::size_t i = 0; i < effects.size(); ++i)
        if (std::ranges::none_of(chosen, [&](std::size_t m) { return materials[m].calls[i]; }))
            out.off.insert(effects[i].name);
    return out;
}

FoundFacts find_facts(const scene::Scene& scene, const ir::Module& module, const std::string& model)
{
    return Finder{scene, module, model}.run();
}

}  // namespace lobe::analyze
