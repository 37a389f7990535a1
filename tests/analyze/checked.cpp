#include "analyze/checked.h"

#include "base/render.h"
#include "check/check.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <optional>

namespace lobe::tests {
namespace {

std::optional<std::uint32_t> add_file(Sources& sources, const std::string& path)
{
    std::ifstream in{path, std::ios::binary};
    if (!in) return std::nullopt;
    return sources.add(path, {std::istreambuf_iterator<char>{in}, {}});
}

void check_root(Checked& out, std::optional<std::uint32_t> root)
{
    REQUIRE(root);
    Diagnostics diagnostics;
    const auto module = check::check(
        out.sources, *root,
        [](Sources& all, std::string_view imported, std::string_view) {
            return add_file(all, "../models/" + std::string{imported} + ".lobe");
        },
        diagnostics);
    INFO(render_text(out.sources, diagnostics));
    REQUIRE(module);
    out.module = *module;
}

}  // namespace

Checked checked_model(const std::string& path)
{
    INFO(path);
    Checked out;
    check_root(out, add_file(out.sources, path));
    return out;
}

Checked checked_text(const std::string& text)
{
    Checked out;
    check_root(out, out.sources.add("test.lobe", text));
    return out;
}

}  // namespace lobe::tests
