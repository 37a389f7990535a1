// The targets, as values: a name people type, a language, and where files go.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::emit {

enum class Language {
    glsl,
    essl,
    hlsl
};

struct Target {
    std::string name;   ///< `ue4`, `glsl450`, `glsl330`, `essl310`, `essl300`, `hlsl`
    std::string title;  ///< `Unreal Engine 4.25-4.27`
    Language language{};
    int version = 0;        ///< 450, 330, 310, 300; shader model 50
    std::string extension;  ///< `.ush`, `.glsl`, `.hlsl`
};

const std::vector<Target>& targets();
const Target* find_target(std::string_view name);

}  // namespace lobe::emit
