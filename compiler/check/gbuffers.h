// `gbuffer` blocks: from what was written to sets of configurations.
#pragma once

#include "check/program.h"

namespace lobe::check {

/// More configurations than this are refused (E0614): every condition is decided for each.
inline constexpr std::size_t most_configurations = 4096;

/// The gbuffer with every condition decided. Nothing if something about it was reported: E0302,
/// E0504, E0505, E0508, E0614.
std::optional<ir::Gbuffer> resolve_gbuffer(const Program& program,
                                           const GbufferDeclaration& declared,
                                           Diagnostics& diagnostics);

}  // namespace lobe::check
