#include "emit/packings.h"

#include "optimize/optimize.h"

namespace lobe::tests {
namespace {

using ir::ExprId;
using ir::Op;
using ir::Type;

void add_parameter(Builder& b, std::string name, Type type, ir::Range range,
                   std::vector<double> standard)
{
    ir::Parameter parameter;
    parameter.name = std::move(name);
    parameter.type = type;
    parameter.quantity = type == Type::vec3 ? ir::Quantity::color : ir::Quantity::number;
    parameter.range = range;
    parameter.default_value = std::move(standard);
    parameter.doc = "What " + parameter.name + " does.";
    parameter.module = b.module.name;
    parameter.span = b.line(static_cast<int>(b.module.parameters.size()) + 2);
    b.module.parameters.push_back(std::move(parameter));
}

/// tint * diffuse_color * cos_i * the sum of the others
void add_output(Builder& b)
{
    ir::Function& f = b.term("skin_diffuse", 20);
    f.kind = ir::Function::Kind::output;
    f.quantity = ir::Quantity::color;
    ir::Graph& g = f.graph;
    const ExprId cos = field(f, ir::GeometryField::cos_i);
    const ExprId albedo = field(f, ir::SurfaceField::diffuse_color);
    ExprId sum = parameter(b.module, f, 0);
    for (const std::uint32_t i : {1u, 2u, 3u, 4u, 6u})
        sum = g.apply(Op::add, {sum, parameter(b.module, f, i)});
    const ExprId tint = parameter(b.module, f, 5);
    f.result = g.apply(Op::multiply,
                       {g.apply(Op::multiply, {g.apply(Op::multiply, {tint, albedo}), cos}), sum});
    b.module.models.push_back(
        {"skin", "A skin.", b.module.name, b.line(19), {{"diffuse", ir::FunctionId{0}}}});
}

ir::Gbuffer unreal(const Builder& b)
{
    ir::Gbuffer gbuffer;
    gbuffer.name = "ue4";
    gbuffer.module = b.module.name;
    const auto add_target = [&](const std::string& name, const std::string& label) {
        gbuffer.targets.push_back({name, label, "", b.line(25)});
    };
    const auto add_channel = [&](const std::string& name, const std::string& label,
                                 const std::string& field) {
        ir::Channel channel;
        channel.target = gbuffer.targets.size() - 1;
        channel.name = name;
        channel.label = label;
        channel.field = field;
        channel.formats = {{ir::Storage::unorm, 8}};
        channel.exists = {true};
        gbuffer.channels.push_back(std::move(channel));
    };
    add_target("c", "GBufferC");
    add_channel("r", "BaseColor.r", "");
    gbuffer.channels.back().holders.push_back({"base_color", "base color", false, {true}, {}});
    add_channel("a", "GenericAO", "GBuffer.GBufferAO");
    add_target("d", "GBufferD");
    add_channel("r", "CustomData.x", "GBuffer.CustomData.x");
    add_channel("g", "CustomData.y", "GBuffer.CustomData.y");
    add_channel("b", "CustomData.z", "GBuffer.CustomData.z");
    add_channel("a", "CustomData.w", "GBuffer.CustomData.w");
    add_target("e", "GBufferE");
    add_channel("r", "PrecomputedShadowFactors.x", "GBuffer.PrecomputedShadowFactors.x");
    add_channel("g", "PrecomputedShadowFactors.y", "GBuffer.PrecomputedShadowFactors.y");
    return gbuffer;
}

ir::Code code(ir::Code::Kind kind, int exponent, int pivot)
{
    ir::Code result;
    result.kind = kind;
    result.exponent = exponent;
    result.pivot = pivot;
    return result;
}

ir::Field stored(const Builder& b, std::uint32_t parameter, std::vector<ir::Slot> slots,
                 ir::Code code, int component = 0)
{
    ir::Field field;
    field.parameter = parameter;
    field.component = component;
    for (const ir::Slot& slot : slots) field.bits += slot.bits;
    field.slots = std::move(slots);
    field.range = b.module.parameters[parameter].range;
    field.code = std::move(code);
    field.span = b.line(30);
    return field;
}

}  // namespace

Builder checked_skin()
{
    using Kind = ir::Code::Kind;
    Builder b{"skin"};
    add_parameter(b, "gain", Type::scalar, {0, 256}, {1});
    add_parameter(b, "falloff", Type::scalar, {0, 1}, {0.75});
    add_parameter(b, "terminator", Type::scalar, {-1, 1}, {0});
    add_parameter(b, "roughening", Type::scalar, {0, 1}, {1});
    add_parameter(b, "sheen", Type::scalar, {0, 4}, {1});
    add_parameter(b, "tint", Type::vec3, {0, 1}, {1, 1, 1});
    add_parameter(b, "depth", Type::scalar, {0, 2}, {0.5});
    add_output(b);

    // By index: c.r, c.a, d.r, d.g, d.b, d.a, e.r, e.g.
    b.module.gbuffers.push_back(unreal(b));
    ir::Packing packing;
    packing.model = b.module.models.front();
    packing.gbuffer = "ue4";
    packing.module = "skin";
    packing.doc = "Everything, somewhere.";
    packing.span = b.line(29);
    packing.supported = {true};
    packing.fields = {
        stored(b, 0, {{2, 0, 8}}, code(Kind::power, 8, 127)),
        stored(b, 1, {{3, 4, 4}}, code(Kind::linear, 1, 12)),
        stored(b, 2, {{5, 3, 5}}, {}),
        stored(b, 3, {{3, 0, 4}}, code(Kind::square_root, 1, 0)),
        stored(b, 4, {{1, 0, 8}}, code(Kind::log2, 1, 100)),
        stored(b, 5, {{4, 5, 3}}, {}, 0),
        stored(b, 5, {{4, 2, 3}}, {}, 1),
        stored(b, 5, {{4, 0, 2}}, {}, 2),
        stored(b, 6, {{5, 0, 2}, {6, 0, 8}}, code(Kind::linear, 1, 1020)),
    };
    packing.fields[1].range = {0, 0.9375};
    packing.fields[1].code.pivot = 15;
    packing.fields[2].is_signed = true;
    ir::build_functions(b.module, packing, b.module.gbuffers.front());
    b.module.packings.push_back(std::move(packing));
    return b;
}

Builder packed_skin()
{
    Builder b = checked_skin();
    b.module = optimize::optimize(b.module);
    return b;
}

}  // namespace lobe::tests
