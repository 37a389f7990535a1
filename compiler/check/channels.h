// Whether the channels of a packing are there, hold codes, and are the model's alone.
#pragma once

#include "base/diagnostic.h"
#include "ir/gbuffer.h"
#include "ir/packing.h"

#include <string>
#include <vector>

namespace lobe::check {

/// A field with its parts where they were written.
struct PlacedField {
    ir::Field field;
    std::string name;          ///< of its parameter, with its component
    std::vector<Span> places;  ///< of each slot
};

/// How many bits of a channel a slot without `[low..high]` takes: all that the channel has wherever
/// it can hold codes and has to.
int whole_width(const ir::Channel& channel, const ir::Configurations& supported);

/// Reports bits that two fields claim (E0602), channels with content or readers of the engine's own
/// (E0604), channels that are not there, or hold no codes, where the packing has to work (E0605),
/// and more bits than there are (E0613). Each channel is reported once.
void check_channels(const ir::Gbuffer& gbuffer, const ir::Packing& packing,
                    const std::vector<PlacedField>& fields, Diagnostics& diagnostics);

}  // namespace lobe::check
