// Module to text: what a person includes in their engine, and what the judges run.
//
// The module has been through optimize (the promise `legal`). Dialects are tables; the writer
// is one loop; file frames are templates. Total: a failure here is a bug.
#pragma once

#include "emit/target.h"
#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::emit {

/// Lines first .. last (from 1) of an artifact were written for this place in a .lobe file. In an
/// artifact these are in order and do not overlap; a statement's own line has its own place.
struct LineOrigin {
    int first = 0;
    int last = 0;
    Span span;
};

struct Artifact {
    std::string path;  ///< relative to the output folder: `callisto/ue4/Callisto.ush`
    std::string text;
    std::vector<LineOrigin> origins;
    std::vector<std::string> calls = {};  ///< statements that call every root once; see `frame`
};

/// The files of one module for one target: its functions and models, unless it has none; and, if it
/// has packings, the file that packs and unpacks.
std::vector<Artifact> emit(const ir::Module& module, const Sources& sources, const Target& target);

/// The same for several targets, in their order. What is the same text for some of them is written
/// once.
std::vector<Artifact> emit(const ir::Module& module, const Sources& sources,
                           const std::vector<const Target*>& targets);

/// A number format a function can be computed in on a device.
enum class Precision {
    float32,
    float16
};

/// A compute shader that evaluates one function at many points: the function exactly as `emit`
/// writes it for this target, everything it calls, its entry point from vectors, and a main that
/// reads the inputs of point i from a storage buffer at binding 0 and writes its results to one
/// at binding 1. Floats, tightly packed: inputs are the scalars of `evaluate::Tape::inputs` of
/// the entry point, in that order. Workgroups of 64; a push constant `uint count` bounds it.
struct Harness {
    Artifact artifact;
    int inputs = 0;  ///< floats per point
    int outputs = 0;
    std::string entry = "main";
};
Harness harness(const ir::Module& module, const Sources& sources, ir::FunctionId function,
                const Target& target, Precision precision);

/// A shader that unpacks every parameter of a packing from what its channels read and packs them
/// again: the packing's file as `emit` writes it, in Unreal through the macro and the function that
/// stand there for the engine. Inputs of a point: what each of Packing::channels reads. Outputs:
/// what each is to store then, followed by the unpacked parameters, component by component.
Harness packing_harness(const ir::Module& module, const Sources& sources, std::size_t packing,
                        const Target& target);

/// One output of a model's BxDF for Unreal, as emitted, under a point light of radiance 1.
struct BxdfCheck {
    ir::Module module;        ///< the module, with `function` added
    ir::FunctionId function;  ///< what the BxDF must compute, over vectors
    Harness harness;          ///< its inputs are those of the function's entry point
};
/// Every output of every BxDF of a module; where the model is packed once more, as the module's and
/// the packing's file are in the engine: then its parameters come out of the GBuffer. Not those
/// that share a member of the engine's result, and not those of models with a tangent frame, whose
/// context the stand-in does not define.
std::vector<BxdfCheck> bxdf_checks(const ir::Module& module, const Sources& sources);

/// Text that makes an artifact a whole shader for its judge: the version line, the stand-in
/// prelude of the engine, a main that calls every root so that nothing is dropped. Line counts tell
/// how far the artifact's lines move.
struct Framed {
    std::string text;
    int first_line = 1;  ///< of the artifact within the text
};
Framed frame(const Artifact& artifact, const Target& target);

}  // namespace lobe::emit
