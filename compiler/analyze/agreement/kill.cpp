#include "analyze/agreement/kill.h"

#include "analyze/agreement/symmetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

namespace lobe::analyze {
namespace {

/// SPIR-V without what only people read: names, source text, lines.
std::vector<std::uint32_t> stripped(const std::vector<std::uint32_t>& spirv)
{
    // OpSourceContinued, OpSource, OpSourceExtension, OpName, OpMemberName, OpString, OpLine,
    // OpNoLine, OpModuleProcessed. [SPIRV] 3.49.2
    constexpr std::array<std::uint32_t, 9> for_people{2, 3, 4, 5, 6, 7, 8, 317, 330};
    constexpr std::size_t header = 5;
    std::vector<std::uint32_t> out;
    for (std::size_t at = header; at < spirv.size();) {
        const std::size_t size = std::max<std::size_t>(spirv[at] >> 16, 1);
        if (std::ranges::find(for_people, spirv[at] & 0xFFFF) == for_people.end())
            out.insert(out.end(), spirv.begin() + static_cast<std::ptrdiff_t>(at),
                       spirv.begin() +
                           static_cast<std::ptrdiff_t>(std::min(at + size, spirv.size())));
        at += size;
    }
    return out;
}

/// A function whose text is mutated, and the mutants that were chosen of it.
struct Parent {
    KillSubject subject;
    ir::FunctionId function;
    const emit::Target* target = nullptr;
    emit::Harness harness;
    std::vector<Mutant> mutants;
    std::vector<MutantFate> fates;
    bool usable = true;
};

/// The mutants of the function's own text, not of its callees, which have their own turn.
std::vector<Mutant> own_mutants(const emit::Harness& harness)
{
    std::vector<Mutant> all = mutants(harness);
    if (all.empty()) return all;
    const std::string own = all.back().function;  // callees come first
    std::erase_if(all, [&own](const Mutant& mutant) { return mutant.function != own; });
    return all;
}

/// Keeps `wanted` of all mutants: as many of each mutation as there are, up to an equal share,
/// spread evenly over the functions.
void choose(std::vector<Parent>& parents, std::size_t wanted)
{
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> places(all_mutations().size());
    for (std::size_t p = 0; p < parents.size(); ++p)
        for (std::size_t m = 0; m < parents[p].mutants.size(); ++m)
            places[static_cast<std::size_t>(parents[p].mutants[m].mutation)].emplace_back(p, m);

    std::vector<std::size_t> quotas(places.size());
    std::size_t given = 0;
    for (bool more = true; more && given < wanted;) {
        more = false;
        for (std::size_t c = 0; c < places.size() && given < wanted; ++c)
            if (quotas[c] < places[c].size()) {
                ++quotas[c];
                ++given;
                more = true;
            }
    }

    std::vector<std::vector<bool>> keep;
    for (const Parent& parent : parents) keep.emplace_back(parent.mutants.size());
    for (std::size_t c = 0; c < places.size(); ++c)
        for (std::size_t i = 0; i < quotas[c]; ++i) {
            const auto [p, m] = places[c][i * places[c].size() / quotas[c]];
            keep[p][m] = true;
        }
    for (std::size_t p = 0; p < parents.size(); ++p) {
        std::vector<Mutant> kept;
        for (std::size_t m = 0; m < keep[p].size(); ++m)
            if (keep[p][m]) kept.push_back(std::move(parents[p].mutants[m]));
        parents[p].mutants = std::move(kept);
    }
}

std::size_t count_changed(const std::vector<float>& a, const std::vector<float>& b,
                          std::size_t outputs)
{
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.size(); i += outputs)
        changed += std::memcmp(&a[i], &b[i], outputs * sizeof(float)) != 0;
    return changed;
}

/// Everything about one parent: its own run, then each mutant's.
class Trial {
public:
    Trial(Parent& parent, device::Device& device, std::size_t points)
        : parent_(parent), device_(device),
          reference_(reference(*parent.subject.module, parent.function,
                               evaluate::Precision::float32, points))
    {
    }

    /// False when the unchanged shader is no ground to judge from.
    bool run_parent()
    {
        spirv_ = spirv_of(parent_.harness.artifact.text, *parent_.target, parent_.harness.entry);
        if (spirv_.empty()) return false;
        if (execute(device_, reference_, parent_.harness, spirv_, results_)) return false;
        return count_outside(reference_, results_) == 0;
    }

