#include "analyze/residual/emitters.h"

#include "analyze/residual/reach.h"

#include <cmath>

namespace lobe::analyze {
namespace {

constexpr double centimeters = 100;  ///< of a meter

/// What a light gives to the fields that its light function asks for.
std::map<std::string, double> fields_of(const scene::Light& light)
{
    using Kind = scene::Light::Kind;
    std::map<std::string, double> fields;
    if (light.kind == Kind::directional) return fields;
    fields["inverse_range"] = light.range ? 1 / (centimeters * *light.range) : 0;
    if (light.kind == Kind::spot) {
        fields["cos_inner"] = std::cos(light.inner_cone);
        fields["cos_outer"] = std::cos(light.outer_cone);
    }
    if (light.kind == Kind::tube) fields["half_length"] = centimeters * light.length / 2;
    if (light.radius > 0) fields["radius"] = centimeters * light.radius;
    return fields;
}

}  // namespace

std::string light_name(const scene::Light& light)
{
    using Kind = scene::Light::Kind;
    switch (light.kind) {
    case Kind::directional: return "directional";
    case Kind::point: return "punctual";
    case Kind::spot: return "spot";
    case Kind::sphere: return "sphere";
    case Kind::tube: return light.radius > 0 ? "capsule" : "tube";
    }
    return {};
}

std::map<std::string, optimize::Called> emitter_facts(const std::vector<scene::Light>& lights)
{
    std::map<std::string, optimize::Called> out;
    for (const scene::Light& light : lights) {
        optimize::Limits& ranges = out[light_name(light)].ranges;
        for (const auto& [field, value] : fields_of(light)) {
            const auto [known, is_first] = ranges.try_emplace(field, ir::Range{value, value});
            if (!is_first) known->second = hull(known->second, {value, value});
        }
    }
    for (auto& [name, emitter] : out)
        for (auto& [field, range] : emitter.ranges) {
            if (range == ir::Range{0, 0} || range == ir::Range{1, 1})
                emitter.constants[field] = {range.low};
            range = in_digits(rounded_by_hosts(range));
        }
    return out;
}

}  // namespace lobe::analyze
