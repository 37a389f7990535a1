// Typed handles, and side tables keyed by them.
//
// An `Id<T>` names the n-th T of one arena: four bytes, survives growth, prints as a number.
// `Facts<T, V>` holds what was discovered about every T without a field in T itself.
#pragma once

#include <cassert>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace lobe {

/// Handle of a `T`. Default-constructed ids name nothing; `valid()` tells.
template <class T>
struct Id {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t index = none;

    constexpr Id() = default;
    constexpr explicit Id(std::size_t i) : index(static_cast<std::uint32_t>(i)) {}

    constexpr bool valid() const { return index != none; }

    friend constexpr bool operator==(Id, Id) = default;
    friend constexpr auto operator<=>(Id, Id) = default;
};

/// One `V` for every `T` of an arena, indexed by id.
template <class T, class V>
class Facts {
public:
    Facts() = default;
    explicit Facts(std::size_t size, V value = V{}) : values_(size, value) {}

    decltype(auto) operator[](Id<T> id)
    {
        assert(id.index < values_.size());
        return values_[id.index];
    }
    decltype(auto) operator[](Id<T> id) const
    {
        assert(id.index < values_.size());
        return values_[id.index];
    }

    std::size_t size() const { return values_.size(); }

private:
    std::vector<V> values_;
};

}  // namespace lobe

template <class T>
struct std::hash<lobe::Id<T>> {
    std::size_t operator()(lobe::Id<T> id) const noexcept { return id.index; }
};
