#include "emit/cases.h"

#include "emit/emit.h"
#include "emit/packings.h"

namespace lobe::tests {
namespace {

using ir::ExprId;
using ir::Op;
using ir::Type;

/// x^5 over shared squares, which get the names x2 and x4.
Builder powers()
{
    Builder b{"powers"};
    ir::Function& f = b.term("fifth", 3);
    ir::Graph& g = f.graph;
    const ExprId x = argument(f, "x");
    const ExprId x2 = g.apply(Op::multiply, {x, x});
    const ExprId x4 = g.apply(Op::multiply, {x2, x2});
    f.result = g.apply(Op::add, {g.apply(Op::multiply, {x4, x}), x4});
    return b;
}

/// The author's names of intermediate values stay, and a field's name is a shader author's.
Builder lets()
{
    Builder b{"lets"};
    ir::Function& f = b.term("falloff", 5);
    ir::Graph& g = f.graph;
    const ExprId cos = field(f, ir::GeometryField::cos_h);
    const ExprId rise = g.apply(Op::subtract, {cos, g.literal("0.25")});
    g.set_name(rise, "first_rise");
    f.result = g.apply(Op::maximum, {rise, g.literal("0")});
    return b;
}

/// Scalars among vectors: only where a builtin function takes them.
Builder spreading()
{
    Builder b{"spreading"};
    ir::Function& f = b.term("spread", 2);
    f.quantity = ir::Quantity::color;
    ir::Graph& g = f.graph;
    const ExprId c = color(f, "tint");
    const ExprId t = argument(f, "t");
    const ExprId one = g.literal("1");
    const ExprId mixed = g.apply(Op::lerp, {one, c, t});
    const ExprId low = g.apply(Op::minimum, {one, mixed});
    f.result = g.apply(Op::select, {g.apply(Op::less, {t, one}), g.apply(Op::maximum, {low, t}),
                                    g.component(c, 1)});
    return b;
}

/// Guards become helper functions, and only those that are called.
Builder guards()
{
    Builder b{"guards"};
    ir::Function& f = b.term("guarded", 2);
    f.quantity = ir::Quantity::color;
    ir::Graph& g = f.graph;
    f.result = g.apply(Op::guarded_power, {color(f, "base"), argument(f, "exponent")});
    return b;
}

/// Keywords, builtin functions and names that GLSL keeps for itself.
Builder names()
{
    Builder b{"names"};
    ir::Function& f = b.term("mix", 2);
    ir::Graph& g = f.graph;
    const ExprId sample = argument(f, "sample");
    const ExprId twice = argument(f, "a__b");
    const ExprId reserved = argument(f, "gl_x");
    const ExprId sum = g.apply(Op::add, {g.apply(Op::add, {sample, twice}), reserved});
    g.set_name(sum, "mix");
    f.result = g.apply(Op::exp2, {sum});
    return b;
}

/// A line never grows wider than a page.
Builder wide()
{
    Builder b{"wide"};
    ir::Function& f = b.term("sum_of_products", 2);
    ir::Graph& g = f.graph;
    ExprId sum = g.literal("0.5");
    for (const char* name :
         {"first_operand", "second_operand", "third_operand", "fourth_operand", "fifth_operand"}) {
        const ExprId x = argument(f, name);
        const ExprId product = g.apply(Op::multiply, {g.apply(Op::sine, {x}), g.literal("0.1")});
        sum = g.apply(Op::add, {sum, product});
    }
    f.result = sum;
    return b;
}

/// A model whose output reads everything that a host gives: the tangent frame, the half vector, a
/// boolean and a pair as parameters.
Builder everything()
{
    Builder b{"cloth"};
    b.module.parameters.push_back({"is_wet",
                                   Type::boolean,
                                   ir::Quantity::boolean,
                                   {0, 1},
                                   {1},
                                   "",
                                   "",
                                   "Wet.",
                                   "cloth",
                                   b.line(3)});
    b.module.parameters.push_back({"weave",
                                   Type::vec2,
                                   ir::Quantity::vector,
                                   {0, 1},
                                   {0.25, 1},
                                   "",
                                   "",
                                   "Density of threads.",
                                   "cloth",
                                   b.line(4)});
    ir::Function& f = b.term("cloth_specular", 9);
    f.kind = ir::Function::Kind::output;
    ir::Graph& g = f.graph;
    ExprId sum = g.literal("0");
    for (int i = 0; i <= static_cast<int>(ir::GeometryField::one_minus_cos_d); ++i) {
        const ExprId value = field(f, static_cast<ir::GeometryField>(i));
        const bool vector = g[value].type == Type::vec3;
        sum = g.apply(Op::add, {sum, vector ? g.component(value, i % 3) : value});
    }
    for (int i = 0; i <= static_cast<int>(ir::SurfaceField::f0); ++i) {
        if (static_cast<ir::SurfaceField>(i) == ir::SurfaceField::alpha) continue;
        const ExprId value = field(f, static_cast<ir::SurfaceField>(i));
        const bool vector = g[value].type == Type::vec3;
        sum = g.apply(Op::add, {sum, vector ? g.component(value, i % 3) : value});
    }
    const ExprId wet = parameter(b.module, f, 0);
    const ExprId weave = g.apply(Op::length, {parameter(b.module, f, 1)});
    f.result = g.apply(Op::select, {wet, g.apply(Op::multiply, {sum, weave}), g.literal("0")});
    ir::Function& coat = b.term("cloth_coat", 11);
    coat.kind = ir::Function::Kind::output;
    coat.quantity = ir::Quantity::color;
    coat.result = coat.graph.apply(Op::multiply, {field(coat, ir::SurfaceField::base_color),
                                                  field(coat, ir::GeometryField::cos_i)});
    b.module.models.push_back({"thread",
                               "",
                               "cloth",
                               b.line(8),
                               {{"specular", ir::FunctionId{0}}, {"coat", ir::FunctionId{1}}}});
    return b;
}

/// A model with one parameter, one term and one output.
Builder model()
{
    Builder b{"velvet"};
    b.module.doc = "Cloth.";
    b.module.sources.push_back({"Ashikhmin07", "Ashikhmin and Premoze 2007", b.line(1)});
    b.module.parameters.push_back({"sheen",
                                   Type::scalar,
                                   ir::Quantity::number,
                                   {0, 2},
                                   {0.5},
                                   "base",
                                   "Sheen",
                                   "Strength of the sheen.",
                                   "velvet",
                                   b.line(3)});
    ir::Function& f = b.term("F_sheen", 5);
    {
        ir::Graph& g = f.graph;
        const ExprId gap = field(f, ir::GeometryField::one_minus_cos_d);
        f.result = g.apply(Op::multiply, {parameter(b.module, f, 0), gap});
    }
    ir::Function& output = b.term("velvet_diffuse", 9);
    output.kind = ir::Function::Kind::output;
    output.quantity = ir::Quantity::color;
    ir::Graph& g = output.graph;
    const ExprId cos = field(output, ir::GeometryField::cos_i);
    const ExprId gap = field(output, ir::GeometryField::one_minus_cos_d);
    const ExprId albedo = field(output, ir::SurfaceField::diffuse_color);
    const ExprId sheen = parameter(b.module, output, 0);
    const std::array operands{gap, sheen};
    const ExprId lobe = g.call(ir::FunctionId{0}, Type::scalar, operands);
    output.result = g.apply(Op::multiply, {g.apply(Op::multiply, {albedo, lobe}), cos});
    b.module.functions[0].inputs = {b.module.functions[0].inputs[0],
                                    b.module.functions[0].inputs[1]};
    b.module.models.push_back({"velvet",
                               "A velvet.\nAshikhmin07 eq 2",
                               "velvet",
                               b.line(8),
                               {{"diffuse", ir::FunctionId{1}}}});
    return b;
}

}  // namespace

const std::vector<GoldenCase>& golden_cases()
{
    static const std::vector<GoldenCase> cases{
        {"ggx", "glsl450", ggx},
        {"ggx", "ue4", ggx},
        {"powers", "hlsl", powers},
        {"lets", "glsl330", lets},
        {"spreading", "glsl450", spreading},
        {"spreading", "hlsl", spreading},
        {"guards", "essl300", guards},
        {"guards", "ue4", guards},
        {"names", "glsl450", names},
        {"wide", "hlsl", wide},
        {"model", "glsl450", model},
        {"model", "ue4", model},
        {"everything", "ue4", everything},
        {"packing", "glsl450", packed_skin},
        {"packing", "ue4", packed_skin},
    };
    return cases;
}

std::string golden_path(const GoldenCase& golden)
{
    return "emit/golden/" + golden.name + "." + golden.target +
           emit::find_target(golden.target)->extension;
}

std::string golden_text(const GoldenCase& golden)
{
    const Builder b = golden.build();
    return emit::emit(b.module, b.sources, *emit::find_target(golden.target)).back().text;
}

}  // namespace lobe::tests
