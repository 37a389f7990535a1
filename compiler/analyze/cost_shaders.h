// What is compiled to tell what a subject costs, and how the numbers that come back are read.
#pragma once

#include "analyze/cost.h"
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

/// The same of evaluations that measure links (see emit::identity): of so many numbers that come
/// out as they went in, and of the product of one and of two.
struct Links {
    Slope identity;  ///< of as many numbers as the subject returns
    Slope square;
    Slope product;
};

/// A subject's cost on a family: its slope without its links. A link takes one operation per
/// number that is read (the difference of `product` and `square`), and what joins the results.
FamilyCost family_cost(Family family, const Chain& chain, const ChainStatistics& statistics,
                       const Links& links);

}  // namespace lobe::analyze
