// What a reflectance model owes to physics, asked of what was emitted: normal distributions
// integrate to one, no lobe reflects more than arrives, light and view may be swapped, nothing is
// negative. Where a model does not keep it by design, the report says where and by how much.
//
// Integrals are quadratures over the hemisphere of results that the emitted shader gave (on the
// device if there is one, else the evaluator's), with the quadrature's own error measured on the
// definition in double.
#pragma once

#include "analyze/store.h"
#include "analyze/verify.h"
#include "ir/module.h"

#include <string>
#include <vector>

namespace lobe::analyze {

enum class Law : std::uint8_t {
    normalized,  ///< the integral of D cos is 1
    albedo,      ///< the integral of f cos over light is at most 1
    reciprocal,  ///< f(l, v) = f(v, l)
    positive
};
std::string_view name(Law law);

struct PhysicsRow {
    std::string
        subject;  ///< a term or an output, and its parameters: `callisto_specular, roughness = 0.5`
    Law law{};
    std::string where;       ///< `n.v = 0.1`
    double value = 0;        ///< the integral; the asymmetry; the least value
    double exact = 0;        ///< the same of the definition in double
    double uncertainty = 0;  ///< of the quadrature
    bool kept = false;       ///< the law is kept there
    std::string note;        ///< `gains energy`; `the term is pi D: 3.1416`
};

struct PhysicsOptions {
    std::string device;
    bool execute = true;
    unsigned jobs = 0;
    std::function<void(const Progress&)> progress;
};

std::vector<PhysicsRow> physics(const ir::Module& module, const Sources& sources,
                                const PhysicsOptions& options, const Store& store);

}  // namespace lobe::analyze
