// What an engine's edit list (templates/ue4/engine.edits) is told about a model.
//
// Comes in: a module, one of its `engine` blocks and the packing that it goes with. Goes out:
// values, lists and words. Nothing here knows an engine: pins and channels come by the names that
// the gbuffer gives them, and the edit list says what they are in the engine's files.
//
//   Model MODEL                   `Callisto`, from the shading model's name
//   display display_text          that name, quoted for C++, and for a comment
//   color                         `0.9f, 0.2f, 0.1f`, if the block has one
//   bxdf pack                     functions of the generated shaders
//   shader_file packing_file      their names: the model's, and the one that packs
//   pack_arguments                the parameters, as the locals of the lists below
//   default_arguments             the parameters' defaults
//   Node NODE caption input_count inputs node_source banner
//                                 of the custom output node, if there is one; `inputs` are records
//                                 of index, name, tip, comment, and one of number and color
//   pin_<pin>                     the parameter that a pin feeds: none or one
//   pins                          all of these
//   nodes                         none or one: upper, function, inputs
//   unfed                         the parameters that are packed and nothing feeds
//   carrier_<channel>             `carrier_f_a`: none or one, whether the channel is packed
//   lent_<pin>                    none or one: whether the pin feeds a parameter, or a channel is
//                                 packed that holds what the pin is named after, so that the engine
//                                 must not find it there
//
// A parameter is a record of local, type, value (its default) and, if a pin feeds it, label
// (quoted), constant (the default in C++) and pin (the engine's name of it).
//
// Words are the names of the lists with a record, and has_color, has_node, any_pin,
// stray_<channel> (it carries a parameter that is not fed by the pin named after what the engine
// has there).
#pragma once

#include "emit/template.h"
#include "ir/module.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::emit {

struct EngineValues {
    std::string model;  ///< `Callisto`
    Record values;
    std::vector<std::string> words;
};

/// The packing of an engine block: for its model, on its gbuffer. An index into Module::packings.
std::optional<std::size_t> packing_of(const ir::Module& module, const ir::Engine& engine);

/// Nothing if the packing has a channel that the engine's shaders cannot name.
std::optional<EngineValues> engine_values(const ir::Module& module, const ir::Engine& engine,
                                          std::size_t packing);

}  // namespace lobe::emit
