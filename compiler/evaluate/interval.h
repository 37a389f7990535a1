// Closed intervals of real numbers, and the intervals of results that a target may return.
#pragma once

namespace lobe::evaluate {

/// Every real number in [low, high]; infinite ends are never reached. `low > high` never
/// happens. Operations round outward, so an interval contains every value it stands for.
struct Interval {
    double low = 0;
    double high = 0;

    friend bool operator==(const Interval&, const Interval&) = default;
};

/// The set of results that the Vulkan precision table allows a conforming device to return
/// ("acceptance interval"): all of [low, high], where an infinite end includes the infinity.
/// `undefined` says that the contract lets any value through, NaN included: 0/0, 0^0, a
/// denormal or huge divisor, overflow on the way. Such points are counted, never passed.
struct Acceptance {
    double low = 0;
    double high = 0;
    bool undefined = false;

    friend bool operator==(const Acceptance&, const Acceptance&) = default;
};

}  // namespace lobe::evaluate
