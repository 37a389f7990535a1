// What a scene calls for under a model, as tables and JSON.
#pragma once

#include "analyze/residual/facts.h"
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

/// `directional`
std::string_view name(scene::Light::Kind kind);

}  // namespace lobe::report
