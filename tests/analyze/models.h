// Small modules built by hand, as optimize would leave them, for tests of what reads modules.
#pragma once

#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::tests {

/// Builds one function at a time; inputs are declared in order.
class FunctionBuilder {
public:
    explicit FunctionBuilder(std::string name)
    {
        function.name = std::move(name);
        function.module = "sample";
        function.kind = ir::Function::Kind::term;
        function.quantity = ir::Quantity::number;
        function.range = {0, 1};
    }

    ir::ExprId argument(const std::string& name, double low, double high)
    {
        return add({name,
                    ir::Type::scalar,
                    ir::Quantity::number,
                    {low, high},
                    ir::Origin::argument,
                    0,
                    {}});
    }
    ir::ExprId color(const std::string& name)
    {
        return add(
            {name, ir::Type::vec3, ir::Quantity::color, {0, 1}, ir::Origin::argument, 0, {}});
    }
    ir::ExprId geometry(ir::GeometryField field)
    {
        const ir::FieldFacts& known = ir::facts(field);
        return add({std::string{known.name},
                    known.type,
                    ir::Quantity::number,
                    {known.low, known.high},
                    ir::Origin::geometry,
                    static_cast<std::uint32_t>(field),
                    {}});
    }
    ir::ExprId surface(ir::SurfaceField field)
    {
        const ir::FieldFacts& known = ir::facts(field);
        return add({std::string{known.name},
                    known.type,
                    ir::Quantity::number,
                    {known.low, known.high},
                    ir::Origin::surface,
                    static_cast<std::uint32_t>(field),
                    {}});
    }
    ir::ExprId parameter(const ir::Module& module, std::uint32_t which)
    {
        const ir::Parameter& p = module.parameters[which];
        return add({p.name, p.type, p.quantity, p.range, ir::Origin::parameter, which, {}});
    }

    ir::ExprId literal(const std::string& text) { return function.graph.literal(text); }
    ir::ExprId operator()(ir::Op op, std::initializer_list<ir::ExprId> operands)
    {
        return function.graph.apply(op, operands);
    }

    ir::Function finish(ir::ExprId result)
    {
        function.result = result;
        if (ir::components(function.type()) == 3) function.quantity = ir::Quantity::color;
        return std::move(function);
    }

    ir::Function function;

private:
    ir::ExprId add(ir::Input input)
    {
        const auto index = static_cast<std::uint32_t>(function.inputs.size());
        function.inputs.push_back(input);
        return function.graph.input(index, input.type);
    }
};

/// D: alpha^2 / (pi ((cos_h^2 (alpha^2 - 1) + 1)^2)) with alpha = roughness^2, over the stable
/// sine. [Walter07] eq. 33
ir::Function ggx();
/// V: 0.5 / (cos_i s(cos_o) + cos_o s(cos_i)), symmetric in its cosines.
ir::Function smith();
/// F: lerp of f0 to 1 by (1 - cos_d)^5, and at least f0.
ir::Function schlick();
/// A gain parameter in [0, 256] with default 1 blended by `guarded_power(x, falloff)`.
ir::Function blend(const ir::Module& module);
/// A Lambert lobe: cos_i / pi, with the cosine saturated once more.
ir::Function lambert();

/// All of the above as a library without models.
ir::Module sample_module();

}  // namespace lobe::tests
