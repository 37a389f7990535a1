#include "analyze/emitted.h"

#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <map>

namespace lobe::tests {
namespace {

std::optional<std::uint32_t> add_model(Sources& sources, std::string_view name)
{
    const std::string path = "../models/" + std::string{name} + ".lobe";
    std::ifstream in{path, std::ios::binary};
    if (!in) return std::nullopt;
    return sources.add(path, {std::istreambuf_iterator<char>{in}, {}});
}

void compile(Emitted& out, std::optional<std::uint32_t> root)
{
    REQUIRE(root);
    Diagnostics diagnostics;
    const auto module = front(
        out.sources, *root,
        [](Sources& all, std::string_view imported, std::string_view) {
            return add_model(all, imported);
        },
        diagnostics);
    INFO(render_text(out.sources, diagnostics));
    REQUIRE(module);
    out.module = middle(*module);
}

}  // namespace

const Emitted& emitted_model(const std::string& name)
{
    static std::map<std::string, Emitted> known;
    const auto place = known.find(name);
    if (place != known.end()) return place->second;
    INFO(name);
    Emitted out;
    compile(out, add_model(out.sources, name));
    return known.emplace(name, std::move(out)).first->second;
}

Emitted emitted_text(const std::string& text)
{
    Emitted out;
    compile(out, out.sources.add("test.lobe", text));
    return out;
}

}  // namespace lobe::tests
