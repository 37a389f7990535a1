// Proving what a body needs: every obligation of a draft, over the declared ranges of its inputs.
#pragma once

#include "check/boxes.h"
#include "check/draft.h"

namespace lobe::check {

/// True when every obligation of the draft is proved. Reports each that is not, with an input that
/// breaks it where one is found. Sets the range of the draft's function: what was declared,
/// narrowed by what is inferred.
bool prove(const Program& program, Draft& draft, const Sources& sources, Effort& effort,
           Diagnostics& diagnostics);

}  // namespace lobe::check
