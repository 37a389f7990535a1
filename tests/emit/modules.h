// Small modules built by hand, so that emission is tested without a front end.
#pragma once

#include "base/source.h"
#include "ir/module.h"

#include <limits>

namespace lobe::tests {

/// A module under construction. Functions get the spans of lines in a made-up source.
struct Builder {
    ir::Module module;
    Sources sources;

    explicit Builder(std::string name)
    {
        module.name = name;
        module.path = "models/" + name + ".lobe";
        std::string text;
        for (int line = 1; line <= 40; ++line) text += "line " + std::to_string(line) + "\n";
        sources.add(module.path, text);
    }

    Span line(int number) const
    {
        const std::uint32_t start = sources[0].line_start(number);
        return {0, start, start + 4};
    }

    ir::Function& term(std::string name, int at)
    {
        ir::Function function;
        function.name = std::move(name);
        function.module = module.name;
        function.span = line(at);
        function.range = {-infinity, infinity};
        module.functions.push_back(std::move(function));
        return module.functions.back();
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

inline ir::ExprId argument(ir::Function& function, std::string name,
                           ir::Type type = ir::Type::scalar, ir::Range range = {0, 1},
                           ir::Quantity quantity = ir::Quantity::number)
{
    const auto index = static_cast<std::uint32_t>(function.inputs.size());
    function.inputs.push_back(
        {std::move(name), type, quantity, range, ir::Origin::argument, 0, function.span});
    return function.graph.input(index, type);
}

inline ir::ExprId color(ir::Function& function, std::string name)
{
    return argument(function, std::move(name), ir::Type::vec3, {0, 1}, ir::Quantity::color);
}

inline ir::ExprId field(ir::Function& function, ir::GeometryField which)
{
    const ir::FieldFacts& facts = ir::facts(which);
    const auto index = static_cast<std::uint32_t>(function.inputs.size());
    const bool direction = facts.type == ir::Type::vec3;
    function.inputs.push_back({std::string{facts.name},
                               facts.type,
                               direction ? ir::Quantity::direction : ir::Quantity::number,
                               {facts.low, facts.high},
                               ir::Origin::geometry,
                               static_cast<std::uint32_t>(which),
                               function.span});
    return function.graph.input(index, facts.type);
}

inline ir::ExprId field(ir::Function& function, ir::SurfaceField which)
{
    const ir::FieldFacts& facts = ir::facts(which);
    const auto index = static_cast<std::uint32_t>(function.inputs.size());
    const bool is_color = facts.type == ir::Type::vec3;
    function.inputs.push_back({std::string{facts.name},
                               facts.type,
                               is_color ? ir::Quantity::color : ir::Quantity::number,
                               {facts.low, facts.high},
                               ir::Origin::surface,
                               static_cast<std::uint32_t>(which),
                               function.span});
    return function.graph.input(index, facts.type);
}

inline ir::ExprId parameter(ir::Module& module, ir::Function& function, std::uint32_t which)
{
    const ir::Parameter& declared = module.parameters[which];
    const auto index = static_cast<std::uint32_t>(function.inputs.size());
    function.inputs.push_back({declared.name, declared.type, declared.quantity, declared.range,
                               ir::Origin::parameter, which, function.span});
    return function.graph.input(index, declared.type);
}

/// D_GGX in its stable form over sin2_h, with a formula and a citation.
inline Builder ggx()
{
    Builder b{"microfacet"};
    b.module.sources.push_back({"Walter07", "Walter et al. 2007, Microfacet Models", b.line(1)});
    ir::Function& d = b.term("D_GGX", 7);
    d.doc = "Trowbridge-Reitz normal distribution, per steradian.";
    d.citations = {{"Walter07", "eq 33"}};
    d.formula = "alpha^2 / (pi * (g.cos_h^2 * (alpha^2 - 1) + 1)^2)";
    d.declared_range = ir::Range{0, Builder::infinity};
    const ir::ExprId alpha = argument(d, "alpha", ir::Type::scalar, {0.000244140625, 1});
    const ir::ExprId sin2 = field(d, ir::GeometryField::sin2_h);
    ir::Graph& g = d.graph;
    const ir::ExprId one = g.literal("1");
    const ir::ExprId alpha2 = g.apply(ir::Op::multiply, {alpha, alpha});
    const ir::ExprId gap = g.apply(ir::Op::subtract, {one, alpha2});
    const ir::ExprId t =
        g.apply(ir::Op::add, {alpha2, g.apply(ir::Op::multiply, {sin2, gap})}, b.line(9));
    const ir::ExprId bottom =
        g.apply(ir::Op::multiply, {g.literal("pi"), g.apply(ir::Op::multiply, {t, t})});
    d.result = g.apply(ir::Op::divide, {alpha2, bottom}, b.line(10));
    return b;
}

}  // namespace lobe::tests
