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

std::uint32_t add_model(Sources& sources, std::string_view module)
{
    const std::string path = "models/" + std::string{module} + ".lobe";
    return sources.add(path, read("../" + path));
}

void compile(Shipped& result, std::uint32_t root)
{
    Diagnostics diagnostics;
    const check::Loader loader = [](Sources& all, std::string_view module,
                                    std::string_view) -> std::optional<std::uint32_t> {
        return add_model(all, module);
    };
    const auto module = front(result.sources, root, loader, diagnostics);
    REQUIRE(module.has_value());
    result.module = middle(*module);
}

}  // namespace

Shipped shipped(const std::string& name)
{
    Shipped result;
    compile(result, add_model(result.sources, name));
    return result;
}

Shipped written(const std::string& text)
{
    Shipped result;
    compile(result, result.sources.add("written.lobe", text));
    return result;
}

}  // namespace lobe::tests
