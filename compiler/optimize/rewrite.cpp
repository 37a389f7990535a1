#include "optimize/rewrite.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace lobe::optimize {

using namespace ir;

namespace {

/// The input that a function gains when a callee asks for this field or parameter.
Input gained_input(const Module& module, Origin origin, std::uint32_t which)
{
    assert(origin != Origin::argument && "an argument comes from the caller's operand");
    if (origin != Origin::parameter) return field_input(origin, which);
    const Parameter& parameter = module.parameters[which];
    return {parameter.name, parameter.type, parameter.quantity, parameter.range,
            origin,         which,          parameter.span};
}

/// True when a callee with these wires takes what it took when it had so many inputs.
bool is_same_order(const std::vector<Wire>& wires, std::size_t inputs)
{
    if (wires.size() != inputs) return false;
    for (std::uint32_t i = 0; i < wires.size(); ++i)
        if (wires[i].kind != Wire::Kind::kept || wires[i].index != i) return false;
    return true;
}

}  // namespace

Rebuild::Rebuild(const Module& old_module, const Module& new_module,
                 const std::vector<std::vector<Wire>>& wires, FunctionId id, bool is_root)
    : old_module_{&old_module},
      new_module_{&new_module}, wires_{&wires}, id_{id}, is_root_{is_root},
      moved_(old_module[id].graph.size())
{
    for (std::uint32_t i = 0; i < old().inputs.size(); ++i)
        slots_.push_back({old().inputs[i], {Wire::Kind::kept, i}});
    complement = [this](ExprId operand) {
        return graph.apply(Op::subtract, {graph.literal("1"), moved(operand)});
    };
}

std::vector<ExprId> Rebuild::moved_operands(ExprId old_id) const
{
    std::vector<ExprId> operands;
    for (const ExprId operand : old().graph.operands(old_id)) operands.push_back(moved(operand));
    return operands;
}

ExprId Rebuild::copy(ExprId old_id)
{
    // An input keeps its index until `finish` renumbers: old inputs come first among the slots.
    if (old().graph[old_id].op == Op::call) return call(old_id);
    return graph.copy(old().graph, old_id, moved_operands(old_id));
}

ExprId Rebuild::call(ExprId old_id)
{
    const Expr& expr = old().graph[old_id];
    const FunctionId callee_id{expr.aux};
    const Function& callee = rebuilt(callee_id);
    const auto& wires = (*wires_)[callee_id.index];
    const auto old_operands = old().graph.operands(old_id);

    std::vector<ExprId> operands;
    for (std::size_t i = 0; i < wires.size(); ++i) {
        const Input& wanted = callee.inputs[i];
        switch (wires[i].kind) {
        case Wire::Kind::kept: operands.push_back(moved(old_operands[wires[i].index])); break;
        case Wire::Kind::gained: operands.push_back(input(wanted.origin, wanted.which)); break;
        case Wire::Kind::complement:
            operands.push_back(complement(old_operands[wires[i].index]));
            break;
        }
    }
    return graph.call(callee_id, callee.type(), operands, old().graph.span(old_id));
}

ExprId Rebuild::call_instead(ExprId old_call, FunctionId callee_id)
{
    const Function& before = old_module()[FunctionId{old().graph[old_call].aux}];
    const Function& wanted = old_module()[callee_id];
    const auto old_operands = old().graph.operands(old_call);
    const auto operand_named = [&](const std::string& name) {
        const auto found = std::ranges::find_if(before.inputs, [&](const Input& input) {
            return input.origin == Origin::argument && input.name == name;
        });
        assert(found != before.inputs.end());
        return old_operands[static_cast<std::size_t>(found - before.inputs.begin())];
    };

    const Function& callee = rebuilt(callee_id);
    const auto& wires = (*wires_)[callee_id.index];
    std::vector<ExprId> operands;
    for (std::size_t i = 0; i < wires.size(); ++i) {
        const bool gained = wires[i].kind == Wire::Kind::gained;
        const Input& input = gained ? callee.inputs[i] : wanted.inputs[wires[i].index];
        if (input.origin != Origin::argument)
            operands.push_back(this->input(input.origin, input.which));
        else if (wires[i].kind == Wire::Kind::complement)
            operands.push_back(complement(operand_named(input.name)));
        else
            operands.push_back(moved(operand_named(input.name)));
    }
    return graph.call(callee_id, callee.type(), operands, old().graph.span(old_call));
}

