#include "evaluate/random_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace lobe::tests {
namespace {

using namespace lobe::ir;

constexpr double largest_value = 1e4;

/// An expression, and a bound of its components' sizes over the declared ranges.
struct Candidate {
    ExprId id;
    double size = 0;
};

class Builder {
public:
    Builder(std::mt19937& random, const RandomShape& shape, const Module& module)
        : random_{random}, shape_{shape}, module_{module}
    {
    }

    Function build(std::size_t index);

private:
    int below(int count) { return std::uniform_int_distribution<int>{0, count - 1}(random_); }
    bool chance(int one_in) { return below(one_in) == 0; }

    Graph& graph() { return function_.graph; }
    const Candidate& any()
    {
        return pool_[static_cast<std::size_t>(below(static_cast<int>(pool_.size())))];
    }
    Candidate scalar();
    Candidate vector();
    Candidate literal(std::string_view text)
    {
        const ExprId id = graph().literal(text);
        return {id, std::abs(graph().literal_of(id).value)};
    }
    ExprId condition();
    ExprId positive(ExprId x);
    void add_input(std::string name, Type type, Quantity quantity, Range range);
    void keep(ExprId id, double size)
    {
        if (size <= largest_value) pool_.push_back({id, size});
    }

    void grow();
    void grow_arithmetic(int kind);
    void grow_choice(int kind);
    void grow_elementary(int kind);
    void grow_vector(int kind);
    void grow_call();

