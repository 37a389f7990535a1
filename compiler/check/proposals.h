// Another code for a field, in which the values that must survive lie on codes: what a message can
// offer.
#pragma once

#include "ir/module.h"

#include <optional>
#include <vector>

namespace lobe::check {

/// The code that keeps all of these values and reaches the ends of the field's range with the bits
/// that it has. Codes of the kind that the field has come first, then those that waste the fewest
/// codes. Nothing if no linear or power code does, or for a field that can have no other code.
std::optional<ir::Code> code_for(const ir::Field& field, const ir::Parameter& parameter,
                                 const std::vector<double>& values);

/// The greatest pivot with which a power or log2 code reaches the high end.
std::optional<int> reaching_pivot(const ir::Field& field);

}  // namespace lobe::check