ExprId Rebuild::input(Origin origin, std::uint32_t which)
{
    const auto found = std::ranges::find_if(slots_, [&](const Slot& slot) {
        return slot.input.origin == origin && slot.input.which == which;
    });
    const auto index = static_cast<std::uint32_t>(found - slots_.begin());
    if (found == slots_.end())
        slots_.push_back({gained_input(*old_module_, origin, which), {Wire::Kind::gained, 0}});
    return graph.input(index, slots_[index].input.type);
}

ExprId Rebuild::input(GeometryField field)
{
    return input(Origin::geometry, static_cast<std::uint32_t>(field));
}

ExprId Rebuild::complement_input(std::uint32_t index)
{
    assert(!is_root_ && "a root keeps the signature it was declared with");
    const auto found = std::ranges::find_if(slots_, [&](const Slot& slot) {
        return slot.wire.kind == Wire::Kind::complement && slot.wire.index == index;
    });
    const auto at = static_cast<std::uint32_t>(found - slots_.begin());
    if (found == slots_.end()) {
        Input added = old().inputs[index];
        added.range = {1 - added.range.high, 1 - added.range.low};
        added.name = "one_minus_" + added.name;
        added.complement = true;
        while (std::ranges::any_of(slots_,
                                   [&](const Slot& slot) { return slot.input.name == added.name; }))
            added.name += "_";
        slots_.push_back({added, {Wire::Kind::complement, index}});
    }
    return graph.input(at, slots_[at].input.type);
}

void Rebuild::place(ExprId old_id, ExprId new_id)
{
    assert(graph[new_id].type == old().graph[old_id].type);
    moved_[old_id] = new_id;
    // What the author called the old expression names the new one, unless it is plain already.
    if (shape(graph[new_id].op) != Shape::leaf) graph.set_name(new_id, old().graph.name_of(old_id));
}

/// Old inputs keep their order. A complement follows what it complements, and a gained field
/// goes among its like by field number; the first field of its kind goes before the parameters,
/// which come last by number.
std::vector<std::uint32_t> Rebuild::canonical_order(const std::vector<bool>& wanted) const
{
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < old().inputs.size(); ++i) order.push_back(i);
    for (auto added = static_cast<std::uint32_t>(order.size()); added < slots_.size(); ++added) {
        const Slot& slot = slots_[added];
        const auto belongs_before = [&](std::uint32_t other) {
            const Input& input = slots_[other].input;
            if (input.origin == slot.input.origin) return input.which > slot.input.which;
            return input.origin == Origin::parameter;
        };
        auto position = order.end();
        if (slot.wire.kind == Wire::Kind::complement) {
            position = std::ranges::find(order, slot.wire.index) + 1;
        } else {
            // After the last of its like that it follows, else before the first it precedes.
            const auto last_like = std::find_if(order.rbegin(), order.rend(), [&](auto other) {
                return slots_[other].input.origin == slot.input.origin && !belongs_before(other);
            });
            position = last_like != order.rend() ? last_like.base()
                                                 : std::ranges::find_if(order, belongs_before);
        }
        order.insert(position, added);
    }
    std::erase_if(order, [&](std::uint32_t index) { return !wanted[index]; });
    return order;
}

bool Rebuild::is_unchanged_by_copies() const
{
    const Graph& graph_of_old = old().graph;
    const auto uses = use_counts(graph_of_old, old().result);
    std::vector<bool> is_read(old().inputs.size());
    for (const ExprId id : graph_of_old.ids()) {
        const Expr& expr = graph_of_old[id];
        if (uses[id] == 0) return false;
        if (expr.op == Op::input) is_read[expr.aux] = true;
        if (expr.op == Op::call && !is_same_order((*wires_)[expr.aux], expr.count)) return false;
    }
    for (std::size_t i = 0; i < is_read.size(); ++i)
        if (!is_read[i] && !(is_root_ && old().inputs[i].origin == Origin::argument)) return false;
    return true;
}

