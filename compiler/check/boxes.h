// Deciding a claim for all inputs of a box: intervals first, then slopes, then halves of the box.
#pragma once

#include "check/analysis.h"
#include "check/derivative.h"

#include <memory>
#include <vector>

namespace lobe::check {

/// What proofs may still cost, in operations on intervals. One text has one effort, so that
/// thousands of hard terms take no longer than some.
struct Effort {
    std::size_t left = 200'000'000;

    /// How often something may be done that costs this much, `most` times at best; at least once.
    std::size_t times(std::size_t cost, std::size_t most) const;
    void spend(std::size_t cost) { left -= cost < left ? cost : left; }
};

/// Proves "at every input one of the claims holds" over the declared ranges of a flat body. Claim
/// `i` is about root `i`.
class BoxProof {
public:
    /// `slack` is how far past a closed end still counts as inside: interval arithmetic rounds
    /// outward, so a bound that is exact in the reals may be missed by a few units.
    BoxProof(const Flat& flat, std::vector<Requirement> claims, double slack, Effort& effort);

    /// False means that it is not known. The box is halved at most some thousand times.
    bool prove();
    /// The same with little effort: what is not obvious is not known.
    bool prove_quickly();

    /// The range of a root over the declared ranges, as tight as slopes make it, and halving the
    /// box so many times.
    Interval range(std::size_t root, std::size_t halvings);
    /// What one look at one box costs.
    std::size_t cost() const { return flat_.function.graph.size() * (1 + varied_.size()); }

private:
    bool holds(const Box& box);
    bool holds_by_slopes(const Box& box);
    Interval bounds(std::size_t root, const Box& box);
    /// One bound of one component, from the face of the box where the slopes say it is attained.
    double bound(std::size_t root, std::size_t component, const Box& box, bool low);
    Analysis* slopes(std::size_t root);
    bool prove(std::size_t most, bool with_slopes);
    std::optional<std::size_t> widest(const Box& box) const;

    Flat flat_;
    std::vector<Requirement> claims_;
    double slack_;
    Effort& effort_;
    Analysis analysis_;
    Box whole_;
    std::vector<ScalarInput> varied_;                ///< the inputs that matter
    std::vector<std::size_t> varied_index_;          ///< their place in a box
    std::vector<std::unique_ptr<Analysis>> slopes_;  ///< per root, built when first needed
};

}  // namespace lobe::check
