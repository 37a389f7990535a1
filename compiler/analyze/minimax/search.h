// The search for one ratio of polynomials that follows one part of a term.
#pragma once

#include "analyze/minimax/form.h"
#include "analyze/minimax/parts.h"
#include "analyze/minimax/surface.h"
#include "analyze/store.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace lobe::analyze {

/// A form that errs by more than this part of its term's range is dropped: in no use of the term
/// could it pass for it.
inline constexpr double hopeless = 0.1;

struct FoundRatio {
    Ratio ratio;                ///< coefficients are floats
    double error = 0;           ///< over the part's box, held in its range
    std::vector<Place> places;  ///< where it is greatest
    Ratio ideal_ratio;          ///< before rounding
    double ideal = 0;
};

/// A part, and what is known of it however often it is asked. May be used by several threads.
class PartSearch {
public:
    PartSearch(const ir::Module& module, Part part);

    const Part& part() const { return part_; }

    /// The best ratio of a shape; nothing where it is hopeless, where the part is constant or not
    /// finite, or where double is not accurate enough to say.
    std::optional<FoundRatio> find(const NamedShape& shape, const Store& store);

private:
    const Samples& samples();
    std::string key(const NamedShape& shape) const;
    std::optional<FoundRatio> search(const Shape& shape);
    std::optional<Fit> fitted(const Shape& shape, Samples& seen, double limit);
    double confirmed(const Surface& approximation, const std::vector<Difference>& worst) const;
    Place scaled(Place at) const;

    const ir::Module& module_;
    Part part_;
    Surface surface_;
    std::once_flag sampled_;
    Samples samples_;
};

}  // namespace lobe::analyze
