// The stage on one page: load, declare, lower callees first, prove, place, assemble.
#include "check/check.h"

#include "check/assemble.h"
#include "check/codes.h"
#include "check/flatten.h"
#include "check/functions.h"
#include "check/layouts.h"
#include "check/modules.h"
#include "check/names.h"
#include "check/order.h"
#include "check/prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace lobe::check {
namespace {

/// Past this many errors a reader is not helped by more: what is shown, and what is looked for.
constexpr int shown_errors = 20;
constexpr int most_errors = 100;

/// What one function, and all of them together, may come to once calls are taken in. Calls within
/// calls multiply, so a short text can mean an endless program.
constexpr std::uint64_t most_operations = 1 << 16;
constexpr std::uint64_t most_operations_together = 1 << 24;

class Checking {
public:
    Checking(Program& program, const Sources& sources, Diagnostics& diagnostics)
        : program_(program), sources_(sources), diagnostics_(diagnostics)
    {
    }

    void lower_callables()
    {
        for (const std::size_t index : lowering_order(program_, diagnostics_)) {
            if (enough()) return;
            Callable& callable = program_.callables[index];
            Diagnostics found;
            Lowered lowered = lower_callable(program_, index, sources_, found);
            callable.function = settle(lowered, found);
            const bool own = callable.file + 1 == program_.files.size() &&
                             !program_.files[callable.file]->broken;
            forward_from(callable.file, found);
            if (own) warn_undocumented(callable);
        }
    }

    void lower_items()
    {
        for (std::size_t i = 0; i < program_.codes.size(); ++i) {
            if (enough()) return;
            if (is_needed(program_, NameKind::code, i, program_.codes[i].file)) lower_code(i);
        }
        for (std::size_t i = 0; i < program_.models.size(); ++i) {
            if (enough()) return;
            const ModelDeclaration& declared = program_.models[i];
            if (is_needed(program_, kind_of(declared), i, declared.file)) lower_model(i);
        }
        const File& root = program_.root();
        for (const syntax::Item& item : root.tree.items) {
            if (enough()) return;
            if (const auto* effect = std::get_if<syntax::EffectItem>(&item.node)) {
                const auto number = declarations_.effects.size() + 1;
                Lowered lowered = lower_effect(program_, *effect, number, sources_, diagnostics_);
                const std::string condition = lowered.draft.function.formula;
                const auto function = settle(lowered, diagnostics_);
                declarations_.effects.push_back({effect->name, function.value_or(ir::FunctionId{}),
                                                 condition, effect->name_span});
            }
        }
    }

    /// Every model that the root has or imports, under every such light.
    void join_lights()
    {
        Scope& names = program_.root().names;
        const auto visible = [&](NameKind kind) {
            std::vector<Declared*> found;
            for (std::size_t i = 0; i < program_.models.size(); ++i)
                for (auto& [name, declared] : names)
                    if (declared.kind == kind && declared.index == i && program_.models[i].model)
                        found.push_back(&declared);
            return found;
        };
        for (Declared* model : visible(NameKind::model))
            for (Declared* light : visible(NameKind::light)) {
                model->used = light->used = true;
                declarations_.shadings.push_back({*program_.models[model->index].model,
                                                  *program_.models[light->index].model,
                                                  {}});
            }
    }

    /// Whether decode undoes encode; a packing that uses them is looked at all the same.
    void check_codes()
    {
        for (const CodeDeclaration& declared : program_.codes) {
            if (!declared.encode || !declared.decode || enough()) continue;
            Diagnostics found;
            check_inverse(program_, declared, sources_, found);
            forward_from(declared.file, found);
        }
    }

    Declarations take() { return std::move(declarations_); }

private:
    bool enough() const { return diagnostics_.error_count() >= most_errors; }

    /// Proves what has to be proved of a body and enters its function. Nothing if either failed.
    std::optional<ir::FunctionId> settle(Lowered& lowered, Diagnostics& diagnostics)
    {
        // What could not be read may be what a proof would need.
        if (program_.files[lowered.file]->broken) return std::nullopt;
        const ir::Function& draft = lowered.draft.function;
        const std::uint64_t size = flat_size(program_.sizes, draft);
        operations_ += size;
        if (size > most_operations || operations_ > most_operations_together) {
            if (lowered.good) report_size(draft, size, diagnostics);
            return std::nullopt;
        }
        const bool proved = prove(program_, lowered.draft, sources_, effort_, diagnostics);
        if (!lowered.good || !proved) return std::nullopt;
        program_.functions.push_back(lowered.draft.finish());
        program_.sizes.push_back(size);
        return ir::FunctionId{program_.functions.size() - 1};
    }

