// Finding an input that breaks a claim: real vectors where the body takes a geometry.
#pragma once

#include "check/analysis.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::check {

/// What is searched for: a point where every claim fails and every fact holds. In a flat body the
/// claims' subjects are the first roots, then come the facts' sides, left and right in turn.
struct Search {
    Flat flat;
    std::vector<Requirement> claims;
    std::vector<Relation> facts;
};

struct Witness {
    std::string point;           ///< `l = (1, 0, 0), v = (0, 0, 1), n = (0, 0, 1), alpha = 0.5`
    std::vector<double> values;  ///< of the first claim's subject
    bool on_vectors = true;      ///< false: cosines that no vectors may have
};

/// Looks at the corners of the inputs' ranges, at simple values and at some thousand others, the
/// same ones each time; between points where a divisor changes its sign it closes in on 0.
std::optional<Witness> find_witness(const Search& search);

}  // namespace lobe::check
