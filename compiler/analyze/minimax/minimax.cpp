#include "analyze/minimax/minimax.h"

#include "analyze/cost/weight.h"
#include "analyze/minimax/error.h"
#include "analyze/minimax/formula.h"
#include "analyze/minimax/search.h"
#include "analyze/tasks.h"
#include "evaluate/run.h"
#include "ir/insert.h"
#include "optimize/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

using ir::FunctionId;

/// A part, what it weighs, and what was found for it.
struct PartFinds {
    PartSearch search;
    int weight = 0;
    struct Find {
        NamedShape shape;
        std::optional<FoundRatio> ratio;
    };
    std::vector<Find> finds;

    PartFinds(const ir::Module& module, Part part) : search{module, std::move(part)} {}

    const Find* find(const std::string& shape) const
    {
        const auto found = std::ranges::find_if(
            finds, [&](const Find& f) { return f.shape.name == shape && f.ratio; });
        return found == finds.end() ? nullptr : &*found;
    }
};

/// A term that forms are looked for.
struct Subject {
    FunctionId term;
    int weight = 0;
    std::vector<std::unique_ptr<PartFinds>> parts;
};

/// A product and a sum, which are one operation, per coefficient but one.
int least_weight(const Shape& shape)
{
    const int top = static_cast<int>(shape.numerator.size()) - 1;
    const int bottom = static_cast<int>(shape.denominator.size());
    return bottom == 0 ? top : top + bottom + weight_of_division;
}

/// Weights of functions that are not in the module, as they would be after its passes.
std::vector<int> weights(const ir::Module& module, const std::vector<const ir::Function*>& more,
                         std::vector<int>* of_module = nullptr)
{
    ir::Module probe = module;
    for (const ir::Function* function : more) {
        probe.functions.push_back(*function);
        // No root, whose inputs would be kept whatever it reads.
        probe.functions.back().module.clear();
    }
    const ir::Module optimized = optimize::optimize(probe);
    std::vector<int> all;
    for (const ir::Function& function : optimized.functions)
        all.push_back(weight(evaluate::compile(optimized, function)));
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(module.functions.size());
    if (of_module) of_module->assign(all.begin(), middle);
    return {middle, all.end()};
}

/// Terms with parts that are dearer than a line.
std::vector<Subject> subjects(const ir::Module& checked)
{
    std::vector<Subject> result;
    std::vector<const ir::Function*> functions;
    for (const FunctionId id : checked.reachable(checked.roots())) {
        const ir::Function& function = checked[id];
        const bool can_be_said =
            function.type() == ir::Type::scalar || function.quantity == ir::Quantity::color;
        if (function.kind != ir::Function::Kind::term || !can_be_said) continue;
        Subject subject{id, 0, {}};
        for (Part& part : parts_of(checked, id)) {
            subject.parts.push_back(std::make_unique<PartFinds>(checked, std::move(part)));
            functions.push_back(&subject.parts.back()->search.part().function);
        }
        if (!subject.parts.empty()) result.push_back(std::move(subject));
    }
    std::vector<int> of_terms;
    const std::vector<int> of_parts = weights(checked, functions, &of_terms);
    std::size_t next = 0;
    for (Subject& subject : result) {
        subject.weight = of_terms[subject.term.index];
        for (auto& part : subject.parts) part->weight = of_parts[next++];
        std::erase_if(subject.parts, [](const auto& part) {
            return part->weight <= static_cast<int>(part->search.part().inputs.size());
        });
    }
    std::erase_if(result, [](const Subject& subject) { return subject.parts.empty(); });
    return result;
}

/// A form, and what it is judged by.
struct Offer {
    ir::Function function;
    int weight = 0;
    FoundForm found;
};

std::string documentation(double error)
{
    return fmt::format("Found by the compiler: nearest over the declared ranges. Off by up to "
                       "{:.2g}.",
                       error);
}

/// The term with all parts replaced for which a shape was found; nothing where there are none, or
/// where it errs too much.
std::optional<Offer> offer_of(const ir::Module& checked, const Subject& subject,
                              const std::string& shape)
{
    const ir::Function& term = checked[subject.term];
    std::vector<Replacement> replacements;
    std::vector<Replacement> ideals;
    std::vector<Held> held;
    const PartFinds::Find* whole = nullptr;
    for (const auto& part : subject.parts) {
        const PartFinds::Find* const find = part->find(shape);
        if (find == nullptr) continue;
        const Part& of = part->search.part();
        replacements.push_back(
            {of.root, of.inputs, of.function.range, find->shape.shape, find->ratio->ratio});
        ideals.push_back(replacements.back());
        ideals.back().ratio = find->ratio->ideal_ratio;
        held.push_back({of.inputs, find->ratio->places});
        if (of.root == term.result) whole = find;
    }
    if (replacements.empty()) return std::nullopt;

    Offer offer;
    ir::Function& form = offer.function = replaced(checked, term, replacements);
    form.name = term.name + "_" + shape;
    form.kind = ir::Function::Kind::form;
    form.form_of = subject.term;
    form.form_name = shape;
    form.declared_range.reset();
    form.citations.clear();
    const auto formula = formula_of(checked, form);
    if (!formula || checked.find(form.name)) return std::nullopt;
    form.formula = *formula;

    offer.found = {term.name, shape, 0, 0, *formula};
    if (whole) {
        offer.found.error = whole->ratio->error;
        offer.found.ideal = whole->ratio->ideal;
    } else {
        const auto error = departure(checked, term, form, held);
        const auto ideal = departure(checked, term, replaced(checked, term, ideals), held);
        if (!error || !ideal || !(error->error < hopeless * error->range)) return std::nullopt;
        offer.found.error = error->error;
        offer.found.ideal = ideal->error;
    }
    form.doc = documentation(offer.found.error);
    return offer;
}

