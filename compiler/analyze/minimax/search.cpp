#include "analyze/minimax/search.h"

#include "evaluate/run.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lobe::analyze {

static void to_json(nlohmann::json& json, const Place& place) { json = {place.x, place.y}; }

static void from_json(const nlohmann::json& json, Place& place)
{
    place = {json.at(0).get<double>(), json.at(1).get<double>()};
}

static void to_json(nlohmann::json& json, const Ratio& ratio)
{
    json = {ratio.numerator, ratio.denominator};
}

static void from_json(const nlohmann::json& json, Ratio& ratio)
{
    json.at(0).get_to(ratio.numerator);
    json.at(1).get_to(ratio.denominator);
}

namespace {

std::string written(const std::optional<FoundRatio>& found)
{
    if (!found) return "null";
    return nlohmann::json{{"ratio", found->ratio},
                          {"error", found->error},
                          {"places", found->places},
                          {"ideal_ratio", found->ideal_ratio},
                          {"ideal", found->ideal}}
        .dump();
}

/// What `written` wrote.
std::optional<FoundRatio> read(const std::string& text)
{
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    FoundRatio found;
    json.at("ratio").get_to(found.ratio);
    json.at("error").get_to(found.error);
    json.at("places").get_to(found.places);
    json.at("ideal_ratio").get_to(found.ideal_ratio);
    json.at("ideal").get_to(found.ideal);
    return found;
}

}  // namespace

PartSearch::PartSearch(const ir::Module& module, Part part)
    : module_{module}, part_{std::move(part)}, surface_{evaluate::compile(module, part_.function),
                                                        evaluate::declared_ranges(part_.function)}
{
}

const Samples& PartSearch::samples()
{
    std::call_once(sampled_, [this] { samples_ = surface_.samples(); });
    return samples_;
}

std::string PartSearch::key(const NamedShape& shape) const
{
    const ir::Range range = part_.function.range;
    std::string over;
    for (const ir::Input& input : part_.function.inputs)
        over += fmt::format(" [{}, {}]", input.range.low, input.range.high);
    return fmt::format("minimax 1\n{} over{} within [{}, {}]\n{}", shape.name, over, range.low,
                       range.high, evaluate::dump(surface_.tape()));
}

std::optional<FoundRatio> PartSearch::find(const NamedShape& shape, const Store& store)
{
    return read(kept(store, key(shape), [&] { return written(search(shape.shape)); }));
}

Place PartSearch::scaled(Place at) const
{
    const auto& inputs = part_.function.inputs;
    const auto along = [&](std::size_t i, double value) {
        if (i >= inputs.size()) return 0.0;
        const Axis axis = axis_of(inputs[i].range);
        return (value - axis.center) / axis.scale;
    };
    return {along(0, at.x), along(1, at.y)};
}

/// The best fit, with places between the lattice's added to `seen` until it is nowhere worse by
/// more than a percent. Its level is then the greatest difference anywhere.
std::optional<Fit> PartSearch::fitted(const Shape& shape, Samples& seen, double limit)
{
    constexpr int most_rounds = 4;
    constexpr double nearly = 1.01;
    std::optional<Fit> fit;
    for (int round = 0; round < most_rounds; ++round) {
        fit = best_fit(shape, seen);
        if (!fit || !(fit->level < limit)) return std::nullopt;
        const auto ratio_values = [&](std::span<const Place> places) {
            std::vector<double> result;
            for (const Place place : places)
                result.push_back(value_at(shape, fit->ratio, scaled(place)));
            return result;
        };
        const auto worst = greatest_differences(surface_, samples(), ratio_values);
        const double level = std::exchange(fit->level, worst.front().size);
        if (worst.front().size <= level * nearly) break;
        for (const Difference& difference : worst) {
            if (difference.size <= level) break;
            seen.places.push_back(scaled(difference.at));
            seen.values.push_back(surface_.values({&difference.at, 1}).front());
        }
    }
    return fit;
}

std::optional<FoundRatio> PartSearch::search(const Shape& shape)
{
    const std::vector<double>& values = samples().values;
    if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
        return std::nullopt;
    const auto [least, greatest] = std::ranges::minmax(values);
    const double range = greatest - least;
    // What varies by less than a float's last digit is a constant.
    constexpr double float_step = 0x1p-24;
    if (range <= float_step * std::fmax(std::fabs(least), std::fabs(greatest))) return std::nullopt;

    Samples seen = samples();
    for (Place& place : seen.places) place = scaled(place);
    const auto fit = fitted(shape, seen, hopeless * range);
    if (!fit) return std::nullopt;
    FoundRatio found{round_to_float(shape, seen, *fit).ratio, 0, {}, fit->ratio, fit->level};

    // Measured on what it becomes, graph and all.
    std::vector<std::uint32_t> inputs;
    for (std::uint32_t i = 0; i < part_.function.inputs.size(); ++i) inputs.push_back(i);
    const ir::Function form =
        replaced(module_, part_.function,
                 {{part_.function.result, inputs, part_.function.range, shape, found.ratio}});
    const Surface approximation{evaluate::compile(module_, form), surface_.sides()};
    const auto worst =
        greatest_differences(surface_, samples(), [&](std::span<const Place> places) {
            return approximation.values(places);
        });
    found.error = confirmed(approximation, worst);
    // Where double's own error shows, what was measured with it is worth nothing.
    const double doubt = 0.01 * worst.front().size + 1e-12 * range;
    if (!(std::fabs(found.error - worst.front().size) <= doubt)) return std::nullopt;
    if (!(found.error < hopeless * range)) return std::nullopt;
    for (const Difference& difference : worst) found.places.push_back(difference.at);
    return found;
}

/// The greatest of the differences again, by MPFR.
double PartSearch::confirmed(const Surface& approximation,
                             const std::vector<Difference>& worst) const
{
    constexpr std::size_t most = 4;
    std::vector<Place> places;
    for (const Difference& difference : worst)
        if (places.size() < most) places.push_back(difference.at);
    const auto exact = surface_.confirmed(places);
    const auto approximate = approximation.confirmed(places);
    double result = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        result = std::fmax(result, std::fabs(exact[i] - approximate[i]));
    return result;
}

}  // namespace lobe::analyze
