#include "analyze/residual/selection.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace lobe::analyze {
namespace {

/// Of branches, for one number of candidates. A scene of a handful of effects takes thousands.
constexpr std::size_t most_steps = 5'000'000;
/// Sums of the same prices in another order differ by their rounding.
constexpr double tolerance = 1e-9;
/// A group whose area is too small to count still chooses its cheapest.
constexpr double least_share = 1e-6;

class Search {
public:
    explicit Search(const Selection& selection) : selection_{selection}
    {
        for (std::size_t c = 0; c < selection.prices.size(); ++c)
            if (!is_needless(c)) open_.push_back(c);
        // What serves nothing yet pays more than any shader, so that a bound stays a bound.
        for (const double price : selection.prices) dearest_ = std::max(dearest_, 2 * price);
        const double all = std::accumulate(selection.weights.begin(), selection.weights.end(), 0.0);
        for (const double weight : selection.weights)
            weights_.push_back(std::max(weight, least_share * (all > 0 ? all : 1)));
    }

    /// The cheapest of at most so many, if it is cheaper than what was found before.
    std::optional<Selected> next(std::size_t most)
    {
        most_ = most;
        steps_ = 0;
        improved_ = false;
        descend(open_, std::vector<double>(weights_.size(), dearest_));
        if (!improved_) return std::nullopt;
        return concluded();
    }

private:
    /// Another candidate serves all that this one does, and costs no more.
    bool is_needless(std::size_t c) const
    {
        for (std::size_t other = 0; other < selection_.prices.size(); ++other) {
            if (other == c || selection_.prices[other] > selection_.prices[c]) continue;
            bool serves_all = true;
            bool serves_more = false;
            for (std::size_t g = 0; g < selection_.weights.size(); ++g) {
                serves_all = serves_all && selection_.serves[other][g] >= selection_.serves[c][g];
                serves_more = serves_more || selection_.serves[other][g] > selection_.serves[c][g];
            }
            const bool same = !serves_more && selection_.prices[other] == selection_.prices[c];
            if (serves_all && (!same || other < c)) return true;
        }
        return false;
    }

    double cost_of(const std::vector<double>& paid) const
    {
        return std::inner_product(paid.begin(), paid.end(), weights_.begin(), 0.0);
    }

    /// What a candidate alone would save.
    double saving(std::size_t c, const std::vector<double>& paid) const
    {
        double saved = 0;
        for (std::size_t g = 0; g < weights_.size(); ++g)
            if (selection_.serves[c][g])
                saved += weights_[g] * std::max(paid[g] - selection_.prices[c], 0.0);
        return saved;
    }

    void descend(const std::vector<std::size_t>& candidates, const std::vector<double>& paid)
    {
        if (++steps_ > most_steps) return;
        const double cost = cost_of(paid);
        const bool serves_all =
            std::ranges::all_of(paid, [this](double price) { return price < dearest_; });
        if (serves_all && cost < best_cost_ * (1 - tolerance)) {
            best_ = picked_;
            best_cost_ = cost;
            improved_ = true;
        }
        if (picked_.size() == most_) return;

        std::vector<std::pair<double, std::size_t>> by_saving;
        for (const std::size_t c : candidates)
            if (const double saved = saving(c, paid); saved > 0) by_saving.emplace_back(-saved, c);
        std::ranges::sort(by_saving);
        std::vector<std::size_t> rest;
        for (const auto& [negative, c] : by_saving) rest.push_back(c);

        for (std::size_t i = 0; i < rest.size(); ++i) {
            // Picks after this one are of those behind it; together they save at most the sum.
            double bound = cost;
            for (std::size_t k = i; k < std::min(rest.size(), i + most_ - picked_.size()); ++k)
                bound += by_saving[k].first;
            if (bound >= best_cost_ * (1 - tolerance)) return;
            std::vector<double> with = paid;
            for (std::size_t g = 0; g < weights_.size(); ++g)
                if (selection_.serves[rest[i]][g])
                    with[g] = std::min(with[g], selection_.prices[rest[i]]);
            picked_.push_back(rest[i]);
            descend({rest.begin() + static_cast<std::ptrdiff_t>(i) + 1, rest.end()}, with);
            picked_.pop_back();
        }
    }

    Selected concluded() const
    {
        Selected out;
        out.is_proved = steps_ <= most_steps;
        for (std::size_t g = 0; g < weights_.size(); ++g) {
            std::optional<std::size_t> server;
            for (const std::size_t c : best_)
                if (selection_.serves[c][g] &&
                    (!server || selection_.prices[c] < selection_.prices[*server]))
                    server = c;
            out.of_group.push_back(*server);
            out.cost += selection_.weights[g] * selection_.prices[*server];
        }
        // A pick that no group is served by is none.
        std::ranges::copy_if(best_, std::back_inserter(out.candidates), [&](std::size_t c) {
            return std::ranges::count(out.of_group, c) > 0;
        });
        std::ranges::sort(out.candidates);
        return out;
    }

    const Selection& selection_;
    std::vector<std::size_t> open_;
    std::vector<double> weights_;
    double dearest_ = 1;
    std::size_t most_ = 0;
    std::vector<std::size_t> picked_;
    std::vector<std::size_t> best_;
    double best_cost_ = std::numeric_limits<double>::infinity();
    bool improved_ = false;
    std::size_t steps_ = 0;
};

}  // namespace

std::vector<Selected> cheapest(const Selection& selection, std::size_t most)
{
    const std::size_t groups = selection.weights.size();
    if (most == 0 || most > groups) most = groups;
    std::vector<Selected> out;
    Search search{selection};
    for (std::size_t count = 1; count <= most; ++count) {
        auto next = search.next(count);
        if (next) out.push_back(std::move(*next));
    }
    return out;
}

}  // namespace lobe::analyze
