#include "evaluate/line.h"

#include "base/hash_index.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lobe::evaluate {
namespace {

using ir::ExprId;
using ir::Function;
using ir::Graph;
using ir::Op;

std::size_t hash_of(const Step& step)
{
    std::size_t hash = mix_hash(step.index, static_cast<std::size_t>(step.op) * 3 +
                                                static_cast<std::size_t>(step.kind));
    for (const Value operand : step.arguments()) hash = mix_hash(hash, operand);
    return hash;
}

/// Integer exponents up to this are products; optimize/legalize.cpp writes the same products.
constexpr int largest_product = 64;
ir::Literal literal_of(double value)
{
    ir::Graph graph;
    return graph.literal_of(graph.literal(value));
}

/// Guards keep an argument at these or above: the least normal float, and what divides. A literal
/// is never less than the least normal number of the format it is read in, so in half both are
/// that.
const ir::Literal& least_normal()
{
    static const ir::Literal literal = literal_of(0x1p-126);
    return literal;
}
const ir::Literal& least_divisor()
{
    static const ir::Literal literal = literal_of(ir::least_divisor);
    return literal;
}

/// Up to this they are products where the base is negative, and powers elsewhere.
constexpr int largest_product_of_negative = 4096;

/// The whole number that an exponent is written as, if it is one and not too large.
std::optional<int> integer_exponent(const Graph& graph, ExprId id)
{
    double sign = 1;
    if (graph[id].op == Op::negate) {
        sign = -1;
        id = graph.operands(id)[0];
    }
    if (graph[id].op != Op::literal || graph.literal_of(id).text == "pi") return std::nullopt;
    const double value = sign * graph.literal_of(id).value;
    if (std::abs(value) > largest_product_of_negative || value != std::floor(value))
        return std::nullopt;
    // 2.00000000000000000001 is another real number, though the nearest double is 2.
    if (!graph.is_literal(id, std::abs(value)) && !graph.is_literal(id, value)) return std::nullopt;
    return static_cast<int>(value);
}

class Scalarizer {
public:
    Scalarizer(const ir::Module& module, const Function& function, Trace trace)
        : module_{module}, function_{function}, trace_{trace}
    {
    }

    Line run();

private:
    /// One function on the way: its arguments, what is known so far, and where it goes on.
    struct Frame {
        const Function* function = nullptr;
        std::vector<Components> arguments;
        std::vector<Components> values;
        std::vector<bool> live;
        std::size_t next = 0;
        ExprId caller;  ///< the call in the frame below; invalid for the outermost
    };

    void enter(const Function& function, std::vector<Components> arguments, ExprId caller,
               bool everything);
    void leave();
    void visit(Frame& frame, ExprId id);

    Value emit(TapeOp op, Value a, Value b = 0, Value c = 0, Value d = 0);
    Value intern(const Step& step);
    Value constant(const ir::Literal& literal);
    Value number(int value);
    Value at_least(Value x, const ir::Literal& low);
    Value product(Value a, Value b);
    Value sum(const Components& terms);
    Value integer_power(Value base, int exponent);
    Value bounded_quotient(Value condition, Value quotient);
    Components scalars(const Frame& frame, ExprId id);
    Components each(const Frame& frame, ExprId id);

