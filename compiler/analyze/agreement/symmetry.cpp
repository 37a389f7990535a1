#include "analyze/agreement/symmetry.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lobe::analyze {
namespace {

bool commutes(ir::Op op)
{
    switch (op) {
    case ir::Op::add:
    case ir::Op::multiply:
    case ir::Op::minimum:
    case ir::Op::maximum:
    case ir::Op::equal:
    case ir::Op::not_equal:
    case ir::Op::logical_and:
    case ir::Op::logical_or:
    case ir::Op::dot: return true;
    default: return false;
    }
}

bool associates(ir::Op op) { return op == ir::Op::add || op == ir::Op::multiply; }

/// Numbers expressions so that two which differ only in the order and grouping of their operands
/// get the same number. Sums and products are kept as the sorted list of what they combine.
class Forms {
public:
    /// The number of a function's result when its inputs have the given numbers.
    int of_function(const ir::Module& module, ir::FunctionId id, const std::vector<int>& inputs)
    {
        const ir::Function& function = module[id];
        const ir::Graph& graph = function.graph;
        std::vector<int> forms(graph.size());
        for (const ir::ExprId expr : graph.ids()) {
            const ir::Expr& node = graph[expr];
            std::vector<int> operands;
            for (const ir::ExprId operand : graph.operands(expr))
                operands.push_back(forms[operand.index]);
            int& form = forms[expr.index];
            if (node.op == ir::Op::input)
                form = inputs[node.aux];
            else if (node.op == ir::Op::call)
                form = of_function(module, ir::FunctionId{std::size_t{node.aux}}, operands);
            else if (node.op == ir::Op::literal)
                form = number({node.op, node.type, graph.literal_of(expr).text, {}});
            else
                form = of_operation(node, std::move(operands));
        }
        return forms[function.result.index];
    }

    /// A number that stands for itself: an input of the outermost function.
    int of_input(ir::Type type, std::size_t index)
    {
        return number({ir::Op::input, type, std::to_string(index), {}});
    }

private:
    /// Operation, type, component or text of a literal, operands.
    using Form = std::tuple<ir::Op, ir::Type, std::string, std::vector<int>>;

    int of_operation(const ir::Expr& node, std::vector<int> operands)
    {
        if (associates(node.op)) {
            std::vector<int> flat;
            for (const int operand : operands) {
                const auto& [op, type, text, parts] = forms_[static_cast<std::size_t>(operand)];
                if (op == node.op)
                    flat.insert(flat.end(), parts.begin(), parts.end());
                else
                    flat.push_back(operand);
            }
            operands = std::move(flat);
        }
        if (commutes(node.op)) std::ranges::sort(operands);
        return number({node.op, node.type, std::to_string(node.aux), std::move(operands)});
    }

    int number(Form form)
    {
        const auto [found, added] = numbers_.try_emplace(form, static_cast<int>(forms_.size()));
        if (added) forms_.push_back(std::move(form));
        return found->second;
    }

    std::map<Form, int> numbers_;
    std::vector<Form> forms_;
};

}  // namespace

bool is_symmetric(const ir::Module& module, ir::FunctionId function, std::uint32_t a,
                  std::uint32_t b)
{
    const std::vector<ir::Input>& inputs = module[function].inputs;
    if (inputs[a].type != inputs[b].type) return false;
    Forms forms;
    std::vector<int> numbers;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        numbers.push_back(forms.of_input(inputs[i].type, i));
    const int plain = forms.of_function(module, function, numbers);
    std::swap(numbers[a], numbers[b]);
    return forms.of_function(module, function, numbers) == plain;
}

}  // namespace lobe::analyze
