// The points of the corner suite: directions and values, each at and next to their boundaries.
#include "analyze/corners/corners.h"
#include "analyze/corners/directions.h"
#include "analyze/corners/fields.h"
#include "analyze/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

constexpr std::size_t most_combinations = 1024;
constexpr std::size_t mixed_points = 8192;

using Value = EntryInputs::Value;
using Values = EntryInputs::Values;

class CornerBuilder {
public:
    CornerBuilder(const EntryInputs& inputs, const Grid& grid)
        : inputs_(inputs), grid_(grid), scalars_(inputs.scalars())
    {
        out_.names = inputs.names();
        out_.columns.resize(inputs.columns());
        for (const Scalar& scalar : scalars_) specials_.push_back(specials(scalar));
        if (inputs.has_geometry()) {
            all_ = corner_directions();
            core_ = core_directions();
        } else {
            all_ = core_ = {Directional{{}, {0, 0, 1}, {0, 0, 1}}};
        }
    }

    Points build(std::span<const NamedBox> open)
    {
        for (const Values& values : {inputs_.neutral(), ends(false), ends(true)})
            add_all(all_, values);
        if (!inputs_.values().empty()) {
            for (const Values& values : one_at_a_time()) add_all(core_, values);
            add_combinations();
            add_mixed();
            for (const NamedBox& box : open) add_box(box);
        }
        return std::move(out_);
    }

private:
    /// Ends, what is next to them and to the neutral value, and where exponents end.
    std::vector<double> specials(const Scalar& scalar) const
    {
        const double step = scalar.whole ? 1 : 0;
        const auto above = [&](double x) { return step > 0 ? x + step : next_above(x, grid_); };
        const auto below = [&](double x) { return step > 0 ? x - step : next_below(x, grid_); };
        std::vector<double> values{scalar.low,
                                   above(scalar.low),
                                   below(scalar.high),
                                   scalar.high,
                                   scalar.neutral,
                                   below(scalar.neutral),
                                   above(scalar.neutral),
                                   0,
                                   1};
        if (!scalar.whole)
            for (const double value : {grid_.least, -grid_.least, grid_.least_normal, 0.5,
                                       scalar.low / 2 + scalar.high / 2})
                values.push_back(value);
        std::vector<double> inside;
        for (double value : values) {
            if (scalar.whole) value = std::floor(value);
            if (scalar.contains(value) && std::ranges::find(inside, value) == inside.end())
                inside.push_back(value);
        }
        return inside;
    }

    Values ends(bool high) const
    {
        Values values;
        for (const Scalar& scalar : scalars_) values.push_back(high ? scalar.high : scalar.low);
        return values;
    }

    /// Every special value of every input, of all its components and of each alone, with the
    /// others at neutral values.
    std::vector<Values> one_at_a_time() const
    {
        std::vector<Values> out;
        for (const Value& input : inputs_.values())
            for (const double special : specials_[input.first]) {
                Values values = inputs_.neutral();
                EntryInputs::set(values, input, special);
                out.push_back(values);
                for (std::size_t k = 0; input.size > 1 && k < input.size; ++k) {
                    values = inputs_.neutral();
                    values[input.first + k] = special;
                    out.push_back(std::move(values));
                }
            }
        return out;
    }

    /// Combinations of the ends of all inputs, each with some of the core directions, the other
    /// inputs' own neighbors at every second one.
    void add_combinations()
    {
        const std::vector<Value>& inputs = inputs_.values();
        const std::size_t count = inputs.size();
        const bool all = count <= 10;
        const std::size_t combinations = all ? std::size_t{1} << count : most_combinations;
        const std::size_t turns = std::min<std::size_t>(core_.size(), all && count < 6 ? 72 : 16);
        std::size_t next = 0;
        for (std::size_t i = 0; i < combinations; ++i) {
            // Random patterns: each of the 8 of any three inputs is missing from all of them
            // with a probability of (7/8)^1024.
            Random random{i};
            Values values(scalars_.size());
            for (std::size_t k = 0; k < count; ++k) {
                const bool high = all ? (i >> k & 1) != 0 : random.coin();
                for (std::size_t c = inputs[k].first; c < inputs[k].first + inputs[k].size; ++c)
                    values[c] = high ? scalars_[c].high : scalars_[c].low;
            }
            for (std::size_t turn = 0; turn < turns; ++turn) {
                Values at = values;
                if (turn % 2 == 1)
                    for (std::size_t c = 0; c < at.size(); ++c)
                        at[c] =
                            specials_[c][at[c] == scalars_[c].low ? inner_low(c) : inner_high(c)];
                add(core_[next++ % core_.size()], at);
            }
        }
    }

