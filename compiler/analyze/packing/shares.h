// Sharing bits out: which option of each curve, for so many bits together.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lobe::analyze {

struct ShareOption {
    int bits = 0;
    double cost = 0;
};

/// One option per curve (its index), so that the bits together are at most `bits` and the sum of
/// the costs is least; of equal sums the one with fewest bits, then the first. Nothing when even
/// the smallest options need more.
///
/// Exact: best[i][b], the least cost of the first i curves in b bits, from best[i - 1].
std::optional<std::vector<std::size_t>> share(const std::vector<std::vector<ShareOption>>& curves,
                                              int bits);

/// As `share`, but first of all the largest cost of one curve is least.
std::optional<std::vector<std::size_t>>
share_evenly(const std::vector<std::vector<ShareOption>>& curves, int bits);

}  // namespace lobe::analyze
