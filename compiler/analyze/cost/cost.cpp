// Asks drivers and devices what chains cost; see cost_shaders.h for what is asked.
#include "analyze/cost/cost.h"

#include "analyze/cost/shaders.h"
#include "analyze/cost/spirv_count.h"
#include "analyze/cost/time.h"
#include "analyze/tasks.h"
#include "verify/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <mutex>
#include <thread>

namespace lobe::analyze {
namespace {

using device::ChipCompiler;
using device::ShaderStatistics;

/// As the driver calls them; a chip that was renamed has two spellings.
std::vector<std::string> chips(Family family)
{
    switch (family) {
    case Family::gcn4: return {"polaris10"};
    case Family::gcn5: return {"vega10"};
    case Family::rdna1: return {"navi10"};
    case Family::rdna2: return {"navi21"};
    case Family::rdna3: return {"gfx1100", "navi31"};
    }
    return {};
}

// ---- what is kept

std::string_view bytes_of(const Words& words)
{
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)};
}

std::string to_text(const ChainStatistics& statistics)
{
    std::string text;
    for (const ShaderStatistics& each : {statistics.once, statistics.shorter, statistics.longer})
        text += fmt::format("{} {} {} {} {} {} {} {} {}\n", each.vector, each.transcendental,
                            each.instructions, each.latency, each.inverse_throughput, each.vgprs,
                            each.waves, each.spilled, each.code_bytes);
    return text;
}

std::optional<ChainStatistics> to_statistics(std::string_view text)
{
    const auto number = [&text](int& value) {
        while (!text.empty() && (text.front() == ' ' || text.front() == '\n'))
            text.remove_prefix(1);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        return error == std::errc{};
    };
    ChainStatistics statistics;
    for (ShaderStatistics* each : {&statistics.once, &statistics.shorter, &statistics.longer})
        for (int* value : {&each->vector, &each->transcendental, &each->instructions,
                           &each->latency, &each->inverse_throughput, &each->vgprs, &each->waves,
                           &each->spilled, &each->code_bytes})
            if (!number(*value)) return std::nullopt;
    return statistics;
}

// ---- the measurement

/// Jobs that are worth starting another process of a driver for.
constexpr std::size_t least_of_a_lane = 8;

/// One thing to put into chains, and what the driver of each family that is asked says of it.
struct Job {
    Chain chain;
    std::vector<std::optional<ChainStatistics>> statistics;
};

class Measurement {
public:
    Measurement(std::span<const CostSubject> subjects, const Sources& sources,
                const CostOptions& options, const Store& store)
        : subjects_{subjects}, sources_{sources}, options_{options}, store_{store}
    {
    }

    Costs run()
    {
        out_.costs.resize(subjects_.size());
        jobs_.resize(subjects_.size());
        total_ = subjects_.size();
        for_each_task(subjects_.size(), options_.jobs, [&](std::size_t i) {
            jobs_[i].chain = make_chain(subjects_[i], sources_);
            out_.costs[i].spirv_instructions = arithmetic_of(jobs_[i].chain);
            step("shaders");
        });
        if (options_.statistics) measure_statistics();
        if (options_.nanoseconds) measure_time();
        return std::move(out_);
    }

private:
    int arithmetic_of(const Chain& chain) const
    {
        const std::string count =
            kept(store_, fmt::format("arithmetic 1\n{}", bytes_of(chain.once)), [&] {
                const verify::Verdict optimized = verify::optimize(chain.once);
                return std::to_string(
                    count_arithmetic(optimized.accepted ? optimized.spirv : chain.once));
            });
        int value = 0;
        std::from_chars(count.data(), count.data() + count.size(), value);
        return chain.format == emit::NumberFormat::packed16 ? value / 2 : value;
    }

    void measure_statistics()
    {
        add_links();
        done_ = 0;
        const std::size_t families = options_.families.size();
        for (Job& job : jobs_) job.statistics.resize(families);
        total_ = jobs_.size() * families;
        // The compilers work in processes of their own, the threads here only wait for them.
        const std::size_t threads =
            options_.jobs == 0 ? std::max(families, cores()) : options_.jobs;
        const std::size_t most_lanes = threads / std::max<std::size_t>(1, families);
        const std::size_t lanes = std::clamp<std::size_t>(jobs_.size() / least_of_a_lane, 1,
                                                          std::max<std::size_t>(1, most_lanes));
        std::vector<std::string> failures(families * lanes);
        std::vector<std::string> drivers(families * lanes);
        for_each_task(families * lanes, static_cast<unsigned>(threads), [&](std::size_t task) {
            failures[task] = measure_family(task / lanes, task % lanes, lanes, drivers[task]);
        });
        const auto failed =
            std::ranges::find_if(failures, [](const std::string& why) { return !why.empty(); });
        if (failed != failures.end()) out_.no_statistics = *failed;
        if (!drivers.empty()) out_.driver = drivers.front();
        for (std::size_t i = 0; i < subjects_.size(); ++i) conclude(i);
    }

