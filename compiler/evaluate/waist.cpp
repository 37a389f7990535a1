#include "evaluate/waist.h"

#include <algorithm>
#include <map>
#include <utility>

namespace lobe::evaluate {
namespace {

constexpr std::uint32_t nowhere = ~std::uint32_t{0};

using Waist = std::vector<std::uint32_t>;

std::size_t arity(const RoundingNode& node) { return static_cast<std::size_t>(node.arity); }

/// How far each is from the output.
std::vector<std::size_t> heights(const RoundingTape& tape)
{
    std::vector<std::size_t> height(tape.nodes.size());
    for (auto i = static_cast<std::uint32_t>(tape.nodes.size()); i-- > 0;)
        for (std::size_t k = 0; k < arity(tape.nodes[i]); ++k) {
            std::size_t& operand = height[tape.nodes[i].operands[k]];
            operand = std::max(operand, height[i] + 1);
        }
    return height;
}

class Search {
public:
    explicit Search(const RoundingTape& tape) : tape_{tape}, height_{heights(tape)}
    {
        for (std::uint32_t i = 0; i + 1 < tape.nodes.size(); ++i)
            if (tape.nodes[i].kind == RoundingNode::Kind::operation) order_.push_back(i);
    }

    std::vector<Waist> take()
    {
        walk();
        // The components of a vector come together, wherever the tape has them.
        std::ranges::stable_sort(order_, std::ranges::greater{},
                                 [&](std::uint32_t node) { return height_[node]; });
        walk();
        std::ranges::stable_sort(found_, {}, &Waist::size);
        return std::move(found_);
    }

private:
    /// What is alive after each operation, where it is less than the inputs: of each size the first
    /// set and the last, and all behind which everything is nearer to the output.
    void walk()
    {
        std::vector<std::size_t> uses(tape_.nodes.size());  // that are left
        Waist alive;
        for (std::uint32_t i = 0; i < tape_.nodes.size(); ++i) {
            // An input counts as alive from the start, wherever its node stands.
            if (tape_.nodes[i].kind == RoundingNode::Kind::input) alive.push_back(i);
            for (std::size_t k = 0; k < arity(tape_.nodes[i]); ++k)
                ++uses[tape_.nodes[i].operands[k]];
        }
        const std::size_t inputs = alive.size();
        std::map<std::size_t, std::pair<Waist, Waist>> by_size;
        for (std::size_t at = 0; at < order_.size(); ++at) {
            const std::uint32_t node = order_[at];
            for (std::size_t k = 0; k < arity(tape_.nodes[node]); ++k)
                --uses[tape_.nodes[node].operands[k]];
            alive.push_back(node);
            std::erase_if(alive, [&](std::uint32_t each) { return uses[each] == 0; });
            if (alive.size() >= inputs) continue;
            Waist waist = alive;
            std::ranges::sort(waist);
            by_size.try_emplace(waist.size(), waist, waist).first->second.second = waist;
            if (at + 1 < order_.size() && height_[order_[at + 1]] < height_[node]) add(waist);
        }
        for (const auto& [size, ends] : by_size) {
            add(ends.first);
            add(ends.second);
        }
    }

    void add(const Waist& waist)
    {
        // A condition is no number, and has no middle.
        const bool has_condition = std::ranges::any_of(waist, [&](std::uint32_t each) {
            const RoundingNode& node = tape_.nodes[each];
            return node.kind == RoundingNode::Kind::operation && makes_condition(node.op);
        });
        if (!has_condition && std::ranges::find(found_, waist) == found_.end())
            found_.push_back(waist);
    }

    const RoundingTape& tape_;
    std::vector<std::size_t> height_;
    std::vector<std::uint32_t> order_;
    std::vector<Waist> found_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> waists(const RoundingTape& tape)
{
    return Search{tape}.take();
}

RoundingTape behind(const RoundingTape& tape, const std::vector<std::uint32_t>& waist)
{
    // What the output needs, down to the waist.
    std::vector<bool> wanted(tape.nodes.size());
    wanted.back() = true;
    const auto is_waist = [&](std::uint32_t node) {
        return std::ranges::binary_search(waist, node);
    };
    for (std::uint32_t i = static_cast<std::uint32_t>(tape.nodes.size()); i-- > 0;)
        if (wanted[i] && !is_waist(i))
            for (int k = 0; k < tape.nodes[i].arity; ++k)
                wanted[tape.nodes[i].operands[static_cast<std::size_t>(k)]] = true;

    RoundingTape out;
    std::vector<std::uint32_t> now(tape.nodes.size(), nowhere);
    for (std::uint32_t i = 0; i < tape.nodes.size(); ++i) {
        const auto place = std::ranges::lower_bound(waist, i);
        const bool starts = place != waist.end() && *place == i;
        if (!starts && !wanted[i]) continue;
        RoundingNode node;
        if (starts) {
            node.kind = RoundingNode::Kind::input;
            node.input = static_cast<std::uint32_t>(place - waist.begin());
        } else {
            node = tape.nodes[i];
            for (int k = 0; k < node.arity; ++k) {
                auto& operand = node.operands[static_cast<std::size_t>(k)];
                operand = now[operand];
            }
            // What a value was compared with may be out of sight.
            for (Limit& limit : node.limits) limit.other = now[limit.other];
            std::erase_if(node.limits, [](const Limit& limit) { return limit.other == nowhere; });
        }
        now[i] = static_cast<std::uint32_t>(out.nodes.size());
        out.nodes.push_back(std::move(node));
    }
    return out;
}

}  // namespace lobe::evaluate
