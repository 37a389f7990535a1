// The language reference says only what compiles.
#include "analyze/packing/radiance.h"
#include "base/render.h"
#include "check/check.h"
#include "compile.h"
#include "syntax/format.h"
#include "syntax/parse.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <sstream>

namespace lobe {
namespace {

std::string read(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    INFO(path);
    REQUIRE(file);
    std::ostringstream text;
    text << file.rdbuf();
    return std::move(text).str();
}

/// The fenced blocks of a page that hold the language: those without a word behind the fence that
/// begin with one of these items.
std::vector<std::string> examples(const std::string& page, std::span<const std::string_view> items)
{
    std::istringstream lines{read(page)};
    std::vector<std::string> found;
    bool inside = false;
    std::string block;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("```")) {
            if (inside) block += line + "\n";
            continue;
        }
        inside = !inside;
        if (inside) {
            block.clear();
            continue;
        }
        std::istringstream words{block};
        std::string first;
        for (std::string row; std::getline(words, row);)
            if (!row.starts_with("//")) {
                first = row.substr(0, row.find(' '));
                break;
            }
        if (std::ranges::find(items, first) != items.end()) found.push_back(block);
    }
    return found;
}

/// Messages about a text; empty when there are none. What packings ask of radiance is measured.
std::string complaints(const std::string& text)
{
    const check::Loader loader = [](Sources& sources, std::string_view module, std::string_view) {
        const std::string path = "../models/" + std::string{module} + ".lobe";
        return std::optional{sources.add(path, read(path))};
    };
    Sources sources;
    Diagnostics diagnostics;
    const std::uint32_t source = sources.add("example.lobe", text);
    if (const auto module = front(sources, source, loader, diagnostics)) {
        const ir::Module computed = middle(*module);
        for (const ir::Packing& packing : computed.packings) {
            const auto errors = analyze::packing_errors(computed, packing);
            const Diagnostics unmet = analyze::unmet(computed, packing, errors);
            for (const Diagnostic& diagnostic : unmet.all()) diagnostics.report(diagnostic);
        }
    }
    return render_text(sources, diagnostics);
}

}  // namespace

TEST_CASE("every example of the language reference compiles without a complaint")
{
    constexpr std::array<std::string_view, 7> items{"module", "tier",  "param", "term",
                                                    "model",  "light", "effect"};
    const auto found = examples("../docs/language.md", items);
    REQUIRE(found.size() == 9);
    for (const std::string& example : found) {
        // A fragment stands in a module that declares what it cites and calls.
        const bool whole = example.find("module ") != std::string::npos;
        const bool model = example.starts_with("model ");
        std::string text = whole ? "" : "module fragment\n";
        if (model) text += "import callisto { c1, c2, proxima_cos, specular_cos }\n";
        if (example.starts_with("light "))
            text += "import lights { falloff, closest_on_sphere, SphereNormalization }\n";
        if (!whole)
            text += "source Walter07 = \"Walter et al. 2007\"\n"
                    "source Karis13 = \"Karis 2013\"\n"
                    "source slides = \"Jimenez et al. 2023\"\n";
        if (model) text += "/// slides 131\n";
        if (example.starts_with("term ")) text += "/// Walter07 eq 25\n";
        text += example;
        // Parameters that a fragment declares for show are used by a term of ours.
        if (example.find("param diffuse_fresnel ") != std::string::npos)
            text += "/// slides 85\nterm gain() -> color in [0, 256] = "
                    "diffuse_fresnel * diffuse_fresnel_tint\n";
        CAPTURE(text);
        CHECK(complaints(text) == "");
    }
}

TEST_CASE("the gbuffer, packing, code and engine of the language reference fit each other")
{
    constexpr std::array<std::string_view, 4> items{"gbuffer", "packing", "code", "engine"};
    const auto found = examples("../docs/language.md", items);
    REQUIRE(found.size() == 4);
    std::string text = "module fragment\nimport callisto { callisto_lambert }\n";
    for (const std::string& example : found) text += example;
    CAPTURE(text);
    CHECK(complaints(text) == "");

    Sources sources;
    Diagnostics diagnostics;
    const auto tree = syntax::parse(sources, sources.add("example.lobe", text), diagnostics);
    CHECK(syntax::format(tree) == text);
}

}  // namespace lobe
