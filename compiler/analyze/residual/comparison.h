// Two functions over a scene's box: whether one's exact value is always what the other's acceptance
// interval allows, and how far their exact values are apart.
//
// The other's exact value is an interval first, rounded outward in double, which settles nearly all
// points; how far it is from the general one's is told in double, whose roundings are 2^-29 of
// those that the acceptance interval allows. Where the interval is too wide to tell, 113 bits tell
// both.
#pragma once

#include "analyze/physics/emitted_function.h"
#include "evaluate/tape.h"
#include "ir/module.h"
#include "optimize/residual.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::analyze {

/// What the inputs of both functions can be.
struct SceneBox {
    optimize::Called called;       ///< parameters and surface fields
    optimize::Settings constants;  ///< of these; those that `called` has, and what is set besides
    const optimize::Called* light = nullptr;  ///< fields of an emitter; null: whatever they declare

    /// The value of an input that does not vary.
    const std::vector<double>* constant(const ir::Input& input) const;
    bool is_binary(const ir::Input& input) const;
    ir::Range range(const ir::Input& input) const;
};

/// What some of the points say.
struct Disagreement {
    std::size_t outside = 0;         ///< the other function's value is not allowed
    std::size_t device_outside = 0;  ///< what a device returned is not
    double worst = 0;                ///< distance of the exact values in half widths, at most
    void add(const Disagreement& more);
};

class Comparison {
public:
    /// `meant` and `other` are entry points of their modules, which have been through optimize.
    Comparison(const ir::Module& general, const ir::Function& meant, const ir::Module& residual,
               const ir::Function& other, const SceneBox& box, std::size_t points);

    /// What results depend on.
    std::string key() const;
    std::size_t points() const { return values_.empty() ? 0 : values_.front().size(); }
    /// What `other` is given, point by point in the order of its inputs.
    EmittedFunction::Batch inputs_of_other() const;
    /// Of points from `first` on. `device` has what a device computed of all points, or nothing.
    Disagreement count(std::size_t first, std::size_t size, const ResultColumns& device) const;

private:
    /// One scalar of the points.
    struct Column {
        std::string name;
        std::optional<double> constant;
    };
    struct Side {
        evaluate::Tape tape;
        std::vector<std::size_t> columns;  ///< that its inputs read
    };
    template <class Number, class Make>
    std::vector<std::vector<Number>> slice(const Side& side, std::size_t first, std::size_t size,
                                           const Make& make) const;
    template <class Number, class Make, class Run>
    std::vector<std::vector<Number>> run(const Side& side, std::size_t first, std::size_t size,
                                         const Make& make, const Run& run) const;
    Side side_of(const ir::Module& module, const ir::Function& entry) const;
    std::vector<double> exactly(const Side& side, std::size_t point) const;

    std::vector<Column> columns_;
    std::vector<std::vector<float>> values_;
    Side general_;
    Side other_;
};

}  // namespace lobe::analyze
