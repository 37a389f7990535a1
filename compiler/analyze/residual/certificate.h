// What a residual shader owes to the general one: that on everything the scene can show they are
// the same, and how far apart where an effect was dropped on purpose.
#pragma once

#include "analyze/residual/facts.h"
#include "analyze/store.h"
#include "analyze/verify.h"
#include "ir/module.h"
#include "optimize/residual.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::analyze {

/// An effect that is called for, and was left out because it changes little: on the scene's box,
/// radiance with and without differ by at most `bound`, measured as packings are
/// (packing/radiance.h): relative, or to an 18 % grey card where darker.
struct Dropped {
    std::string effect;
    double bound = 0;     ///< proved; infinite: none is known
    double observed = 0;  ///< the most that a search found
};

/// One output of the model, or the model under one kind of light.
struct Equality {
    std::string output;       ///< `diffuse`, `under sphere`
    bool same_graph = false;  ///< proved: after `optimize` both are one graph, input for input
    std::size_t points = 0;   ///< compared, of the scene's box, a quarter of them hostile
    std::size_t outside = 0;  ///< where the residual's exact value is none that the general one's
                              ///< acceptance interval allows
    double worst = 0;         ///< differences are at most so many of that interval's half widths
    std::string device;       ///< that the emitted residual ran on; empty: none did
    std::size_t device_outside = 0;  ///< device results outside of the general one's interval
    bool ok() const { return outside == 0 && device_outside == 0; }
};

struct Certificate {
    std::string model;
    std::vector<Equality> outputs;  ///< residual against general, both without what was dropped
    std::vector<Dropped> dropped;
    /// What epsilon was asked about and stays: more was found, or no bound below was, or what went
    /// before it left too little.
    std::vector<Dropped> kept;
    bool ok() const;
};

struct CertificateOptions {
    std::size_t points = 16384;  ///< per output; of those proved a quarter
    double epsilon = 0;          ///< 0: drop nothing
    bool execute = true;
    std::string device;
    unsigned jobs = 0;
};

/// Effects of `called` materials that may go for an epsilon, with their proved bounds; together
/// they stay below it. The scene's box is `called`'s.
std::vector<Dropped> droppable(const ir::Module& module, const std::string& model,
                               const optimize::Called& called, double epsilon,
                               const CertificateOptions& options);

/// The effects that are still on, whatever their bounds; none for an epsilon of 0. No bound is
/// looked for where more than epsilon was found.
std::vector<Dropped> not_droppable(const ir::Module& module, const std::string& model,
                                   const optimize::Called& called,
                                   const CertificateOptions& options);

/// A residual shader, made of the general module by `called`. All outlive the call.
struct CertificateSubject {
    const optimize::Called* called = nullptr;
    const optimize::Residual* residual = nullptr;
    std::vector<Dropped> dropped{};
    /// What the scene says of the emitters of its lights, by their names; null: nothing.
    const std::map<std::string, optimize::Called>* lights = nullptr;
};

/// `general` is the checked module. Of lights, those that a residual is shaded under and the
/// general module too are compared (lights.h joins them to both). Equal inputs give equal results,
/// whatever the number of threads.
std::vector<Certificate> certify(const ir::Module& general, const Sources& sources,
                                 const std::string& model,
                                 const std::vector<CertificateSubject>& subjects,
                                 const CertificateOptions& options, const Store& store);

}  // namespace lobe::analyze
