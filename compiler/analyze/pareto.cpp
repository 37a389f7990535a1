#include "analyze/pareto.h"

#include "analyze/minimax/minimax.h"
#include "analyze/packing/radiance.h"
#include "analyze/trade/text.h"
#include "analyze/trade/trade.h"
#include "optimize/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

namespace lobe::analyze {

std::string describe(const Candidate& candidate)
{
    std::string text;
    for (const auto& [term, form] : candidate.choice)
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", term, form);
    if (text.empty()) text = "definition";
    if (candidate.spelling != optimize::Spelling::stable)
        text += fmt::format("; {}", optimize::name(candidate.spelling));
    if (candidate.format != Format::float32) text += fmt::format("; {}", name(candidate.format));
    return text;
}

double Trade::error_of(const Candidate& candidate) const
{
    if (candidate.total.not_finite > 0) return std::numeric_limits<double>::infinity();
    return whole_model ? candidate.total.often : candidate.total.scaled;
}

namespace {

/// The best selectable candidate by `less`, of those that `fits` lets in.
template <class Fits, class Less>
std::optional<std::size_t> best_of(const Trade& trade, const Fits& fits, const Less& less)
{
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < trade.candidates.size(); ++i) {
        const Candidate& candidate = trade.candidates[i];
        if (!candidate.selectable || trade.cost_of(candidate).families.empty() || !fits(candidate))
            continue;
        if (!best || less(candidate, trade.candidates[*best])) best = i;
    }
    return best;
}

bool asks_for(const std::string& only, const std::string& name)
{
    return only.empty() || only == name;
}

/// Terms that the module's roots reach, but for the conditions of effects and terms that are shown
/// with another module.
std::vector<ir::FunctionId> terms_of(const ir::Module& module, const ParetoOptions& options)
{
    std::vector<ir::FunctionId> terms;
    for (const ir::FunctionId id : module.reachable(module.roots())) {
        const ir::Function& function = module[id];
        if (function.kind != ir::Function::Kind::term ||
            function.quantity == ir::Quantity::boolean || function.inputs.empty() ||
            std::ranges::count(options.elsewhere, function.module) > 0 ||
            !asks_for(options.only_term, function.name))
            continue;
        terms.push_back(id);
    }
    return terms;
}

/// Everything that a trade is made of, as text.
std::string key_of(const TradeSubject& subject, const FoundNames& found,
                   const ParetoOptions& options, const std::string& driver)
{
    std::string key = fmt::format("trade 2\n{}\n{}\n{} points{}\n{}\n", subject.name(),
                                  subject.is_model() ? "model" : "term", options.points,
                                  options.every_cost ? ", every cost" : "", driver);
    if (options.proofs) key += fmt::format("{} boxes\n", options.proof_boxes);
    for (const Family family : options.cost.families) key += fmt::format("{}\n", name(family));
    for (const auto& [term, form] : found) key += fmt::format("found {} {}\n", term, form);
    for (const ir::Parameter& parameter : subject.module().parameters)
        key += fmt::format("{} {} {}\n", parameter.name, parameter.range.low, parameter.range.high);
    for (const ir::Function& function : subject.module().functions) {
        key += fmt::format("{} {}\n", function.name, function.form_name);
        for (const ir::Input& input : function.inputs)
            key += fmt::format("{} {} {} {} {}\n", input.name, static_cast<int>(input.origin),
                               input.which, input.range.low, input.range.high);
        key += ir::dump(function.graph);
        key += fmt::format("%{}\n", function.result.index);
    }
    return key;
}

Trade kept_trade(const TradeSubject& subject, const FoundNames& found, const ParetoOptions& options,
                 const Measurer& measurer, const std::string& driver, const Store& store)
{
    const std::string key = key_of(subject, found, options, driver);
    if (store.load)
        if (const auto text = store.load(key))
            if (auto known = read_trade(*text)) {
                judge(*known);
                return std::move(*known);
            }
    Trade made = trade(subject, found, options, measurer, store);
    if (store.save) store.save(key, to_text(made));
    return made;
}

/// Two ways that a build could choose between.
bool has_alternative(const Trade& trade)
{
    return std::ranges::count(trade.candidates, true, &Candidate::selectable) > 1;
}

std::optional<Quantization> quantization(const ir::Module& checked, const ir::Model& model,
                                         const ParetoOptions& options)
{
    if (std::ranges::none_of(checked.packings, [&model](const ir::Packing& packing) {
            return packing.model.name == model.name;
        }))
        return std::nullopt;
    const ir::Module optimized = optimize::optimize(checked);
    for (const ir::Packing& packing : optimized.packings) {
        if (packing.model.name != model.name) continue;
        const PackingErrors errors =
            packing_errors(optimized, packing, {options.points, options.cost.jobs, true});
        Quantization out;
        out.worst = errors.whole.worst;
        out.often = errors.whole.often;
        out.typical = errors.whole.typical;
        out.absolute = std::abs(errors.whole.witness.packed - errors.whole.witness.exact);
        out.codes = errors.whole.codes;
        out.often_codes = errors.whole.often_codes;
        out.points = errors.points;
        for (const auto& [name, value] : errors.whole.witness.inputs)
            out.at += fmt::format("{}{} = {:.6g}", out.at.empty() ? "" : ", ", name, value);
        return out;
    }
    return std::nullopt;
}

/// With the budget of `lobec stability`, so that either keeps what the other asks for.
std::vector<Proof> output_proofs(const ir::Module& checked, const ir::Model& model,
                                 const ParetoOptions& options, const Store& store)
{
    const ir::Module optimized = optimize::optimize(checked);
    std::vector<ir::FunctionId> outputs;
    for (const ir::ModelOutput& output : model.outputs)
        if (const auto id = optimized.find(checked[output.function].name)) outputs.push_back(*id);
    ProofOptions proof;
    proof.precisions = {evaluate::Precision::float32};
    proof.jobs = options.cost.jobs;
    proof.progress = options.progress;
    return proofs_of(optimized, outputs, proof, store);
}

}  // namespace

