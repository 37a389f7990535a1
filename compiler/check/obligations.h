// What has to be true of the values inside a body, collected while it is lowered and proved once
// it is whole.
#pragma once

#include "base/source.h"
#include "ir/graph.h"

#include <limits>
#include <string>
#include <vector>

namespace lobe::check {

/// A set of real numbers that every component of a value has to lie in.
struct Requirement {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;  ///< the end itself is outside
    bool high_open = false;
    bool nonzero = false;  ///< 0 is outside
};

struct Claim {
    ir::ExprId subject;
    Requirement requirement;
};

/// A comparison that holds wherever the value of an arm is used.
enum class Relation {
    less,
    less_equal,
    equal,
    not_equal
};
struct Fact {
    Relation relation{};
    ir::ExprId left;
    ir::ExprId right;
};

struct Obligation {
    enum class Kind {
        divisor,     ///< a / b
        domain,      ///< sqrt(x), acos(x), ...
        power_base,  ///< x ^ y with a base that may be negative
        power_zero,  ///< x ^ y where 0 may meet a negative exponent
        argument,    ///< of a term, into its declared range
        result,      ///< of a term, into its declared range
        stored,      ///< of the encode of a code, into [0, 1]
    };
    Kind kind{};
    std::vector<Claim> any_of;  ///< one of these, at every input
    std::vector<Fact> given = {};
    Span whole;                 ///< the operation or call
    Span subject;               ///< the operand that is judged
    Span declared = {};         ///< argument, result: the type that asks for the range
    std::string function = {};  ///< domain: `sqrt`; argument: the callee
    std::string name = {};      ///< argument: of the callee's
    bool in_choice = false;     ///< inside an arm of a conditional
    std::string term = {};      ///< of a sum: `i = 3`
};

/// `a / b else c`: a warning when b cannot be 0.
struct NamedLimit {
    ir::ExprId divisor;
    std::vector<Fact> given;
    Span limit;  ///< from `else` on
    Span divisor_span;
};

}  // namespace lobe::check
