#include "check/names.h"

#include "check/builtins.h"
#include "check/declarations.h"

#include <fmt/format.h>

#include <set>

namespace lobe::check {
namespace {

class Declaring {
public:
    Declaring(Program& program, std::size_t index, Diagnostics& diagnostics)
        : program_(program), index_(index), file_(*program.files[index]), diagnostics_(diagnostics)
    {
    }

    void run()
    {
        // Citations and tiers may be named above their declaration.
        for (const syntax::Item& item : file_.tree.items) {
            if (const auto* source = std::get_if<syntax::SourceItem>(&item.node))
                declare_source(*source);
            if (const auto* tier = std::get_if<syntax::TierItem>(&item.node)) declare_tiers(*tier);
        }
        std::size_t import = 0;
        for (const syntax::Item& item : file_.tree.items) {
            if (const auto* node = std::get_if<syntax::Import>(&item.node)) {
                declare_import(*node, file_.imports[import++]);
            } else if (const auto* param = std::get_if<syntax::ParamItem>(&item.node)) {
                declare_parameter(item, *param);
            } else if (const auto* term = std::get_if<syntax::TermItem>(&item.node)) {
                declare_term(item, *term);
            } else if (const auto* model = std::get_if<syntax::ModelItem>(&item.node)) {
                declare_model(item, *model);
            } else if (const auto* gbuffer = std::get_if<syntax::GbufferItem>(&item.node)) {
                program_.gbuffers.push_back({index_, &item, gbuffer, {}});
                enter(gbuffer->name,
                      {NameKind::gbuffer, program_.gbuffers.size() - 1, gbuffer->name.span},
                      "gbuffer");
            } else if (const auto* code = std::get_if<syntax::CodeItem>(&item.node)) {
                program_.codes.push_back({index_, &item, code, {}, {}});
                enter(code->name, {NameKind::code, program_.codes.size() - 1, code->name.span},
                      "code");
            } else if (const auto* effect = std::get_if<syntax::EffectItem>(&item.node)) {
                const auto [found, added] = effects_.try_emplace(effect->name, effect->name_span);
                if (!added) duplicate("effect", effect->name, effect->name_span, found->second);
            }
        }
    }

private:
    void duplicate(std::string_view what, const std::string& name, const Span& span,
                   const Span& first)
    {
        diagnostics_.report({.code = Code::duplicate_name,
                             .message = fmt::format("the {} `{}` is declared twice", what, name),
                             .primary = {span, "declared again"},
                             .secondary = {{first, "first declared here"}}});
    }

    /// Enters a name; false (reported) when it is taken or standard.
    bool enter(const syntax::Identifier& name, const Declared& declared, std::string_view what)
    {
        return enter(name.text, declared, what);
    }
    bool enter(const std::string& name, const Declared& declared, std::string_view what)
    {
        if (name.empty()) return false;
        if (is_standard_name(name)) {
            diagnostics_.report(
                {.code = Code::shadowed_builtin,
                 .message = fmt::format("the {} `{}` would hide the standard name", what, name),
                 .primary = {declared.span, ""},
                 .helps = {"give it another name"}});
            return false;
        }
        const auto [found, added] = file_.names.try_emplace(name, declared);
        if (added) return true;
        if (found->second.kind != NameKind::lost)
            duplicate(what, name, declared.span, found->second.span);
        return false;
    }

    void declare_source(const syntax::SourceItem& source)
    {
        const auto [found, added] = file_.sources.try_emplace(source.name.text, &source);
        if (!added)
            duplicate("source", source.name.text, source.name.span, found->second->name.span);
    }

    void declare_tiers(const syntax::TierItem& tier)
    {
        for (const syntax::Identifier& name : tier.names) {
            const auto [found, added] = file_.tiers.try_emplace(name.text, name.span);
            if (!added) duplicate("tier", name.text, name.span, found->second);
        }
    }

    static bool is_exported(NameKind kind)
    {
        return kind != NameKind::output && kind != NameKind::lost;
    }

    void declare_import(const syntax::Import& import, const std::optional<std::size_t>& from)
    {
        for (const syntax::Identifier& name : import.names) {
            Declared declared{NameKind::lost, 0, name.span, true, false};
            if (from) {
                const File& other = *program_.files[*from];
                const auto found = other.names.find(name.text);
                if (found != other.names.end() && !found->second.imported &&
                    is_exported(found->second.kind)) {
                    declared.kind = found->second.kind;
                    declared.index = found->second.index;
                } else if (!other.broken) {
                    report_not_exported(name, other);
                }
            }
            enter(name, declared, "import");
        }
    }

