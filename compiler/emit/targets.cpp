#include "emit/target.h"

#include <algorithm>

namespace lobe::emit {

const std::vector<Target>& targets()
{
    static const std::vector<Target> all{
        {"ue4", "Unreal Engine 4.25-4.27", Language::hlsl, 50, ".ush"},
        {"glsl450", "GLSL 4.50, Vulkan", Language::glsl, 450, ".glsl"},
        {"glsl330", "GLSL 3.30, OpenGL", Language::glsl, 330, ".glsl"},
        {"essl310", "GLSL ES 3.10", Language::essl, 310, ".glsl"},
        {"essl300", "GLSL ES 3.00, WebGL 2", Language::essl, 300, ".glsl"},
        {"hlsl", "HLSL, shader model 5", Language::hlsl, 50, ".hlsl"},
    };
    return all;
}

const Target* find_target(std::string_view name)
{
    const auto found = std::ranges::find(targets(), name, &Target::name);
    return found == targets().end() ? nullptr : &*found;
}

}  // namespace lobe::emit
