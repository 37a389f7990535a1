#include "check/traverse.h"

#include <algorithm>

namespace lobe::check {

using syntax::ExpressionId;

std::vector<ExpressionId> children(const syntax::Expression& expression)
{
    std::vector<ExpressionId> result;
    const auto add = [&result](ExpressionId id) {
        if (id.valid()) result.push_back(id);
    };
    if (const auto* member = std::get_if<syntax::Member>(&expression.node)) {
        add(member->base);
    } else if (const auto* unary = std::get_if<syntax::Unary>(&expression.node)) {
        add(unary->operand);
    } else if (const auto* binary = std::get_if<syntax::Binary>(&expression.node)) {
        add(binary->left);
        add(binary->right);
        add(binary->limit);
    } else if (const auto* call = std::get_if<syntax::Call>(&expression.node)) {
        for (const ExpressionId argument : call->arguments) add(argument);
    } else if (const auto* conditional = std::get_if<syntax::Conditional>(&expression.node)) {
        add(conditional->condition);
        add(conditional->then_value);
        add(conditional->else_value);
    }
    return result;
}

Walk walk(const syntax::Tree& tree, ExpressionId root)
{
    Walk result;
    result.guards.emplace_back();
    if (!root.valid()) return result;

    // Preorder with the operands pushed left to right visits the rightmost first; reversed, it
    // is the order of evaluation.
    std::vector<Visit> open{{root, 0}};
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        result.visits.push_back(visit);
        const syntax::Expression& expression = tree[visit.id];
        if (const auto* choice = std::get_if<syntax::Conditional>(&expression.node)) {
            open.push_back({choice->condition, visit.guard});
            for (const bool holds : {true, false}) {
                result.guards.push_back({visit.guard, choice->condition, holds});
                open.push_back(
                    {holds ? choice->then_value : choice->else_value, result.guards.size() - 1});
            }
        } else {
            for (const ExpressionId child : children(expression))
                open.push_back({child, visit.guard});
        }
    }
    std::ranges::reverse(result.visits);
    return result;
}

}  // namespace lobe::check
