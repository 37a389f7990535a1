// The layout of a first port, written by hand before there was a checker: every fault that was
// found in it by running it is found here by reading it. What is said about it as a whole is on
// file,
//
//     LOBE_REWRITE=1 build/<preset>/tests/check/test-check "[port]"
//
// takes over a changed text after it was read.
#include "base/render.h"
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace lobe;
using lobe::tests::file_text;
using lobe::tests::words;
namespace fs = std::filesystem;

namespace {

const std::string where = "data/packing/port.lobe";

struct Read {
    Sources sources;
    Diagnostics diagnostics;
};

/// Checks a text as if it were the port, beside the models of the repository.
void check_port(Read& read, std::string text)
{
    const auto root = read.sources.add("tests/" + where, std::move(text));
    const check::Loader loader = [](Sources& sources, std::string_view module,
                                    std::string_view) -> std::optional<std::uint32_t> {
        const std::string path = "models/" + std::string{module} + ".lobe";
        return sources.add(path, file_text("../" + path));
    };
    CHECK(!check::check(read.sources, root, loader, read.diagnostics));
}

/// The text with one line for another, which has to be there.
std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    CAPTURE(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Whether some diagnostic of this code, about a line with this text, says all of this.
bool says(const Read& read, std::string_view code, const std::string& line,
          const std::vector<std::string>& texts)
{
    for (const Diagnostic& diagnostic : read.diagnostics.all()) {
        if (id(diagnostic.code) != code) continue;
        const Source& source = read.sources[diagnostic.primary.span.source];
        const int number = source.position(diagnostic.primary.span.begin).line;
        if (source.line(number).find(line) == std::string_view::npos) continue;
        bool all = true;
        for (const std::string& text : texts)
            all = all && words(diagnostic).find(text) != std::string::npos;
        if (all) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("ambient occlusion carries no parameter", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    // With static lighting, the engine's own setting, it is always read as 1.
    CHECK(says(read, "E0605", "c.a = retroreflection_falloff",
               {"`c.a` is not there", "where r.AllowStaticLighting = on it reads 1"}));
    // Without, ambient light, sky and reflections are darkened by it, and it is changed on its way.
    CHECK(says(read, "E0604", "c.a = retroreflection_falloff",
               {"`c.a` is not the model's alone", "sky light, reflections and ambient",
                "changed by AOMultiBounce", "0.75 becomes 0.853"}));
}

TEST_CASE("a ray tracing payload has no ambient occlusion", "[check][port]")
{
    Read read;
    check_port(read, replaced(file_text(where), "  supports ray_tracing == off\n", ""));
    CHECK(says(read, "E0604", "c.a = retroreflection_falloff",
               {"r.RayTracing = on it is changed by ray tracing, whose payload does not have it"}));
    // And it has other custom data.
    CHECK(says(
        read, "E0604", "d.r = diffuse_fresnel_falloff",
        {"where r.RayTracing = on it is changed by ray tracing", "`supports ray_tracing == off`"}));
}

TEST_CASE("a decode that skips half of what the engine's encode did", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "E0608", "decode(u) = 256 * u",
               {"does not undo its `encode`", "1 is stored as 0.501953 and read as 128.5"}));
    CHECK(says(read, "E0606", "f.a = diffuse_fresnel",
               {"the default of `diffuse_fresnel` does not survive", "1 is stored as code 128",
                "comes back as 128.5"}));
}

TEST_CASE("the anisotropy is not there by default, and not the model's alone", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "E0605", "f.a = diffuse_fresnel",
               {"where r.AnisotropicMaterials = off it reads 0",
                "`supports anisotropic_materials == on`", "`supports anisotropic_platform == yes`",
                "is float 16"}));
    CHECK(says(read, "E0604", "f.a = diffuse_fresnel",
               {"anisotropy, by which reflections bend the normal", "`without anisotropy`"}));
    CHECK(says(read, "E0607", "pin anisotropy = diffuse_fresnel",
               {"clamps to [-1, 1]", "diffuse_fresnel = 256 arrives as 1"}));
}

TEST_CASE("eight linear bits for a gain up to 256", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "E0606", "d.g = retroreflection",
               {"the default of `retroreflection` does not survive",
                "1 is stored as code 1 and comes back as 1.003922",
                "the codes around it are 0, which is 0, and 1, which is 1.003922", "power(8"}));
    // A logarithm does not keep 1 either, but a device's own.
    Read logarithm;
    check_port(logarithm, replaced(file_text(where), "d.g = retroreflection : unorm 8",
                                   "d.g = retroreflection : unorm 8 code log2"));
    CHECK(says(logarithm, "E0606", "d.g = retroreflection", {"comes back as 1.006"}));
}

TEST_CASE("a gain through the opacity arrives as 1 at most", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "E0607", "pin opacity = retroreflection",
               {"clamps to [0, 1]", "retroreflection = 256 arrives as 1"}));
    // Said as a code: what is stored is taken as it is, without the factor that the range asks for.
    Read unscaled;
    check_port(unscaled, replaced(replaced(file_text(where), "d.g = retroreflection : unorm 8",
                                           "d.g = retroreflection : unorm 8 code unscaled"),
                                  "packing callisto on ue4 {",
                                  "code unscaled(x: float in [0, 256]) {\n  encode = min(x, 1)\n"
                                  "  decode(u) = u\n}\n\npacking callisto on ue4 {"));
    CHECK(says(unscaled, "E0608", "decode(u) = u", {"`decode` of the code `unscaled`"}));
}

TEST_CASE("seven scalars do not fit into four channels", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "E0613", "packing callisto on ue4",
               {"these fields need 72 bits, and `ue4` has 32", "d.r with 8", "d.a with 8"}));
    CHECK(says(read, "E0602", "d.r = specular_fresnel_falloff",
               {"`diffuse_fresnel_falloff` and `specular_fresnel_falloff` share bits of `d.r`"}));
    CHECK(says(read, "E0602", "d.b = dual_specular_roughness_scale", {"by `smooth_terminator`"}));
    CHECK(says(read, "E0602", "d.a = dual_specular_opacity", {"by `smooth_terminator_length`"}));
}

TEST_CASE("a pin with one parameter's name and another one's wire", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    CHECK(says(read, "W0601", "smooth_terminator : snorm 8",
               {"`smooth_terminator` is packed, but no pin or node feeds it"}));
}

TEST_CASE("what is said about the port is what is on file", "[check][port]")
{
    Read read;
    check_port(read, file_text(where));
    // Not the lines of the models that it points to: they move.
    Diagnostics own;
    for (Diagnostic diagnostic : read.diagnostics.all()) {
        const std::uint32_t root = diagnostic.primary.span.source;
        std::erase_if(diagnostic.secondary,
                      [root](const Label& label) { return label.span.source != root; });
        own.report(std::move(diagnostic));
    }
    const std::string text = render_text(read.sources, own);
    const fs::path expected = fs::path{where}.replace_extension(".txt");
    if (std::getenv("LOBE_REWRITE") != nullptr) std::ofstream{expected, std::ios::binary} << text;
    CHECK(file_text(expected.generic_string()) == text);
}
