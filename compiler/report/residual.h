// What a scene was specialized to: its shaders, what they cost, what they leave out and why, and
// what was checked of them. Tables, JSON, a page, and lines for the banner of what is emitted.
#pragma once

#include "analyze/residual/certificate.h"
#include "analyze/residual/variants.h"
#include "report/document.h"
#include "report/table.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace lobe::report {

struct Specialization {
    std::string scene;  ///< its path, as it may be shown
    std::string module;
    std::string command;  ///< that does this again
    analyze::SceneFacts facts;
    analyze::Variants variants;
    analyze::Family family{};
    double epsilon = 0;
    bool has_lights = true;  ///< shaders come with what they are under the scene's lights
    std::vector<analyze::Certificate> certificates;  ///< one per chosen variant, or none

    bool ok() const;
};

/// For the banner of a variant: the scene and materials that it is for, what is on and why, what is
/// off, what is a constant, what was left out for an epsilon and how much that changes.
std::vector<std::string> remarks(const Specialization& of, std::size_t variant);

/// One row per shader, then all together and the general one.
Table variant_table(const Specialization& of);
/// Shaders against cycles; empty where there is nothing to choose.
Table frontier_table(const Specialization& of);
/// One row per shader and output.
Table certificate_table(const Specialization& of);

/// One row per shader and effect that stays although an epsilon was given; empty without one.
Table kept_table(const Specialization& of);

std::string to_text(const Specialization& of, const Look& look);
Document to_document(const Specialization& of);
nlohmann::ordered_json to_json(const Specialization& of);
/// What was proved and what was checked, alone.
nlohmann::ordered_json certificates_to_json(const Specialization& of);

}  // namespace lobe::report
