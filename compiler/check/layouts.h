// Gbuffers, packings and engines of a program, from what was written to what is proved of them.
//
// `read_layouts` needs the functions of models and codes, and finds all that is wrong with names,
// bits and channels. What the codes come to as numbers is checked by `build_packings`, in the
// assembled module, whose functions it completes.
#pragma once

#include "check/assemble.h"
#include "check/packings.h"

namespace lobe::check {

/// Decides the gbuffers that the root declares or imports, and reads its packings and engines into
/// the declarations. An imported file's warnings are not reported, and nothing is said about blocks
/// of a file with syntax errors, whose missing lines would be blamed.
void read_layouts(Program& program, Declarations& declarations, Diagnostics& diagnostics);

/// Builds the functions of the module's packings and checks what they make of values. Where bits
/// overlap (which was reported), fields are looked at apart. The module's packings have their
/// functions, if nothing was ever reported about them.
void build_packings(ir::Module& module, Diagnostics& diagnostics);

}  // namespace lobe::check
