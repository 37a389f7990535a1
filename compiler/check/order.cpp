#include "check/order.h"

#include "check/traverse.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

enum class Color {
    white,
    gray,
    black
};

/// The forms of a term, in their order.
std::vector<std::size_t> forms_of(const Program& program, std::size_t term)
{
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < program.callables.size(); ++i)
        if (program.callables[i].form && program.callables[i].term_index == term)
            result.push_back(i);
    return result;
}

class Ordering {
public:
    Ordering(const Program& program, Diagnostics& diagnostics)
        : program_(program), diagnostics_(diagnostics), colors_(program.callables.size()),
          cyclic_(program.callables.size())
    {
    }

    void visit(std::size_t root)
    {
        if (colors_[root] != Color::white) return;
        enter(root);
        while (!path_.empty()) {
            Step& step = path_.back();
            if (step.next == step.callees.size()) {
                colors_[step.callable] = Color::black;
                if (!cyclic_[step.callable]) order_.push_back(step.callable);
                path_.pop_back();
                continue;
            }
            const Callee callee = step.callees[step.next++];
            if (colors_[callee.callable] == Color::white)
                enter(callee.callable);
            else if (colors_[callee.callable] == Color::gray && !callee.is_alternative)
                report_cycle(callee.callable);
        }
    }

    std::vector<std::size_t> take() { return std::move(order_); }

private:
    /// What has to come first, or would better: a form of what is called.
    struct Callee {
        std::size_t callable = 0;
        Span span;
        bool is_alternative = false;
    };
    struct Step {
        std::size_t callable = 0;
        std::vector<Callee> callees;
        std::size_t next = 0;  ///< the callee to enter next; the one before it is being visited
    };

    void enter(std::size_t index)
    {
        colors_[index] = Color::gray;
        path_.push_back({index, callees_of(index), 0});
    }

    std::vector<Callee> callees_of(std::size_t index) const
    {
        const Callable& callable = program_.callables[index];
        const File& file = *program_.files[callable.file];
        const syntax::Body& body = callable.form ? callable.form->body : callable.term->body;
        std::vector<Callee> result;
        if (callable.form) result.push_back({callable.term_index, callable.span});
        const auto add = [&](syntax::ExpressionId root) {
            for (const Reference& called : references(program_, file, root)) {
                result.push_back({called.callable, called.span});
                for (const std::size_t form : forms_of(program_, called.callable))
                    result.push_back({form, called.span, true});
            }
        };
        for (const syntax::Let& let : body.lets) add(let.value);
        add(body.value);
        return result;
    }

    void report_cycle(std::size_t callee)
    {
        auto first = std::ranges::find(path_, callee, &Step::callable);
        std::string chain;
        std::vector<Label> calls;
        for (auto step = first; step != path_.end(); ++step) {
            cyclic_[step->callable] = true;
            const Callee& call = step->callees[step->next - 1];
            const std::string& caller = program_.callables[step->callable].name;
            const std::string& called = program_.callables[call.callable].name;
            if (chain.empty()) chain = fmt::format("`{}`", caller);
            chain += fmt::format(" calls `{}`", called);
            calls.push_back({call.span, fmt::format("`{}` calls `{}`", caller, called)});
        }
        const Callable& start = program_.callables[callee];
        const bool itself = first + 1 == path_.end();
        Diagnostic diagnostic{.code = Code::recursive_term,
                              .message = itself ? fmt::format("`{}` calls itself", start.name)
                                                : fmt::format("terms call each other: {}", chain),
                              .primary = calls.back(),
                              .secondary = {}};
        if (itself) diagnostic.primary.text.clear();
        for (std::size_t i = 0; i + 1 < calls.size(); ++i) diagnostic.secondary.push_back(calls[i]);
        diagnostic.notes = {"a term is a formula: its value must not depend on itself"};
        diagnostics_.report(std::move(diagnostic));
    }

    const Program& program_;
    Diagnostics& diagnostics_;
    std::vector<Color> colors_;
    std::vector<bool> cyclic_;
    std::vector<Step> path_;
    std::vector<std::size_t> order_;
};

}  // namespace

std::vector<Reference> references(const Program& program, const File& file,
                                  syntax::ExpressionId root)
{
    std::vector<Reference> result;
    std::vector<Visit> visits = walk(file.tree, root).visits;
    const auto visit_also = [&](syntax::ExpressionId id) {
        const std::vector<Visit> below = walk(file.tree, id).visits;
        visits.insert(visits.end(), below.begin(), below.end());
    };
    for (std::size_t i = 0; i < visits.size(); ++i) {
        if (const auto* sum = std::get_if<syntax::Sum>(&file.tree[visits[i].id].node)) {
            for (const syntax::Let& let : sum->body.lets) visit_also(let.value);
            visit_also(sum->body.value);
        }
        const auto* call = std::get_if<syntax::Call>(&file.tree[visits[i].id].node);
        if (!call) continue;
        const auto found = file.names.find(call->callee.text);
        if (found != file.names.end() && found->second.kind == NameKind::callable &&
            found->second.index < program.callables.size())
            result.push_back({found->second.index, call->callee.span});
    }
    return result;
}

bool is_needed(const Program& program, NameKind kind, std::size_t index, std::size_t file)
{
    if (file + 1 == program.files.size()) return true;
    return std::ranges::any_of(program.files.back()->names, [&](const auto& entry) {
        return entry.second.kind == kind && entry.second.index == index;
    });
}

std::vector<std::size_t> lowering_order(const Program& program, Diagnostics& diagnostics)
{
    Ordering ordering{program, diagnostics};
    const std::size_t root = program.files.size() - 1;
    for (std::size_t i = 0; i < program.callables.size(); ++i)
        if (program.callables[i].file == root) ordering.visit(i);

    const auto visit = [&](const File& file, syntax::ExpressionId id) {
        for (const Reference& reference : references(program, file, id)) {
            ordering.visit(reference.callable);
            for (const std::size_t form : forms_of(program, reference.callable))
                ordering.visit(form);
        }
    };
    for (const syntax::Item& item : program.files[root]->tree.items)
        if (const auto* effect = std::get_if<syntax::EffectItem>(&item.node))
            visit(*program.files[root], effect->off_when);
    for (std::size_t i = 0; i < program.models.size(); ++i) {
        const ModelDeclaration& model = program.models[i];
        if (!is_needed(program, kind_of(model), i, model.file)) continue;
        const File& file = *program.files[model.file];
        for (const syntax::Let& let : model.node->lets) visit(file, let.value);
        for (const syntax::Output& output : model.node->outputs) visit(file, output.value);
    }
    for (std::size_t i = 0; i < program.codes.size(); ++i) {
        const CodeDeclaration& code = program.codes[i];
        if (!is_needed(program, NameKind::code, i, code.file)) continue;
        visit(*program.files[code.file], code.node->encode);
        visit(*program.files[code.file], code.node->decode);
    }
    return ordering.take();
}

}  // namespace lobe::check
