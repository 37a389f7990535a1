#include "analyze/corners/continuity_boundaries.h"

#include "analyze/random.h"
#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lobe::analyze {
namespace {

using Values = EntryInputs::Values;

/// Settings of the values per pair of directions.
constexpr std::size_t settings = 24;

/// Light and view on a boundary, and how they move across it: to first order as unit vectors do,
/// which is all that a limit sees.
struct Way {
    Directional at;
    Vector l, v;  ///< what a distance of 1 adds
};

constexpr Vector up{0, 0, 1};
constexpr Vector none{0, 0, 0};

Vector operator-(const Vector& a) { return {-a.x, -a.y, -a.z}; }

Way way(const Vector& l, const Vector& v, const Vector& move_l, const Vector& move_v = none)
{
    return {{{}, l, v}, move_l, move_v};
}

/// What is left of a move that turns a direction and does not stretch it: at l = -v the half vector
/// is all that remains, and would be the stretching.
Vector turning(const Vector& direction, const Vector& move)
{
    const double along = direction.x * move.x + direction.y * move.y + direction.z * move.z;
    return {move.x - along * direction.x, move.y - along * direction.y,
            move.z - along * direction.z};
}

/// Above the horizon, in general and special position; unit vectors by Pythagoras.
constexpr std::array some_directions{Vector{0, 0, 1},
                                     Vector{.6, 0, .8},
                                     Vector{0, .8, .6},
                                     Vector{-.6, 0, .8},
                                     Vector{.48, .64, .6},
                                     Vector{-.8, 0, .6},
                                     Vector{2. / 3, 2. / 3, 1. / 3}};
/// On the horizon.
constexpr std::array horizon{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{-.6, .8, 0}};

/// By name, so that equal names are one boundary.
struct NamedWays {
    const char* name;
    std::vector<Way> ways;
};

std::vector<NamedWays> geometry_ways()
{
    std::vector<NamedWays> out;
    const auto add = [&out](const char* name) -> std::vector<Way>& {
        return out.emplace_back(NamedWays{name, {}}).ways;
    };
    auto& light = add("n.l = 0");
    for (const Vector& l : horizon)
        for (const Vector& v : some_directions) light.push_back(way(l, v, up));
    auto& view = add("n.v = 0");
    for (const Vector& v : horizon)
        for (const Vector& l : some_directions) view.push_back(way(l, v, none, up));
    auto& both = add("n.l = n.v = 0");
    for (const Vector& v : horizon) both.push_back(way({1, 0, 0}, v, up, up));
    // v.l = 0 exactly needs axes; the normal is what is in general position.
    auto& across = add("v.l = 0");
    for (const Vector& n : {Vector{.6, .48, .64}, Vector{.48, .6, .64}, Vector{.64, .6, .48},
                            Vector{1. / 3, 2. / 3, 2. / 3}, Vector{.8, .6, 0}}) {
        Way turned = way({0, 1, 0}, {1, 0, 0}, {1, 0, 0});
        turned.at.basis = {{}, {}, n};
        // A tangent frame to go with it.
        const double side = std::sqrt(n.x * n.x + n.y * n.y);
        turned.at.basis.x = {-n.y / side, n.x / side, 0};
        turned.at.basis.y = {-n.z * n.x / side, -n.z * n.y / side, side};
        across.push_back(turned);
    }
    auto& half = add("n.h = 0");
    for (const Vector& l : some_directions)
        for (const Vector& side : {Vector{l.y, l.x, -l.z}, Vector{-l.y, l.x, -l.z}})
            if (l.z < 1) half.push_back(way(l, side, up));
    auto& equal = add("l = v");
    auto& opposed = add("l = -v");
    auto& mirrored = add("h = n");
    for (const Vector& l : some_directions)
        for (const Vector& move : {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{.48, .64, -.6}}) {
            equal.push_back(way(l, l, none, turning(l, move)));
            opposed.push_back(way(l, -l, none, turning(l, move)));
            const Vector mirror{-l.x, -l.y, l.z};
            mirrored.push_back(way(l, mirror, none, turning(mirror, move)));
        }
    for (const Vector& l : horizon) opposed.push_back(way(l, -l, none, up));
    auto& light_up = add("l = n");
    auto& view_up = add("v = n");
    for (const Vector& other : some_directions) {
        light_up.push_back(way(up, other, {1, 0, 0}));
        view_up.push_back(way(other, up, none, {1, 0, 0}));
    }
    return out;
}

/// Where values are crossed: in general position, and where bases of powers are 0.
std::vector<Directional> places()
{
    std::vector<Directional> out;
    for (const NamedWays& named : geometry_ways()) out.push_back(named.ways.front().at);
    for (const Vector& v : {Vector{.48, .64, .6}, Vector{0, .8, .6}})
        out.push_back({{}, {.6, 0, .8}, v});
    // l = v, l = -v and h = n away from the normal.
    out.push_back({{}, {.6, 0, .8}, {.6, 0, .8}});
    out.push_back({{}, {.6, 0, .8}, {-.6, 0, -.8}});
    out.push_back({{}, {.6, 0, .8}, {-.6, 0, .8}});
    return out;
}

class BoundaryBuilder {
public:
    BoundaryBuilder(const ir::Module& module, const EntryInputs& inputs, Parameters parameters)
        : module_(module), inputs_(inputs), parameters_(parameters)
    {
    }

