// From lowered functions to the finished module: what is imported but unused stays out.
#pragma once

#include "check/program.h"

namespace lobe::check {

/// What the root declares besides functions.
struct Declarations {
    std::vector<ir::Effect> effects;
    std::vector<ir::Model> models;
    std::vector<ir::Model> lights;
    std::vector<ir::Shading> shadings;
    std::vector<ir::Gbuffer> gbuffers;
    std::vector<ir::Packing> packings;
    std::vector<ir::Engine> engines;
};

/// The module of the root file. Parameters of other files come along where a function reads them
/// or where they are the root's own; what names them is renumbered. Sources likewise. The functions
/// of packings are not built yet.
ir::Module assemble(Program& program, Declarations declarations, const Sources& sources);

/// Names that imports bring along and that collide with one another or with the root's own
/// (E0302): parameters, and terms that were not imported by name.
void report_collisions(const Program& program, Diagnostics& diagnostics);

}  // namespace lobe::check
