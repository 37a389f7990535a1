#include "analyze/residual/comparison.h"

#include "analyze/heads.h"
#include "analyze/kept_lines.h"
#include "analyze/points.h"
#include "evaluate/bounds.h"
#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::Acceptance;
using evaluate::Interval;
using evaluate::Real;

/// Bits of the exact values: twice those of a double, and some.
constexpr int exact_bits = 113;

/// Intervals of exact values that are wider than this share of the acceptance interval do not tell
/// how far apart they are.
constexpr double wide = 0x1p-10;

bool is_of_scene(const ir::Input& input)
{
    return input.origin == ir::Origin::parameter || input.origin == ir::Origin::surface;
}

/// A light at the very point is in no direction. Formulas that take unit vectors for granted owe
/// each other nothing there: such lights are moved away.
void move_lights_away(const ir::Input& input, std::span<std::vector<float>> coordinates)
{
    if (input.origin != ir::Origin::emitter ||
        input.which != static_cast<std::uint32_t>(ir::EmitterField::to_light))
        return;
    for (std::size_t point = 0; point < coordinates.front().size(); ++point) {
        float squares = 0;
        for (const auto& coordinate : coordinates) squares += coordinate[point] * coordinate[point];
        if (squares < std::numeric_limits<float>::min()) coordinates.back()[point] = 1;
    }
}

/// A material's number reaches a shader as the float next to it: the general function may be given
/// that one, and is meant for the number itself.
Acceptance admitted(const std::optional<double>& constant, float value)
{
    if (!constant || *constant == double{value}) return {value, value, false};
    return {std::min(evaluate::next_down(*constant), double{value}),
            std::max(evaluate::next_up(*constant), double{value}), false};
}

/// The decimal that a constant stands for is next to a double; it is one where that has 15 digits
/// or less, as whole parts below 2^16 and ten binary places have.
Interval enclosed(const std::optional<double>& constant, float value)
{
    if (!constant) return {value, value};
    const double scaled = *constant * 0x1p10;
    if (std::abs(scaled) < 0x1p26 && scaled == std::floor(scaled)) return {*constant, *constant};
    return {evaluate::next_down(*constant), evaluate::next_up(*constant)};
}

double nearest(const std::optional<double>& constant, float value)
{
    return constant.value_or(static_cast<double>(value));
}

Real exact(const std::optional<double>& constant, float value)
{
    return constant ? Real{fmt::format("{}", *constant), exact_bits} : Real{value, exact_bits};
}

bool allows(const Acceptance& allowed, double value)
{
    return allowed.undefined || (allowed.low <= value && value <= allowed.high);
}

/// In shares of the half width; 0 where both are one number, whatever the width.
double share(const Acceptance& allowed, double distance)
{
    if (allowed.undefined || distance == 0) return 0;
    return distance / ((allowed.high - allowed.low) / 2);
}

/// What an interval says of one component, if it is enough.
struct Settled {
    bool is_settled = false;
    double distance = 0;  ///< of the values, at most
};

Settled settled(const Acceptance& allowed, double meant, const Interval& other)
{
    if (allowed.undefined || (other.low == meant && other.high == meant)) return {true, 0};
    const bool is_inside = allowed.low <= other.low && other.high <= allowed.high;
    const bool is_narrow = other.high - other.low <= wide * (allowed.high - allowed.low);
    if (!is_inside || !is_narrow || !std::isfinite(meant)) return {};
    return {true, std::max(std::abs(other.high - meant), std::abs(meant - other.low))};
}

}  // namespace

const std::vector<double>* SceneBox::constant(const ir::Input& input) const
{
    const optimize::Settings* known = is_of_scene(input) ? &constants : nullptr;
    if (input.origin == ir::Origin::emitter && light != nullptr) known = &light->constants;
    if (known == nullptr) return nullptr;
    const auto found = known->find(input.name);
    const auto size = static_cast<std::size_t>(ir::components(input.type));
    return found != known->end() && found->second.size() == size ? &found->second : nullptr;
}

bool SceneBox::is_binary(const ir::Input& input) const
{
    return is_of_scene(input) && called.binary.contains(input.name);
}

ir::Range SceneBox::range(const ir::Input& input) const
{
    const optimize::Limits* known = is_of_scene(input) ? &called.ranges : nullptr;
    if (input.origin == ir::Origin::emitter && light != nullptr) known = &light->ranges;
    const auto found =
        known == nullptr ? optimize::Limits::const_iterator{} : known->find(input.name);
    if (known == nullptr || found == known->end()) return input.range;
    const ir::Range both{std::max(input.range.low, found->second.low),
                         std::min(input.range.high, found->second.high)};
    return both.low <= both.high ? both : input.range;
}

void Disagreement::add(const Disagreement& more)
{
    outside += more.outside;
    device_outside += more.device_outside;
    worst = std::max(worst, more.worst);
}

