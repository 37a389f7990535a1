// Where the bits of fields go: into the channels there are, in one piece where they can be.
#pragma once

#include "ir/packing.h"

#include <optional>
#include <vector>

namespace lobe::analyze {

/// The slots of every field, most significant first, within the slots of `room`. As few fields as
/// possible are cut in two; of the layouts with the fewest, the one that has the first fields in
/// the first slots. Fields fill a slot from its high end. Nothing when there is no room.
///
/// Exact for up to 14 fields of which none needs three slots; else one field after the other, cut
/// wherever a slot ends.
std::optional<std::vector<std::vector<ir::Slot>>> lay_out(const std::vector<int>& bits,
                                                          const std::vector<ir::Slot>& room);

}  // namespace lobe::analyze
