#include "optimize/forms.h"

#include "optimize/rewrite.h"

namespace lobe::optimize {

using namespace ir;

namespace {

/// By function: the form to call in its place.
std::vector<FunctionId> chosen_forms(const Module& module, const Choice& choice)
{
    std::vector<FunctionId> result(module.functions.size());
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        const Function& form = module.functions[i];
        if (form.kind != Function::Kind::form) continue;
        const auto found = choice.find(module[form.form_of].name);
        if (found != choice.end() && found->second == form.form_name)
            result[form.form_of.index] = FunctionId{i};
    }
    return result;
}

}  // namespace

std::vector<Alternatives> alternatives(const Module& module, const std::vector<FunctionId>& roots)
{
    std::vector<Alternatives> result;
    for (const FunctionId term : module.reachable(roots)) {
        Alternatives found{term, {}};
        for (std::size_t i = 0; i < module.functions.size(); ++i)
            if (module.functions[i].kind == Function::Kind::form &&
                module.functions[i].form_of == term)
                found.forms.push_back(FunctionId{i});
        if (!found.forms.empty()) result.push_back(std::move(found));
    }
    return result;
}

Module choose(const Module& module, const Choice& choice)
{
    const std::vector<FunctionId> chosen = chosen_forms(module, choice);
    return rewrite(module, [&](Rebuild& rebuild) -> Step {
        // The checker puts a form before all that calls its term, but for what the form needs:
        // there a call stays what it was, or the form would call itself.
        const auto replacement = [&rebuild, &chosen](ExprId id) {
            const Expr& expr = rebuild.old().graph[id];
            if (expr.op != Op::call) return FunctionId{};
            const FunctionId form = chosen[expr.aux];
            return form.valid() && form.index < rebuild.id().index ? form : FunctionId{};
        };
        if (!any_expression(rebuild.old().graph,
                            [&](ExprId id) { return replacement(id).valid(); }))
            return {};
        return [&rebuild, replacement](ExprId id) {
            const FunctionId form = replacement(id);
            return form.valid() ? rebuild.call_instead(id, form) : rebuild.copy(id);
        };
    });
}

}  // namespace lobe::optimize