    void report_size(const ir::Function& draft, std::uint64_t size, Diagnostics& diagnostics)
    {
        if (size <= most_operations) {
            if (reported_together_) return;
            reported_together_ = true;
        }
        diagnostics.report(
            {.code = Code::expansion_too_large,
             .message = fmt::format("`{}` is too large to check", draft.name),
             .primary = {draft.span,
                         size > most_operations
                             ? fmt::format("more than {} operations once its calls are taken in",
                                           most_operations)
                             : fmt::format("with it, the module has more than {} operations",
                                           most_operations_together)},
             .notes = {"each call counts with all that it calls"}});
    }

    /// Of an imported module's reports only errors are the root's affair, and warnings about half
    /// a text are nobody's.
    void forward_from(std::size_t file, const Diagnostics& found)
    {
        const bool own = file + 1 == program_.files.size() && !program_.files[file]->broken;
        for (const Diagnostic& diagnostic : found.all())
            if (own || severity(diagnostic.code) == Severity::error)
                diagnostics_.report(diagnostic);
    }

    void lower_code(std::size_t index)
    {
        Diagnostics found;
        LoweredCode lowered = check::lower_code(program_, index, sources_, found);
        CodeDeclaration& declared = program_.codes[index];
        declared.encode = settle(lowered.encode, found);
        declared.decode = settle(lowered.decode, found);
        forward_from(declared.file, found);
    }

    void lower_model(std::size_t index)
    {
        ModelDeclaration& declared = program_.models[index];
        const syntax::ModelItem& node = *declared.node;
        Diagnostics found;
        ir::Model result;
        result.name = node.name.text;
        result.span = node.name.span;
        result.module = program_.files[declared.file]->name;
        result.doc = syntax::doc_text(declared.item->comments);
        std::vector<Lowered> outputs = check::lower_model(program_, declared, sources_, found);
        for (std::size_t i = 0; i < outputs.size(); ++i)
            if (const auto function = settle(outputs[i], found))
                result.outputs.push_back({node.outputs[i].name.text, *function});
        declared.broken = result.outputs.size() < node.outputs.size();
        if (declared.file + 1 == program_.files.size())
            (node.is_light ? declarations_.lights : declarations_.models).push_back(result);
        declared.model = std::move(result);
        forward_from(declared.file, found);
    }

    void warn_undocumented(const Callable& callable)
    {
        const auto& comments = callable.item->comments;
        if (callable.form != nullptr || callable.name.empty() ||
            std::ranges::any_of(comments, &syntax::Comment::doc))
            return;
        diagnostics_.report(
            {.code = Code::undocumented_term,
             .message = fmt::format("the term `{}` says neither what it is nor where it is from",
                                    callable.name),
             .primary = {callable.span, ""},
             .helps = {"write a `///` line above it; generated code carries it along"}});
    }

    Program& program_;
    const Sources& sources_;
    Diagnostics& diagnostics_;
    Declarations declarations_;
    Effort effort_;
    std::uint64_t operations_ = 0;
    bool reported_together_ = false;
};

/// The first errors by place, and all warnings; the last error says how many are left out.
void forward(const Diagnostics& found, Diagnostics& diagnostics)
{
    int errors = 0;
    for (Diagnostic& diagnostic : found.sorted()) {
        const bool is_error = severity(diagnostic.code) == Severity::error;
        if (is_error && ++errors > shown_errors) continue;
        if (is_error && errors == shown_errors && found.error_count() > shown_errors)
            diagnostic.notes.push_back(fmt::format("this is error {}; {} more are not shown",
                                                   shown_errors,
                                                   found.error_count() - shown_errors));
        diagnostics.report(std::move(diagnostic));
    }
}

std::optional<ir::Module> check_program(Sources& sources, std::uint32_t root, const Loader& loader,
                                        Diagnostics& diagnostics)
{
    Program program;
    load_files(program, sources, root, loader, diagnostics);
    declare(program, diagnostics);

    Checking checking{program, sources, diagnostics};
    checking.lower_callables();
    checking.lower_items();
    checking.join_lights();
    if (!diagnostics.has_errors()) report_collisions(program, diagnostics);
    const bool proved = !diagnostics.has_errors();
    checking.check_codes();
    Declarations declarations = checking.take();
    read_layouts(program, declarations, diagnostics);
    if (!proved) return std::nullopt;

    // What is wrong with the places of fields does not hide what is wrong with their codes.
    ir::Module module = assemble(program, std::move(declarations), sources);
    build_packings(module, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;

    report_unused_imports(program, diagnostics);
    assert(!ir::verify(module));
    return module;
}

}  // namespace

std::optional<ir::Module> check(Sources& sources, std::uint32_t root, const Loader& loader,
                                Diagnostics& diagnostics)
{
    Diagnostics found;
    auto module = check_program(sources, root, loader, found);
    forward(found, diagnostics);
    return module;
}

}  // namespace lobe::check
