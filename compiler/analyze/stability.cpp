#include "analyze/stability.h"

#include "optimize/optimize.h"

#include <algorithm>
#include <chrono>

namespace lobe::analyze {

namespace {

/// What proofs leave open becomes points, and what they claim in half is required.
CornerOptions with_proofs(CornerOptions options, const std::vector<Proof>& proofs)
{
    for (const Proof& proof : proofs) {
        if (proof.precision == evaluate::Precision::float16)
            options.half.push_back({proof.function, proof.over, proof.refused});
        for (const NamedBox& box : proof.open) options.open.emplace_back(proof.function, box);
    }
    return options;
}

}  // namespace

bool Stability::ok() const
{
    const auto is_proved = [](const Proof& proof) {
        return proof.precision != evaluate::Precision::float32 ||
               (proof.finite && proof.open_count == 0);
    };
    const auto is_finite = [](const CornerRow& row) {
        return !row.required || (row.failure.empty() && row.not_a_number == 0 && row.infinite == 0);
    };
    return std::ranges::all_of(proofs, is_proved) && std::ranges::all_of(fields, is_proved) &&
           std::ranges::all_of(corners.rows, is_finite);
}

Stability stability(const ir::Module& checked, const Sources& sources,
                    const StabilityOptions& options, const Store& store)
{
    const auto start = std::chrono::steady_clock::now();
    const ir::Module module = optimize::optimize(checked);
    Stability out;
    out.module = module.name;
    out.proofs = proofs(module, options.proof, store);
    out.fields = field_proofs(module, options.proof, store);
    if (options.hazards) out.hazards = hazards(checked, sources, options.hazard, store);
    out.corners = corners(module, sources, with_proofs(options.corner, out.proofs), store);
    out.physics = physics(module, sources, options.physics, store);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace lobe::analyze
