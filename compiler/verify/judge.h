// The outside judges, linked in process: glslang, SPIRV-Tools, SPIRV-Cross.
//
// Text or SPIR-V in, a verdict out. They see text, never the IR: a judge must not share the
// defendant's notes. Messages are kept verbatim, with the line they speak of.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::verify {

struct Message {
    int line = 0;      ///< in the text that was judged; 0 if none was named
    std::string text;  ///< verbatim, one message
};

struct Verdict {
    bool accepted = false;
    std::vector<Message> messages;     ///< errors, and warnings when accepted
    std::vector<std::uint32_t> spirv;  ///< of an accepted compile, or of the optimizer
    std::string text;                  ///< of a cross-compile
};

enum class Dialect {
    glsl,
    essl,
    hlsl
};
enum class Stage {
    fragment,
    compute
};

/// The text of `#include "name"`; nothing if there is none. A file whose text says `#pragma once`
/// is asked for once: the judge heeds it.
using Includes = std::function<std::optional<std::string>(std::string_view name)>;

/// glslang, with `nan-clamp`. Vulkan 1.1, SPIR-V 1.3 rules; `entry` and `includes` are for HLSL.
Verdict compile(std::string_view text, Dialect dialect, Stage stage,
                std::string_view entry = "main", const Includes& includes = {});

/// glslang under OpenGL rules, for GLSL 3.30 and ESSL 3.00 which Vulkan does not take; parses
/// and links, makes no SPIR-V for versions that have none.
Verdict parse_only(std::string_view text, Dialect dialect, Stage stage);

/// spirv-val, Vulkan 1.1.
Verdict validate(std::span<const std::uint32_t> spirv);

/// spirv-opt -O.
Verdict optimize(std::span<const std::uint32_t> spirv);

/// Every floating-point arithmetic result decorated NoContraction: what `precise` would do,
/// for a check that must not be re-associated. Production text stays free.
std::vector<std::uint32_t> forbid_contraction(std::span<const std::uint32_t> spirv);

enum class CrossTarget {
    glsl450,
    essl310,
    hlsl50,
    msl21
};
Verdict cross_compile(std::span<const std::uint32_t> spirv, CrossTarget target);

}  // namespace lobe::verify
