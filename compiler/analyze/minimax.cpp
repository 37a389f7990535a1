#include "analyze/minimax.h"

#include "analyze/minimax_form.h"
#include "analyze/surface.h"
#include "analyze/tasks.h"
#include "evaluate/run.h"
#include "ir/insert.h"
#include "optimize/optimize.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

namespace lobe::analyze {
namespace {

using evaluate::Tape;
using evaluate::TapeOp;
using ir::FunctionId;

/// What an operation weighs: those that a GPU does at a quarter of the rate weigh 4.
int weight(TapeOp op)
{
    switch (op) {
    case TapeOp::divide:
    case TapeOp::square_root:
    case TapeOp::inverse_square_root:
    case TapeOp::exp2:
    case TapeOp::log2:
    case TapeOp::exp:
    case TapeOp::log:
    case TapeOp::sine:
    case TapeOp::cosine:
    case TapeOp::tangent:
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine:
    case TapeOp::arc_tangent:
    case TapeOp::normalized:
    case TapeOp::guarded_normalized:
    case TapeOp::smoothstep:
    case TapeOp::guarded_smoothstep: return 4;
    case TapeOp::power:
    case TapeOp::guarded_power: return 9;  // a logarithm, a product and an exponential function
    default: return 1;
    }
}

int weight(const Tape& tape)
{
    int result = 0;
    for (const evaluate::Instruction& step : tape.code) result += weight(step.op);
    return result;
}

/// A product and a sum per coefficient but one.
int weight(const Shape& shape)
{
    const auto count = [](std::size_t size) { return 2 * static_cast<int>(size); };
    const int top = count(shape.numerator.size()) - 2;
    return shape.denominator.empty()
               ? top
               : top + count(shape.denominator.size()) + weight(TapeOp::divide);
}

/// A term that forms are looked for.
struct Subject {
    FunctionId term;
    int weight = 0;
    std::unique_ptr<Surface> surface;
    std::once_flag sampled;
    Samples samples;  ///< once sampled

    const Samples& sample()
    {
        std::call_once(sampled, [this] { samples = surface->samples(); });
        return samples;
    }
};

bool is_side(const ir::Input& input)
{
    return input.type == ir::Type::scalar && input.quantity == ir::Quantity::number &&
           std::isfinite(input.range.low) && std::isfinite(input.range.high) &&
           input.range.low < input.range.high;
}

std::vector<std::unique_ptr<Subject>> subjects(const ir::Module& checked)
{
    const ir::Module optimized = optimize::optimize(checked);
    std::vector<std::unique_ptr<Subject>> result;
    for (const FunctionId id : checked.reachable(checked.roots())) {
        const ir::Function& function = checked[id];
        if (function.kind != ir::Function::Kind::term || function.type() != ir::Type::scalar ||
            function.quantity != ir::Quantity::number)
            continue;
        const std::size_t inputs = function.inputs.size();
        if (inputs < 1 || inputs > 2 || !std::ranges::all_of(function.inputs, is_side)) continue;
        auto subject = std::make_unique<Subject>();
        subject->term = id;
        subject->weight = weight(evaluate::compile(optimized, optimized[id]));
        const int linear = 2 * static_cast<int>(inputs);
        if (subject->weight <= linear) continue;
        subject->surface = std::make_unique<Surface>(evaluate::compile(checked, function),
                                                     evaluate::declared_ranges(function));
        result.push_back(std::move(subject));
    }
    return result;
}

/// What was found of a shape; kept in the store.
struct Found {
    Ratio ratio;
    double error = 0;
    double ideal = 0;
};

std::string to_json(const std::optional<Found>& found)
{
    if (!found) return "null";
    return nlohmann::json{{"numerator", found->ratio.numerator},
                          {"denominator", found->ratio.denominator},
                          {"error", found->error},
                          {"ideal", found->ideal}}
        .dump();
}

/// Nothing for `null`, and for what `to_json` did not write.
std::optional<Found> from_json(const std::string& text)
{
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    Found found;
    json.at("numerator").get_to(found.ratio.numerator);
    json.at("denominator").get_to(found.ratio.denominator);
    json.at("error").get_to(found.error);
    json.at("ideal").get_to(found.ideal);
    return found;
}

/// One search: a shape for a term.
class Search {
public:
    Search(const ir::Module& module, Subject& subject, const NamedShape& shape)
        : module_{module}, subject_{subject}, shape_{shape}
    {
    }

    std::string key() const
    {
        const ir::Function& term = module_[subject_.term];
        std::string result = fmt::format("minimax 1\n{} over", shape_.name);
        for (const ir::Input& input : term.inputs)
            result += fmt::format(" [{}, {}]", input.range.low, input.range.high);
        return fmt::format("{} within [{}, {}]\n{}", result, term.range.low, term.range.high,
                           evaluate::dump(subject_.surface->tape()));
    }