std::pair<Function, std::vector<Wire>> Rebuild::finish()
{
    const ExprId result = moved(old().result);
    const auto uses = use_counts(graph, result);
    if (finished) finished();

    std::vector<bool> wanted(slots_.size());
    for (std::size_t i = 0; i < slots_.size(); ++i)
        wanted[i] = is_root_ && slots_[i].input.origin == Origin::argument;
    for (const ExprId id : graph.ids())
        if (graph[id].op == Op::input && uses[id] > 0) wanted[graph[id].aux] = true;

    Function function = without_body(old());
    std::vector<Wire> wires;
    std::vector<std::uint32_t> place_of(slots_.size());
    for (const std::uint32_t index : canonical_order(wanted)) {
        place_of[index] = static_cast<std::uint32_t>(function.inputs.size());
        function.inputs.push_back(slots_[index].input);
        wires.push_back(slots_[index].wire);
    }

    Facts<Expr, ExprId> compacted(graph.size());
    std::vector<ExprId> operands;
    for (const ExprId id : graph.ids()) {
        if (uses[id] == 0) continue;
        if (graph[id].op == Op::input) {
            compacted[id] =
                function.graph.input(place_of[graph[id].aux], graph[id].type, graph.span(id));
            continue;
        }
        operands.clear();
        for (const ExprId operand : graph.operands(id)) operands.push_back(compacted[operand]);
        compacted[id] = function.graph.copy(graph, id, operands);
    }
    function.result = compacted[result];
    return {std::move(function), std::move(wires)};
}

std::vector<FunctionId> all_roots(const Module& module)
{
    std::vector<FunctionId> roots = module.roots();
    std::ranges::copy(module.packing_roots(), std::back_inserter(roots));
    std::ranges::copy(module.shading_roots(), std::back_inserter(roots));
    return roots;
}

std::vector<bool> root_flags(const Module& module)
{
    std::vector<bool> flags(module.functions.size());
    for (const FunctionId id : all_roots(module)) flags[id.index] = true;
    return flags;
}

Module rewrite(const Module& module, const Pass& pass)
{
    const std::vector<bool> is_root = root_flags(module);
    Module result = without_functions(module);
    result.functions.reserve(module.functions.size());
    std::vector<std::vector<Wire>> wires;
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        Rebuild rebuild{module, result, wires, FunctionId{i}, is_root[i]};
        const Step step = pass(rebuild);
        if (!step && rebuild.is_unchanged_by_copies()) {
            result.functions.push_back(module.functions[i]);
            auto& same = wires.emplace_back();
            for (std::uint32_t k = 0; k < module.functions[i].inputs.size(); ++k)
                same.push_back({Wire::Kind::kept, k});
            continue;
        }
        for (const ExprId id : rebuild.old().graph.ids())
            rebuild.place(id, step ? step(id) : rebuild.copy(id));
        auto [function, function_wires] = rebuild.finish();
        result.functions.push_back(std::move(function));
        wires.push_back(std::move(function_wires));
    }
    return result;
}

namespace {

/// The same expression from the result down. Both graphs share equal expressions, so a pairing
/// of ids that is one to one is all there is to it.
bool same_graph(const Function& f, const Function& g)
{
    std::vector<std::pair<ExprId, ExprId>> open{{f.result, g.result}};
    Facts<Expr, ExprId> paired(f.graph.size());
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        if (paired[a].valid()) {
            if (paired[a] != b) return false;
            continue;
        }
        paired[a] = b;
        const Expr& x = f.graph[a];
        const Expr& y = g.graph[b];
        if (x.op != y.op || x.type != y.type || x.count != y.count) return false;
        if (x.op == Op::literal ? f.graph.literal_of(a).text != g.graph.literal_of(b).text
                                : x.aux != y.aux)
            return false;
        for (std::size_t i = 0; i < x.count; ++i)
            open.emplace_back(f.graph.operands(a)[i], g.graph.operands(b)[i]);
    }
    return true;
}

bool same_input(const Input& x, const Input& y)
{
    return x.name == y.name && x.type == y.type && x.range == y.range && x.origin == y.origin &&
           x.which == y.which;
}

}  // namespace

bool same_function(const Function& f, const Function& g)
{
    return f.name == g.name && std::ranges::equal(f.inputs, g.inputs, same_input) &&
           same_graph(f, g);
}

bool same_graphs(const Module& a, const Module& b)
{
    return std::ranges::equal(a.functions, b.functions, same_function);
}

}  // namespace lobe::optimize
