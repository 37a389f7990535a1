// A small model for tests of facts, and what scenes say of it.
#pragma once

#include "analyze/checked.h"
#include "analyze/residual/facts.h"
#include "analyze/scenes.h"

#include <catch2/catch.hpp>

#include <string>

namespace lobe::tests {

using analyze::SceneFacts;

inline const Checked& toy()
{
    static const Checked checked = checked_text(R"(module toy

param gain  : float in [0, 8] = 1
param tint  : color = (1, 1, 1)
param width : unit = 0.5
param steps : int in [0, 4] = 1
param clearcoat : unit = 0

effect "Gain" off when gain * tint == 1
effect "Third" off when gain * width == 0.3
effect "Coat" off when clearcoat == 0

term lobe(albedo: color, g: geometry) -> color =
  albedo * gain * tint * (1 + width + clearcoat + steps) * g.cos_i

model toy(g: geometry, s: surface) {
  diffuse = lobe(s.diffuse_color, g) * s.metallic
  specular = lobe(s.f0, g) * s.roughness
}
)");
    return checked;
}

inline analyze::FoundFacts found(const scene::Scene& scene)
{
    return analyze::find_facts(scene, toy().module, "toy");
}

inline SceneFacts facts_of(const scene::Scene& scene)
{
    auto result = found(scene);
    for (const scene::Complaint& each : result.complaints)
        UNSCOPED_INFO(each.pointer << ": " << each.message);
    REQUIRE(result.facts);
    return *result.facts;
}

inline scene::Material with(const std::string& parameter, const scene::Value& value)
{
    scene::Material material = plain("m");
    material.parameters[parameter] = value;
    return material;
}

inline bool is_on(const SceneFacts& facts, std::size_t effect)
{
    return facts.effects[effect].is_on;
}

inline ir::Range range_of(const SceneFacts& facts, const std::string& name)
{
    return facts.input(facts.materials[0], name).components[0];
}

}  // namespace lobe::tests
