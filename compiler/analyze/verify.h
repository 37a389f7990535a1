// The whole check of one module: its files through every judge, its functions on a device.
//
// Text, judges, device and evaluator are four witnesses that share no code but the module; this
// is where their statements are held together.
#pragma once

#include "analyze/agreement/agreement.h"
#include "analyze/agreement/judgement.h"
#include "analyze/packing/round_trip.h"
#include "base/diagnostic.h"
#include "emit/emit.h"
#include "ir/module.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lobe::analyze {

struct Progress {
    std::size_t done = 0;
    std::size_t total = 0;
    std::string_view what;  ///< `D_GGX, ue4`; lives during the call
};

struct VerifyOptions {
    std::vector<const emit::Target*> targets;  ///< empty: all
    std::vector<emit::Precision> precisions{emit::Precision::float32, emit::Precision::float16};
    std::size_t points = 65536;                     ///< per function; a quarter are hostile
    std::string device;                             ///< selector; see device::Device::open
    unsigned jobs = 0;                              ///< threads; 0: one per core
    bool execute = true;                            ///< false: judges only
    std::function<void(const Progress&)> progress;  ///< from any thread, one call at a time
};

/// One function on one target in one precision.
struct Row {
    std::string term;
    std::string target;
    emit::Precision precision{};
    std::vector<Judgement> judgements;  ///< of its harness
    std::string failure;                ///< why the device could not run it; empty: it could
    bool executed = false;
    Agreement direct;     ///< as the front end made it
    Agreement optimized;  ///< after spirv-opt -O
    double judge_seconds = 0;
    double run_seconds = 0;

    bool ok() const;
};

struct Verification {
    std::string module;                  ///< its name
    std::vector<Judgement> judgements;   ///< of the files: by target, file, judge
    std::vector<Row> rows;               ///< by term, target, precision
    std::vector<RoundTrip> round_trips;  ///< by packing, target
    std::string device;                  ///< name and driver; empty when nothing was executed
    std::string no_device;           ///< why nothing was executed; empty: it was, or was not asked
    std::vector<std::string> notes;  ///< what was left out, and why: `float16: …`
    double seconds = 0;              ///< wall clock
    double acceptance_seconds = 0;   ///< of all threads together
    std::size_t acceptance_points = 0;

    bool ok() const;
    std::size_t outside() const;
};

/// Everything of a module that has been through optimize (the promise `legal`): every function
/// that the module itself declares, on every target, and every file. Equal inputs give equal
/// results but for the times, whatever the number of threads.
Verification verify(const ir::Module& module, const Sources& sources, const VerifyOptions& options);

/// What the judges said against the artifacts and harnesses, as diagnostics (E0701) at the place
/// in the .lobe file that the refused line was written for.
Diagnostics complaints(const Verification& verification, const ir::Module& module);

/// The functions that `verify` checks: the module's own, but not the conditions of effects.
std::vector<ir::FunctionId> checked_functions(const ir::Module& module);

}  // namespace lobe::analyze
