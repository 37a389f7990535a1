// From curves to layouts of all parameters: the bits shared out, and what comes out measured.
#pragma once

#include "analyze/packing/curves.h"

#include <optional>
#include <vector>

namespace lobe::analyze {

/// Options of the curves (one index per placed parameter) that share some bits.
struct Shared {
    std::vector<std::size_t> options;
    int bits = 0;                ///< of all components together
    double predicted = 0;        ///< sum over the curves
    double measured = -1;        ///< as a whole
    std::vector<float> worst{};  ///< the point of that
};

/// How many bits an option takes, for all components.
int bits_of(const CodeSearch& subject, std::size_t placed, const Fitted& fitted);

/// The fewest bits in which every parameter has an option.
std::optional<int> least_bits(const CodeSearch& subject, const std::vector<FittedCurve>& curves);

/// The layouts of up to `bits` bits that are worth measuring: least sum of errors, least product of
/// (1 + error), which is what independent errors do to a pixel, and least maximum. Not measured
/// yet; none twice; none when the bits do not do.
std::vector<Shared> shares_of(const CodeSearch& subject, const std::vector<FittedCurve>& curves,
                              int bits);

/// The best measured layout for each of several questions. All are measured side by side, and then
/// once more, each at what was worst for the others.
struct ShareQuestion {
    const CodeSearch* subject = nullptr;
    const std::vector<FittedCurve>* curves = nullptr;
    int bits = 0;
};
std::vector<std::optional<Shared>> best_shares(const std::vector<ShareQuestion>& questions,
                                               unsigned jobs);

/// A better layout near one, as measured: a bit more for one parameter, out of what `bits` leaves
/// or from another parameter, as long as that helps. Errors do not quite add up, as the sums above
/// take them to. `known` are bad points of other layouts.
Shared improved(const CodeSearch& subject, const std::vector<FittedCurve>& curves, Shared shared,
                int bits, const std::vector<std::vector<float>>& known, unsigned jobs);

}  // namespace lobe::analyze
