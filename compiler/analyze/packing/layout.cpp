#include "analyze/packing/layout.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

namespace lobe::analyze {
namespace {

constexpr int impossible = 1 << 20;

/// Which fields live in one slot of the room, and which one begins there.
struct Filling {
    int cuts = impossible;  ///< here and in all later slots
    std::uint32_t whole = 0;
    int begun = -1;  ///< the field that is cut: as many of its bits as are left here
};

class Search {
public:
    Search(const std::vector<int>& bits, const std::vector<ir::Slot>& room)
        : bits_{bits}, room_{room}
    {
    }

    /// The best filling of the slots from `slot` on, when `placed` fields have begun before and the
    /// rest of one of them takes `taken` bits of this slot.
    const Filling& best(std::size_t slot, std::uint32_t placed, int taken)
    {
        const auto key = std::make_tuple(slot, placed, taken);
        if (const auto found = known_.find(key); found != known_.end()) return found->second;
        Filling filling;
        if (taken <= room_[slot].bits)
            choose(slot, placed, 0, 0, room_[slot].bits - taken, filling);
        return known_[key] = filling;
    }

    std::vector<std::vector<ir::Slot>> read()
    {
        std::vector<std::vector<ir::Slot>> slots(bits_.size());
        std::uint32_t placed = 0;
        int carried = -1;
        int taken = 0;
        for (std::size_t i = 0; i < room_.size(); ++i) {
            const Filling filling = best(i, placed, taken);
            int top = room_[i].low + room_[i].bits;
            const auto put = [&](std::size_t field, int count) {
                top -= count;
                slots[field].push_back({room_[i].channel, top, count});
            };
            if (carried >= 0) put(static_cast<std::size_t>(carried), taken);
            for (std::size_t field = 0; field < bits_.size(); ++field)
                if ((filling.whole >> field & 1) != 0) put(field, bits_[field]);
            placed |= filling.whole;
            carried = filling.begun;
            taken = 0;
            if (carried < 0) continue;
            placed |= 1U << carried;
            const int here = top - room_[i].low;
            put(static_cast<std::size_t>(carried), here);
            taken = bits_[static_cast<std::size_t>(carried)] - here;
        }
        return slots;
    }

private:
    std::uint32_t all() const { return (1U << bits_.size()) - 1; }

    void consider(std::size_t slot, std::uint32_t placed, const Filling& tried, int taken,
                  Filling& filling)
    {
        if (slot + 1 == room_.size()) {
            if (placed == all() && taken == 0 && filling.cuts > 0)
                filling = {0, tried.whole, tried.begun};
            return;
        }
        const int cut = tried.begun >= 0 ? 1 : 0;
        const int later = best(slot + 1, placed, taken).cuts;
        if (later + cut < filling.cuts) filling = {later + cut, tried.whole, tried.begun};
    }

    /// Every set of fields from `from` on that fits, those with the first fields first.
    void choose(std::size_t slot, std::uint32_t placed, std::size_t from, std::uint32_t whole,
                int left, Filling& filling)
    {
        if (from < bits_.size()) {
            const bool open = ((placed | whole) >> from & 1) == 0;
            if (open && bits_[from] <= left)
                choose(slot, placed, from + 1, whole | 1U << from, left - bits_[from], filling);
            choose(slot, placed, from + 1, whole, left, filling);
            return;
        }
        consider(slot, placed | whole, {0, whole, -1}, 0, filling);
        if (left == 0) return;
        for (std::size_t field = 0; field < bits_.size(); ++field)
            if (((placed | whole) >> field & 1) == 0 && bits_[field] > left)
                consider(slot, placed | whole | 1U << field, {0, whole, static_cast<int>(field)},
                         bits_[field] - left, filling);
    }

    const std::vector<int>& bits_;
    const std::vector<ir::Slot>& room_;
    std::map<std::tuple<std::size_t, std::uint32_t, int>, Filling> known_;
};

std::vector<std::vector<ir::Slot>> one_after_the_other(const std::vector<int>& bits,
                                                       const std::vector<ir::Slot>& room)
{
    std::vector<std::vector<ir::Slot>> slots(bits.size());
    std::size_t at = 0;
    int left = room[0].bits;
    for (std::size_t field = 0; field < bits.size(); ++field)
        for (int missing = bits[field]; missing > 0;) {
            if (left == 0) left = room[++at].bits;
            const int here = std::min(missing, left);
            left -= here;
            missing -= here;
            slots[field].push_back({room[at].channel, room[at].low + left, here});
        }
    return slots;
}

}  // namespace

std::optional<std::vector<std::vector<ir::Slot>>> lay_out(const std::vector<int>& bits,
                                                          const std::vector<ir::Slot>& room)
{
    int wanted = 0;
    int there = 0;
    for (const int count : bits) wanted += count;
    for (const ir::Slot& slot : room) there += slot.bits;
    if (wanted > there) return std::nullopt;
    if (bits.empty()) return std::vector<std::vector<ir::Slot>>{};
    if (bits.size() <= 14) {
        Search search{bits, room};
        if (search.best(0, 0, 0).cuts < impossible) return search.read();
    }
    return one_after_the_other(bits, room);
}

}  // namespace lobe::analyze
