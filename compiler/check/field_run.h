// A built field at work: all of its codes, decoded and encoded again, in several kinds of numbers.
#pragma once

#include "evaluate/run.h"
#include "ir/module.h"

#include <vector>

namespace lobe::check {

using evaluate::Acceptance;

inline Acceptance point(double value) { return {value, value, false}; }

class FieldRun {
public:
    FieldRun(const ir::Module& module, const ir::Field& field);

    std::vector<float> floats;         ///< what a code decodes to, by code
    std::vector<double> reals;         ///< the same in double
    std::vector<Acceptance> accepted;  ///< what a device may decode it to
    std::vector<Acceptance> encoded;   ///< what it may store that as
    std::size_t top = 0;               ///< the code of the high end
    std::size_t bottom = 0;            ///< of the low end

    std::size_t code_of(double value) const;
    /// What a device may read after it stored a value.
    Acceptance stored_and_read(double value) const;
    /// It comes back as the float that it is in a shader, and as nothing else.
    bool keeps(double value) const;

private:
    double last_;
    evaluate::Tape encode_;
    evaluate::Tape decode_;
};

/// A function of one number at one number.
double value_of(const ir::Module& module, ir::FunctionId function, double x);

}  // namespace lobe::check