    /// The jobs that measure links, after those of the subjects.
    void add_links()
    {
        const auto add = [&](const Kind& kind, const emit::Evaluation& evaluation) {
            const auto [known, is_new] = links_.try_emplace(kind, jobs_.size());
            if (!is_new) return;
            Chain& chain = jobs_.emplace_back().chain;
            chain.format = kind.format;
            chain.copies = 32;
            chain.once = chain_words(evaluation, kind.format, 1);
            chain.evaluation = evaluation;
        };
        for (std::size_t i = 0; i < subjects_.size(); ++i) {
            const emit::NumberFormat format = jobs_[i].chain.format;
            for (const int numbers : {1, results_of(jobs_[i].chain)})
                for (const int exponent : {2, 3})
                    add({format, numbers, exponent}, emit::powers(numbers, exponent, format));
            add({format, 2, 1}, emit::product(format));
        }
    }

    static int results_of(const Chain& chain)
    {
        return static_cast<int>(chain.evaluation.results.size());
    }

    static std::size_t cores() { return std::max(1U, std::thread::hardware_concurrency()); }

    /// Of every `lanes` jobs the one at `lane`, by a compiler of their own. Why it failed; empty on
    /// success.
    std::string measure_family(std::size_t which, std::size_t lane, std::size_t lanes,
                               std::string& driver)
    {
        const Family family = options_.families[which];
        std::string why;
        auto compiler = ChipCompiler::open(chips(family), why);
        if (!compiler) return why;
        driver = compiler->driver();
        for (std::size_t i = lane; i < jobs_.size(); i += lanes) {
            jobs_[i].statistics[which] = statistics_of(jobs_[i].chain, *compiler, why);
            step(title(family));
        }
        return why;
    }

    std::optional<ChainStatistics> statistics_of(const Chain& chain, ChipCompiler& compiler,
                                                 std::string& why) const
    {
        const std::string key =
            fmt::format("statistics 1\n{}\n{}\n{} copies\n{}", compiler.driver(), compiler.chip(),
                        chain.copies, bytes_of(chain.once));
        if (store_.load)
            if (const auto text = store_.load(key))
                if (auto known = to_statistics(*text)) return known;
        ChainStatistics statistics;
        const auto ask = [&](int copies, ShaderStatistics& out) {
            const auto answer = compiler.compile(
                copies == 1 ? chain.once : chain_words(chain.evaluation, chain.format, copies),
                why);
            if (answer) out = *answer;
            return answer.has_value();
        };
        if (!ask(1, statistics.once) || !ask(chain.copies, statistics.shorter) ||
            !ask(2 * chain.copies, statistics.longer))
            return std::nullopt;
        if (store_.save) store_.save(key, to_text(statistics));
        return statistics;
    }

    /// The cost of a subject on the families that are asked for, if all have answered.
    void conclude(std::size_t subject)
    {
        const Chain& chain = jobs_[subject].chain;
        std::map<Family, FamilyCost> costs;
        for (std::size_t which = 0; which < options_.families.size(); ++which) {
            const auto& statistics = jobs_[subject].statistics[which];
            const auto link = [&](int numbers, int exponent) -> std::optional<Slope> {
                const Job& job = jobs_[links_.at({chain.format, numbers, exponent})];
                if (!job.statistics[which]) return std::nullopt;
                return slope(*job.statistics[which], job.chain.copies);
            };
            const auto squares = link(results_of(chain), 2);
            const auto cubes = link(results_of(chain), 3);
            const auto square = link(1, 2);
            const auto product = link(2, 1);
            if (!statistics || !squares || !cubes || !square || !product) return;
            const Family family = options_.families[which];
            costs[family] =
                family_cost(family, chain, *statistics, {*squares, *cubes, *square, *product});
        }
        out_.costs[subject].families = std::move(costs);
    }

    /// One after the other, so that none disturbs another.
    void measure_time()
    {
        done_ = 0;
        total_ = subjects_.size();
        std::optional<DeviceClock> clock;
        if (auto opened = device::Device::open(options_.device, out_.no_device)) {
            out_.device = fmt::format("{}, {}", opened->facts().name, opened->facts().driver);
            clock.emplace(std::move(*opened));
        }
        for (std::size_t i = 0; i < subjects_.size(); ++i) {
            Cost& cost = out_.costs[i];
            if (clock) cost.device_nanoseconds = clock->nanoseconds(jobs_[i].chain);
            cost.tape_nanoseconds = tape_nanoseconds(subjects_[i]);
            step("time");
        }
    }

    void step(std::string_view what)
    {
        if (!options_.progress) return;
        const std::lock_guard lock{mutex_};
        options_.progress({++done_, total_, what});
    }

    /// What measures links: so many numbers to this power, or the product of two.
    struct Kind {
        emit::NumberFormat format{};
        int numbers = 0;
        int exponent = 0;  ///< 1: the product
        friend auto operator<=>(const Kind&, const Kind&) = default;
    };

    std::span<const CostSubject> subjects_;
    const Sources& sources_;
    const CostOptions& options_;
    const Store& store_;
    Costs out_;
    std::vector<Job> jobs_;
    std::map<Kind, std::size_t> links_;
    std::mutex mutex_;
    std::size_t done_ = 0;
    std::size_t total_ = 0;
};

}  // namespace

Costs measure_costs(std::span<const CostSubject> subjects, const Sources& sources,
                    const CostOptions& options, const Store& store)
{
    return Measurement{subjects, sources, options, store}.run();
}

double issue_on(const Cost& cost, Family family)
{
    const auto found = cost.families.find(family);
    return found == cost.families.end() ? 0 : found->second.issue;
}

}  // namespace lobe::analyze
