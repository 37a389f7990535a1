// Files that were compiled into the program (cmake/embed.cmake).
#pragma once

#include <span>
#include <string_view>

namespace lobe {

struct Embedded {
    std::string_view name;  ///< path relative to the folder that was embedded
    std::string_view text;
};

/// docs/diagnostics/*.md
std::span<const Embedded> embedded_diagnostic_pages();

/// models/lights.lobe
std::span<const Embedded> embedded_lights();

/// templates/**
std::span<const Embedded> embedded_templates();

}  // namespace lobe
