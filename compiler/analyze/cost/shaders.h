// What is compiled to tell what a subject costs, and how the numbers that come back are read.
#pragma once

#include "analyze/cost/cost.h"
#include "device/statistics.h"
#include "emit/cost_harness.h"

#include <cstdint>
#include <vector>

namespace lobe::analyze {

using Words = std::vector<std::uint32_t>;

/// A chain's text as SPIR-V.
Words chain_words(const emit::Evaluation& evaluation, emit::NumberFormat format, int copies,
                  int chains = 1);

/// A subject, ready to be put into chains.
struct Chain {
    emit::Evaluation evaluation;
    emit::NumberFormat format{};
    int live_inputs = 0;  ///< scalars that it really reads
    int copies = 0;       ///< of the shorter chain
    Words once;           ///< a chain of one evaluation
};
Chain make_chain(const CostSubject& subject, const Sources& sources);

/// What a driver says of the chains of one evaluation, of `copies`, and of twice as many.
struct ChainStatistics {
    device::ShaderStatistics once, shorter, longer;
};

/// Of one evaluation and its link.
struct Slope {
    double valu = 0;
    double transcendental = 0;
    double inverse_throughput = 0;
    double latency = 0;
};
Slope slope(const ChainStatistics& statistics, int copies);

/// The same of evaluations that measure links: squares and cubes of as many numbers as the subject
/// returns, the square of one, the product of two.
struct Links {
    Slope squares;
    Slope cubes;
    Slope square;
    Slope product;
};

/// A subject's cost on a family: its slope without its links. Cubes and squares differ by their
/// last multiplications, so squares without these are links that read as many numbers as they
/// return; a number more to read is what `product` has beyond `square`.
FamilyCost family_cost(Family family, const Chain& chain, const ChainStatistics& statistics,
                       const Links& links);

}  // namespace lobe::analyze