/// Those of a term that weigh less than it does, each with an error smaller by a tenth and more
/// than that of any lighter one.
std::vector<Offer> worth_offering(std::vector<Offer> offers, int weight_of_term)
{
    std::erase_if(offers, [&](const Offer& offer) { return offer.weight >= weight_of_term; });
    std::ranges::stable_sort(offers, [](const Offer& a, const Offer& b) {
        return std::pair{a.weight, a.found.error} < std::pair{b.weight, b.found.error};
    });
    constexpr double worth_its_weight = 0.9;
    std::vector<Offer> result;
    for (Offer& offer : offers)
        if (result.empty() || offer.found.error < worth_its_weight * result.back().found.error)
            result.push_back(std::move(offer));
    return result;
}

/// Behind the forms that follow a term.
FunctionId place_of_forms(const ir::Module& module, FunctionId term)
{
    FunctionId result = term;
    while (result.index + 1 < module.functions.size() &&
           module.functions[result.index + 1].form_of == term)
        ++result.index;
    return result;
}

void search(std::vector<Subject>& subjects, const MinimaxOptions& options, const Store& store)
{
    struct Task {
        PartFinds* part;
        PartFinds::Find* find;
    };
    const std::array all_shapes{shapes(1, options.max_degree), shapes(2, options.max_degree)};
    std::size_t most = 0;
    for (Subject& subject : subjects)
        for (auto& part : subject.parts) {
            for (const NamedShape& shape : all_shapes[part->search.part().inputs.size() - 1])
                if (least_weight(shape.shape) < part->weight)
                    part->finds.push_back({shape, std::nullopt});
            most = std::max(most, part->finds.size());
        }
    // Shape by shape, so that tasks that run at once are of different parts.
    std::vector<Task> tasks;
    for (std::size_t i = 0; i < most; ++i)
        for (Subject& subject : subjects)
            for (auto& part : subject.parts)
                if (i < part->finds.size()) tasks.push_back({part.get(), &part->finds[i]});
    for_each_task(tasks.size(), options.jobs, [&](std::size_t i) {
        tasks[i].find->ratio = tasks[i].part->search.find(tasks[i].find->shape, store);
    });
}

/// Names of shapes of which something was found for a part of the term, in the order of shapes.
std::vector<std::string> found_shapes(const Subject& subject)
{
    std::vector<std::string> result;
    for (const auto& part : subject.parts)
        for (const PartFinds::Find& find : part->finds)
            if (find.ratio && std::ranges::find(result, find.shape.name) == result.end())
                result.push_back(find.shape.name);
    return result;
}

}  // namespace

WithFoundForms add_found_forms(const ir::Module& checked, const MinimaxOptions& options,
                               const Store& store)
{
    std::vector<Subject> terms = subjects(checked);
    search(terms, options, store);

    std::vector<std::pair<const Subject*, std::string>> tries;
    for (const Subject& subject : terms)
        for (std::string& shape : found_shapes(subject))
            tries.emplace_back(&subject, std::move(shape));
    std::vector<std::optional<Offer>> offers(tries.size());
    for_each_task(tries.size(), options.jobs, [&](std::size_t i) {
        offers[i] = offer_of(checked, *tries[i].first, tries[i].second);
    });

    std::vector<const ir::Function*> functions;
    for (const auto& offer : offers)
        if (offer) functions.push_back(&offer->function);
    const std::vector<int> weighed = weights(checked, functions);

    WithFoundForms result;
    std::vector<ir::Insertion> insertions;
    std::size_t next = 0;
    std::size_t i = 0;
    for (const Subject& subject : terms) {
        std::vector<Offer> mine;
        for (; i < tries.size() && tries[i].first == &subject; ++i) {
            if (!offers[i]) continue;
            mine.push_back(std::move(*offers[i]));
            mine.back().weight = weighed[next++];
        }
        const FunctionId after = place_of_forms(checked, subject.term);
        for (Offer& offer : worth_offering(std::move(mine), subject.weight)) {
            result.found.push_back(std::move(offer.found));
            insertions.push_back({after, std::move(offer.function)});
        }
    }
    result.module = ir::insert_functions(checked, insertions);
    return result;
}

}  // namespace lobe::analyze
