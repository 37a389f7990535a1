// Models with packings and engine blocks, built by hand: what the engine's edits are told of them.
#pragma once

#include "emit/engine_values.h"
#include "engine/patch.h"
#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::engine {

/// One field of a packing: a parameter in whole bits of one channel.
struct Place {
    std::string parameter;
    std::string channel;  ///< `d.r`
    int low = 0;
    int bits = 8;
    int component = 0;
};

struct Wish {
    std::string shading_model = "Callisto";
    std::vector<Place> places;
    std::vector<std::pair<std::string, std::string>> pins;  ///< pin, parameter
    std::string node;
    std::vector<std::string> node_parameters;
    std::vector<double> color;  ///< none, or three
};

/// Callisto's scalars in GBufferD, some by pins, one by a node.
Wish plain_wish();
/// The same, with the gains in GBufferF.a and GBufferB.
Wish carrier_wish();
/// Tints too, by the node; colors cannot come through pins.
Wish color_wish();

/// What `lobec patch` makes of models/callisto.lobe with this wish.
struct Wished {
    ir::Module module;
    emit::EngineValues values;
    Request request;
};
Wished wished(const Wish& wish);
/// models/callisto.lobe as it is.
Wished shipped();

}  // namespace lobe::engine
