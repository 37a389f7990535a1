// Which effects an epsilon lets go, and the proof.
//
// The bound: contributions over boxes (contribution.h), the scene's box divided where the bound is
// worst. Fields of the geometry count as independent, which only makes the box larger: 1 - cos_d
// beside cos_d in a stable form is then another quantity, and in the written one a power of cos_d
// has no end near 1. Both are tried. At a point the error is the lesser of two: what the ratio of
// radiance with and without says, whatever the radiance is, and the difference over the radiance of
// a grey card.
#include "analyze/packing/radiance_search.h"
#include "analyze/residual/certificate.h"
#include "analyze/residual/contribution.h"
#include "analyze/tasks.h"
#include "evaluate/intervals.h"
#include "optimize/optimize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

namespace lobe::analyze {
namespace {

using evaluate::Interval;

/// How many boxes to look at before a bound is as good as it gets, and the search for what it is a
/// bound of. A bound this close to what was found needs no more.
constexpr std::size_t most_boxes = 8192;
constexpr double close_enough = 1.05;
constexpr Effort effort{8192, 8, 24};

/// An effect that is on, as an experiment: everything that the scene says is in the module, but for
/// the parameters that switch this effect, which are inputs.
struct Experiment {
    ir::Module module;                                 ///< as written
    ir::Module stable;                                 ///< through optimize
    std::set<std::string> switches;                    ///< the parameters
    std::map<std::string, std::vector<double>> off;    ///< their values without the effect
    std::map<std::string, std::vector<ir::Range>> on;  ///< and with it
};

/// What the scene says of a parameter, by component.
std::vector<ir::Range> said(const ir::Parameter& parameter, const optimize::Called& called)
{
    const auto size = parameter.default_value.size();
    if (const auto constant = called.constants.find(parameter.name);
        constant != called.constants.end() && constant->second.size() == size) {
        std::vector<ir::Range> result;
        for (const double value : constant->second) result.push_back({value, value});
        return result;
    }
    ir::Range range = parameter.range;
    if (const auto found = called.ranges.find(parameter.name); found != called.ranges.end())
        range = {std::max(range.low, found->second.low), std::min(range.high, found->second.high)};
    return std::vector<ir::Range>(size, range.low <= range.high ? range : parameter.range);
}

/// Nothing where the effect cannot be switched off by itself.
std::optional<Experiment> experiment(const ir::Module& general, const std::string& model,
                                     const optimize::Called& called, const ir::Effect& effect)
{
    ir::Module module = general;
    module.packings.clear();
    module.engines.clear();
    module.lights.clear();
    module.shadings.clear();

    optimize::Called without = called;
    without.off.insert(effect.name);
    const optimize::Residual gone = optimize::residual(module, without, model);
    if (std::ranges::count(gone.off, effect.name) == 0) return std::nullopt;

    Experiment result;
    optimize::Called with = called;
    with.off.erase(effect.name);
    for (const ir::Input& input : general[effect.off_when].inputs) {
        const auto off = gone.settings.find(input.name);
        if (off == gone.settings.end()) return std::nullopt;
        const ir::Parameter& parameter = general.parameters[input.which];
        const std::vector<ir::Range> on = said(parameter, called);
        ir::Range both = on.front();
        for (std::size_t k = 0; k < on.size(); ++k)
            both = {std::min({both.low, on[k].low, off->second[k]}),
                    std::max({both.high, on[k].high, off->second[k]})};
        with.constants.erase(input.name);
        with.binary.erase(input.name);
        with.ranges[input.name] = both;
        result.switches.insert(input.name);
        result.off[input.name] = off->second;
        result.on[input.name] = on;
    }
    const optimize::Residual kept = optimize::residual(module, with, model);
    // Another effect that is off may have set them.
    for (const std::string& name : result.switches)
        if (kept.settings.contains(name)) return std::nullopt;
    result.module = kept.module;
    result.stable = optimize::optimize(kept.module);
    return result;
}

std::vector<ir::FunctionId> outputs_of(const ir::Module& module)
{
    std::vector<ir::FunctionId> outputs;
    for (const ir::ModelOutput& output : module.models.front().outputs)
        outputs.push_back(output.function);
    return outputs;
}

// ---- found

/// The worst of a search, as packings are measured: the switches "stored" as what is off.
double observed(const Experiment& experiment)
{
    RadianceBox box =
        whole_box(experiment.module, radiance_of(experiment.module, outputs_of(experiment.module)));
    std::vector<Steps> steps(box.width());
    StoredAs stored(box.width(), nullptr);
    for (std::size_t i = 0; i < box.width(); ++i) {
        const evaluate::TapeInput& scalar = box.tape.inputs[i];
        // `tint.r` is a component of `tint`.
        const std::string name = scalar.name.substr(0, scalar.name.find('.'));
        const auto off = experiment.off.find(name);
        if (off == experiment.off.end()) continue;
        const auto k = static_cast<std::size_t>(scalar.component);
        const ir::Range& on = experiment.on.at(name)[k];
        steps[i].values = {static_cast<float>(off->second[k])};
        stored[i] = &steps[i];
        box.coordinates[i].low = static_cast<float>(on.low);
        box.coordinates[i].high = static_cast<float>(on.high);
    }
    return std::max(search(box, stored, effort, {}).error, 0.0);
}

// ---- proved

/// One box and the most that the error can be in it.
struct Part {
    double bound = 0;
    std::vector<Contribution> box;
};

bool less_bad(const Part& a, const Part& b) { return a.bound < b.bound; }

/// The scene's box, divided.
class Divided {
public:
    Divided(const Experiment& experiment, const ir::Module& module)
    {
        const ir::Function radiance =
            radiance_of(module, outputs_of(module), Channels::all, GeometryAs::fields);
        tape_ = evaluate::compile(module, radiance);
        for (std::size_t k = 0; k < tape_.outputs.size(); ++k)
            channels_.push_back(rounding_tape(tape_, k, evaluate::Detail::operations));
        Part whole;
        for (std::size_t i = 0; i < tape_.inputs.size(); ++i)
            whole.box.push_back(side(experiment, radiance, i));
        // The cosine of the light is a side even where no output reads it.
        if (!cos_i_) {
            cos_i_ = whole.box.size();
            whole.box.push_back(untouched({least_cosine, 1}));
        }
        whole.bound = bound_of(whole.box);
        parts_.push_back(std::move(whole));
    }

