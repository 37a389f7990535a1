// A packing drawn in characters: what lies in which bits of which channel, and what it means.
//
// For the comment at the top of generated packing code. Comes in: a packing with its gbuffer. Goes
// out: lines of plain ASCII, at most 96 columns wide where names allow it.
#pragma once

#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::emit {

/// One box per channel, the highest bit at the left, and a row per field below them. Channels of
/// the targets that the packing uses, other than the engine's own, are drawn empty.
std::vector<std::string> draw_layout(const ir::Module& module, const ir::Packing& packing);

/// `d.b[4..7]`, `d.r` for all bits of a channel.
std::string slot_text(const ir::Gbuffer& gbuffer, const ir::Packing& packing, const ir::Slot& slot);

}  // namespace lobe::emit