std::optional<std::size_t> cheapest_within(const Trade& trade, Family family, double max_error)
{
    return best_of(
        trade, [&](const Candidate& one) { return trade.error_of(one) <= max_error; },
        [&](const Candidate& one, const Candidate& other) {
            const double its = issue_on(trade.cost_of(one), family);
            const double others = issue_on(trade.cost_of(other), family);
            return its < others || (its == others && trade.error_of(one) < trade.error_of(other));
        });
}

std::optional<std::size_t> most_accurate_within(const Trade& trade, Family family, double cycles)
{
    return best_of(
        trade,
        [&](const Candidate& one) {
            return issue_on(trade.cost_of(one), family) <= cycles &&
                   trade.error_of(one) < std::numeric_limits<double>::infinity();
        },
        [&](const Candidate& one, const Candidate& other) {
            const double its = trade.error_of(one);
            const double others = trade.error_of(other);
            return its < others || (its == others && issue_on(trade.cost_of(one), family) <
                                                         issue_on(trade.cost_of(other), family));
        });
}

Pareto pareto(const ir::Module& original, const Sources& sources, const ParetoOptions& options,
              const Store& store)
{
    const auto start = std::chrono::steady_clock::now();
    Pareto out;
    out.module = original.name;
    MinimaxOptions minimax;
    minimax.jobs = options.cost.jobs;
    WithFoundForms with_found = add_found_forms(original, minimax, store);
    out.checked = std::move(with_found.module);
    const ir::Module& checked = out.checked;
    for (const FoundForm& form : with_found.found) out.found.emplace(form.term, form.form);
    const FoundNames& found = out.found;
    const Measurer measurer = [&](std::span<const CostSubject> subjects) {
        Costs costs = measure_costs(subjects, sources, options.cost, store);
        out.about.no_statistics = costs.no_statistics;
        out.about.driver = costs.driver;
        out.about.device = costs.device;
        return costs;
    };
    // A driver of another version is another driver.
    const std::string driver = measurer({}).driver;
    if (options.terms)
        for (const ir::FunctionId term : terms_of(checked, options)) {
            Trade of_term = kept_trade(TradeSubject::of_term(checked, term), found, options,
                                       measurer, driver, store);
            if (has_alternative(of_term)) out.trades.push_back(std::move(of_term));
        }
    if (options.models)
        for (const ir::Model& model : checked.models) {
            if (!asks_for(options.only_model, model.name)) continue;
            Trade of_model = kept_trade(TradeSubject::of_model(checked, model), found, options,
                                        measurer, driver, store);
            of_model.quantization = quantization(checked, model, options);
            if (options.proofs) of_model.proofs = output_proofs(checked, model, options, store);
            out.trades.push_back(std::move(of_model));
        }
    const auto spent = std::chrono::steady_clock::now() - start;
    out.seconds = std::chrono::duration<double>(spent).count();
    return out;
}

}  // namespace lobe::analyze
