#include "check/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::check {

using ir::ExprId;
using ir::Op;
using ir::Range;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Stands for "above 0": the smallest positive float, so in float nothing lies between. Products
/// of some such values still do not underflow in double.
constexpr double least = 0x1p-149;

ExprId constant(ir::Graph& graph, double value)
{
    // The common ones need no conversion to exact decimal digits.
    if (value == 0) return graph.literal("0");
    if (value == 1) return graph.literal("1");
    return graph.literal(value);
}

/// An expression known to lie in a range.
ExprId clamped(ir::Graph& graph, ExprId value, const Range& range)
{
    if (graph[value].type == ir::Type::boolean) return value;
    if (range.low > -infinity)
        value = graph.apply(Op::maximum, {value, constant(graph, range.low)});
    if (range.high < infinity)
        value = graph.apply(Op::minimum, {value, constant(graph, range.high)});
    return value;
}

std::vector<bool> live(const ir::Graph& graph, std::span<const ExprId> roots)
{
    std::vector<bool> result(graph.size());
    for (const ExprId root : roots) result[root.index] = true;
    for (std::size_t i = graph.size(); i-- > 0;)
        if (result[i])
            for (const ExprId operand : graph.operands(ExprId{i})) result[operand.index] = true;
    return result;
}

/// The ranges that facts give to expressions of the draft.
class Bounds {
public:
    Bounds(const ir::Graph& graph, const std::vector<Fact>& given) : ranges_(graph.size(), open)
    {
        for (const Fact& fact : given) {
            const bool strict = fact.relation == Relation::less;
            switch (fact.relation) {
            case Relation::less:
            case Relation::less_equal: add_order(graph, fact.left, fact.right, strict); break;
            case Relation::equal:
                add_order(graph, fact.left, fact.right, false);
                add_order(graph, fact.right, fact.left, false);
                break;
            case Relation::not_equal: break;  // no interval says it
            }
        }
    }

    const Range& operator[](ExprId id) const { return ranges_[id.index]; }

private:
    static constexpr Range open{-infinity, infinity};

    void narrow(ExprId id, const Range& by)
    {
        Range& range = ranges_[id.index];
        range.low = std::max(range.low, by.low);
        range.high = std::min(range.high, by.high);
    }

    /// smaller < larger, or <=.
    void add_order(const ir::Graph& graph, ExprId smaller, ExprId larger, bool strict)
    {
        const auto literal = [&](ExprId id) { return graph[id].op == Op::literal; };
        const auto above = [strict](double x) { return strict && x == 0 ? least : x; };
        const auto below = [strict](double x) { return strict && x == 0 ? -least : x; };
        if (literal(smaller)) narrow(larger, {above(graph.literal_of(smaller).value), infinity});
        if (literal(larger)) narrow(smaller, {-infinity, below(graph.literal_of(larger).value)});
        // Of two expressions the fact is about their difference, if the body has it.
        for (const ExprId id : graph.ids()) {
            if (graph[id].op != Op::subtract) continue;
            const auto operands = graph.operands(id);
            if (operands[0] == larger && operands[1] == smaller) narrow(id, {above(0), infinity});
            if (operands[0] == smaller && operands[1] == larger) narrow(id, {-infinity, below(0)});
        }
    }

    std::vector<Range> ranges_;
};

/// A graph that is being copied, and how far: calls within calls are taken in without recursion.
struct Frame {
    const ir::Function* function = nullptr;
    std::vector<bool> wanted;
    std::vector<ExprId> moved;   ///< per expression
    std::vector<ExprId> inputs;  ///< what stands for the function's inputs; empty at the outermost
    std::size_t next = 0;
    ExprId call;  ///< the call in the frame below that this one answers
};

std::vector<ExprId> operands_of(const Frame& frame, ExprId id)
{
    std::vector<ExprId> operands;
    for (const ExprId operand : frame.function->graph.operands(id))
        operands.push_back(frame.moved[operand.index]);
    return operands;
}

}  // namespace