    const ir::Module& module_;
    const Function& function_;
    Trace trace_;
    Line line_;
    HashIndex shared_;     ///< of steps
    HashIndex constants_;  ///< of constants, by text
    std::vector<Frame> stack_;
};

Value Scalarizer::intern(const Step& step)
{
    const std::size_t hash = hash_of(step);
    const auto same = [&](std::uint32_t position) { return line_.steps[position] == step; };
    if (const auto found = shared_.find(hash, same)) return *found;
    shared_.add(hash, line_.steps.size());
    line_.steps.push_back(step);
    return static_cast<Value>(line_.steps.size() - 1);
}

Value Scalarizer::emit(TapeOp op, Value a, Value b, Value c, Value d)
{
    // IEEE addition and multiplication commute, so their operands have one order.
    if ((op == TapeOp::add || op == TapeOp::multiply) && a > b) std::swap(a, b);
    return intern(
        {Step::Kind::operation, op, static_cast<std::uint8_t>(arity(op)), 0, {a, b, c, d}});
}

Value Scalarizer::constant(const ir::Literal& literal)
{
    const std::size_t hash = std::hash<std::string_view>{}(literal.text);
    auto position = constants_.find(hash, [&](std::uint32_t candidate) {
        return line_.constants[candidate].text == literal.text;
    });
    if (!position) {
        position = static_cast<std::uint32_t>(line_.constants.size());
        constants_.add(hash, *position);
        line_.constants.push_back(literal);
    }
    return intern({Step::Kind::constant, {}, 0, *position, {}});
}

Value Scalarizer::number(int value)
{
    return constant({std::to_string(value), static_cast<double>(value)});
}

Value Scalarizer::at_least(Value x, const ir::Literal& low)
{
    return emit(TapeOp::maximum, x, constant(low));
}

Value Scalarizer::product(Value a, Value b)
{
    return a == b ? emit(TapeOp::square, a) : emit(TapeOp::multiply, a, b);
}

Value Scalarizer::sum(const Components& terms)
{
    switch (terms.size()) {
    case 1: return terms[0];
    case 2: return emit(TapeOp::add, terms[0], terms[1]);
    case 3: return emit(TapeOp::sum3, terms[0], terms[1], terms[2]);
    default: return emit(TapeOp::sum4, terms[0], terms[1], terms[2], terms[3]);
    }
}

/// Squares, then their products from the highest down: x^5 = (x^2)^2 x, x^7 = (x^4 x^2) x.
Value Scalarizer::integer_power(Value base, int exponent)
{
    const auto count = static_cast<unsigned>(std::abs(exponent));
    if (count == 0) return number(1);
    std::vector<Value> squares{base};
    while ((count >> squares.size()) != 0)
        squares.push_back(product(squares.back(), squares.back()));
    std::optional<Value> result;
    for (std::size_t bit = squares.size(); bit-- > 0;)
        if ((count >> bit & 1U) != 0)
            result = result ? product(*result, squares[bit]) : squares[bit];
    return exponent > 0 ? *result : emit(TapeOp::divide, number(1), *result);
}

/// Componentwise operations: scalars spread over vectors.
Components Scalarizer::each(const Frame& frame, ExprId id)
{
    const Graph& graph = frame.function->graph;
    const auto operands = graph.operands(id);
    const Op op = graph[id].op;
    const auto width = static_cast<std::size_t>(components(graph[id].type));

    std::optional<int> exponent;
    if (op == Op::power || op == Op::guarded_power) exponent = integer_exponent(graph, operands[1]);

    Components result;
    for (std::size_t k = 0; k < width; ++k) {
        const auto operand = [&](std::size_t i) {
            const Components& all = frame.values[operands[i].index];
            return all.size() == 1 ? all[0] : all[k];
        };
        if (exponent) {
            const Value chain = integer_power(operand(0), *exponent);
            if (std::abs(*exponent) <= largest_product) {
                result.push_back(chain);
                continue;
            }
            const Value base = op == Op::power ? operand(0) : at_least(operand(0), least_normal());
            result.push_back(emit(TapeOp::select, emit(TapeOp::less, operand(0), number(0)), chain,
                                  emit(TapeOp::power, base, operand(1))));
            continue;
        }
        switch (op) {
        case Op::multiply: result.push_back(product(operand(0), operand(1))); break;
#define LOBE_SAME_1(name)                                                                          \
    case Op::name:                                                                                 \
        result.push_back(emit(TapeOp::name, operand(0)));                                          \
        break;
#define LOBE_SAME_2(name)                                                                          \
    case Op::name:                                                                                 \
        result.push_back(emit(TapeOp::name, operand(0), operand(1)));                              \
        break;
#define LOBE_SAME_3(name)                                                                          \
    case Op::name: result.push_back(emit(TapeOp::name, operand(0), operand(1), operand(2))); break;
            LOBE_SAME_1(negate)
            LOBE_SAME_1(absolute)
            LOBE_SAME_1(sign)
            LOBE_SAME_1(floor)
            LOBE_SAME_1(square_root)
            LOBE_SAME_1(inverse_square_root)
            LOBE_SAME_1(exp2)
            LOBE_SAME_1(log2)
            LOBE_SAME_1(exp)
            LOBE_SAME_1(log)
            LOBE_SAME_1(sine)
            LOBE_SAME_1(cosine)
            LOBE_SAME_1(tangent)
            LOBE_SAME_1(arc_sine)
            LOBE_SAME_1(arc_cosine)
            LOBE_SAME_1(arc_tangent)
            LOBE_SAME_1(saturate)
            LOBE_SAME_1(logical_not)
            LOBE_SAME_2(add)
            LOBE_SAME_2(subtract)
            LOBE_SAME_2(divide)
            LOBE_SAME_2(power)
        case Op::guarded_power:
            result.push_back(emit(TapeOp::power, at_least(operand(0), least_normal()), operand(1)));
            break;
            LOBE_SAME_2(minimum)
            LOBE_SAME_2(maximum)
            LOBE_SAME_2(step)
            LOBE_SAME_2(less)
            LOBE_SAME_2(less_equal)
            LOBE_SAME_2(equal)
            LOBE_SAME_2(not_equal)
            LOBE_SAME_2(logical_and)
            LOBE_SAME_2(logical_or)
            LOBE_SAME_3(lerp)
            LOBE_SAME_3(clamp)
            LOBE_SAME_3(smoothstep)
        case Op::guarded_smoothstep: {
            // Of edges 0 and b - a: the same operations on the way, and the width is kept above 0.
            const Value ramp = emit(TapeOp::subtract, operand(1), operand(0));
            result.push_back(emit(TapeOp::smoothstep, number(0), at_least(ramp, least_divisor()),
                                  emit(TapeOp::subtract, operand(2), operand(0))));
            break;
        }
        case Op::select:
            result.push_back(emit(TapeOp::select, operand(0),
                                  bounded_quotient(operand(0), operand(1)), operand(2)));
            break;
#undef LOBE_SAME_1
#undef LOBE_SAME_2
#undef LOBE_SAME_3
        case Op::literal:
        case Op::input:
        case Op::dot:
        case Op::length:
        case Op::cross:
        case Op::normalize:
        case Op::guarded_normalize:
        case Op::component:
        case Op::construct:
        case Op::call: assert(false && "not a componentwise operation"); break;
        }
    }
    return result;
}

/// The quotient of `a / b else c`, whose condition is t <= |b| (or t <= b), without a division by
/// anything below t: a / max(b, t), or sign(b) a / max(|b|, t). Where the quotient counts that is
/// the same to the bit, and sets of numbers see that it is bounded.
Value Scalarizer::bounded_quotient(Value condition, Value quotient)
{
    const auto is = [&](Value value, TapeOp op) {
        return line_.steps[value].kind == Step::Kind::operation && line_.steps[value].op == op;
    };
    if (!is(condition, TapeOp::less_equal) || !is(quotient, TapeOp::divide)) return quotient;
    const Value least = line_.steps[condition].operands[0];
    const Value size = line_.steps[condition].operands[1];
    const Value a = line_.steps[quotient].operands[0];
    const Value b = line_.steps[quotient].operands[1];
    if (line_.steps[least].kind != Step::Kind::constant ||
        line_.constants[line_.steps[least].index].value <= 0)
        return quotient;
    if (size == b) return emit(TapeOp::divide, a, emit(TapeOp::maximum, b, least));
    if (!is(size, TapeOp::absolute) || line_.steps[size].operands[0] != b) return quotient;
    return emit(TapeOp::divide, emit(TapeOp::multiply, a, emit(TapeOp::sign, b)),
                emit(TapeOp::maximum, size, least));
}

Components Scalarizer::scalars(const Frame& frame, ExprId id)
{
    const Graph& graph = frame.function->graph;
    const ir::Expr& expr = graph[id];
    const auto operand = [&](std::size_t i) -> const Components& {
        return frame.values[graph.operands(id)[i].index];
    };
    const auto dot = [&](const Components& a, const Components& b) {
        Components products;
        for (std::size_t k = 0; k < a.size(); ++k) products.push_back(product(a[k], b[k]));
        return sum(products);
    };

    switch (expr.op) {
    case Op::literal: return {constant(graph.literal_of(id))};
    case Op::input: return frame.arguments[expr.aux];
    case Op::component: return {operand(0)[expr.aux]};
    case Op::construct: {
        Components result;
        for (std::size_t i = 0; i < expr.count; ++i) result.push_back(operand(i)[0]);
        while (result.size() < static_cast<std::size_t>(components(expr.type)))
            result.push_back(result[0]);
        return result;
    }
    case Op::dot: return {dot(operand(0), operand(1))};
    case Op::length: return {emit(TapeOp::square_root, dot(operand(0), operand(0)))};
    case Op::normalize:
    case Op::guarded_normalize: {
        Value squares = dot(operand(0), operand(0));
        if (expr.op == Op::guarded_normalize) squares = at_least(squares, least_normal());
        Components result;
        for (const Value component : operand(0))
            result.push_back(emit(TapeOp::normalized, component, squares));
        return result;
    }
    case Op::cross: {
        const Components& a = operand(0);
        const Components& b = operand(1);
        Components result;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3;
            const std::size_t j = (k + 2) % 3;
            result.push_back(emit(TapeOp::subtract, product(a[i], b[j]), product(a[j], b[i])));
        }
        return result;
    }
    default: return each(frame, id);
    }
}

