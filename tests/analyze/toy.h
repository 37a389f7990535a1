// A model so small that the error of radiance can be computed by hand.
#pragma once

#include "analyze/models.h"
#include "ir/module.h"

#include <string>

namespace lobe::tests {

using ir::Op;

/// A module with one gain parameter and an exponent, and models that use them.
struct Toy {
    ir::Module module;
    ir::Packing packing;

    Toy()
    {
        module.name = "toy";
        module.path = "toy.lobe";
        add_parameter("gain", {0, 256}, 1);
        add_parameter("falloff", {0, 1}, 0.75);
        packing.model.name = "toy";
    }

    void add_parameter(const std::string& name, ir::Range range, double standard)
    {
        ir::Parameter parameter;
        parameter.name = name;
        parameter.type = ir::Type::scalar;
        parameter.range = range;
        parameter.default_value = {standard};
        module.parameters.push_back(parameter);
    }

    ir::FunctionId add(ir::Function function)
    {
        module.functions.push_back(std::move(function));
        return ir::FunctionId{module.functions.size() - 1};
    }

    /// f cos_i = gain base / pi cos_i
    void use_gain()
    {
        tests::FunctionBuilder f{"gained"};
        const auto base = f.surface(ir::SurfaceField::diffuse_color);
        f.function.inputs.back().quantity = ir::Quantity::color;
        const auto cosine = f.geometry(ir::GeometryField::cos_i);
        const auto gain = f.parameter(module, 0);
        const auto lit = f(Op::multiply, {f(Op::divide, {base, f.literal("pi")}), cosine});
        packing.model.outputs.push_back({"diffuse", add(f.finish(f(Op::multiply, {lit, gain})))});
    }

    /// f cos_i = cos_h^(10 (1 - falloff)) cos_i
    void use_falloff()
    {
        tests::FunctionBuilder f{"falling"};
        const auto cos_h = f.geometry(ir::GeometryField::cos_h);
        const auto cosine = f.geometry(ir::GeometryField::cos_i);
        const auto falloff = f.parameter(module, 1);
        const auto exponent =
            f(Op::multiply, {f.literal("10"), f(Op::subtract, {f.literal("1"), falloff})});
        const auto blend = f(Op::guarded_power, {cos_h, exponent});
        packing.model.outputs.push_back(
            {"specular", add(f.finish(f(Op::multiply, {blend, cosine})))});
    }

    /// code = floor(clamp(x, low, high) last / (high - low) + 0.5), for low = 0
    void store(std::uint32_t parameter, int bits, double high)
    {
        ir::Field field;
        field.parameter = parameter;
        field.bits = bits;
        field.range = {0, high};
        const std::string last = std::to_string((1 << bits) - 1);
        const std::string top = std::to_string(high);
        tests::FunctionBuilder encode{"encode_" + std::to_string(packing.fields.size())};
        const auto x = encode.argument("x", 0, high);
        const auto inside = encode(Op::clamp, {x, encode.literal("0"), encode.literal(top)});
        const auto scaled =
            encode(Op::divide,
                   {encode(Op::multiply, {inside, encode.literal(last)}), encode.literal(top)});
        field.encode = add(
            encode.finish(encode(Op::floor, {encode(Op::add, {scaled, encode.literal("0.5")})})));
        tests::FunctionBuilder decode{"decode_" + std::to_string(packing.fields.size())};
        const auto code = decode.argument("code", 0, 65535);
        field.decode =
            add(decode.finish(decode(Op::divide, {decode(Op::multiply, {code, decode.literal(top)}),
                                                  decode.literal(last)})));
        packing.fields.push_back(field);
    }
};

}  // namespace lobe::tests
