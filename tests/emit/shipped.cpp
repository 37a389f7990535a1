#include "emit/shipped.h"

#include "compile.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

namespace lobe::tests {
namespace {

std::string read(const std::string& path)
{
    std::ifstream file{path};
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace

Shipped shipped(const std::string& name)
{
    Shipped result;
    Diagnostics diagnostics;
    const auto add = [](Sources& all, std::string_view module) {
        const std::string path = "models/" + std::string{module} + ".lobe";
        return all.add(path, read("../" + path));
    };
    const std::uint32_t root = add(result.sources, name);
    const check::Loader loader = [&](Sources& all, std::string_view module,
                                     std::string_view) -> std::optional<std::uint32_t> {
        return add(all, module);
    };
    const auto module = front(result.sources, root, loader, diagnostics);
    REQUIRE(module.has_value());
    result.module = middle(*module);
    return result;
}

}  // namespace lobe::tests