void Scalarizer::enter(const Function& function, std::vector<Components> arguments, ExprId caller,
                       bool everything)
{
    Frame frame;
    frame.function = &function;
    frame.arguments = std::move(arguments);
    frame.values.resize(function.graph.size());
    frame.live.resize(function.graph.size(), everything);
    frame.caller = caller;
    frame.live[function.result.index] = true;
    for (std::size_t i = function.graph.size(); i-- > 0;)
        if (frame.live[i])
            for (const ExprId operand : function.graph.operands(ExprId{i}))
                frame.live[operand.index] = true;
    stack_.push_back(std::move(frame));
}

void Scalarizer::leave()
{
    Frame done = std::move(stack_.back());
    stack_.pop_back();
    const Components result = done.values[done.function->result.index];
    stack_.back().values[done.caller.index] = result;
}

void Scalarizer::visit(Frame& frame, ExprId id)
{
    const Graph& graph = frame.function->graph;
    if (graph[id].op != Op::call) {
        frame.values[id.index] = scalars(frame, id);
        return;
    }
    std::vector<Components> arguments;
    for (const ExprId operand : graph.operands(id))
        arguments.push_back(frame.values[operand.index]);
    // `frame` may move from here on.
    enter(module_[ir::FunctionId{graph[id].aux}], std::move(arguments), id, false);
}

