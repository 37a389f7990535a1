// Small modules built by hand, and their values.
#pragma once

#include "ir/module.h"

#include <limits>
#include <string>
#include <vector>

namespace lobe::tests {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A function under construction. Operations are methods, so a test reads like the term.
class Term {
public:
    explicit Term(std::string name)
    {
        function.name = std::move(name);
        function.module = "test";
        function.range = {-infinity, infinity};
    }

    ir::ExprId argument(std::string name, double low = 0, double high = 1,
                        ir::Type type = ir::Type::scalar)
    {
        const auto quantity = type == ir::Type::scalar ? ir::Quantity::number : ir::Quantity::color;
        return add_input(
            {std::move(name), type, quantity, {low, high}, ir::Origin::argument, 0, {}});
    }
    ir::ExprId field(ir::GeometryField field)
    {
        const ir::FieldFacts& known = ir::facts(field);
        return add_input({std::string{known.name},
                          known.type,
                          ir::Quantity::number,
                          {known.low, known.high},
                          ir::Origin::geometry,
                          static_cast<std::uint32_t>(field),
                          {}});
    }
    ir::ExprId parameter(const ir::Module& module, std::uint32_t which)
    {
        const ir::Parameter& p = module.parameters[which];
        return add_input({p.name, p.type, p.quantity, p.range, ir::Origin::parameter, which, {}});
    }

    ir::ExprId number(std::string_view text) { return function.graph.literal(text); }
    ir::ExprId op(ir::Op op, std::initializer_list<ir::ExprId> operands)
    {
        return function.graph.apply(op, operands);
    }
    ir::ExprId add(ir::ExprId a, ir::ExprId b) { return op(ir::Op::add, {a, b}); }
    ir::ExprId subtract(ir::ExprId a, ir::ExprId b) { return op(ir::Op::subtract, {a, b}); }
    ir::ExprId multiply(ir::ExprId a, ir::ExprId b) { return op(ir::Op::multiply, {a, b}); }
    ir::ExprId divide(ir::ExprId a, ir::ExprId b) { return op(ir::Op::divide, {a, b}); }
    ir::ExprId power(ir::ExprId a, std::string_view exponent)
    {
        return op(ir::Op::guarded_power, {a, number(exponent)});
    }
    ir::ExprId call(const ir::Module& module, ir::FunctionId callee,
                    std::vector<ir::ExprId> operands)
    {
        return function.graph.call(callee, module[callee].type(), operands);
    }

    /// Appends the function to the module.
    ir::FunctionId in(ir::Module& module, ir::ExprId result)
    {
        function.result = result;
        module.functions.push_back(function);
        return ir::FunctionId{module.functions.size() - 1};
    }

    ir::Function function;

private:
    ir::ExprId add_input(ir::Input input)
    {
        const auto index = static_cast<std::uint32_t>(function.inputs.size());
        function.inputs.push_back(input);
        return function.graph.input(index, input.type);
    }
};

/// An empty module; its own functions are roots as long as it has no model.
inline ir::Module empty_module()
{
    ir::Module module;
    module.name = "test";
    return module;
}

/// A module with this root alone. By reference: `only(t, t.add(x, y))` must see the sum.
inline ir::Module only(const Term& term, ir::ExprId result)
{
    ir::Module module = empty_module();
    Term{term}.in(module, result);
    return module;
}

/// Makes these functions the outputs of a model, and so the only roots.
inline void set_roots(ir::Module& module, std::vector<ir::FunctionId> roots)
{
    ir::Model model;
    model.name = "model";
    for (const ir::FunctionId id : roots) model.outputs.push_back({module[id].name, id});
    module.models.push_back(model);
}

}  // namespace lobe::tests
