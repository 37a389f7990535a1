// Which of the things seen so far equals this one? The index of what is shared.
//
// The things themselves lie in someone's vector; here lie only their positions, by hash, in one
// flat table with open addressing. Never walked, so its order reaches nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lobe {

/// One more word for a hash.
constexpr std::size_t mix_hash(std::size_t hash, std::size_t word)
{
    constexpr std::size_t odd = 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ word) * odd;
    return hash ^ (hash >> 32);
}

class HashIndex {
public:
    /// The position of a thing with this hash for which `same(position)` holds.
    template <class Same>
    std::optional<std::uint32_t> find(std::size_t hash, Same same) const
    {
        if (slots_.empty()) return std::nullopt;
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t at = hash & mask; slots_[at].position != free; at = (at + 1) & mask)
            if (slots_[at].hash == static_cast<std::uint32_t>(hash) && same(slots_[at].position))
                return slots_[at].position;
        return std::nullopt;
    }

    /// Adds a thing that `find` did not find.
    void add(std::size_t hash, std::size_t position)
    {
        if (2 * (count_ + 1) > slots_.size()) grow();
        place({static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(position)});
        ++count_;
    }

private:
    static constexpr std::uint32_t free = static_cast<std::uint32_t>(-1);
    struct Slot {
        std::uint32_t hash = 0;
        std::uint32_t position = free;
    };

    void place(Slot slot)
    {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = slot.hash & mask;
        while (slots_[at].position != free) at = (at + 1) & mask;
        slots_[at] = slot;
    }

    void grow()
    {
        constexpr std::size_t first_size = 32;
        std::vector<Slot> old(slots_.empty() ? first_size : 2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.position != free) place(slot);
    }

    std::vector<Slot> slots_;  ///< a power of two of them
    std::size_t count_ = 0;
};

}  // namespace lobe
