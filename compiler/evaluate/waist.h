// Where a tape is narrow: few values from which all the rest follows.
//
// A light's falloff reads three coordinates and asks for nothing but their squared sum. Of the sum
// one number is to be divided into boxes, and not three; what is lost is what its error has to do
// with its value, and one waist's values with each other.
#pragma once

#include "evaluate/rounding_tape.h"

#include <cstdint>
#include <vector>

namespace lobe::evaluate {

/// Sets of values, no literals, that are all that is alive behind some operation, in the tape's
/// order or by how far operations are from the output. Each is smaller than the set of inputs; the
/// smallest come first. Not all there are: those that look as if they parted something.
std::vector<std::vector<std::uint32_t>> waists(const RoundingTape& tape);

/// What follows from these values: a tape that has them as its inputs, in their order. Its own
/// `inputs` are empty: they are no inputs of a tape.
RoundingTape behind(const RoundingTape& tape, const std::vector<std::uint32_t>& waist);

}  // namespace lobe::evaluate
