#include "analyze/packing/sharing.h"

#include "analyze/packing/shares.h"
#include "analyze/tasks.h"

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

constexpr Effort whole_effort{4096, 24, 48};
constexpr Effort again_effort{0, 8, 64};
constexpr Effort quick_effort{0, 4, 32};
constexpr std::size_t most_promising = 6;
constexpr int most_moves = 6;
constexpr double worthwhile = 0.98;  ///< less of an improvement is within what searches differ by

/// Bits and prediction of a choice of options; not measured.
Shared summed(const CodeSearch& subject, const std::vector<FittedCurve>& curves,
              std::vector<std::size_t> options)
{
    Shared shared{std::move(options), 0, 0, -1, {}};
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const Fitted& fitted = curves[i][shared.options[i]];
        shared.bits += bits_of(subject, i, fitted);
        shared.predicted += fitted.point.error;
    }
    return shared;
}

}  // namespace

int bits_of(const CodeSearch& subject, std::size_t placed, const Fitted& fitted)
{
    return fitted.point.bits * subject.placed[placed].components;
}

std::optional<int> least_bits(const CodeSearch& subject, const std::vector<FittedCurve>& curves)
{
    int bits = 0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (curves[i].empty()) return std::nullopt;
        bits += bits_of(subject, i, curves[i].front());
    }
    return bits;
}

std::vector<Shared> shares_of(const CodeSearch& subject, const std::vector<FittedCurve>& curves,
                              int bits)
{
    const auto options = [&](auto cost) {
        std::vector<std::vector<ShareOption>> all(curves.size());
        for (std::size_t i = 0; i < curves.size(); ++i)
            for (const Fitted& fitted : curves[i])
                all[i].push_back({bits_of(subject, i, fitted), cost(fitted.point.error)});
        return all;
    };
    const auto sum = options([](double error) { return error; });
    const auto product = options([](double error) { return std::log1p(error); });

    std::vector<Shared> found;
    for (const auto& chosen : {share(sum, bits), share(product, bits), share_evenly(sum, bits)}) {
        if (!chosen) continue;
        const auto same = [&](const Shared& other) { return other.options == *chosen; };
        if (std::ranges::any_of(found, same)) continue;
        found.push_back(summed(subject, curves, *chosen));
    }
    return found;
}

namespace {

/// Measures with all of them stored, or once more with other points to start from.
void measure(const CodeSearch& subject, const std::vector<FittedCurve>& curves,
             const Effort& effort, std::vector<std::vector<float>> seeds, Shared& shared)
{
    StoredAs stored(subject.box.width(), nullptr);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const Fitted& fitted = curves[i][shared.options[i]];
        const std::vector<std::size_t>& coordinates = subject.placed[i].coordinates;
        for (std::size_t k = 0; k < coordinates.size(); ++k)
            stored[coordinates[k]] = &fitted.steps[k];
        if (effort.points > 0) seeds.push_back(fitted.peak.point);
    }
    Peak found = search(subject.box, stored, effort, seeds);
    if (found.error <= shared.measured) return;
    shared.measured = found.error;
    shared.worst = std::move(found.point);
}

/// Some of the points, evenly.
std::vector<std::vector<float>> some(const std::vector<std::vector<float>>& all)
{
    constexpr std::size_t most = 48;
    std::vector<std::vector<float>> chosen;
    const std::size_t count = std::min(all.size(), most);
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
    return chosen;
}

}  // namespace

std::vector<std::optional<Shared>> best_shares(const std::vector<ShareQuestion>& questions,
                                               unsigned jobs)
{
    struct Task {
        std::size_t question = 0;
        Shared shared;
    };
    std::vector<Task> tasks;
    for (std::size_t i = 0; i < questions.size(); ++i)
        for (Shared& shared :
             shares_of(*questions[i].subject, *questions[i].curves, questions[i].bits))
            tasks.push_back({i, std::move(shared)});
    for_each_task(tasks.size(), jobs, [&](std::size_t i) {
        const ShareQuestion& question = questions[tasks[i].question];
        measure(*question.subject, *question.curves, whole_effort, {}, tasks[i].shared);
    });
    std::vector<std::vector<float>> seeds;
    for (const Task& task : tasks) seeds.push_back(task.shared.worst);
    seeds = some(seeds);
    for_each_task(tasks.size(), jobs, [&](std::size_t i) {
        const ShareQuestion& question = questions[tasks[i].question];
        measure(*question.subject, *question.curves, again_effort, seeds, tasks[i].shared);
    });
    std::vector<std::optional<Shared>> best(questions.size());
    for (Task& task : tasks) {
        std::optional<Shared>& so_far = best[task.question];
        if (!so_far || task.shared.measured < so_far->measured) so_far = std::move(task.shared);
    }
    return best;
}

Shared improved(const CodeSearch& subject, const std::vector<FittedCurve>& curves, Shared shared,
                int bits, const std::vector<std::vector<float>>& known, unsigned jobs)
{
    std::vector<std::vector<float>> seeds = some(known);
    for (int move = 0; move < most_moves; ++move) {
        std::vector<Shared> tried;
        for (std::size_t more = 0; more < curves.size(); ++more)
            for (std::size_t less = 0; less < curves.size(); ++less) {
                // With itself: from what is left.
                const bool takes = more != less;
                if (shared.options[more] + 1 == curves[more].size()) continue;
                if (takes && shared.options[less] == 0) continue;
                std::vector<std::size_t> options = shared.options;
                ++options[more];
                if (takes) --options[less];
                Shared moved = summed(subject, curves, std::move(options));
                if (moved.bits <= bits) tried.push_back(std::move(moved));
            }
        for_each_task(tried.size(), jobs, [&](std::size_t i) {
            measure(subject, curves, quick_effort, seeds, tried[i]);
        });
        // The most promising are looked at again, at all that is known by now.
        std::ranges::stable_sort(tried, {}, &Shared::measured);
        if (tried.size() > most_promising) tried.resize(most_promising);
        for (const Shared& one : tried) seeds.push_back(one.worst);
        seeds.push_back(shared.worst);
        for_each_task(tried.size(), jobs, [&](std::size_t i) {
            measure(subject, curves, whole_effort, seeds, tried[i]);
        });
        const auto best = std::ranges::min_element(tried, {}, &Shared::measured);
        if (best == tried.end() || best->measured >= shared.measured * worthwhile) break;
        shared = *best;
    }
    return shared;
}

}  // namespace lobe::analyze
