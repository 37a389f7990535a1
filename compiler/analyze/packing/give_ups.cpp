#include "analyze/packing/give_ups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

namespace lobe::analyze {
namespace {

/// Less of an improvement is not worth a line.
constexpr double worthwhile = 0.95;
constexpr std::size_t most_told = 3;      ///< of each kind
constexpr std::size_t most_narrowed = 4;  ///< parameters

std::string percent(double error) { return fmt::format("{:.3g} %", error * 100); }

int bits_in(const std::vector<ir::Slot>& room)
{
    int bits = 0;
    for (const ir::Slot& slot : room) bits += slot.bits;
    return bits;
}

/// One thing to give up, with what is left.
struct Alternative {
    int kind = 0;
    std::string what;
    CodeSearch subject;
    std::vector<FittedCurve> curves;
    int bits = 0;
};

/// Channels of the engine's that may be taken if the pixel does without their contents.
void add_lent_channels(const ir::Module& module, const CodeSearch& subject,
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
        out.push_back({0, fmt::format("`without {}`, {} bits more", words, bits), subject, curves,
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

/// The placed parameters by their error alone, largest first; where nothing fits, by the bits that
/// they need.
std::vector<std::size_t> costly_first(const CodeSearch& subject,
                                      const std::vector<FittedCurve>& curves, const Best& best)
{
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        double cost = std::numeric_limits<double>::infinity();
        if (best.shared != nullptr)
            cost = curves[i][best.shared->options[i]].point.error;
        else if (!curves[i].empty())
            cost = bits_of(subject, i, curves[i].front());
        ranked.emplace_back(-cost, i);
    }
    std::ranges::sort(ranked);
    std::vector<std::size_t> order;
    for (const auto& [cost, i] : ranked) order.push_back(i);
    return order;
}

/// Half of the range at one end, if the default and what must be exact stay inside.
std::optional<ir::Range> halved(const ir::Module& module, const CodeSearch& subject,
                                const Placed& placed, bool upper)
{
    const auto& standard = module.parameters[placed.parameter].default_value;
    const auto [least, most] = std::ranges::minmax(standard);
    ir::Range range = placed.range;
    if (upper)
        range.high = nearer(most, range.high);
    else
        range.low = nearer(least, range.low);
    if (range == placed.range || !(range.low < range.high)) return std::nullopt;
    if (least < range.low || most > range.high) return std::nullopt;
    for (const ir::ExactRequirement& required : subject.packing.exact)
        if (required.parameter == placed.parameter &&
            (required.value < range.low || required.value > range.high))
            return std::nullopt;
    return range;
}

void add_narrower_ranges(const ir::Module& module, const CodeSearch& subject,
                         const std::vector<FittedCurve>& curves, const SuggestOptions& options,
                         const Best& best, std::deque<Alternative>& out)
{
    std::vector<std::size_t> order = costly_first(subject, curves, best);
    if (order.size() > most_narrowed) order.resize(most_narrowed);
    for (const std::size_t i : order) {
        const Placed& placed = subject.placed[i];
        for (const bool upper : {false, true}) {
            const auto range = halved(module, subject, placed, upper);
            if (!range) continue;
            Alternative narrower{1,
                                 fmt::format("`{} in [{}, {}]` instead of [{}, {}]",
                                             module.parameters[placed.parameter].name, range->low,
                                             range->high, placed.range.low, placed.range.high),
                                 subject, curves, bits_in(options.room)};
            narrower.subject.placed[i].range = *range;
            for (const std::size_t at : placed.coordinates) {
                Coordinate& coordinate = narrower.subject.box.coordinates[at];
                coordinate.low = std::max(coordinate.low, static_cast<float>(range->low));
                coordinate.high = std::min(coordinate.high, static_cast<float>(range->high));
            }
            // Around what it has now: one bit less, two more.
            BitRange bits{1, best.most_bits};
            if (best.shared != nullptr) {
                const int now = curves[i][best.shared->options[i]].point.bits;
                bits = {std::max(1, now - 1), std::min(now + 2, best.most_bits)};
            }
            narrower.curves[i] = fit_curves(narrower.subject, {i}, bits, options.radiance.jobs)[0];
            if (!narrower.curves[i].empty()) out.push_back(std::move(narrower));
        }
    }
}

void add_dropped_parameters(const ir::Module& module, const CodeSearch& subject,
                            const std::vector<FittedCurve>& curves, const SuggestOptions& options,
                            std::deque<Alternative>& out)
{
    if (subject.placed.size() < 2) return;
    for (std::size_t i = 0; i < subject.placed.size(); ++i) {
        const ir::Parameter& parameter = module.parameters[subject.placed[i].parameter];
        Alternative without{2, fmt::format("`{}`, which stays at its default", parameter.name),
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

std::vector<std::string> give_ups(const ir::Module& module, const CodeSearch& subject,
                                  const std::vector<FittedCurve>& curves,
                                  const SuggestOptions& options, const Best& best)
{
    std::deque<Alternative> alternatives;
    add_lent_channels(module, subject, curves, options, alternatives);
    add_narrower_ranges(module, subject, curves, options, best, alternatives);
    add_dropped_parameters(module, subject, curves, options, alternatives);

    std::vector<ShareQuestion> questions;
    for (const Alternative& one : alternatives)
        questions.push_back({&one.subject, &one.curves, one.bits});
    const auto answers = best_shares(questions, options.radiance.jobs);

    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (!answers[i]) continue;
        const double reached = answers[i]->measured;
        if (best.shared != nullptr && reached > best.shared->measured * worthwhile) continue;
        ranked.emplace_back(reached, i);
    }
    std::ranges::sort(ranked);
    std::vector<std::string> out;
    std::array<std::size_t, 3> told{};
    for (const auto& [reached, i] : ranked)
        if (told[static_cast<std::size_t>(alternatives[i].kind)]++ < most_told)
            out.push_back(fmt::format("{}: {}", alternatives[i].what, percent(reached)));
    return out;
}

}  // namespace lobe::analyze