    std::vector<Boundary> build()
    {
        if (inputs_.has_geometry())
            for (const NamedWays& named : geometry_ways()) add_geometry(named);
        for (const EntryInputs::Value& value : inputs_.values()) add_value(value);
        return std::move(out_);
    }

private:
    void add_geometry(const NamedWays& named)
    {
        Boundary& boundary = out_.emplace_back(Boundary{named.name, {}});
        for (const Way& one : named.ways)
            for (std::size_t i = 0; i < settings; ++i) {
                Crossing crossing;
                crossing.at = setting(i);
                inputs_.place(crossing.at, one.at);
                crossing.direction.assign(inputs_.columns(), 0);
                put(crossing.direction, ir::GeometryField::l, one.l);
                put(crossing.direction, ir::GeometryField::v, one.v);
                boundary.crossings.push_back(std::move(crossing));
            }
    }

    /// The ends of a value and its neutral one.
    void add_value(const EntryInputs::Value& value)
    {
        const Scalar& scalar = inputs_.scalars()[value.first];
        if (scalar.whole || scalar.low == scalar.high) return;
        const double neutral = scalar.neutral;
        add_crossings(value, scalar.low, scalar);
        if (scalar.low < neutral && neutral < scalar.high) add_crossings(value, neutral, scalar);
        add_crossings(value, scalar.high, scalar);
    }

    void add_crossings(const EntryInputs::Value& value, double at, const Scalar& scalar)
    {
        // An unbounded range has no end to come near to.
        if (std::abs(at) > 0x1p64) return;
        const double below = at - scalar.low;
        const double above = scalar.high - at;
        const double step =
            below > 0 && above > 0 ? std::min(below, above) : std::max(below, above);
        Boundary& boundary = out_.emplace_back(Boundary{name_of(value, at), {}, &value});
        const std::vector<Directional> where =
            inputs_.has_geometry() ? places() : std::vector<Directional>(1);
        for (const Directional& directions : where)
            for (std::size_t i = 0; i < settings; ++i) {
                Crossing crossing;
                crossing.at = setting(i);
                inputs_.place(crossing.at, directions);
                EntryInputs::set(crossing.at, value, at);
                crossing.direction.assign(inputs_.columns(), 0);
                EntryInputs::set(crossing.direction, value, std::min(step, 0x1p64));
                crossing.before = below > 0;
                crossing.after = above > 0;
                boundary.crossings.push_back(std::move(crossing));
            }
    }

    std::string name_of(const EntryInputs::Value& value, double at) const
    {
        const std::string plain = fmt::format("{} = {}", value.name, at);
        if (!value.parameter) return plain;
        for (const ir::Effect& effect : module_.effects) {
            const ir::Function& condition = module_[effect.off_when];
            if (condition.find_input(ir::Origin::parameter, value.which) &&
                is_off(condition, value, at))
                return fmt::format("effect \"{}\" on/off, {}", effect.name, plain);
        }
        return plain;
    }

    /// Whether an effect is off for this value of a parameter, the others being at their defaults.
    bool is_off(const ir::Function& condition, const EntryInputs::Value& value, double at) const
    {
        const evaluate::Tape tape = evaluate::compile(module_, condition);
        std::vector<double> values;
        for (const evaluate::TapeInput& input : tape.inputs) {
            const std::uint32_t which = condition.inputs[input.input].which;
            values.push_back(which == value.which
                                 ? at
                                 : module_.parameters[which]
                                       .default_value[static_cast<std::size_t>(input.component)]);
        }
        std::vector<const double*> columns;
        for (const double& one : values) columns.push_back(&one);
        double result = 0;
        const std::array<double*, 1> outputs{&result};
        evaluate::run(tape, evaluate::Columns<double>{columns}, evaluate::Results<double>{outputs},
                      1);
        return result != 0;
    }

    /// All neutral, all low, all high, then mixed; of parameters only where they may be anywhere.
    Values setting(std::size_t index) const
    {
        Values values = inputs_.neutral();
        Random random{index};
        for (const EntryInputs::Value& value : inputs_.values()) {
            const Scalar& scalar = inputs_.scalars()[value.first];
            if (value.parameter && parameters_ == Parameters::at_defaults) continue;
            const std::array choices{scalar.neutral, scalar.low, scalar.high,
                                     scalar.low + 0.625 * (scalar.high - scalar.low)};
            const std::uint32_t choice =
                index < 3 ? static_cast<std::uint32_t>(index) : random.below(4);
            EntryInputs::set(values, value, choices[choice]);
        }
        return values;
    }

    void put(Values& values, ir::GeometryField field, const Vector& vector) const
    {
        const auto column = inputs_.find(field);
        if (!column) return;
        values[*column] = vector.x;
        values[*column + 1] = vector.y;
        values[*column + 2] = vector.z;
    }

    const ir::Module& module_;
    const EntryInputs& inputs_;
    Parameters parameters_;
    std::vector<Boundary> out_;
};

}  // namespace

std::vector<Boundary> boundaries(const ir::Module& module, const EntryInputs& inputs,
                                 Parameters parameters)
{
    return BoundaryBuilder{module, inputs, parameters}.build();
}

}  // namespace lobe::analyze
