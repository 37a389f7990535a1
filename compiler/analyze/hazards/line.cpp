#include "analyze/hazards/line.h"

#include "optimize/inline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace lobe::analyze {
namespace {

using evaluate::Instruction;
using evaluate::Slot;
using ir::ExprId;

constexpr std::string_view complement_prefix = "one_minus_";

/// The function with the literal exponents of its powers as inputs of their own, and their values.
std::vector<double> open_exponents(ir::Function& function)
{
    std::vector<double> exponents;
    ir::Graph graph;
    Facts<ir::Expr, ExprId> moved(function.graph.size());
    const auto input_of = [&](double value) {
        const auto index = static_cast<std::uint32_t>(function.inputs.size());
        ir::Input input;
        input.name = "exponent";
        input.type = ir::Type::scalar;
        input.range = {value, value};
        function.inputs.push_back(input);
        exponents.push_back(value);
        return graph.input(index, ir::Type::scalar);
    };
    for (const ExprId id : function.graph.ids()) {
        std::vector<ExprId> operands;
        for (const ExprId operand : function.graph.operands(id)) operands.push_back(moved[operand]);
        if (function.graph[id].op == ir::Op::power) {
            const ExprId exponent = function.graph.operands(id)[1];
            if (function.graph[exponent].op == ir::Op::literal)
                operands[1] = input_of(function.graph.literal_of(exponent).value);
        }
        moved[id] = graph.copy(function.graph, id, operands);
    }
    function.result = moved[function.result];
    function.graph = std::move(graph);
    return exponents;
}

std::vector<WatchedLine::Feed> feeds_of(const WatchedLine& line, std::size_t declared,
                                        std::span<const double> exponents,
                                        std::span<const std::string> columns)
{
    std::vector<WatchedLine::Feed> feeds;
    for (const evaluate::TapeInput& input : line.tape.inputs) {
        WatchedLine::Feed feed;
        if (input.input >= declared) {
            feed.constant = exponents[input.input - declared];
            feeds.push_back(feed);
            continue;
        }
        std::string name = input.name;
        feed.complement = line.function.inputs[input.input].complement;
        if (feed.complement) name = name.substr(complement_prefix.size());
        const auto column = std::ranges::find(columns, name);
        assert(column != columns.end());
        feed.column = static_cast<std::size_t>(column - columns.begin());
        feeds.push_back(feed);
    }
    return feeds;
}

/// The first expression that a slot is of computes it; what is no expression's belongs to the one
/// that uses it.
std::vector<ExprId> owners(const evaluate::Traced& traced)
{
    std::vector<ExprId> of_slot(traced.tape.slots);
    for (std::size_t expr = 0; expr < traced.slots_of.size(); ++expr)
        for (const Slot slot : traced.slots_of[expr])
            if (!of_slot[slot].valid()) of_slot[slot] = ExprId{expr};
    const std::vector<Instruction>& code = traced.tape.code;
    std::vector<ExprId> owner(code.size());
    for (std::size_t i = code.size(); i-- > 0;) {
        owner[i] = of_slot[code[i].result];
        const std::array operands{code[i].a, code[i].b, code[i].c, code[i].d};
        for (std::size_t k = 0; k < static_cast<std::size_t>(arity(code[i].op)); ++k)
            if (!of_slot[operands[k]].valid()) of_slot[operands[k]] = owner[i];
    }
    return owner;
}

/// `a - b`, `f(a, b)`: enough for what ir::expand builds.
std::string formula(const ir::Function& function, ExprId id)
{
    const ir::Graph& graph = function.graph;
    const ir::Expr& expr = graph[id];
    const auto operand = [&](std::size_t i) { return formula(function, graph.operands(id)[i]); };
    switch (expr.op) {
    case ir::Op::input: return function.inputs[expr.aux].name;
    case ir::Op::literal: return graph.literal_of(id).text;
    case ir::Op::add: return fmt::format("{} + {}", operand(0), operand(1));
    case ir::Op::subtract: return fmt::format("{} - {}", operand(0), operand(1));
    case ir::Op::multiply: return fmt::format("({}) * ({})", operand(0), operand(1));
    case ir::Op::divide: return fmt::format("({}) / ({})", operand(0), operand(1));
    case ir::Op::component:
        return operand(0) + evaluate::component_suffix(ir::Type::vec3, ir::Quantity::direction,
                                                       static_cast<int>(expr.aux));
    default: break;
    }
    std::string text{ir::name(expr.op)};
    if (expr.op == ir::Op::guarded_normalize) text = "normalize";
    for (std::size_t i = 0; i < graph.operands(id).size(); ++i)
        text += (i == 0 ? "(" : ", ") + operand(i);
    return text + ")";
}

std::string on_one_line(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (!space)
            out += c;
        else if (!out.empty() && out.back() != ' ')
            out += ' ';
    }
    return out;
}

}  // namespace

WatchedLine watch(const ir::Module& module, ir::FunctionId function,
                  std::span<const std::string> columns)
{
    ir::Module with_entry = module;
    with_entry.functions.push_back(ir::entry_point(module, function));
    WatchedLine line;
    line.function =
        optimize::inline_calls(with_entry, ir::FunctionId{with_entry.functions.size() - 1});
    const std::size_t declared = line.function.inputs.size();
    const std::vector<double> exponents = open_exponents(line.function);
    evaluate::Traced traced = evaluate::compile_traced(with_entry, line.function);
    line.owner = owners(traced);
    line.tape = std::move(traced.tape);
    line.feeds = feeds_of(line, declared, exponents, columns);
    return line;
}

std::string text_of(const WatchedLine& line, ExprId expression, const Sources& sources)
{
    const Span span = line.function.graph.span(expression);
    if (span.begin != span.end && span.source < sources.size())
        return on_one_line(sources.text(span));
    return formula(line.function, expression);
}

}  // namespace lobe::analyze
