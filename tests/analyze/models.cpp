#include "analyze/models.h"

namespace lobe::tests {

using ir::GeometryField;
using ir::Op;
using ir::SurfaceField;

ir::Function ggx()
{
    FunctionBuilder f{"D_GGX"};
    const auto roughness = f.surface(SurfaceField::roughness);
    const auto sin2 = f.geometry(GeometryField::sin2_h);
    const auto alpha = f(Op::multiply, {roughness, roughness});
    const auto a2 = f(Op::multiply, {alpha, alpha});
    const auto rest = f(Op::subtract, {f.literal("1"), a2});
    const auto d = f(Op::add, {a2, f(Op::multiply, {sin2, rest})});
    const auto bottom = f(Op::multiply, {f.literal("pi"), f(Op::multiply, {d, d})});
    return f.finish(f(Op::divide, {a2, bottom}));
}

ir::Function smith()
{
    FunctionBuilder f{"V_Smith"};
    const auto a2 = f.argument("a2", 0x1p-20, 1);
    const auto cos_i = f.argument("cos_i", 0x1p-10, 1);
    const auto cos_o = f.argument("cos_o", 0x1p-10, 1);
    const auto rest = f(Op::subtract, {f.literal("1"), a2});
    const auto lobe = [&](ir::ExprId one, ir::ExprId other) {
        const auto square = f(Op::multiply, {other, other});
        const auto root = f(Op::square_root, {f(Op::add, {a2, f(Op::multiply, {rest, square})})});
        return f(Op::multiply, {one, root});
    };
    const auto bottom = f(Op::add, {lobe(cos_i, cos_o), lobe(cos_o, cos_i)});
    return f.finish(f(Op::divide, {f.literal("0.5"), bottom}));
}

ir::Function schlick()
{
    FunctionBuilder f{"F_Schlick"};
    const auto f0 = f.color("f0");
    const auto cos_d = f.argument("cos_d", 0, 1);
    const auto x = f(Op::subtract, {f.literal("1"), cos_d});
    const auto x2 = f(Op::multiply, {x, x});
    const auto x5 = f(Op::multiply, {f(Op::multiply, {x2, x2}), x});
    const auto blend = f(Op::lerp, {f0, f.literal("1"), x5});
    return f.finish(f(Op::maximum, {blend, f0}));
}

ir::Function blend(const ir::Module& module)
{
    FunctionBuilder f{"blend"};
    const auto cos_h = f.geometry(GeometryField::cos_h);
    const auto gain = f.parameter(module, 0);
    const auto falloff = f.parameter(module, 1);
    const auto weight =
        f(Op::guarded_power,
          {cos_h, f(Op::multiply, {f.literal("5"), f(Op::subtract, {f.literal("1"), falloff})})});
    return f.finish(f(Op::lerp, {f.literal("1"), gain, weight}));
}

ir::Function lambert()
{
    FunctionBuilder f{"lambert"};
    const auto cosine = f.argument("cosine", -1, 1);
    return f.finish(f(Op::divide, {f(Op::maximum, {cosine, f.literal("0")}), f.literal("pi")}));
}

ir::Module sample_module()
{
    ir::Module module;
    module.name = "sample";
    module.path = "sample.lobe";
    const auto parameter = [&module](std::string name, ir::Range range, double standard) {
        ir::Parameter p;
        p.name = std::move(name);
        p.type = ir::Type::scalar;
        p.quantity = ir::Quantity::number;
        p.range = range;
        p.default_value = {standard};
        p.module = module.name;
        module.parameters.push_back(std::move(p));
    };
    parameter("gain", {0, 256}, 1);
    parameter("falloff", {0, 1}, 0.75);
    module.functions = {ggx(), smith(), schlick(), blend(module), lambert()};
    return module;
}

}  // namespace lobe::tests