    /// Divides until the bound is no more than that, or the budget is spent.
    double bound(double enough)
    {
        while (spent_ < most_boxes && parts_.front().bound > enough)
            if (!divide()) break;
        return parts_.front().bound;
    }

private:
    Contribution side(const Experiment& experiment, const ir::Function& radiance, std::size_t i)
    {
        const evaluate::TapeInput& scalar = tape_.inputs[i];
        const ir::Input& input = radiance.inputs[scalar.input];
        if (const auto off = experiment.off.find(input.name);
            input.origin == ir::Origin::parameter && off != experiment.off.end()) {
            const auto k = static_cast<std::size_t>(scalar.component);
            const ir::Range& on = experiment.on.at(input.name)[k];
            return changed(off->second[k], {on.low, on.high});
        }
        Interval range{input.range.low, input.range.high};
        if (input.origin == ir::Origin::geometry) {
            const auto field = static_cast<ir::GeometryField>(input.which);
            if (field == ir::GeometryField::cos_i) cos_i_ = i;
            if (field == ir::GeometryField::cos_i || field == ir::GeometryField::cos_o)
                range.low = least_cosine;
        }
        return untouched(range);
    }

    double bound_of(const std::vector<Contribution>& box)
    {
        ++spent_;
        double worst = 0;
        const double dark = grey_card * (1 - 0x1p-50) * box[*cos_i_].with.low;
        std::vector<Contribution> sides;
        for (const evaluate::RoundingTape& channel : channels_) {
            sides.clear();
            for (const std::uint32_t input : channel.inputs) sides.push_back(box[input]);
            worst = std::max(worst, error(contribution(channel, sides, values_), dark));
        }
        return worst;
    }

    /// |with - without| / max(|with|, dark)
    static double error(const Contribution& radiance, double dark)
    {
        const auto size = [](const Interval& x) {
            return std::max(std::abs(x.low), std::abs(x.high));
        };
        double result = std::numeric_limits<double>::infinity();
        const double least = std::max(
            dark, radiance.with.low > 0 ? radiance.with.low : -std::min(radiance.with.high, 0.0));
        if (least > 0) result = evaluate::divide({0, size(radiance.change)}, {least, least}).high;
        if (radiance.factor && radiance.factor->low > 0)
            result = std::min(result, size(evaluate::subtract(
                                          {1, 1}, evaluate::divide({1, 1}, *radiance.factor))));
        return result;
    }

    /// In the middle, and by halves of its logarithm toward 0 and 1, where what is small differs.
    static std::vector<double> cuts(const Interval& side)
    {
        std::vector<double> result;
        const auto add = [&](double at) {
            if (side.low < at && at < side.high) result.push_back(at);
        };
        add(side.low + (side.high - side.low) / 2);
        if (side.low >= 0 && side.high > 16 * side.low)
            add(std::sqrt(std::max(side.low, side.high * 0x1p-16) * side.high));
        if (side.high == 1 && side.low >= 0) add(1 - (1 - side.low) / 16);
        return result;
    }