    std::size_t inner_low(std::size_t column) const
    {
        return std::min<std::size_t>(1, specials_[column].size() - 1);
    }
    std::size_t inner_high(std::size_t column) const
    {
        return std::min<std::size_t>(2, specials_[column].size() - 1);
    }

    /// Special values of everything, at random.
    void add_mixed()
    {
        for (std::size_t i = 0; i < mixed_points; ++i) {
            Random random{i + most_combinations};
            Values values;
            for (const std::vector<double>& special : specials_)
                values.push_back(special[random.below(static_cast<std::uint32_t>(special.size()))]);
            add(all_[random.below(static_cast<std::uint32_t>(all_.size()))], values);
        }
    }

    /// Ends and middles of the sides that the entry point has inputs for, with directions whose
    /// fields may be in the others; where none are, with the core ones.
    void add_box(const NamedBox& box)
    {
        constexpr std::size_t most = 81;
        const std::vector<Directional> directions = directions_in(box);
        for (std::size_t i = 0; i < most; ++i) {
            Random random{i};
            Values values = inputs_.neutral();
            for (const auto& [name, side] : box.sides)
                for (std::size_t c = 0; c < values.size(); ++c) {
                    if (inputs_.names()[c] != name) continue;
                    const double low = std::max(side.low, scalars_[c].low);
                    const double high = std::min(side.high, scalars_[c].high);
                    const std::array choices{low, low / 2 + high / 2, high};
                    values[c] = choices[random.below(3)];
                }
            add_all(directions, values);
        }
    }

    std::vector<Directional> directions_in(const NamedBox& box) const
    {
        Points candidates;
        candidates.names = inputs_.names();
        candidates.columns.resize(inputs_.columns());
        for (const Directional& at : all_) {
            Values values = inputs_.neutral();
            inputs_.place(values, at);
            for (std::size_t i = 0; i < values.size(); ++i)
                candidates.columns[i].push_back(to_grid(values[i], grid_.precision));
            candidates.cases.emplace_back();
        }
        NamedBox fields;
        for (const auto& side : box.sides)
            if (std::ranges::find(inputs_.fields(), side.first, &EntryInputs::Field::name) !=
                inputs_.fields().end())
                fields.sides.push_back(side);
        const std::vector<bool> is_in =
            inside(inputs_, candidates, grid_.precision, fields, Inside::possibly);
        std::vector<Directional> found;
        for (std::size_t i = 0; i < all_.size(); ++i)
            if (is_in[i]) found.push_back(all_[i]);
        if (found.empty()) return core_;
        // As many as the core ones, spread over all that were found.
        const std::size_t step = (found.size() + core_.size() - 1) / core_.size();
        std::vector<Directional> some;
        for (std::size_t i = 0; i < found.size(); i += step) some.push_back(found[i]);
        return some;
    }

    void add_all(const std::vector<Directional>& directions, const Values& values)
    {
        for (const Directional& at : directions) add(at, values);
    }

    void add(const Directional& at, Values values)
    {
        inputs_.place(values, at);
        for (std::size_t i = 0; i < values.size(); ++i)
            out_.columns[i].push_back(to_grid(values[i], grid_.precision));
        out_.cases.emplace_back();
    }

    const EntryInputs& inputs_;
    const Grid& grid_;
    const std::vector<Scalar>& scalars_;
    std::vector<std::vector<double>> specials_;  ///< per column; low, next, before high, high …
    std::vector<Directional> all_;
    std::vector<Directional> core_;
    Points out_;
};

}  // namespace

Points corner_points(const EntryInputs& inputs, const Grid& grid, std::span<const NamedBox> open)
{
    return CornerBuilder{inputs, grid}.build(open);
}

}  // namespace lobe::analyze
