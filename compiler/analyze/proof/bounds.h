// A bound of a subject's error over its whole box: the box divided where the bound is worst, until
// it is close to what was observed or the budget is spent.
#pragma once

#include "analyze/proof/search.h"
#include "evaluate/rounding_bounds.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace lobe::analyze {

/// One way to cut a box in two.
struct Cut {
    std::size_t side = 0;
    double at = 0;
};
/// Where it makes sense to cut a side: in the middle, by binades toward 0, and toward 1.
void cuts_of(const evaluate::Interval& side, std::size_t index, std::vector<Cut>& cuts);
/// Both halves. Every number is in one of them; where sides hold numbers of the grid alone, their
/// ends are such.
std::pair<Box, Box> halves(const Subject& subject, const Box& box, const Cut& cut);

/// The boxes of one subject, machine and measure. `worst` is where the search for bad points goes
/// on: in the boxes whose bounds are worst.
class Division {
public:
    Division(const Subject& subject, evaluate::Machine machine, Measure measure, Worst& worst);

    /// Divides until the bound is at most `target` times what was observed, or the budget
    /// (`boxes_within`) of bounds were computed.
    void refine(std::size_t budget, double target);

    /// Over all boxes; infinite: none was found.
    double bound() const { return leaves_.front().bound; }
    double ratio() const;
    const Box& worst() const { return leaves_.front().box; }  ///< the box of the bound
    std::size_t boxes() const { return leaves_.size(); }

private:
    struct Leaf {
        double bound = 0;
        double doubt = 0;
        Box box;
        std::uint32_t depth = 0;
    };

    Leaf leaf(Box box, std::uint32_t depth);
    double doubt() const;
    double bound_of(const Box& box);
    std::optional<std::size_t> loosest(const Leaf& parent);
    bool divide_worst();
    void search();

    const Subject& subject_;
    Measure measure_;
    Worst& worst_;
    evaluate::RoundingBounds bounds_;
    std::vector<Leaf> leaves_;  ///< a heap, worst first
    std::size_t spent_ = 0;
    std::size_t next_search_ = 64;
};

/// The least bound known of a subject: of its own boxes, or of those of one of its waists.
class Bound {
public:
    Bound(const Subject& subject, evaluate::Machine machine, Measure measure, Worst& worst);

    /// As `Division::refine`. Waists are looked at where the subject's own boxes do not get there;
    /// what is best by then gets the rest of the budget.
    void refine(std::size_t budget, double target);

    double value() const { return divisions_[best()].bound(); }
    double ratio() const { return divisions_[best()].ratio(); }
    std::size_t boxes() const;

private:
    std::size_t best() const;
    void start_waists();

    const Subject& subject_;
    evaluate::Machine machine_;
    Measure measure_;
    Worst& worst_;
    std::vector<Subject> from_;        ///< not moved once divided
    std::vector<Division> divisions_;  ///< the first is of the subject's own boxes
    bool started_ = false;
};

/// Finds bad points of the whole box, before any division; further ones with every `round`.
void explore(const Subject& subject, const std::vector<Worst*>& worst, std::uint64_t round);

}  // namespace lobe::analyze
