#include "emit/namer.h"

#include <fmt/format.h>

namespace lobe::emit {
namespace {

/// Without what GLSL keeps for itself.
std::string allowed(std::string_view wanted)
{
    std::string name;
    for (const char c : wanted)
        if (c != '_' || name.empty() || name.back() != '_') name += c;
    if (name.starts_with("gl_")) name.insert(0, "a_");
    return name;
}

}  // namespace

bool Namer::is_taken(std::string_view name) const
{
    for (const Namer* namer = this; namer != nullptr; namer = namer->outer_)
        if (namer->taken_.contains(name)) return true;
    return dialect_->reserved.contains(name);
}

std::string Namer::unique(std::string_view wanted)
{
    const std::string base = allowed(wanted);
    std::string name = base;
    if (dialect_->reserved.contains(name) && !name.ends_with('_')) name += '_';
    const std::string_view stem =
        std::string_view{base}.substr(0, base.size() - (base.ends_with('_') ? 1 : 0));
    for (int count = 2; is_taken(name); ++count) name = fmt::format("{}_{}", stem, count);
    taken_.insert(name);
    return name;
}

}  // namespace lobe::emit
