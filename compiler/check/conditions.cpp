#include "check/conditions.h"

#include "check/program.h"
#include "check/traverse.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

namespace lobe::check {
namespace {

using ir::any;
using ir::both;
using ir::Configurations;
using ir::except;
using syntax::BinaryOperator;
using syntax::ExpressionId;

bool is_comparison(BinaryOperator op)
{
    return op == BinaryOperator::less || op == BinaryOperator::less_equal ||
           op == BinaryOperator::greater || op == BinaryOperator::greater_equal ||
           op == BinaryOperator::equal || op == BinaryOperator::not_equal;
}

bool holds(BinaryOperator op, std::size_t left, std::size_t right)
{
    switch (op) {
    case BinaryOperator::less: return left < right;
    case BinaryOperator::less_equal: return left <= right;
    case BinaryOperator::greater: return left > right;
    case BinaryOperator::greater_equal: return left >= right;
    case BinaryOperator::equal: return left == right;
    case BinaryOperator::not_equal: return left != right;
    case BinaryOperator::add:
    case BinaryOperator::subtract:
    case BinaryOperator::multiply:
    case BinaryOperator::divide:
    case BinaryOperator::power:
    case BinaryOperator::logical_and:
    case BinaryOperator::logical_or: break;
    }
    return false;
}

/// `a < b` with its operands exchanged.
BinaryOperator mirrored(BinaryOperator op)
{
    switch (op) {
    case BinaryOperator::less: return BinaryOperator::greater;
    case BinaryOperator::less_equal: return BinaryOperator::greater_equal;
    case BinaryOperator::greater: return BinaryOperator::less;
    case BinaryOperator::greater_equal: return BinaryOperator::less_equal;
    case BinaryOperator::add:
    case BinaryOperator::subtract:
    case BinaryOperator::multiply:
    case BinaryOperator::divide:
    case BinaryOperator::power:
    case BinaryOperator::equal:
    case BinaryOperator::not_equal:
    case BinaryOperator::logical_and:
    case BinaryOperator::logical_or: break;
    }
    return op;
}

class Deciding {
public:
    Deciding(const syntax::Tree& tree, const ir::Gbuffer& gbuffer, Diagnostics& diagnostics)
        : tree_(tree), gbuffer_(gbuffer), diagnostics_(diagnostics)
    {
        for (const ir::Setting& setting : gbuffer.settings) settings_.push_back(setting.name);
    }

    std::optional<Configurations> decide(ExpressionId root)
    {
        // Operands come first. Names have no set; the comparison above them reads them.
        for (const Visit& visit : walk(tree_, root).visits)
            if (!decide_node(visit.id)) return std::nullopt;
        if (std::holds_alternative<syntax::Name>(tree_[root].node)) {
            refuse_name(root);
            return std::nullopt;
        }
        return sets_.at(root.index);
    }

private:
    /// False when something was reported, or is poison.
    bool decide_node(ExpressionId id)
    {
        const syntax::Expression& expression = tree_[id];
        if (std::holds_alternative<syntax::Poison>(expression.node)) return false;
        if (std::holds_alternative<syntax::Name>(expression.node)) return true;
        if (const auto* unary = std::get_if<syntax::Unary>(&expression.node)) {
            if (unary->op != syntax::UnaryOperator::logical_not) return refuse(expression.span);
            const Configurations* operand = set_of(unary->operand);
            if (operand) sets_[id.index] = complement(*operand);
            return operand != nullptr;
        }
        const auto* binary = std::get_if<syntax::Binary>(&expression.node);
        if (!binary) return refuse(expression.span);
        if (is_comparison(binary->op)) {
            auto set = compare(*binary);
            if (set) sets_[id.index] = std::move(*set);
            return set.has_value();
        }
        if (binary->op != BinaryOperator::logical_and && binary->op != BinaryOperator::logical_or)
            return refuse(expression.span);
        const Configurations* left = set_of(binary->left);
        const Configurations* right = set_of(binary->right);
        if (!left || !right) return false;
        sets_[id.index] = binary->op == BinaryOperator::logical_and
                              ? both(*left, *right)
                              : complement(both(complement(*left), complement(*right)));
        return true;
    }

    const Configurations* set_of(ExpressionId id)
    {
        const auto found = sets_.find(id.index);
        if (found != sets_.end()) return &found->second;
        refuse_name(id);
        return nullptr;
    }

    std::optional<Configurations> compare(const syntax::Binary& binary)
    {
        const auto* left = std::get_if<syntax::Name>(&tree_[binary.left].node);
        const auto* right = std::get_if<syntax::Name>(&tree_[binary.right].node);
        if (!left || !right) {
            refuse(tree_[left ? binary.right : binary.left].span);
            return std::nullopt;
        }
        if (const auto setting = find(settings_, left->text))
            return compare(*setting, binary.op, right->text, tree_[binary.right].span);
        if (const auto setting = find(settings_, right->text))
            return compare(*setting, mirrored(binary.op), left->text, tree_[binary.left].span);
        report_unknown(left->text, tree_[binary.left].span,
                       fmt::format("`{}` has no setting", gbuffer_.name), settings_, "settings");
        return std::nullopt;
    }

