#include "evaluate/fixture.h"

#include <limits>

namespace lobe::tests {
namespace {

using namespace lobe::evaluate;

template <class Number, class Run>
Table<Number> transposed(const Tape& tape, const Table<Number>& points, Number blank, Run run_tape)
{
    Table<Number> columns(tape.inputs.size());
    for (const auto& point : points)
        for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(point[i]);
    Table<Number> outputs(tape.outputs.size(), std::vector<Number>(points.size(), blank));
    std::vector<const Number*> in;
    std::vector<Number*> out;
    for (const auto& column : columns) in.push_back(column.data());
    for (auto& column : outputs) out.push_back(column.data());
    run_tape(Columns<Number>{in}, Results<Number>{out}, points.size());

    Table<Number> results(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
        for (const auto& column : outputs) results[p].push_back(column[p]);
    return results;
}

Tape tape_of(ir::Op op, std::size_t arity)
{
    const ir::Module module = module_of(op, static_cast<int>(arity));
    return compile(module, module.functions[0]);
}

constexpr double unbounded = std::numeric_limits<double>::infinity();

}  // namespace

ir::Input number_input(std::string name, double low, double high)
{
    return {std::move(name),
            ir::Type::scalar,
            ir::Quantity::number,
            {low, high},
            ir::Origin::argument,
            0,
            {}};
}

ir::Input color_input(std::string name)
{
    return {
        std::move(name), ir::Type::vec3, ir::Quantity::color, {0, 1}, ir::Origin::argument, 0, {}};
}

ir::Module module_of(ir::Op op, int arity)
{
    ir::Module module;
    ir::Function function;
    function.name = "f";
    std::vector<ir::ExprId> operands;
    for (int i = 0; i < arity; ++i) {
        function.inputs.push_back(number_input("x" + std::to_string(i), -unbounded, unbounded));
        operands.push_back(function.graph.input(static_cast<std::uint32_t>(i), ir::Type::scalar));
    }
    function.result = function.graph.apply(op, operands);
    module.functions.push_back(std::move(function));
    return module;
}

Table<float> evaluate_float(const Tape& tape, const Table<float>& points)
{
    return transposed(tape, points, 0.0F,
                      [&](auto in, auto out, auto count) { run(tape, in, out, count); });
}

Table<double> evaluate_double(const Tape& tape, const Table<double>& points)
{
    return transposed(tape, points, 0.0,
                      [&](auto in, auto out, auto count) { run(tape, in, out, count); });
}

Table<float> evaluate_half(const Tape& tape, HalfMode mode, const Table<float>& points)
{
    return transposed(tape, points, 0.0F,
                      [&](auto in, auto out, auto count) { run_half(tape, mode, in, out, count); });
}

Table<Interval> evaluate_interval(const Tape& tape, const Table<Interval>& points)
{
    return transposed(tape, points, Interval{},
                      [&](auto in, auto out, auto count) { run(tape, in, out, count); });
}

Table<Acceptance> evaluate_acceptance(const Tape& tape, Precision precision,
                                      const Table<float>& points)
{
    Table<Acceptance> exact;
    for (const auto& point : points) {
        auto& row = exact.emplace_back();
        for (const float value : point)
            row.push_back({static_cast<double>(value), static_cast<double>(value), false});
    }
    return transposed(tape, exact, Acceptance{}, [&](auto in, auto out, auto count) {
        run_acceptance(tape, precision, in, out, count);
    });
}

Table<Real> evaluate_real(const Tape& tape, int bits, const Table<double>& points)
{
    Table<Real> exact;
    for (const auto& point : points) {
        auto& row = exact.emplace_back();
        for (const double value : point) row.push_back(Real{value, 53});
    }
    return transposed(tape, exact, Real{bits},
                      [&](auto in, auto out, auto count) { run_real(tape, bits, in, out, count); });
}

double apply_double(ir::Op op, std::initializer_list<double> operands)
{
    return evaluate_double(tape_of(op, operands.size()), {operands})[0][0];
}

float apply_float(ir::Op op, std::initializer_list<float> operands)
{
    return evaluate_float(tape_of(op, operands.size()), {operands})[0][0];
}

float apply_half(ir::Op op, HalfMode mode, std::initializer_list<float> operands)
{
    return evaluate_half(tape_of(op, operands.size()), mode, {operands})[0][0];
}

Interval apply_interval(ir::Op op, std::initializer_list<Interval> operands)
{
    return evaluate_interval(tape_of(op, operands.size()), {operands})[0][0];
}

Acceptance apply_acceptance(ir::Op op, std::initializer_list<float> operands, Precision precision)
{
    return evaluate_acceptance(tape_of(op, operands.size()), precision, {operands})[0][0];
}

}  // namespace lobe::tests
