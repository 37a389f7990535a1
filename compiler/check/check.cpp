// The stage on one page: load, declare, lower callees first, prove, assemble.
#include "check/check.h"

#include "check/assemble.h"
#include "check/functions.h"
#include "check/modules.h"
#include "check/names.h"
#include "check/order.h"
#include "check/prove.h"

#include <fmt/format.h>

#include <cassert>

namespace lobe::check {
namespace {

/// Past this many errors a reader is not helped by more.
constexpr int error_limit = 20;

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
            Lowered lowered = lower_callable(program_, index, sources_, diagnostics_);
            program_.callables[index].function = settle(lowered);
            warn_undocumented(program_.callables[index], lowered.draft.function);
        }
    }

    void lower_items()
    {
        const File& root = program_.root();
        for (const syntax::Item& item : root.tree.items) {
            if (enough()) return;
            if (const auto* model = std::get_if<syntax::ModelItem>(&item.node))
                lower_model_item(item, *model);
            if (const auto* effect = std::get_if<syntax::EffectItem>(&item.node)) {
                const auto number = declarations_.effects.size() + 1;
                Lowered lowered = lower_effect(program_, *effect, number, sources_, diagnostics_);
                const std::string condition = lowered.draft.function.formula;
                const auto function = settle(lowered);
                declarations_.effects.push_back({effect->name, function.value_or(ir::FunctionId{}),
                                                 condition, effect->name_span});
            }
        }
    }

    Declarations take() { return std::move(declarations_); }

private:
    bool enough() const { return diagnostics_.error_count() >= error_limit; }

    /// Proves what has to be proved of a body and enters its function. Nothing if either failed.
    std::optional<ir::FunctionId> settle(Lowered& lowered)
    {
        const bool proved = prove(program_, lowered.draft, sources_, diagnostics_);
        if (!lowered.good || !proved) return std::nullopt;
        program_.functions.push_back(lowered.draft.finish());
        return ir::FunctionId{program_.functions.size() - 1};
    }

    void lower_model_item(const syntax::Item& item, const syntax::ModelItem& model)
    {
        const File& root = program_.root();
        ir::Model result;
        result.name = model.name.text;
        result.span = model.name.span;
        result.module = root.name;
        result.doc = syntax::doc_text(item.comments);
        std::vector<Lowered> outputs = lower_model(program_, item, model, sources_, diagnostics_);
        for (std::size_t i = 0; i < outputs.size(); ++i)
            if (const auto function = settle(outputs[i]))
                result.outputs.push_back({model.outputs[i].name.text, *function});
        declarations_.models.push_back(std::move(result));
    }

    void warn_undocumented(const Callable& callable, const ir::Function& function)
    {
        const bool own = callable.file + 1 == program_.files.size();
        if (!own || callable.form != nullptr || !function.doc.empty() ||
            !function.citations.empty() || callable.name.empty())
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
};

}  // namespace

std::optional<ir::Module> check(Sources& sources, std::uint32_t root, const Loader& loader,
                                Diagnostics& diagnostics)
{
    Program program;
    load_files(program, sources, root, loader, diagnostics);
    declare(program, diagnostics);

    Checking checking{program, sources, diagnostics};
    checking.lower_callables();
    checking.lower_items();
    if (!diagnostics.has_errors()) report_collisions(program, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;

    report_unused_imports(program, diagnostics);
    ir::Module module = assemble(program, checking.take(), sources);
    assert(!ir::verify(module));
    return module;
}

}  // namespace lobe::check
