// `engine` blocks: what an engine's material editor offers, and what of it reaches the packing.
#pragma once

#include "check/packings.h"

namespace lobe::check {

/// Reads an engine block of the root file; parameters are indices into Program::parameters.
/// `packings` are those of the root: what is fed must be packed, or it is lost on its way (E0611),
/// what is packed should be fed (W0601), and a pin must not clamp what is carried (E0607). Nothing
/// if model or gbuffer are not known.
std::optional<ir::Engine> read_engine(Program& program, const syntax::EngineItem& node,
                                      const std::vector<ReadPacking>& packings,
                                      Diagnostics& diagnostics);

}  // namespace lobe::check
