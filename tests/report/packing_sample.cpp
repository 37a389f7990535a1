#include "packing_sample.h"

namespace lobe::tests {
namespace {

ir::Parameter parameter(std::string name, ir::Range range, std::vector<double> defaults)
{
    ir::Parameter out;
    out.name = std::move(name);
    out.type = ir::vector_type(static_cast<int>(defaults.size()));
    out.quantity = defaults.size() == 1 ? ir::Quantity::number : ir::Quantity::color;
    out.range = range;
    out.default_value = std::move(defaults);
    out.module = "skin";
    return out;
}

/// The configurations are lighting: baked or moving.
const ir::Configurations everywhere{true, true}, baked{true, false}, moving{false, true};

ir::Channel channel(std::size_t target, std::string name, std::string label, ir::Format format)
{
    ir::Channel out;
    out.target = target;
    out.name = std::move(name);
    out.label = std::move(label);
    out.field = "GBuffer." + out.label;
    out.formats = {format, format};
    out.exists = everywhere;
    return out;
}

ir::Gbuffer small_gbuffer()
{
    constexpr ir::Format unorm8{ir::Storage::unorm, 8}, unorm10{ir::Storage::unorm, 10},
        float16{ir::Storage::floating, 16};
    ir::Gbuffer out;
    out.name = "small";
    out.settings.push_back({"lighting", "r.Lighting", {"baked", "moving"}, 0, "", {}});
    out.targets = {{"a", "Normals", "", {}},
                   {"d", "Custom", "", {}},
                   {"e", "Shadows", "", {}},
                   {"motion", "Motion", "", {}}};
    for (const char* name : {"r", "g", "b"}) {
        out.channels.push_back(channel(0, name, "Normal", unorm10));
        out.channels.back().holders.push_back({"normal", "world normal", false, everywhere, {}});
    }
    for (const char* name : {"r", "g", "b", "a"})
        out.channels.push_back(channel(1, name, std::string{"Custom."} + name, unorm8));
    out.channels[5].changes.push_back({"a <ray> pass", moving, {}});

    out.channels.push_back(channel(2, "r", "Shadow", unorm8));
    out.channels.back().exists = moving;
    out.channels.push_back(channel(2, "g", "Occlusion", unorm8));
    out.channels.back().holders = {{"irradiance", "baked irradiance", false, baked, {}},
                                   {"occlusion", "ambient occlusion", true, moving, {}}};
    out.channels.push_back(channel(2, "b", "Gloss", {ir::Storage::unorm, 16}));
    out.channels.push_back(channel(3, "r", "Speed", float16));
    out.channels.back().holders.push_back({"velocity", "velocity", false, everywhere, {}});
    return out;
}

ir::Field field(std::uint32_t parameter, std::vector<ir::Slot> slots, ir::Code code,
                ir::Range range)
{
    ir::Field out;
    out.parameter = parameter;
    out.slots = std::move(slots);
    for (const ir::Slot& slot : out.slots) out.bits += slot.bits;
    out.code = std::move(code);
    out.range = range;
    return out;
}

ir::Packing packing()
{
    ir::Code power;
    power.kind = ir::Code::Kind::power;
    power.exponent = 8;
    power.pivot = 127;
    ir::Code pivoted;
    pivoted.pivot = 12;
    ir::Packing out;
    out.model.name = "skin";
    out.gbuffer = "small";
    out.module = "skin";
    out.supported = everywhere;
    out.fields = {
        field(0, {{3, 0, 8}}, power, {0, 256}), field(1, {{5, 4, 4}}, pivoted, {0, 0.9375}),
        field(2, {{5, 0, 3}}, {}, {-1, 1}),     field(3, {{4, 0, 8}, {6, 6, 2}}, {}, {0, 1}),
        field(3, {{6, 4, 2}}, {}, {0, 1}),      field(3, {{6, 0, 1}}, {}, {0, 1})};
    out.fields[2].is_signed = true;
    out.fields[4].component = 1;
    out.fields[5].component = 2;
    return out;
}

analyze::RadianceError error(double worst)
{
    analyze::RadianceError out{worst, worst / 20, worst / 2, {}};
    out.witness.inputs = {{"l.x", 0.8},
                          {"l.y", 0},
                          {"l.z", 0.6},
                          {"v.x", -0.8},
                          {"v.y", 0},
                          {"v.z", 0.6},
                          {"n.x", 0},
                          {"n.y", 0},
                          {"n.z", 1},
                          {"roughness", 0.3},
                          {"gain", 17.25},
                          {"falloff", 0.75},
                          {"smooth_terminator", 0},
                          {"tint.r", 0.5},
                          {"tint.g", 1},
                          {"tint.b", 1}};
    out.witness.stored = {{"gain", 17},    {"falloff", 0.75}, {"smooth_terminator", 0},
                          {"tint.r", 0.5}, {"tint.g", 1},     {"tint.b", 1}};
    out.witness.exact = 1.25;
    out.witness.packed = 1.5;
    return out;
}

}  // namespace

PackingSample packing_sample()
{
    PackingSample out;
    ir::Module& module = out.module;
    module.name = "skin";
    module.parameters = {parameter("gain", {0, 256}, {1}), parameter("falloff", {0, 1}, {0.75}),
                         parameter("smooth_terminator", {-1, 1}, {0}),
                         parameter("tint", {0, 1}, {1, 1, 1})};
    module.gbuffers = {small_gbuffer()};
    module.packings = {packing()};

    analyze::Suggestion& found = out.suggestion;
    found.module = module;
    found.found = true;
    found.give_ups = {"`without occlusion`: 8 more bits, the worst error falls to 3 %"};
    for (std::uint32_t i = 0; i < 3; ++i) {
        analyze::Curve curve{i, {}};
        for (int bits = 2; bits <= 10; ++bits)
            if (bits != 5) curve.points.push_back({bits, false, {}, (1 + i) / double(1 << bits)});
        found.curves.push_back(std::move(curve));
    }
    for (int bits = 6; bits <= 28; ++bits)
        found.trade.push_back({bits, {bits - 4, 2, 2}, 2.0 / bits / bits, 1.5 / bits / bits});
    found.errors.points = 4096;
    found.errors.parameters = {
        {0, error(0.04)}, {1, error(0.1)}, {2, error(0)}, {3, error(0.0025)}};
    found.errors.whole = error(0.125);
    found.linear = found.errors;
    found.linear.whole = error(2.5);
    found.text = "packing skin on small {\n  d.r = gain : unorm 8 code power(8, 127/255)\n}\n";
    return out;
}

report::Packed PackingSample::packed() const
{
    report::Packed out;
    out.module = &module;
    out.packing = &module.packings.front();
    for (std::size_t channel = 3; channel < 7; ++channel) out.room.push_back({channel, 0, 8});
    out.codes.resize(6, {256, 1, 255, 1, 0.0078125, 0.5, 0, 1});
    out.codes[0] = {255, 1, 127, 1, 7.875, 248.125, 0, 256};
    out.codes[1] = {16, 0.75, 12, 0.7499999, 0.0625, 0, 0, 0.9375};
    out.errors = suggestion.errors;
    out.limit = 0.25;
    return out;
}

report::Packed PackingSample::suggested() const
{
    report::Packed out = packed();
    out.module = &suggestion.module;
    out.packing = &suggestion.module.packings.back();
    out.suggestion = &suggestion;
    out.limit = 0.2;
    out.written_error = 0.5;
    out.written_bits = 24;
    return out;
}

}  // namespace lobe::tests
