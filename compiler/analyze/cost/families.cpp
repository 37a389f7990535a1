// The names of families and formats.
#include "analyze/cost/cost.h"

#include <algorithm>

namespace lobe::analyze {

std::string_view name(Family family)
{
    switch (family) {
    case Family::gcn4: return "gcn4";
    case Family::gcn5: return "gcn5";
    case Family::rdna1: return "rdna1";
    case Family::rdna2: return "rdna2";
    case Family::rdna3: return "rdna3";
    }
    return {};
}

std::string_view title(Family family)
{
    switch (family) {
    case Family::gcn4: return "GCN4 (polaris10)";
    case Family::gcn5: return "GCN5 (vega10)";
    case Family::rdna1: return "RDNA1 (navi10)";
    case Family::rdna2: return "RDNA2 (navi21)";
    case Family::rdna3: return "RDNA3 (gfx1100)";
    }
    return {};
}

std::optional<Family> find_family(std::string_view wanted)
{
    const auto found =
        std::ranges::find(all_families, wanted, [](Family family) { return name(family); });
    return found == all_families.end() ? std::nullopt : std::optional{*found};
}

std::string_view name(Format format)
{
    switch (format) {
    case Format::float32: return "float";
    case Format::float16: return "half";
    case Format::packed16: return "packed half";
    }
    return {};
}

}  // namespace lobe::analyze
