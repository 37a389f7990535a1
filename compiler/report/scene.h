// What a scene calls for under a model, as tables and JSON.
#pragma once

#include "analyze/residual/facts.h"
#include "analyze/residual/layers.h"
#include "report/table.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lobe::report {

/// One row per material: its share of the picture, what it calls for, what it gives.
Table material_table(const analyze::SceneFacts& facts);
/// One row per effect: on or off, why, and who called for it.
Table effect_table(const analyze::SceneFacts& facts);
/// One row per input that some material sets or that is the surface's: what it is over the scene.
Table input_table(const analyze::SceneFacts& facts);

/// `3 point (2 kinds …)`: lights, environment and the rest, a line each.
std::string surroundings(const analyze::SceneFacts& facts);

std::string to_text(const analyze::SceneFacts& facts, const Look& look);
nlohmann::ordered_json to_json(const analyze::SceneFacts& facts);

/// One row per layered material: what shading a blend of its parameters is off by, and where.
Table layer_table(const analyze::LayeredMaterials& layered);
/// The table and what it means; empty where there are no layers.
std::string to_text(const analyze::LayeredMaterials& layered, const Look& look);
nlohmann::ordered_json to_json(const analyze::LayeredMaterials& layered);

/// What the lights of the scene give to light functions, in words: `sphere (radius 30 .. 40)`.
std::string emitters_in_words(const analyze::SceneFacts& facts);

/// `directional`
std::string_view name(scene::Light::Kind kind);

}  // namespace lobe::report