    std::optional<Configurations> compare(std::size_t index, BinaryOperator op,
                                          const std::string& value, const Span& span)
    {
        const ir::Setting& setting = gbuffer_.settings[index];
        const auto wanted = find(setting.values, value);
        if (!wanted) {
            report_unknown(value, span, fmt::format("the setting `{}` has no value", setting.name),
                           setting.values, "values");
            return std::nullopt;
        }
        std::vector<std::size_t> values;
        for (std::size_t i = 0; i < setting.values.size(); ++i)
            if (holds(op, i, *wanted)) values.push_back(i);
        return gbuffer_.where(index, values);
    }

    static std::optional<std::size_t> find(const std::vector<std::string>& names,
                                           const std::string& name)
    {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) return std::nullopt;
        return static_cast<std::size_t>(found - names.begin());
    }

    void report_unknown(const std::string& name, const Span& span, std::string_view what,
                        const std::vector<std::string>& known, std::string_view kind)
    {
        Diagnostic diagnostic{.code = Code::gbuffer_declaration,
                              .message =
                                  fmt::format("{} `{}`{}", what, name, did_you_mean(name, known)),
                              .primary = {span, ""},
                              .fix = rename_fix(name, span, known)};
        if (!diagnostic.fix)
            diagnostic.notes = {known.empty()
                                    ? fmt::format("it has no {}", kind)
                                    : fmt::format("its {} are {}", kind, fmt::join(known, ", "))};
        diagnostics_.report(std::move(diagnostic));
    }

    void refuse_name(ExpressionId id)
    {
        const auto* name = std::get_if<syntax::Name>(&tree_[id].node);
        const auto setting = name ? find(settings_, name->text) : std::nullopt;
        if (!setting) {
            refuse(tree_[id].span);
            return;
        }
        const ir::Setting& of = gbuffer_.settings[*setting];
        diagnostics_.report(
            {.code = Code::gbuffer_declaration,
             .message = fmt::format("`{}` is a setting, not a condition", of.name),
             .primary = {tree_[id].span, ""},
             .helps = {fmt::format("compare it: `{} == {}`", of.name, of.values.back())}});
    }

    bool refuse(const Span& span)
    {
        diagnostics_.report(
            {.code = Code::gbuffer_declaration,
             .message = "this condition asks for something else than settings",
             .primary = {span, ""},
             .notes = {"a condition compares a setting with one of its values: `setting == value`; "
                       "`and`, `or` and `not` join such comparisons"}});
        return false;
    }

    const syntax::Tree& tree_;
    const ir::Gbuffer& gbuffer_;
    Diagnostics& diagnostics_;
    std::vector<std::string> settings_;
    std::unordered_map<std::uint32_t, Configurations> sets_;  ///< by expression
};

}  // namespace

std::optional<Configurations> decide(const syntax::Tree& tree, ExpressionId root,
                                     const ir::Gbuffer& gbuffer, Diagnostics& diagnostics)
{
    return Deciding{tree, gbuffer, diagnostics}.decide(root);
}

Configurations everywhere(const ir::Gbuffer& gbuffer)
{
    return Configurations(gbuffer.configurations(), true);
}

Configurations complement(const Configurations& set)
{
    return except(Configurations(set.size(), true), set);
}

std::vector<std::string> narrowing(const ir::Gbuffer& gbuffer, const Configurations& supported,
                                   const Configurations& good)
{
    const auto start = nearest_to_default(gbuffer, both(supported, good));
    if (!start) return {};
    const Configurations bad = except(supported, good);

    std::vector<std::vector<std::size_t>> box;
    for (const std::size_t value : gbuffer.values(*start)) box.push_back({value});
    const auto inside = [&] {
        Configurations set = everywhere(gbuffer);
        for (std::size_t i = 0; i < box.size(); ++i) set = both(set, gbuffer.where(i, box[i]));
        return set;
    };
    for (std::size_t i = 0; i < box.size(); ++i)
        for (std::size_t value = 0; value < gbuffer.settings[i].values.size(); ++value) {
            if (std::ranges::find(box[i], value) != box[i].end()) continue;
            const std::vector<std::size_t> before = box[i];
            box[i].push_back(value);
            if (any(both(inside(), bad))) box[i] = before;
        }

    std::vector<std::string> clauses;
    for (std::size_t i = 0; i < box.size(); ++i) {
        // Values that are not supported anyway need no clause.
        std::ranges::sort(box[i]);
        if (!any(except(supported, gbuffer.where(i, box[i])))) continue;
        std::string values;
        for (const std::size_t value : box[i])
            if (any(both(supported, gbuffer.where(i, {value}))))
                values += (values.empty() ? "" : ", ") + gbuffer.settings[i].values[value];
        clauses.push_back(fmt::format("supports {} == {}", gbuffer.settings[i].name, values));
    }
    return clauses;
}

std::string describe_where(const ir::Gbuffer& gbuffer, std::size_t configuration,
                           const Configurations& set)
{
    if (!any(complement(set))) return "in every configuration";
    return "where " + gbuffer.describe(configuration, set);
}

}  // namespace lobe::check