    std::mt19937& random_;
    const RandomShape& shape_;
    const Module& module_;
    Function function_;
    std::vector<Candidate> pool_;
};

Candidate Builder::scalar()
{
    for (int attempt = 0; attempt < 8; ++attempt)
        if (const Candidate& found = any(); graph()[found.id].type == Type::scalar) return found;
    return literal("0.75");
}

Candidate Builder::vector()
{
    for (int attempt = 0; attempt < 8; ++attempt)
        if (const Candidate& found = any(); graph()[found.id].type == Type::vec3) return found;
    const Candidate x = scalar();
    const Candidate y = scalar();
    const std::array parts{x.id, y.id, graph().literal("-0.5")};
    return {graph().construct(Type::vec3, parts), std::max({x.size, y.size, 0.5})};
}

ExprId Builder::condition()
{
    constexpr std::array compares{Op::less, Op::less_equal, Op::equal, Op::not_equal};
    const auto compare = [&] {
        const Op op = compares[static_cast<std::size_t>(below(4))];
        const ExprId a = scalar().id;
        const ExprId b = scalar().id;
        return graph().apply(op, {a, b});
    };
    const ExprId first = compare();
    switch (below(5)) {
    case 0: return graph().apply(Op::logical_and, {first, compare()});
    case 1: return graph().apply(Op::logical_or, {first, compare()});
    case 2: return graph().apply(Op::logical_not, {first});
    default: return first;
    }
}

/// 1 + |x|, componentwise
ExprId Builder::positive(ExprId x)
{
    return graph().apply(Op::add, {graph().apply(Op::absolute, {x}), graph().literal("1")});
}

void Builder::grow_arithmetic(int kind)
{
    const Candidate a = any();
    const Candidate b =
        graph()[a.id].type == Type::scalar ? any() : (chance(2) ? scalar() : vector());
    const auto apply = [&](Op op, std::initializer_list<ExprId> operands) {
        return graph().apply(op, operands);
    };
    switch (kind) {
    case 0: keep(apply(Op::add, {a.id, b.id}), a.size + b.size); break;
    case 1: keep(apply(Op::subtract, {a.id, b.id}), a.size + b.size); break;
    case 2: keep(apply(Op::multiply, {a.id, b.id}), a.size * b.size); break;
    case 3: keep(apply(Op::multiply, {a.id, a.id}), a.size * a.size); break;
    case 4: keep(apply(Op::divide, {a.id, positive(b.id)}), a.size); break;
    case 5: keep(apply(Op::square_root, {apply(Op::absolute, {a.id})}), 1 + a.size); break;
    case 6: keep(apply(Op::inverse_square_root, {positive(a.id)}), 1); break;
    case 7: keep(apply(Op::negate, {a.id}), a.size); break;
    case 8: keep(apply(Op::saturate, {a.id}), 1); break;
    case 9: keep(apply(Op::minimum, {a.id, b.id}), a.size + b.size); break;
    case 10: keep(apply(Op::maximum, {a.id, b.id}), a.size + b.size); break;
    case 11:
        keep(apply(Op::clamp, {a.id, graph().literal("-1.5"), graph().literal("2")}), 2);
        break;
    case 12:
        keep(apply(Op::lerp, {a.id, b.id, scalar().id}), (a.size + b.size) * largest_value);
        break;
    case 13: {
        const ExprId weight = apply(Op::saturate, {scalar().id});
        keep(apply(Op::lerp, {a.id, b.id, weight}), a.size + b.size);
        break;
    }
    case 14: {
        constexpr std::array exponents{"2", "3", "5", "7", "0", "1"};
        const ExprId base = apply(Op::clamp, {a.id, graph().literal("-2"), graph().literal("2")});
        const ExprId exponent = graph().literal(exponents[static_cast<std::size_t>(below(6))]);
        keep(apply(Op::power, {base, exponent}), 128);
        break;
    }
    default: pool_.push_back(literal(chance(2) ? "0.19" : "pi")); break;
    }
}

void Builder::grow_choice(int kind)
{
    const Candidate a = scalar();
    const Candidate b = scalar();
    switch (kind) {
    case 0: keep(graph().apply(Op::select, {condition(), a.id, b.id}), a.size + b.size); break;
    case 1: keep(graph().apply(Op::step, {a.id, b.id}), 1); break;
    case 2: keep(graph().apply(Op::sign, {a.id}), 1); break;
    case 3: keep(graph().apply(Op::floor, {a.id}), a.size + 1); break;
    case 4: {
        // A division that names its limit.
        const ExprId zero = graph().literal("0");
        const ExprId whole = graph().apply(Op::floor, {b.id});
        const ExprId quotient = graph().apply(Op::divide, {a.id, whole});
        const ExprId at_limit = graph().apply(Op::equal, {whole, zero});
        keep(graph().apply(Op::select, {at_limit, a.id, quotient}), a.size);
        break;
    }
    default: keep(graph().apply(Op::guarded_smoothstep, {a.id, b.id, scalar().id}), 1); break;
    }
}

void Builder::grow_elementary(int kind)
{
    const Candidate a = any();
    const auto apply = [&](Op op, std::initializer_list<ExprId> operands) {
        return graph().apply(op, operands);
    };
    const auto clamped = [&](std::string_view low, std::string_view high) {
        return apply(Op::clamp, {a.id, graph().literal(low), graph().literal(high)});
    };
    switch (kind) {
    case 0: keep(apply(Op::exp2, {clamped("-10", "8")}), 256); break;
    case 1: keep(apply(Op::log2, {positive(a.id)}), 16); break;
    case 2: keep(apply(Op::exp, {clamped("-10", "5")}), 150); break;
    case 3: keep(apply(Op::log, {positive(a.id)}), 16); break;
    case 4: keep(apply(Op::sine, {clamped("-3", "3")}), 1); break;
    case 5: keep(apply(Op::cosine, {clamped("-3", "3")}), 1); break;
    case 6: keep(apply(Op::arc_tangent, {a.id}), 2); break;
    case 7: keep(apply(Op::arc_cosine, {clamped("-0.875", "0.875")}), 4); break;
    case 8: keep(apply(Op::arc_sine, {clamped("-0.875", "0.875")}), 2); break;
    case 9: keep(apply(Op::tangent, {clamped("-1", "1")}), 2); break;
    default: {
        const ExprId base = apply(Op::saturate, {a.id});
        const ExprId exponent =
            apply(Op::clamp, {scalar().id, graph().literal("0"), graph().literal("10")});
        keep(apply(Op::guarded_power, {base, exponent}), 1);
        break;
    }
    }
}

void Builder::grow_vector(int kind)
{
    const Candidate a = vector();
    const Candidate b = vector();
    switch (kind) {
    case 0: keep(graph().apply(Op::dot, {a.id, b.id}), 3 * a.size * b.size); break;
    case 1: keep(graph().apply(Op::dot, {a.id, a.id}), 3 * a.size * a.size); break;
    case 2: keep(graph().apply(Op::length, {a.id}), 2 * a.size); break;
    case 3: keep(graph().apply(Op::cross, {a.id, b.id}), 2 * a.size * b.size); break;
    case 4: keep(graph().apply(Op::guarded_normalize, {a.id}), 1); break;
    case 5: keep(graph().component(a.id, below(3)), a.size); break;
    default: {
        const std::array parts{scalar(), scalar(), scalar()};
        const std::array ids{parts[0].id, parts[1].id, parts[2].id};
        keep(graph().construct(Type::vec3, ids),
             std::max({parts[0].size, parts[1].size, parts[2].size}));
        break;
    }
    }
}

void Builder::grow_call()
{
    const std::size_t callee =
        static_cast<std::size_t>(below(static_cast<int>(module_.functions.size())));
    const Function& function = module_.functions[callee];
    std::vector<ExprId> operands;
    for (const Input& input : function.inputs) {
        const Candidate value = input.type == Type::vec3 ? vector() : scalar();
        operands.push_back(graph().apply(Op::clamp, {value.id, graph().literal(input.range.low),
                                                     graph().literal(input.range.high)}));
    }
    const ExprId result = graph().call(FunctionId{callee}, function.type(), operands);
    keep(result, std::max(std::abs(function.range.low), std::abs(function.range.high)));
}

void Builder::grow()
{
    const int family = below(10);
    if (family == 0 && shape_.selects) return grow_choice(below(6));
    if (family <= 2 && shape_.elementary) return grow_elementary(below(12));
    if (family <= 4 && shape_.vectors) return grow_vector(below(7));
    if (family == 5 && !module_.functions.empty()) return grow_call();
    grow_arithmetic(below(16));
}

void Builder::add_input(std::string name, Type type, Quantity quantity, Range range)
{
    const auto index = static_cast<std::uint32_t>(function_.inputs.size());
    function_.inputs.push_back({std::move(name), type, quantity, range, Origin::argument, 0, {}});
    pool_.push_back(
        {graph().input(index, type), std::max(std::abs(range.low), std::abs(range.high))});
}

Function Builder::build(std::size_t index)
{
    function_.name = "f" + std::to_string(index);
    function_.module = "random";
    function_.kind = Function::Kind::term;
    add_input("t", Type::scalar, Quantity::number, {0, 1});
    add_input("x", Type::scalar, Quantity::number, {-2, 2});
    if (shape_.vectors && chance(2)) add_input("tint", Type::vec3, Quantity::color, {0, 1});
    for (int i = 0; i < shape_.expressions; ++i) grow();

    // The latest value has the deepest expression.
    const Candidate last = pool_.back();
    function_.result = last.id;
    function_.quantity = graph()[last.id].type == Type::vec3 ? Quantity::vector : Quantity::number;
    function_.range = {-last.size, last.size};
    return std::move(function_);
}

}  // namespace

Module random_module(std::mt19937& random, const RandomShape& shape)
{
    Module module;
    module.name = "random";
    module.path = "random.lobe";
    for (int i = 0; i < shape.functions; ++i) {
        Function function = Builder{random, shape, module}.build(static_cast<std::size_t>(i));
        module.functions.push_back(std::move(function));
    }
    return module;
}

std::vector<double> random_point(std::mt19937& random, const Function& function)
{
    std::vector<double> point;
    for (const Input& input : function.inputs)
        for (int k = 0; k < components(input.type); ++k) {
            const auto [low, high] = input.range;
            const auto kind = std::uniform_int_distribution<int>{0, 15}(random);
            double value = std::uniform_real_distribution<double>{low, high}(random);
            if (kind < 2) value = low;
            if (kind == 2 || kind == 3) value = high;
            if (kind == 4 && low <= 0 && high >= 0x1p-140) value = 0x1p-140;
            if (kind == 5 && low <= 0 && high >= 0x1p-20) value = 0x1p-20;
            value = static_cast<double>(static_cast<float>(value));
            point.push_back(std::clamp(value, low, high));
        }
    return point;
}

}  // namespace lobe::tests
