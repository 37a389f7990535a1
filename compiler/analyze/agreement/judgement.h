// One text before all judges: the verdicts, in the order they were given.
//
//   text ─glslang─▶ SPIR-V ─spirv-val─▶ ─spirv-opt─▶ ─spirv-val─▶
//                     └─SPIRV-Cross─▶ GLSL, ESSL, HLSL, MSL ─glslang again─▶ (all but MSL)
//
// A later judge is asked only about what the earlier ones accepted.
#pragma once

#include "analyze/agreement/agreement.h"
#include "emit/emit.h"
#include "verify/judge.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// A judge's message, verbatim, and what it speaks of.
struct Remark {
    int line = 0;  ///< of the artifact; 0 when the judge named none
    std::string text;
    std::optional<Span> place;  ///< in a .lobe file, when the line was written for one
};

struct Judgement {
    std::string artifact;  ///< its path
    std::string target;
    std::string judge;  ///< one of `judge_names()`
    bool accepted = false;
    std::vector<Remark> remarks;  ///< of a refusal
};

/// Every judge, in the order they are asked.
const std::vector<std::string>& judge_names();

/// A whole file, framed for its judges. GLSL 3.30 and ESSL 3.00 stop after glslang, which makes
/// no SPIR-V of them.
std::vector<Judgement> judge_file(const emit::Artifact& artifact, const emit::Target& target);

/// A harness, and what is to be run of it: nothing unless every judge on the way to it accepted.
/// Half precision is not crossed: ESSL 3.10 and HLSL 5.0 have no word for it.
struct Judged {
    std::vector<Judgement> judgements;
    std::vector<std::uint32_t> direct;     ///< NoContraction everywhere
    std::vector<std::uint32_t> optimized;  ///< of `direct`

    bool accepted() const;
};
Judged judge_harness(const emit::Harness& harness, const emit::Target& target,
                     emit::Precision precision);

/// Only what it takes to run a harness, direct; empty if a judge refused. For mutants.
std::vector<std::uint32_t> spirv_of(std::string_view text, const emit::Target& target,
                                    std::string_view entry);

}  // namespace lobe::analyze
