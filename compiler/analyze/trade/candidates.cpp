#include "analyze/trade/candidates.h"

#include "analyze/packing/radiance_box.h"

#include <algorithm>

namespace lobe::analyze {
namespace {

/// Nothing calls it any more: it only keeps the place of its id.
ir::Function placeholder(const ir::Function& function)
{
    ir::Function empty;
    empty.name = function.name;
    empty.kind = ir::Function::Kind::storage;
    empty.module = function.module;
    empty.result = empty.graph.literal("0");
    return empty;
}

/// The functions that `roots` reach and no other, under their ids.
ir::Module reduced(const ir::Module& module, const std::vector<ir::FunctionId>& roots)
{
    ir::Module out = ir::without_functions(module);
    out.effects.clear();
    out.models.clear();
    out.lights.clear();
    out.shadings.clear();
    out.packings.clear();
    out.engines.clear();
    std::vector<bool> wanted(module.functions.size());
    for (const ir::FunctionId id : module.reachable(roots)) wanted[id.index] = true;
    for (std::size_t i = 0; i < module.functions.size(); ++i)
        out.functions.push_back(wanted[i] ? module.functions[i] : placeholder(module.functions[i]));
    return out;
}

}  // namespace

TradeSubject TradeSubject::of_term(const ir::Module& checked, ir::FunctionId term)
{
    TradeSubject out;
    out.name_ = checked[term].name;
    out.outputs_ = {term};
    for (optimize::Alternatives& found : optimize::alternatives(checked, {term}))
        if (found.term == term) out.alternatives_.push_back(std::move(found));
    std::vector<ir::FunctionId> roots{term};
    for (const optimize::Alternatives& of_term : out.alternatives_)
        roots.insert(roots.end(), of_term.forms.begin(), of_term.forms.end());
    out.module_ = reduced(checked, roots);
    // As in the library that declares it: there it is a root.
    out.module_.name = checked[term].module;
    return out;
}

TradeSubject TradeSubject::of_model(const ir::Module& checked, const ir::Model& model)
{
    TradeSubject out;
    out.name_ = model.name;
    out.is_model_ = true;
    for (const ir::ModelOutput& output : model.outputs) out.outputs_.push_back(output.function);
    out.alternatives_ = optimize::alternatives(checked, out.outputs_);
    std::vector<ir::FunctionId> needed = out.outputs_;
    for (const optimize::Alternatives& of_term : out.alternatives_)
        needed.insert(needed.end(), of_term.forms.begin(), of_term.forms.end());
    out.module_ = reduced(checked, needed);
    out.module_.models = {model};
    return out;
}

bool TradeSubject::has_geometry() const
{
    const auto takes_directions = [this](ir::FunctionId id) {
        return std::ranges::any_of(module_[id].inputs, [](const ir::Input& input) {
            return input.origin == ir::Origin::geometry;
        });
    };
    return std::ranges::any_of(outputs_, takes_directions);
}

double TradeSubject::combinations(std::size_t forms) const
{
    // counts[k]: with exactly k forms.
    std::vector<double> counts(alternatives_.size() + 1);
    counts[0] = 1;
    for (const optimize::Alternatives& of_term : alternatives_)
        for (std::size_t k = counts.size() - 1; k > 0; --k)
            counts[k] += counts[k - 1] * static_cast<double>(of_term.forms.size());
    double sum = 0;
    for (std::size_t k = 0; k <= std::min(forms, alternatives_.size()); ++k) sum += counts[k];
    return sum;
}

std::vector<optimize::Choice> TradeSubject::choices(std::size_t forms) const
{
    std::vector<optimize::Choice> all{{}};
    for (const optimize::Alternatives& of_term : alternatives_) {
        const std::size_t before = all.size();
        for (const ir::FunctionId form : of_term.forms)
            for (std::size_t i = 0; i < before; ++i) {
                if (all[i].size() == forms) continue;
                optimize::Choice choice = all[i];
                choice[module_[of_term.term].name] = module_[form].form_name;
                all.push_back(std::move(choice));
            }
    }
    std::ranges::stable_sort(all, {}, &optimize::Choice::size);
    return all;
}

Spelled TradeSubject::chosen(const optimize::Choice& choice) const
{
    if (is_model_) return {optimize::choose(module_, choice), outputs_};
    const auto form = choice.find(name_);
    if (form == choice.end()) return {module_, outputs_};
    for (const ir::FunctionId id : alternatives_.front().forms)
        if (module_[id].form_name == form->second) return {module_, {id}};
    return {module_, outputs_};
}

Spelled TradeSubject::spelled(const optimize::Choice& choice, optimize::Spelling spelling) const
{
    Spelled out = chosen(choice);
    out.module = optimize::spell(out.module, spelling);
    return out;
}

evaluate::Tape tape_of(const Spelled& spelled)
{
    return evaluate::compile(spelled.module, radiance_of(spelled.module, spelled.outputs));
}

}  // namespace lobe::analyze
