// A definition as a yardstick: the box of its inputs, its exact values there, and how far other
// ways to compute it are off.
//
// Points have the z axis as their normal and directions at least `least_cosine` above the horizon
// (radiance_box.h); half of them are usual ones (deviation.h), half where errors are, and from the
// worst of each contender steps go uphill. What was worst for one is tried on all. The exact
// value is that of the definition in double for the direction that a float vector stands for
// (scaled to unit length in double), and of the worst points with MPFR. Results that are not
// finite are counted, at these points and at those of points.h, whose normal is anywhere and whose
// directions may be below the horizon; there nothing else is asked.
#pragma once

#include "analyze/cost/cost.h"
#include "analyze/packing/radiance_box.h"
#include "analyze/store.h"
#include "analyze/trade/deviation.h"
#include "evaluate/tape.h"

#include <span>
#include <vector>

namespace lobe::analyze {

/// What others are held against.
class Yardstick {
public:
    /// `outputs` of a checked module: their sum. Radiance counts against a grey card lit alike,
    /// anything else against 0.18.
    Yardstick(const ir::Module& module, const std::vector<ir::FunctionId>& outputs, bool radiance);

    /// Makes room for what another way to compute the same reads and the definition does not.
    void widen(const ir::Module& module, const std::vector<ir::FunctionId>& outputs);

    const RadianceBox& box() const { return box_; }
    const ir::Function& function() const { return function_; }
    const ir::Module& module() const { return *module_; }
    bool is_radiance() const { return radiance_; }
    /// The first coordinate of every direction.
    const std::vector<std::size_t>& vectors() const { return vectors_; }
    /// Everything that errors depend on, as text.
    std::string text() const;

private:
    void note_vectors();

    const ir::Module* module_;
    ir::Function function_;
    RadianceBox box_;
    std::vector<std::size_t> vectors_;
    bool radiance_;
};

/// A tape that computes the same in a format.
struct Contender {
    evaluate::Tape tape;
    Format format{};
};

/// A choice of forms: over the reals, and in formats and spellings.
struct Way {
    evaluate::Tape real;
    std::vector<Contender> contenders;
};

struct Deviations {
    Deviation model;  ///< of the way over the reals
    struct OfContender {
        Deviation rounding;  ///< from the way over the reals
        Deviation total;     ///< from the definition
    };
    std::vector<OfContender> contenders;
};

struct DeviationOptions {
    std::size_t points = std::size_t{1} << 15;
    std::size_t climbs = 3;       ///< per contender, from its worst points
    int rounds = 24;              ///< of each climb
    bool every_contender = true;  ///< false: climbs for the first contender of each way only
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

/// One per way. Equal inputs give equal results, whatever the number of threads.
std::vector<Deviations> deviations(const Yardstick& yardstick, std::span<const Way> ways,
                                   const DeviationOptions& options, const Store& store);

}  // namespace lobe::analyze
