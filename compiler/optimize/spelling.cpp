// The other spellings than the one that a build emits; see spelling.h.
#include "optimize/spelling.h"

#include "ir/shade.h"
#include "optimize/bare.h"
#include "optimize/optimize.h"
#include "optimize/stabilize.h"

#include <array>
#include <cassert>

namespace lobe::optimize {

using namespace ir;

namespace {

constexpr std::array all_spellings{Spelling::naive, Spelling::as_written, Spelling::factored,
                                   Spelling::stable};

}  // namespace

std::string_view name(Spelling spelling)
{
    switch (spelling) {
    case Spelling::naive: return "naive";
    case Spelling::as_written: return "as written";
    case Spelling::factored: return "factored";
    case Spelling::stable: return "stable";
    }
    return {};
}

std::span<const Spelling> spellings() { return all_spellings; }

Module spell(const Module& checked, Spelling spelling)
{
    if (spelling == Spelling::stable) return optimize(checked);
    const Module simple = simplify(checked);
    switch (spelling) {
    case Spelling::naive: return with_shades(bare(simple));
    case Spelling::factored: {
        std::vector<Application> log;
        const Module tidy = simplify_again(simple, cancel(simple));
        const Module clean = simplify_again(tidy, stabilize(tidy, log, Inputs::given));
        return with_shades(simplify_again(clean, legalize(regroup(clean))));
    }
    case Spelling::as_written:
    case Spelling::stable: break;
    }
    return with_shades(simplify_again(simple, legalize(simple)));
}

}  // namespace lobe::optimize
