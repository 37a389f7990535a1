// What the files of one target share beyond their dialect.
#pragma once

#include "emit/emit.h"

namespace lobe::emit {

/// What goes before a function's name so that two modules, and the engine, can live in one shader:
/// `Callisto_` for ue4, whose shaders are one namespace; nothing for the others.
std::string function_prefix(const ir::Module& module, const Target& target);

/// Our stand-in for the part of the engine's shaders that a BxDF stands on.
std::string unreal_prelude();

}  // namespace lobe::emit
