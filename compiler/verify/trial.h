// One text before all judges, one after the other.
//
// compile, validate, optimize, validate again; then what SPIRV-Cross makes of it in four
// languages, each of which glslang judges again where it knows the language. A text that Vulkan
// does not take (GLSL 3.30, ESSL 3.00) is parsed under OpenGL rules, and that is all.
#pragma once

#include "verify/judge.h"

namespace lobe::verify {

struct Step {
    std::string name;  ///< `compile`, `validate`, `optimize`, `to hlsl50`, `hlsl50 again`, ...
    Verdict verdict;
};

/// The steps up to the first that leaves nothing to go on with. A refusal by one cross-compiler
/// does not keep the others from being asked.
struct Trial {
    std::vector<Step> steps;

    bool accepted() const;

    /// Null if all accepted.
    const Step* first_refusal() const;
};

enum class Route {
    vulkan,
    opengl
};

/// `entry` is for HLSL.
Trial chain(std::string_view text, Dialect dialect, Stage stage, Route route,
            std::string_view entry = "main");

}  // namespace lobe::verify