    MutantFate run(Mutant mutant)
    {
        MutantFate out;
        out.term = (*parent_.subject.module)[parent_.function].name;
        out.target = parent_.target->name;
        const auto spirv = spirv_of(mutant.text, *parent_.target, parent_.harness.entry);
        std::string{}.swap(mutant.text);
        out.mutant = std::move(mutant);
        std::vector<float> results;
        if (spirv.empty()) {
            out.fate = Fate::rejected;
            return out;
        }
        if (const auto why = execute(device_, reference_, parent_.harness, spirv, results)) {
            out.fate = Fate::rejected;
            out.reason = *why;
            return out;
        }
        out.outside = count_outside(reference_, results);
        out.changed = count_changed(results, results_, reference_.outputs.size());
        if (out.outside > 0)
            out.fate = Fate::killed;
        else if (const std::string proof = proof_of_equivalence(out.mutant, spirv); !proof.empty())
            out = equivalent(std::move(out), proof);
        else if (out.changed == 0)
            out = survivor(std::move(out), Fate::unchanged, "no point reaches the difference");
        else
            out = survivor(
                std::move(out), Fate::tolerated,
                fmt::format("{} points differ, within what the contract allows", out.changed));
        return out;
    }

private:
    static MutantFate survivor(MutantFate fate, Fate which, std::string reason)
    {
        fate.fate = which;
        fate.reason = std::move(reason);
        return fate;
    }
    static MutantFate equivalent(MutantFate fate, const std::string& proof)
    {
        return survivor(std::move(fate), Fate::equivalent, proof);
    }

    std::string proof_of_equivalence(const Mutant& mutant, const std::vector<std::uint32_t>& spirv)
    {
        const ir::Function& function = (*parent_.subject.module)[parent_.function];
        if (mutant.swapped) {
            const auto a = static_cast<std::uint32_t>(mutant.swapped->first);
            const auto b = static_cast<std::uint32_t>(mutant.swapped->second);
            if (std::max(a, b) < function.inputs.size() &&
                is_symmetric(*parent_.subject.module, parent_.function, a, b))
                return fmt::format("symmetric in {} and {}", function.inputs[a].name,
                                   function.inputs[b].name);
        }
        if (stripped(verify::optimize(spirv).spirv) == stripped(verify::optimize(spirv_).spirv))
            return "the optimizer makes the same program of it";
        return {};
    }

    Parent& parent_;
    device::Device& device_;
    Reference reference_;
    std::vector<std::uint32_t> spirv_;
    std::vector<float> results_;
};

std::vector<Parent> parents_of(std::span<const KillSubject> subjects,
                               std::vector<const emit::Target*> targets)
{
    if (targets.empty()) targets = {emit::find_target("glsl450"), emit::find_target("hlsl")};
    std::vector<Parent> parents;
    for (const KillSubject& subject : subjects)
        for (const ir::FunctionId function : checked_functions(*subject.module)) {
            Parent parent;
            parent.subject = subject;
            parent.function = function;
            parent.target = targets[parents.size() % targets.size()];
            parent.harness = emit::harness(*subject.module, *subject.sources, function,
                                           *parent.target, emit::Precision::float32);
            parent.mutants = own_mutants(parent.harness);
            parents.push_back(std::move(parent));
        }
    return parents;
}

}  // namespace

std::string_view name(Fate fate)
{
    // ORDER Fate
    constexpr std::array<std::string_view, 5> names{"killed", "rejected", "equivalent", "unchanged",
                                                    "tolerated"};
    return names[static_cast<std::size_t>(fate)];
}

std::size_t KillReport::count(Fate fate) const
{
    return static_cast<std::size_t>(std::ranges::count(mutants, fate, &MutantFate::fate));
}

double KillReport::kill_rate() const
{
    const std::size_t killed = count(Fate::killed);
    const std::size_t killable = killed + count(Fate::unchanged) + count(Fate::tolerated);
    return killable == 0 ? 1 : static_cast<double>(killed) / static_cast<double>(killable);
}

KillReport kill(std::span<const KillSubject> subjects, const KillOptions& options)
{
    const auto start = std::chrono::steady_clock::now();
    KillReport out;
    auto device = device::Device::open(options.device, out.no_device);
    if (!device) return out;
    out.device = fmt::format("{}; driver {}", device->facts().name, device->facts().driver);

    std::vector<Parent> parents = parents_of(subjects, options.targets);
    for (const Parent& parent : parents) out.available += parent.mutants.size();
    choose(parents, options.mutants == 0 ? out.available : options.mutants);
    std::size_t total = 0;
    for (const Parent& parent : parents) total += parent.mutants.size();

    std::atomic<std::size_t> next{0};
    std::size_t done = 0;
    std::mutex mutex;
    const auto work = [&] {
        for (std::size_t i = next++; i < parents.size(); i = next++) {
            Parent& parent = parents[i];
            if (parent.mutants.empty()) continue;
            Trial trial{parent, *device, options.points};
            parent.usable = trial.run_parent();
            for (Mutant& mutant : parent.mutants) {
                if (parent.usable) parent.fates.push_back(trial.run(std::move(mutant)));
                const std::lock_guard lock{mutex};
                if (options.progress)
                    options.progress(
                        {++done, total, (*parent.subject.module)[parent.function].name});
            }
        }
    };
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    const unsigned workers = options.jobs > 0 ? options.jobs : cores;
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < workers; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();

    for (Parent& parent : parents) {
        if (!parent.usable) out.unusable.push_back((*parent.subject.module)[parent.function].name);
        std::ranges::move(parent.fates, std::back_inserter(out.mutants));
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace lobe::analyze
