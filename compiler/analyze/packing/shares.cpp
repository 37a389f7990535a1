#include "analyze/packing/shares.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace lobe::analyze {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

std::optional<std::vector<std::size_t>> share(const std::vector<std::vector<ShareOption>>& curves,
                                              int bits)
{
    if (bits < 0) return std::nullopt;
    const auto width = static_cast<std::size_t>(bits) + 1;
    struct Cell {
        double cost = infinity;
        std::size_t option = 0;
    };
    // Exactly b bits, so that fewer bits win a tie below.
    std::vector<std::vector<Cell>> best(curves.size() + 1, std::vector<Cell>(width));
    best[0][0].cost = 0;
    for (std::size_t i = 0; i < curves.size(); ++i)
        for (std::size_t b = 0; b < width; ++b) {
            if (best[i][b].cost == infinity) continue;
            for (std::size_t option = 0; option < curves[i].size(); ++option) {
                const std::size_t to = b + static_cast<std::size_t>(curves[i][option].bits);
                if (to >= width) continue;
                const double cost = best[i][b].cost + curves[i][option].cost;
                if (cost < best[i + 1][to].cost) best[i + 1][to] = {cost, option};
            }
        }

    std::size_t at = 0;
    for (std::size_t b = 1; b < width; ++b)
        if (best.back()[b].cost < best.back()[at].cost) at = b;
    if (best.back()[at].cost == infinity) return std::nullopt;
    std::vector<std::size_t> chosen(curves.size());
    for (std::size_t i = curves.size(); i-- > 0;) {
        chosen[i] = best[i + 1][at].option;
        at -= static_cast<std::size_t>(curves[i][chosen[i]].bits);
    }
    return chosen;
}

std::optional<std::vector<std::size_t>>
share_evenly(const std::vector<std::vector<ShareOption>>& curves, int bits)
{
    std::vector<double> limits;
    for (const auto& curve : curves)
        for (const ShareOption& option : curve) limits.push_back(option.cost);
    std::ranges::sort(limits);
    // With every option above the limit out, are there enough bits?
    const auto within = [&](double limit) {
        auto costly = curves;
        for (auto& curve : costly)
            for (ShareOption& option : curve)
                if (option.cost > limit) option.cost = infinity;
        return share(costly, bits);
    };
    // Feasible from some limit on.
    std::size_t low = 0;
    std::size_t high = limits.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (within(limits[middle]))
            high = middle;
        else
            low = middle + 1;
    }
    return low < limits.size() ? within(limits[low]) : share(curves, bits);
}

}  // namespace lobe::analyze
