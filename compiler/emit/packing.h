// The file that packs a model's parameters into an engine's GBuffer and unpacks them again.
//
// Comes in: a module with packings, through optimize. Goes out: one file per target with the
// functions of every packing and what they call, the layout drawn at its top. It needs no other
// file, and may stand beside the module's own in one shader. For Unreal it also holds, for every
// packing whose channels the engine's shaders can name (`field "GBuffer.…"`),
//
//   CALLISTO_PARAMETERS( GBuffer, Parameters )   what the module's own file asks for, if this one
//                                                stands before it
//   Callisto_PackGBuffer( GBuffer, … )           what the base pass calls
//
// A packing serves the model that it names: `callisto on ue4` fills the parameters of `callisto`
// and leaves `callisto_lambert` at its defaults. Where a model is packed a second time, for another
// gbuffer, these two have the gbuffer in their names: CALLISTO_ON_FORK_PARAMETERS,
// Callisto_PackGBufferOnFork; whoever wants that one defines the first macro as the second.
#pragma once

#include "emit/frame.h"
#include "emit/model.h"

namespace lobe::emit {

/// How shaders of the engine reach a packing.
struct GbufferAccess {
    std::string macro;            ///< `CALLISTO_PARAMETERS`
    std::string function;         ///< `Callisto_PackGBuffer`
    std::vector<Member> members;  ///< of the parameters' structure: Packing::parameters in order
    std::vector<std::string> fields;  ///< `GBuffer.CustomData.x`: Packing::channels in order
    /// Fields of free channels in the same targets: nothing lives there, so 0 is written.
    std::vector<std::string> unused;
};

/// Nothing where a packed channel has no name in the engine's shaders, or a parameter no member.
std::optional<GbufferAccess> gbuffer_access(const ir::Module& module, std::size_t packing);

/// The files of one module, as ShadingFiles. The module has packings.
class PackingFiles {
public:
    PackingFiles(const ir::Module& module, const Sources& sources, const Target& target);

    bool serves(const Target& target) const { return &dialect(target) == dialect_; }
    Artifact artifact(const Target& target);
    /// Of a function of the packings.
    const std::string& name_of(ir::FunctionId id) const { return listing_.name_of(id); }

private:
    void add_access(const ir::Packing& packing, const GbufferAccess& access);

    const ir::Module& module_;
    const Dialect* dialect_;
    Record values_;
    std::vector<std::string> calls_;
    Listing listing_;
    std::array<std::optional<Rendered>, 2> rendered_;  ///< without and with precision
};

}  // namespace lobe::emit