Comparison::Comparison(const ir::Module& general, const ir::Function& meant,
                       const ir::Module& residual, const ir::Function& other, const SceneBox& box,
                       std::size_t points)
{
    ir::Function probe = meant;
    for (const ir::Input& input : other.inputs)
        if (std::ranges::count(probe.inputs, input.name, &ir::Input::name) == 0)
            probe.inputs.push_back(input);
    for (ir::Input& input : probe.inputs) input.range = box.range(input);
    Points chosen = analyze::points(general, probe, points);

    std::size_t column = 0;
    for (const ir::Input& input : probe.inputs) {
        move_lights_away(input, std::span{chosen.columns}.subspan(
                                    column, static_cast<std::size_t>(ir::components(input.type))));
        const std::vector<double>* constant = box.constant(input);
        for (int k = 0; k < ir::components(input.type); ++k, ++column) {
            std::vector<float>& values = chosen.columns[column];
            columns_.push_back({chosen.names[column], {}});
            if (constant != nullptr) {
                const double value = (*constant)[static_cast<std::size_t>(k)];
                columns_.back().constant = value;
                std::ranges::fill(values, static_cast<float>(value));
            } else if (box.is_binary(input)) {
                for (float& value : values) value = value > 0.5F ? 1.0F : 0.0F;
            }
        }
    }
    values_ = std::move(chosen.columns);
    general_ = side_of(general, meant);
    other_ = side_of(residual, other);
}

Comparison::Side Comparison::side_of(const ir::Module& module, const ir::Function& entry) const
{
    Side side{evaluate::compile(module, entry), {}};
    for (const evaluate::TapeInput& input : side.tape.inputs)
        side.columns.push_back(static_cast<std::size_t>(
            std::ranges::find(columns_, input.name, &Column::name) - columns_.begin()));
    return side;
}

std::string Comparison::key() const
{
    std::string key = evaluate::dump(general_.tape) + evaluate::dump(other_.tape);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const auto [low, high] = std::ranges::minmax(values_[i]);
        write_line(key, columns_[i].name, low, high, columns_[i].constant.value_or(low));
    }
    write_line(key, points());
    return key;
}

EmittedFunction::Batch Comparison::inputs_of_other() const
{
    EmittedFunction::Batch batch{other_.columns.size()};
    EntryInputs::Values values(other_.columns.size());
    for (std::size_t point = 0; point < points(); ++point) {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = values_[other_.columns[i]][point];
        batch.add(values);
    }
    return batch;
}

template <class Number, class Make>
std::vector<std::vector<Number>> Comparison::slice(const Side& side, std::size_t first,
                                                   std::size_t size, const Make& make) const
{
    std::vector<std::vector<Number>> result;
    for (const std::size_t column : side.columns) {
        auto& values = result.emplace_back();
        values.reserve(size);
        for (std::size_t i = 0; i < size; ++i)
            values.push_back(make(columns_[column].constant, values_[column][first + i]));
    }
    return result;
}

template <class Number, class Make, class Run>
std::vector<std::vector<Number>> Comparison::run(const Side& side, std::size_t first,
                                                 std::size_t size, const Make& make,
                                                 const Run& run) const
{
    const auto in = slice<Number>(side, first, size, make);
    std::vector<std::vector<Number>> out(side.tape.outputs.size(), std::vector<Number>(size));
    run(side.tape, heads(in), heads(out));
    return out;
}

std::vector<double> Comparison::exactly(const Side& side, std::size_t point) const
{
    const auto in = slice<Real>(side, point, 1, exact);
    std::vector<std::vector<Real>> out(side.tape.outputs.size(), {Real{exact_bits}});
    evaluate::run_real(side.tape, exact_bits, heads(in), heads(out), 1);
    std::vector<double> result;
    for (const auto& column : out) result.push_back(column.front().to_double());
    return result;
}

Disagreement Comparison::count(std::size_t first, std::size_t size,
                               const ResultColumns& device) const
{
    const auto allowed = run<Acceptance>(
        general_, first, size, admitted,
        [&](const evaluate::Tape& tape, const auto& in, const auto& out) {
            evaluate::run_acceptance(tape, evaluate::Precision::float32, in, out, size);
        });
    const auto meant =
        run<double>(general_, first, size, nearest,
                    [&](const evaluate::Tape& tape, const auto& in, const auto& out) {
                        evaluate::run(tape, evaluate::Columns<double>{in},
                                      evaluate::Results<double>{out}, size);
                    });
    const auto other =
        run<Interval>(other_, first, size, enclosed,
                      [&](const evaluate::Tape& tape, const auto& in, const auto& out) {
                          evaluate::run(tape, evaluate::Columns<Interval>{in},
                                        evaluate::Results<Interval>{out}, size);
                      });

    Disagreement result;
    for (std::size_t i = 0; i < size; ++i) {
        bool is_settled = true;
        bool device_outside = false;
        double worst = 0;
        for (std::size_t k = 0; k < allowed.size(); ++k) {
            const Settled known = settled(allowed[k][i], meant[k][i], other[k][i]);
            is_settled = is_settled && known.is_settled;
            worst = std::max(worst, share(allowed[k][i], known.distance));
            if (!device.empty()) device_outside |= !allows(allowed[k][i], device[k][first + i]);
        }
        result.device_outside += device_outside;
        if (!is_settled) {
            const std::vector<double> general = exactly(general_, first + i);
            const std::vector<double> values = exactly(other_, first + i);
            bool outside = false;
            worst = 0;
            for (std::size_t k = 0; k < allowed.size(); ++k) {
                outside |= !allows(allowed[k][i], values[k]);
                worst = std::max(worst, share(allowed[k][i], std::abs(values[k] - general[k])));
            }
            result.outside += outside;
        }
        result.worst = std::max(result.worst, worst);
    }
    return result;
}

}  // namespace lobe::analyze