    static std::pair<Contribution, Contribution> halves(const Contribution& side, double at)
    {
        const Interval low{side.with.low, at};
        const Interval high{at, side.with.high};
        if (side.change == Interval{0, 0}) return {untouched(low), untouched(high)};
        return {changed(side.without.low, low), changed(side.without.low, high)};
    }

    /// The worst box in two, where that helps most.
    bool divide()
    {
        const Part parent = parts_.front();
        std::optional<std::pair<Part, Part>> best;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < parent.box.size(); ++i)
            for (const double at : cuts(parent.box[i].with)) {
                std::pair<Part, Part> two{{0, parent.box}, {0, parent.box}};
                std::tie(two.first.box[i], two.second.box[i]) = halves(parent.box[i], at);
                two.first.bound = std::min(bound_of(two.first.box), parent.bound);
                two.second.bound = std::min(bound_of(two.second.box), parent.bound);
                // Of cuts that leave the worst as it was, the one that clears most.
                const double rank = std::max(two.first.bound, two.second.bound) +
                                    0x1p-10 * std::min(two.first.bound, two.second.bound);
                if (best && !(rank < least)) continue;
                least = rank;
                best = std::move(two);
            }
        if (!best) return false;
        std::ranges::pop_heap(parts_, less_bad);
        parts_.pop_back();
        for (Part* part : {&best->first, &best->second}) {
            parts_.push_back(std::move(*part));
            std::ranges::push_heap(parts_, less_bad);
        }
        return true;
    }

    evaluate::Tape tape_;
    std::vector<evaluate::RoundingTape> channels_;
    std::optional<std::size_t> cos_i_;
    std::vector<Part> parts_;  ///< a heap, worst first
    std::vector<Contribution> values_;
    std::size_t spent_ = 0;
};

/// What one effect does. The bound is infinite where more than epsilon was found, or it cannot be
/// switched off by itself.
Dropped measured(const ir::Module& general, const std::string& model,
                 const optimize::Called& called, const ir::Effect& effect, double epsilon)
{
    Dropped result{effect.name, std::numeric_limits<double>::infinity(), 0};
    const auto experiment = analyze::experiment(general, model, called, effect);
    if (!experiment) return result;
    result.observed = observed(*experiment);
    if (!(result.observed < epsilon)) return result;
    const double enough = close_enough * result.observed;
    result.bound = Divided{*experiment, experiment->module}.bound(enough);
    if (result.bound > enough)
        result.bound =
            std::min(result.bound, Divided{*experiment, experiment->stable}.bound(enough));
    return result;
}

/// What the effects that are on do, each by itself.
std::vector<Dropped> measured(const ir::Module& module, const std::string& model,
                              const optimize::Called& called, double epsilon, unsigned jobs)
{
    const std::vector<std::string> off = optimize::residual(module, called, model).off;
    std::vector<const ir::Effect*> on;
    for (const ir::Effect& effect : module.effects)
        if (std::ranges::count(off, effect.name) == 0) on.push_back(&effect);
    std::vector<Dropped> result(on.size());
    for_each_task(on.size(), jobs, [&](std::size_t i) {
        result[i] = measured(module, model, called, *on[i], epsilon);
    });
    return result;
}

}  // namespace

std::vector<Dropped> droppable(const ir::Module& module, const std::string& model,
                               const optimize::Called& called, double epsilon,
                               const CertificateOptions& options)
{
    std::vector<Dropped> result;
    if (!(epsilon > 0)) return result;

    // The least first, and then each without those before it. An error is relative to radiance with
    // the effect, which for the second one is off by the first: (1 + a) (1 + b) - 1 together.
    std::vector<Dropped> alone = measured(module, model, called, epsilon, options.jobs);
    std::ranges::stable_sort(alone, {}, &Dropped::bound);
    optimize::Called left = called;
    double together = 0;
    for (const Dropped& each : alone) {
        const double rest = (epsilon - together) / (1 + together);
        if (!(each.bound < epsilon)) continue;
        const auto effect = std::ranges::find(module.effects, each.effect, &ir::Effect::name);
        const Dropped next = result.empty() ? each : measured(module, model, left, *effect, rest);
        if (!(next.bound < rest)) continue;
        together += next.bound * (1 + together);
        result.push_back(next);
        left.off.insert(next.effect);
    }
    return result;
}

std::vector<Dropped> not_droppable(const ir::Module& module, const std::string& model,
                                   const optimize::Called& called,
                                   const CertificateOptions& options)
{
    if (!(options.epsilon > 0)) return {};
    return measured(module, model, called, options.epsilon, options.jobs);
}

}  // namespace lobe::analyze
