#include "analyze/cost/shaders.h"

#include "analyze/cost/packed_half.h"
#include "evaluate/tape.h"
#include "verify/judge.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <tuple>

namespace lobe::analyze {
namespace {

using evaluate::Slot;
using evaluate::Tape;

emit::NumberFormat number_format(Format format)
{
    switch (format) {
    case Format::float32: return emit::NumberFormat::float32;
    case Format::float16: return emit::NumberFormat::float16;
    case Format::packed16: return emit::NumberFormat::packed16;
    }
    return {};
}

/// A chain is long enough that its arithmetic, and not the way of its inputs from memory, is what
/// the driver's estimates are about; more of it takes only time.
int copies_for(std::size_t instructions)
{
    if (instructions > 60) return 2;
    return instructions > 15 ? 8 : 16;
}

bool is_gcn(Family family) { return family == Family::gcn4 || family == Family::gcn5; }

double issue_cycles(Family family, double valu, double transcendental)
{
    // A SIMD of 16 lanes issues a wave of 64 in 4 cycles, transcendental ones at a quarter of that
    // rate. One of 32 lanes issues a wave of 32 per cycle; a transcendental one occupies a unit of
    // 8 lanes for 4 cycles, beside which others issue.
    if (is_gcn(family)) return 4 * valu + 16 * transcendental;
    return std::max(valu + transcendental, 4 * transcendental);
}

}  // namespace

Words chain_words(const emit::Evaluation& evaluation, emit::NumberFormat format, int copies,
                  int chains)
{
    verify::Verdict verdict =
        verify::compile(emit::cost_harness(evaluation, format, copies, chains),
                        verify::Dialect::glsl, verify::Stage::compute);
    assert(verdict.accepted);
    return std::move(verdict.spirv);
}

Chain make_chain(const CostSubject& subject, const Sources& sources)
{
    Chain chain;
    chain.format = number_format(subject.format);
    chain.evaluation =
        subject.format == Format::packed16
            ? packed_evaluation(*subject.module, subject.functions, subject.from_vectors)
            : emit::evaluation(*subject.module, sources, subject.functions, chain.format,
                               subject.from_vectors);
    std::set<std::tuple<ir::Origin, std::uint32_t, std::string, int>> live;
    std::size_t instructions = 0;
    for (const ir::FunctionId id : subject.functions) {
        const ir::Function function =
            subject.from_vectors ? ir::entry_point(*subject.module, id) : (*subject.module)[id];
        const Tape tape = evaluate::compile(*subject.module, function);
        instructions += tape.code.size();
        std::vector<bool> read(tape.slots);
        for (const evaluate::Instruction& instruction : tape.code)
            for (int i = 0; i < evaluate::arity(instruction.op); ++i)
                read[std::array{instruction.a, instruction.b, instruction.c,
                                instruction.d}[static_cast<std::size_t>(i)]] = true;
        for (const Slot slot : tape.outputs) read[slot] = true;
        for (std::size_t i = 0; i < tape.inputs.size(); ++i) {
            if (!read[i]) continue;
            const ir::Input& input = function.inputs[tape.inputs[i].input];
            const bool named = input.origin == ir::Origin::argument;
            live.emplace(input.origin, named ? 0 : input.which, named ? input.name : "",
                         tape.inputs[i].component);
        }
    }
    chain.live_inputs = static_cast<int>(live.size());
    chain.copies = copies_for(instructions);
    chain.once = chain_words(chain.evaluation, chain.format, 1);
    return chain;
}

Slope slope(const ChainStatistics& statistics, int copies)
{
    const auto of = [&](int device::ShaderStatistics::*member) {
        return static_cast<double>(statistics.longer.*member - statistics.shorter.*member) / copies;
    };
    return {.valu = of(&device::ShaderStatistics::vector),
            .transcendental = of(&device::ShaderStatistics::transcendental),
            .inverse_throughput = of(&device::ShaderStatistics::inverse_throughput),
            .latency = of(&device::ShaderStatistics::latency)};
}

FamilyCost family_cost(Family family, const Chain& chain, const ChainStatistics& statistics,
                       const Links& links)
{
    const Slope whole = slope(statistics, chain.copies);
    // The links that are measured read as many numbers as they return; the subject's may not.
    const double reads = chain.live_inputs - static_cast<double>(chain.evaluation.results.size());
    const int evaluations = chain.format == emit::NumberFormat::packed16 ? 2 : 1;
    const auto alone = [&](double Slope::*part, double more_reads) {
        const double read = links.product.*part - links.square.*part;
        const double link = 2 * links.squares.*part - links.cubes.*part + more_reads * read;
        return std::max(0.0, whole.*part - link) / evaluations;
    };
    FamilyCost cost;
    cost.valu = alone(&Slope::valu, reads);
    cost.transcendental = alone(&Slope::transcendental, reads);
    cost.issue = issue_cycles(family, cost.valu, cost.transcendental);
    cost.inverse_throughput = alone(&Slope::inverse_throughput, reads);
    // Inputs are read side by side: only one of them is on the way from result to result.
    cost.latency = alone(&Slope::latency, 0) * evaluations;
    cost.vgprs = statistics.once.vgprs;
    cost.waves = statistics.once.waves;
    return cost;
}

}  // namespace lobe::analyze