    std::optional<Found> run() const
    {
        const Samples& samples = subject_.sample();
        const auto [least, greatest] = std::ranges::minmax(samples.values);
        if (!std::ranges::all_of(samples.values, [](double v) { return std::isfinite(v); }))
            return std::nullopt;
        const double range = greatest - least;
        // A quarter of the range is what a constant in the middle misses by half of.
        const double hopeless = range / 4;
        if (range == 0) return std::nullopt;

        const Samples scaled = with_axes(samples);
        const auto fit = best_fit(shape_.shape, scaled);
        if (!fit || !(fit->level < hopeless)) return std::nullopt;
        const double ideal = greatest_differences(*subject_.surface, samples,
                                                  [&](std::span<const Place> places) {
                                                      return ratio_values(fit->ratio, places);
                                                  })
                                 .front()
                                 .size;
        Found found{round_to_float(shape_.shape, scaled, *fit).ratio, 0, ideal};

        const ir::Function form = minimax_form(module_, subject_.term, shape_, found.ratio);
        const Surface approximation{evaluate::compile(module_, form), subject_.surface->sides()};
        const auto worst =
            greatest_differences(*subject_.surface, samples, [&](std::span<const Place> places) {
                return approximation.values(places);
            });
        const double confirmed = confirm(approximation, worst);
        // Where double's own error shows, nothing that was measured with it is worth saying.
        const double doubt = 0.01 * worst.front().size + 1e-12 * range;
        if (!(std::fabs(confirmed - worst.front().size) <= doubt)) return std::nullopt;
        found.error = confirmed;
        if (!(found.error < hopeless)) return std::nullopt;
        return found;
    }

private:
    Place scaled(Place at) const
    {
        const auto& inputs = module_[subject_.term].inputs;
        const auto along = [&](std::size_t i, double value) {
            if (i >= inputs.size()) return 0.0;
            const Axis axis = axis_of(inputs[i].range);
            return (value - axis.center) / axis.scale;
        };
        return {along(0, at.x), along(1, at.y)};
    }

    Samples with_axes(const Samples& samples) const
    {
        Samples result = samples;
        for (Place& place : result.places) place = scaled(place);
        return result;
    }

    std::vector<double> ratio_values(const Ratio& ratio, std::span<const Place> places) const
    {
        std::vector<double> result;
        for (const Place place : places)
            result.push_back(value_at(shape_.shape, ratio, scaled(place)));
        return result;
    }

    /// The greatest of the differences again, by MPFR.
    double confirm(const Surface& approximation, const std::vector<Difference>& worst) const
    {
        constexpr std::size_t most = 4;
        std::vector<Place> places;
        for (const Difference& difference : worst)
            if (places.size() < most) places.push_back(difference.at);
        const auto exact = subject_.surface->confirmed(places);
        const auto approximate = approximation.confirmed(places);
        double result = 0;
        for (std::size_t i = 0; i < places.size(); ++i)
            result = std::fmax(result, std::fabs(exact[i] - approximate[i]));
        return result;
    }

    const ir::Module& module_;
    Subject& subject_;
    const NamedShape& shape_;
};

/// A form, and what it is judged by.
struct Offer {
    ir::Function function;
    int weight = 0;
    Found found;
};

/// Those of a term that no other one beats in both weight and error.
std::vector<Offer> worth_offering(std::vector<Offer> offers)
{
    std::vector<Offer> result;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        const auto beats = [&](const Offer& other, std::size_t j) {
            const bool as_good =
                other.weight <= offers[i].weight && other.found.error <= offers[i].found.error;
            const bool same =
                other.weight == offers[i].weight && other.found.error == offers[i].found.error;
            return j != i && as_good && (!same || j < i);
        };
        bool beaten = false;
        for (std::size_t j = 0; j < offers.size(); ++j) beaten = beaten || beats(offers[j], j);
        if (!beaten) result.push_back(offers[i]);
    }
    return result;
}

std::string documentation(const NamedShape& shape, const Found& found)
{
    const bool is_ratio = !shape.shape.denominator.empty();
    return fmt::format("{} of its shape over the declared ranges, found by the compiler. Off by "
                       "up to {:.2g}.",
                       is_ratio ? "The best ratio of polynomials" : "The best polynomial",
                       found.error);
}

}  // namespace

WithFoundForms add_found_forms(const ir::Module& checked, const MinimaxOptions& options,
                               const Store& store)
{
    const auto terms = subjects(checked);
    struct Task {
        Subject* subject;
        NamedShape shape;
        std::optional<Found> found;
    };
    // Shape by shape, so that tasks that run at once are of different terms.
    std::vector<Task> tasks;
    const std::array all_shapes{shapes(1, options.max_degree), shapes(2, options.max_degree)};
    for (std::size_t i = 0; i < std::max(all_shapes[0].size(), all_shapes[1].size()); ++i)
        for (const auto& subject : terms) {
            const auto& mine = all_shapes[checked[subject->term].inputs.size() - 1];
            if (i < mine.size() && weight(mine[i].shape) < subject->weight)
                tasks.push_back({subject.get(), mine[i], {}});
        }
    for_each_task(tasks.size(), options.jobs, [&](std::size_t i) {
        const Search search{checked, *tasks[i].subject, tasks[i].shape};
        tasks[i].found =
            from_json(kept(store, search.key(), [&] { return to_json(search.run()); }));
    });

    WithFoundForms result;
    std::vector<ir::Insertion> insertions;
    for (const auto& subject : terms) {
        std::vector<Offer> offers;
        for (const Task& task : tasks) {
            if (task.subject != subject.get() || !task.found) continue;
            Offer offer{minimax_form(checked, subject->term, task.shape, task.found->ratio), 0,
                        *task.found};
            offer.weight = weight(evaluate::compile(checked, offer.function));
            offer.function.doc = documentation(task.shape, *task.found);
            if (offer.weight < subject->weight && !checked.find(offer.function.name))
                offers.push_back(std::move(offer));
        }
        // Behind the forms that follow the term.
        FunctionId after = subject->term;
        while (after.index + 1 < checked.functions.size() &&
               checked.functions[after.index + 1].form_of == subject->term)
            ++after.index;
        for (Offer& offer : worth_offering(std::move(offers))) {
            result.found.push_back({checked[subject->term].name, offer.function.form_name,
                                    offer.found.error, offer.found.ideal, offer.function.formula});
            insertions.push_back({after, std::move(offer.function)});
        }
    }
    result.module = ir::insert_functions(checked, insertions);
    return result;
}

}  // namespace lobe::analyze
