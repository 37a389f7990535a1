#include "analyze/cost/time.h"

#include "analyze/random.h"
#include "evaluate/run.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

namespace lobe::analyze {
namespace {

/// The least of so many is what the machine takes when nothing else disturbs it.
constexpr std::size_t repetitions = 48;
constexpr std::size_t turns = 6;

/// By how much the second chain is longer: what a dispatch takes besides is told apart from it.
constexpr int lengthened = 5;

/// Enough for every core of a software device, and so few that a dispatch is over within a
/// millisecond or so, between two disturbances.
constexpr std::uint32_t points_per_dispatch = 1U << 16;

/// Between 1/4 and 3/4, each different: nothing that hardware or a driver treats in a special way.
std::vector<float> plain_numbers(std::size_t count)
{
    std::vector<float> numbers(count);
    Random random{count};
    for (float& number : numbers) number = static_cast<float>(random.between(0.25, 0.75));
    return numbers;
}

bool is_long(const Chain& chain) { return chain.copies < 8; }

}  // namespace

std::optional<double> DeviceClock::slope(const emit::Evaluation& evaluation,
                                         emit::NumberFormat format, int copies, int chains)
{
    constexpr std::uint32_t points = points_per_dispatch;
    const std::vector<float> input =
        plain_numbers(static_cast<std::size_t>(evaluation.inputs) * points);
    // In turns: a machine that is slow for a while is so for both.
    std::array<double, 2> least{std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
    for (std::size_t turn = 0; turn < turns; ++turn)
        for (const std::size_t which : {0, 1}) {
            std::array<double, repetitions / turns> seconds{};
            const Words words =
                chain_words(evaluation, format, which == 0 ? copies : lengthened * copies, chains);
            if (device_.time(words, "main", input, points, points, seconds)) return std::nullopt;
            least[which] = std::min(least[which], *std::ranges::min_element(seconds));
        }
    const double more = static_cast<double>(points) * (lengthened - 1) * copies * chains;
    return (least[1] - least[0]) * 1e9 / more;
}

std::optional<double> DeviceClock::link(const Chain& chain)
{
    constexpr int copies = 16;
    constexpr int chains = 4;
    const auto timed = [&](const emit::Evaluation& evaluation) {
        return slope(evaluation, chain.format, copies, chains);
    };
    const int results = static_cast<int>(chain.evaluation.results.size());
    const auto known = links_.find({chain.format, results});
    if (known == links_.end()) {
        const auto squares = timed(emit::powers(results, 2, chain.format));
        const auto cubes = timed(emit::powers(results, 3, chain.format));
        if (!squares || !cubes) return std::nullopt;
        links_[{chain.format, results}] = 2 * *squares - *cubes;
    }
    if (!reads_.contains(chain.format)) {
        const auto square = timed(emit::powers(1, 2, chain.format));
        const auto product = timed(emit::product(chain.format));
        if (!square || !product) return std::nullopt;
        reads_[chain.format] = *product - *square;
    }
    return links_.at({chain.format, results}) +
           (chain.live_inputs - results) * reads_.at(chain.format);
}

std::optional<double> DeviceClock::nanoseconds(const Chain& chain)
{
    // Short evaluations need company, or a core waits for each one's end.
    const auto whole = slope(chain.evaluation, chain.format, chain.copies, is_long(chain) ? 1 : 4);
    const auto links = link(chain);
    if (!whole || !links) return std::nullopt;
    const int evaluations = chain.format == emit::NumberFormat::packed16 ? 2 : 1;
    return std::max(0.0, *whole - *links) / evaluations;
}

std::optional<double> tape_nanoseconds(const CostSubject& subject)
{
    if (subject.format == Format::packed16) return std::nullopt;
    using Clock = std::chrono::steady_clock;
    constexpr std::size_t points = 1024;
    constexpr double shortest = 1e-3;  // seconds that a measurement takes at least
    double sum = 0;
    for (const ir::FunctionId id : subject.functions) {
        const ir::Function function =
            subject.from_vectors ? ir::entry_point(*subject.module, id) : (*subject.module)[id];
        const evaluate::Tape tape = evaluate::compile(*subject.module, function);
        const std::vector<float> numbers = plain_numbers(tape.inputs.size() * points);
        std::vector<float> results(tape.outputs.size() * points);
        std::vector<const float*> inputs;
        for (std::size_t i = 0; i < tape.inputs.size(); ++i)
            inputs.push_back(numbers.data() + i * points);
        std::vector<float*> outputs;
        for (std::size_t i = 0; i < tape.outputs.size(); ++i)
            outputs.push_back(results.data() + i * points);
        const auto run = [&] {
            if (subject.format == Format::float16)
                evaluate::run_half(tape, evaluate::HalfMode::keep_denormals, inputs, outputs,
                                   points);
            else
                evaluate::run(tape, inputs, outputs, points);
        };
        const auto seconds_of = [&](std::size_t rounds) {
            const auto start = Clock::now();
            for (std::size_t i = 0; i < rounds; ++i) run();
            return std::chrono::duration<double>(Clock::now() - start).count();
        };
        std::size_t rounds = 1;
        while (seconds_of(rounds) < shortest) rounds *= 2;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < repetitions; ++i) least = std::min(least, seconds_of(rounds));
        sum += least * 1e9 / static_cast<double>(rounds * points);
    }
    return sum;
}

}  // namespace lobe::analyze
