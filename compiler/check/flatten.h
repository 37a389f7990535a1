// A body with its calls taken in: one graph over the inputs of one function, which is what ranges
// are proved over and counterexamples are searched in.
#pragma once

#include "check/obligations.h"
#include "ir/module.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lobe::check {

/// A function without calls, and where the expressions that were asked for are in it. It has no
/// result of its own.
struct Flat {
    ir::Function function;
    std::vector<ir::ExprId> roots;
};

/// What stands for a call.
enum class Calls {
    taken_in,   ///< the body of the callee, clamped to the range that was proved of it: over the
                ///< reals that changes nothing, and an interval analysis learns from it
    as_inputs,  ///< an input of its own with that range: far less work, and less is known
};

/// What `roots` of a draft mean, without calls. Where `given` bounds an expression by a literal,
/// the expression is clamped to that.
Flat flatten(const std::vector<ir::Function>& functions, const ir::Function& draft,
             std::span<const ir::ExprId> roots, const std::vector<Fact>& given, Calls calls);

/// The same over vectors: in place of its geometry fields the function takes l, v and n (and x, y),
/// from which the fields are computed.
Flat over_vectors(const Flat& flat);

/// The number of scalar operations a body has once its calls are taken in; saturates.
std::uint64_t flat_size(const std::vector<std::uint64_t>& sizes, const ir::Function& function);

}  // namespace lobe::check