Line Scalarizer::run()
{
    std::vector<Components> arguments;
    for (std::uint32_t i = 0; i < function_.inputs.size(); ++i) {
        const ir::Input& input = function_.inputs[i];
        Components scalars_of_input;
        for (int k = 0; k < components(input.type); ++k) {
            const auto index = static_cast<std::uint32_t>(line_.inputs.size());
            line_.inputs.push_back(
                {input.name + component_suffix(input.type, input.quantity, k), i, k});
            scalars_of_input.push_back(intern({Step::Kind::input, {}, 0, index, {}}));
        }
        arguments.push_back(scalars_of_input);
    }

    enter(function_, std::move(arguments), {}, trace_ == Trace::all);
    for (;;) {
        Frame& frame = stack_.back();
        if (frame.next < frame.function->graph.size()) {
            const ExprId id{frame.next++};
            if (frame.live[id.index]) visit(frame, id);
        } else if (stack_.size() > 1) {
            leave();
        } else {
            break;
        }
    }

    Frame& outermost = stack_.back();
    const Components& result = outermost.values[function_.result.index];
    line_.outputs.assign(result.begin(), result.end());
    for (int k = 0; k < components(function_.type()); ++k)
        line_.output_names.push_back(function_.name +
                                     component_suffix(function_.type(), function_.quantity, k));
    if (trace_ == Trace::all) line_.values_of = std::move(outermost.values);
    return std::move(line_);
}

}  // namespace

Line scalarize(const ir::Module& module, const Function& function, Trace trace)
{
    return Scalarizer{module, function, trace}.run();
}

}  // namespace lobe::evaluate
