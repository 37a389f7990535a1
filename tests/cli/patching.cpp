#include "cli/patching.h"

#include <catch2/catch.hpp>

namespace lobe::tests {

using engine::Files;
namespace fs = std::filesystem;

const std::string patched_model = R"(/// A small model.
module skin

import ue4_gbuffer { ue4 }

tier base

/// Gain of the diffuse light.
param gain : float in [0, 2] = 1  base  "Gain"
/// Width of the lobe.
param falloff : unit = 0.4        base  "Falloff"
/// How much is reflected.
param shine : unit = 0            base  "Shine"

/// Scale of the falloff.
term scale(x: unit) -> float in [0, 1] = 1 - 0.5 * x

/// Light that the surface scatters and reflects.
model skin(g: geometry, s: surface) {
  diffuse  = s.diffuse_color * g.cos_i * gain * scale(falloff)
  specular = s.f0 * g.cos_i * shine
}

packing skin on ue4 {
  d.r       = gain    : unorm 8 code linear(254/255)
  d.g[4..7] = falloff : unorm 4
  d.a       = shine   : unorm 8
  supports ray_tracing == off
}
)";

const std::string engine_block = R"(
engine ue4 for skin {
  shading_model "Skin"
  pin custom_data0 = gain "Gain"
  node "SkinParameters" { falloff, shine }
  color (0.5, 0.25, 0.125)
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

Place::Place(const Files& tree, const std::string& source)
{
    fs::copy_file(ROOT "/models/ue4_gbuffer.lobe", path("ue4_gbuffer.lobe"));
    write("skin.lobe", source);
    for (const auto& [path, text] : tree) write("tree/" + path, text);
}

void Place::write(const std::string& name, const std::string& text) const
{
    fs::create_directories(path(name).parent_path());
    scratch_.write(name, text);
}

Outcome Place::patch(const std::string& options, bool check_shaders) const
{
    return shell("lobec patch skin.lobe --engine tree " + options +
                 (check_shaders ? "" : " --skip-shaders"));
}

Files Place::tree() const
{
    Files files;
    const fs::path root = path("tree");
    for (const auto& entry : fs::recursive_directory_iterator{root})
        if (!entry.is_directory()) {
            const std::string name = entry.path().lexically_relative(root).generic_string();
            files[name] = read("tree/" + name);
        }
    return files;
}

void Place::edit(const std::string& name, const std::string& from, const std::string& to) const
{
    write("tree/" + name, replaced(read("tree/" + name), from, to));
}

std::string refuses(const Place& place, const std::string& options, int status, bool check_shaders)
{
    const Files before = place.tree();
    const Outcome outcome = place.patch(options, check_shaders);
    CAPTURE(options, outcome.err);
    CHECK(outcome.status == status);
    CHECK(outcome.out.empty());
    CHECK_FALSE(outcome.err.empty());
    CHECK(place.tree() == before);
    return outcome.err;
}

}  // namespace lobe::tests
