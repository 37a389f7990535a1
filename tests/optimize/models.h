// The models that ship, and small ones as text, checked.
#pragma once

#include "check/check.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>
#include <string>

namespace lobe::tests {

/// Imports come from models/; the working directory is tests/.
inline ir::Module read_text(const std::string& text, const std::string& path = "test.lobe")
{
    Sources sources;
    Diagnostics diagnostics;
    const std::uint32_t root = sources.add(path, text);
    const check::Loader loader = [](Sources& into, std::string_view module,
                                    std::string_view) -> std::optional<std::uint32_t> {
        const std::string file = "../models/" + std::string{module} + ".lobe";
        std::ifstream stream{file};
        if (!stream) return std::nullopt;
        std::stringstream read;
        read << stream.rdbuf();
        return into.add(file, read.str());
    };
    const auto module = check::check(sources, root, loader, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.all())
        UNSCOPED_INFO(sources.cite(diagnostic.primary.span) << ": " << diagnostic.message);
    REQUIRE(module);
    return *module;
}

inline ir::Module read_model(const std::string& path)
{
    std::ifstream stream{path};
    REQUIRE(stream);
    std::stringstream read;
    read << stream.rdbuf();
    return read_text(read.str(), path);
}

}  // namespace lobe::tests