    void report_not_exported(const syntax::Identifier& name, const File& other)
    {
        std::vector<std::string> exported;
        for (const auto& [known, declared] : other.names)
            if (is_exported(declared.kind) && !declared.imported) exported.push_back(known);
        Diagnostic diagnostic{
            .code = Code::not_exported,
            .message = fmt::format("module `{}` declares no `{}` that can be imported{}",
                                   other.name, name.text, did_you_mean(name.text, exported)),
            .primary = {name.span, ""},
            .fix = rename_fix(name.text, name.span, exported)};
        if (const auto found = other.names.find(name.text); found != other.names.end()) {
            diagnostic.secondary.push_back({found->second.span, found->second.imported
                                                                    ? "it only imports it, here"
                                                                    : "this is an output"});
            diagnostic.notes.push_back(
                found->second.imported
                    ? "names are imported from the module that declares them"
                    : "an output comes along with its model or light: import that");
        }
        diagnostics_.report(std::move(diagnostic));
    }

    void declare_parameter(const syntax::Item& item, const syntax::ParamItem& param)
    {
        bool broken = false;
        const std::size_t index = program_.parameters.size();
        program_.parameters.push_back(resolve_parameter(file_, item, param, broken, diagnostics_));
        program_.parameter_broken.push_back(broken);
        enter(param.name, {NameKind::parameter, index, param.name.span}, "parameter");
    }

    void declare_term(const syntax::Item& item, const syntax::TermItem& term)
    {
        Callable callable;
        callable.name = term.name.text;
        callable.span = term.name.span;
        callable.file = index_;
        callable.item = &item;
        callable.term = &term;
        callable.term_index = program_.callables.size();
        callable.signature =
            resolve_signature(file_.tree, term.parameters, term.result, diagnostics_);
        add(callable, "term");

        std::map<std::string, Span> forms;
        for (const syntax::Form& form : term.forms) {
            const auto [found, added] = forms.try_emplace(form.name.text, form.name.span);
            if (!added) {
                duplicate("form", form.name.text, form.name.span, found->second);
                continue;
            }
            Callable other = callable;
            other.name = fmt::format("{}_{}", term.name.text, form.name.text);
            other.span = form.name.span;
            other.form = &form;
            add(other, "form");
        }
    }

    void add(const Callable& callable, std::string_view what)
    {
        const std::size_t index = program_.callables.size();
        program_.callables.push_back(callable);
        // A second declaration is still checked, but no name leads to it.
        enter(callable.name, {NameKind::callable, index, callable.span}, what);
    }

    void declare_model(const syntax::Item& item, const syntax::ModelItem& model)
    {
        program_.models.push_back({index_, &item, &model, {}});
        enter(model.name,
              {kind_of(program_.models.back()), program_.models.size() - 1, model.name.span},
              model.is_light ? "light" : "model");
        std::map<std::string, Span> outputs;
        for (const syntax::Output& output : model.outputs) {
            const auto [found, added] = outputs.try_emplace(output.name.text, output.name.span);
            if (!added) {
                duplicate("output", output.name.text, output.name.span, found->second);
                continue;
            }
            // Each output becomes a function of this name, beside those of the terms.
            enter(fmt::format("{}_{}", model.name.text, output.name.text),
                  {NameKind::output, 0, output.name.span}, "output");
        }
    }

    Program& program_;
    std::size_t index_;
    File& file_;
    Diagnostics& diagnostics_;
    std::map<std::string, Span> effects_;
};

}  // namespace

void declare(Program& program, Diagnostics& diagnostics)
{
    for (std::size_t i = 0; i < program.files.size(); ++i) Declaring{program, i, diagnostics}.run();
}

void report_unused_imports(const Program& program, Diagnostics& diagnostics)
{
    for (const auto& [name, declared] : program.files.back()->names)
        if (declared.imported && !declared.used && declared.kind != NameKind::lost)
            diagnostics.report({.code = Code::unused_name,
                                .message = fmt::format("`{}` is imported but not used", name),
                                .primary = {declared.span, ""},
                                .helps = {"remove it from the import"}});
}

}  // namespace lobe::check
