#include "analyze/give_ups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace lobe::analyze {
namespace {

/// Less of an improvement is not worth a line.
constexpr double worthwhile = 0.95;
constexpr std::size_t most_told = 8;

std::string percent(double error) { return fmt::format("{:.3g} %", error * 100); }

int bits_in(const std::vector<ir::Slot>& room)
{
    int bits = 0;
    for (const ir::Slot& slot : room) bits += slot.bits;
    return bits;
}

/// One thing to give up, with what is left.
struct Alternative {
    std::string what;
    Subject subject;
    std::vector<FittedCurve> curves;
    int bits = 0;
};

/// Channels of the engine's that may be taken if the pixel does without their contents.
void add_lent_channels(const ir::Module& module, const Subject& subject,
                       const std::vector<FittedCurve>& curves, const SuggestOptions& options,
                       std::deque<Alternative>& out)
{
    const ir::Gbuffer& gbuffer = *module.find_gbuffer(subject.packing.gbuffer);
    std::vector<std::string> names;
    for (const ir::Channel& channel : gbuffer.channels)
        for (const ir::Channel::Holder& holder : channel.holders)
            if (holder.lent && std::ranges::find(names, holder.name) == names.end() &&
                std::ranges::find(subject.packing.without, holder.name) ==
                    subject.packing.without.end())
                names.push_back(holder.name);
    const int plain = bits_in(room(gbuffer, subject.packing));
    std::vector<std::string> all;
    int all_bits = 0;
    const auto add = [&](const std::string& words, int bits) {
        out.push_back({fmt::format("`without {}`, {} bits more", words, bits), subject, curves,
                       bits_in(options.room) + bits});
    };
    for (const std::string& name : names) {
        ir::Packing packing = subject.packing;
        packing.without.push_back(name);
        const int bits = bits_in(room(gbuffer, packing)) - plain;
        if (bits == 0) continue;
        add(name, bits);
        all.push_back(name);
        all_bits += bits;
    }
    if (all.size() < 2) return;
    std::string words;
    for (const std::string& name : all) words += (words.empty() ? "" : ", ") + name;
    add(words, all_bits);
}

/// A number of three digits at most that is near: what a person would write.
double rounded(double value)
{
    if (value == 0) return 0;
    const double unit = std::pow(2, std::floor(std::log2(std::abs(value))) - 2);
    return std::round(value / unit) * unit;
}

/// The end half as far from the default; where the range covers orders of magnitude, half of them.
double nearer(double from, double end)
{
    const double ratio = from != 0 ? end / from : 0;
    return rounded(ratio > 16 ? from * std::sqrt(ratio) : from + (end - from) / 2);
}

void add_narrower_ranges(const ir::Module& module, const Subject& subject,
                         const std::vector<FittedCurve>& curves, const SuggestOptions& options,
                         int most_bits, std::deque<Alternative>& out)
{
    for (std::size_t i = 0; i < subject.placed.size(); ++i) {
        const Placed& placed = subject.placed[i];
        const ir::Parameter& parameter = module.parameters[placed.parameter];
        const auto [least, most] = std::ranges::minmax(parameter.default_value);
        for (const bool upper : {false, true}) {
            ir::Range range = placed.range;
            if (upper)
                range.high = nearer(most, range.high);
            else
                range.low = nearer(least, range.low);
            if (range == placed.range || !(range.low < range.high)) continue;
            const bool keeps = std::ranges::all_of(
                subject.packing.exact, [&](const ir::ExactRequirement& required) {
                    return required.parameter != placed.parameter ||
                           (range.low <= required.value && required.value <= range.high);
                });
            if (!keeps || least < range.low || most > range.high) continue;
            std::vector<Placed> all = subject.placed;
            all[i].range = range;
            Alternative narrower{fmt::format("`{} in [{}, {}]` instead of [{}, {}]", parameter.name,
                                             range.low, range.high, placed.range.low,
                                             placed.range.high),
                                 subject, curves, bits_in(options.room)};
            narrower.subject.placed[i].range = range;
            for (const std::size_t at : placed.coordinates) {
                Coordinate& coordinate = narrower.subject.box.coordinates[at];
                coordinate.low = std::max(coordinate.low, static_cast<float>(range.low));
                coordinate.high = std::min(coordinate.high, static_cast<float>(range.high));
            }
            narrower.curves[i] =
                fit_curves(narrower.subject, {i}, most_bits, options.radiance.jobs)[0];
            if (!narrower.curves[i].empty()) out.push_back(std::move(narrower));
        }
    }
}

void add_dropped_parameters(const ir::Module& module, const Subject& subject,
                            const std::vector<FittedCurve>& curves, const SuggestOptions& options,
                            std::deque<Alternative>& out)
{
    if (subject.placed.size() < 2) return;
    for (std::size_t i = 0; i < subject.placed.size(); ++i) {
        const ir::Parameter& parameter = module.parameters[subject.placed[i].parameter];
        Alternative without{fmt::format("`{}`, which stays at its default", parameter.name),
                            subject, curves, bits_in(options.room)};
        const auto at = static_cast<std::ptrdiff_t>(i);
        for (std::size_t k = 0; k < subject.placed[i].coordinates.size(); ++k) {
            const std::size_t index = subject.placed[i].coordinates[k];
            Coordinate& coordinate = without.subject.box.coordinates[index];
            coordinate.low = coordinate.high = static_cast<float>(parameter.default_value[k]);
            std::erase(without.subject.box.values, index);
        }
        without.subject.placed.erase(without.subject.placed.begin() + at);
        without.curves.erase(without.curves.begin() + at);
        out.push_back(std::move(without));
    }
}

}  // namespace

std::vector<std::string> give_ups(const ir::Module& module, const Subject& subject,
                                  const std::vector<FittedCurve>& curves,
                                  const SuggestOptions& options, int most_bits,
                                  std::optional<double> error)
{
    std::deque<Alternative> alternatives;
    add_lent_channels(module, subject, curves, options, alternatives);
    add_narrower_ranges(module, subject, curves, options, most_bits, alternatives);
    add_dropped_parameters(module, subject, curves, options, alternatives);

    std::vector<ShareQuestion> questions;
    for (const Alternative& one : alternatives)
        questions.push_back({&one.subject, &one.curves, one.bits});
    const auto answers = best_shares(questions, options.radiance.jobs);

    std::vector<std::pair<double, std::string>> ranked;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (!answers[i]) continue;
        const double reached = answers[i]->measured;
        if (error && reached > *error * worthwhile) continue;
        ranked.emplace_back(reached, fmt::format("{}: {}", alternatives[i].what, percent(reached)));
    }
    std::ranges::stable_sort(ranked, {}, &std::pair<double, std::string>::first);
    std::vector<std::string> out;
    for (auto& [reached, text] : ranked)
        if (out.size() < most_told) out.push_back(std::move(text));
    return out;
}

}  // namespace lobe::analyze
