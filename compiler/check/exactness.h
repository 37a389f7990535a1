// What the codes of a packing make of the values that they store, over every code there is.
//
// In: a packing whose functions are built. Out: nothing if every field keeps what it must, or what
// it does instead, with the code and the value that show it. The functions are run, in float with
// every rounding that a conforming device may choose, so what is checked is what is emitted.
#pragma once

#include "base/diagnostic.h"
#include "ir/module.h"

namespace lobe::check {

/// Sets Field::anchors: the values at which an effect is off, and where the codes of a declared
/// code meet the values that must survive. Before `ir::build_functions`, which makes them decode
/// without rounding.
void place_anchors(const ir::Module& module, ir::Packing& packing);

/// Reports, field by field,
///
///   E0606  a default, a required value, or one at which an effect is off, that does not decode to
///          itself
///   E0607  a range whose ends are not reached
///   E0608  a code or a value that does not survive decoding and encoding
///   E0609  codes that do not decode to ever greater values
///   E0302  a function of the packing whose name a term has
///
/// False if anything was reported.
bool check_values(const ir::Module& module, const ir::Packing& packing, const ir::Gbuffer& gbuffer,
                  Diagnostics& diagnostics);

}  // namespace lobe::check