Flat flatten(const std::vector<ir::Function>& functions, const ir::Function& draft,
             std::span<const ExprId> roots, const std::vector<Fact>& given, Calls calls)
{
    Flat flat;
    flat.function.name = draft.name;
    flat.function.inputs = draft.inputs;
    ir::Graph& to = flat.function.graph;
    const Bounds bounds{draft.graph, given};

    std::vector<Frame> frames;
    frames.push_back(
        {&draft, live(draft.graph, roots), std::vector<ExprId>(draft.graph.size()), {}, 0, {}});
    while (true) {
        Frame& frame = frames.back();
        const ir::Graph& from = frame.function->graph;
        if (frame.next == from.size()) {
            if (frames.size() == 1) break;
            const ExprId value =
                clamped(to, frame.moved[frame.function->result.index], frame.function->range);
            const ExprId call = frame.call;
            frames.pop_back();
            Frame& caller = frames.back();
            caller.moved[call.index] =
                frames.size() == 1 ? clamped(to, value, bounds[call]) : value;
            continue;
        }
        const ExprId id{frame.next++};
        if (!frame.wanted[id.index]) continue;
        const ir::Expr& expr = from[id];
        if (expr.op == Op::call) {
            const ir::Function& callee = functions[expr.aux];
            if (calls == Calls::as_inputs) {
                const auto index = static_cast<std::uint32_t>(flat.function.inputs.size());
                flat.function.inputs.push_back({callee.name,
                                                expr.type,
                                                callee.quantity,
                                                callee.range,
                                                ir::Origin::argument,
                                                index,
                                                {}});
                frame.moved[id.index] = clamped(to, to.input(index, expr.type), bounds[id]);
                continue;
            }
            std::vector<ExprId> arguments = operands_of(frame, id);
            frames.push_back({&callee, live(callee.graph, std::span{&callee.result, 1}),
                              std::vector<ExprId>(callee.graph.size()), std::move(arguments), 0,
                              id});
            continue;
        }
        const std::vector<ExprId> operands = operands_of(frame, id);
        const bool outermost = frames.size() == 1;
        ExprId moved = expr.op == Op::input && !outermost ? frame.inputs[expr.aux]
                                                          : to.copy(from, id, operands);
        if (outermost && expr.op != Op::literal) moved = clamped(to, moved, bounds[id]);
        frame.moved[id.index] = moved;
    }
    for (const ExprId root : roots) flat.roots.push_back(frames[0].moved[root.index]);
    return flat;
}

Flat over_vectors(const Flat& flat)
{
    using ir::GeometryField;
    Flat result;
    result.function.name = flat.function.name;
    ir::Graph& to = result.function.graph;
    const auto add_input = [&](const ir::Input& input) {
        const auto index = static_cast<std::uint32_t>(result.function.inputs.size());
        result.function.inputs.push_back(input);
        return to.input(index, input.type);
    };
    const auto add_vector = [&](GeometryField field) {
        return add_input({std::string{ir::facts(field).name},
                          ir::Type::vec3,
                          ir::Quantity::direction,
                          {-1, 1},
                          ir::Origin::geometry,
                          static_cast<std::uint32_t>(field),
                          {}});
    };

    const auto wanted = live(flat.function.graph, flat.roots);
    std::vector<bool> used(flat.function.inputs.size());
    for (const ExprId id : flat.function.graph.ids())
        if (wanted[id.index] && flat.function.graph[id].op == Op::input)
            used[flat.function.graph[id].aux] = true;
    bool geometry = false;
    bool tangents = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const ir::Input& input = flat.function.inputs[i];
        if (!used[i] || input.origin != ir::Origin::geometry) continue;
        geometry = true;
        tangents = tangents || ir::needs_tangents(static_cast<GeometryField>(input.which));
    }
    ir::Frame frame;
    if (geometry) {
        frame.l = add_vector(GeometryField::l);
        frame.v = add_vector(GeometryField::v);
        frame.n = add_vector(GeometryField::n);
    }
    if (tangents) {
        frame.x = add_vector(GeometryField::x);
        frame.y = add_vector(GeometryField::y);
    }

    std::vector<ExprId> inputs(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        const ir::Input& input = flat.function.inputs[i];
        if (!used[i]) continue;
        inputs[i] = input.origin == ir::Origin::geometry
                        ? ir::expand(to, static_cast<GeometryField>(input.which), frame)
                        : add_input(input);
    }
    std::vector<ExprId> moved(flat.function.graph.size());
    for (const ExprId id : flat.function.graph.ids()) {
        if (!wanted[id.index]) continue;
        const ir::Expr& expr = flat.function.graph[id];
        if (expr.op == Op::input) {
            moved[id.index] = inputs[expr.aux];
            continue;
        }
        std::vector<ExprId> operands;
        for (const ExprId operand : flat.function.graph.operands(id))
            operands.push_back(moved[operand.index]);
        moved[id.index] = to.copy(flat.function.graph, id, operands);
    }
    for (const ExprId root : flat.roots) result.roots.push_back(moved[root.index]);
    return result;
}

std::uint64_t flat_size(const std::vector<std::uint64_t>& sizes, const ir::Function& function)
{
    constexpr std::uint64_t most = std::uint64_t{1} << 40;
    std::uint64_t total = 0;
    for (const ExprId id : function.graph.ids()) {
        const ir::Expr& expr = function.graph[id];
        total += expr.op == Op::call ? sizes[expr.aux]
                                     : static_cast<std::uint64_t>(ir::components(expr.type));
        if (total > most) return most;
    }
    return total;
}

}  // namespace lobe::check
