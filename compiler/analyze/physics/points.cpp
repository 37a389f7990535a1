// Laws about points: light and view may be swapped, and nothing is negative.
#include "analyze/corners/corners.h"
#include "analyze/physics/laws.h"
#include "analyze/physics/settings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::analyze {
namespace {

/// Below this cosine f itself, which is what was emitted over the cosine, says little: a lobe that
/// is left with light at the horizon grows without bound.
constexpr double least_view = 0.02;

struct Pair {
    Vector l, v;
};

Vector above(double cosine, double x, double y)
{
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * x, sine * y, cosine};
}

/// Extremes first, then anywhere.
const std::vector<Pair>& pairs()
{
    static const std::vector<Pair> all = [] {
        std::vector<Pair> out;
        constexpr std::array cosines{1.0, 0.5, 0.1, least_view};
        constexpr std::array<std::array<double, 2>, 3> azimuths{{{1, 0}, {0, 1}, {-1, 0}}};
        for (const double l : cosines)
            for (const double v : cosines)
                for (const auto& azimuth : azimuths)
                    out.push_back({above(l, 1, 0), above(v, azimuth[0], azimuth[1])});
        Random random{0};
        const auto direction = [&random] {
            Vector side = on_sphere(random);
            const double length = std::hypot(side.x, side.y);
            return above(random.between(least_view, 1), side.x / length, side.y / length);
        };
        while (out.size() < 1024) {
            const Vector l = direction();
            out.push_back({l, direction()});
        }
        return out;
    }();
    return all;
}

/// f of both orders of every pair: results over the cosine of the light.
class Swapped {
public:
    Swapped(EmittedFunction& function, const PhysicsSetting& setting)
        : function_(function), batch_(function.inputs().columns())
    {
        EntryInputs::Values values = setting.values;
        for (const Pair& pair : pairs())
            for (const Pair& order : {pair, Pair{pair.v, pair.l}}) {
                function.inputs().place(values, {{}, order.l, order.v});
                batch_.add(values);
                cosines_.push_back(order.l.z);
            }
    }

    std::string run()
    {
        exact_ = function_.exact(batch_);
        return function_.emitted(batch_, emitted_);
    }

    const ResultColumns& exact() const { return exact_; }

    void fill(PhysicsRow& row) const
    {
        const ResultColumns allowed = function_.allowed(batch_);
        const ResultColumns at_floats = function_.exact_at_floats(batch_);
        row.kept = true;
        for (std::size_t k = 0; k < exact_.size(); ++k)
            for (std::size_t i = 0; i < cosines_.size(); i += 2) {
                const auto gap = [&](const ResultColumns& of, bool floats) {
                    const double one = of[k][i] / cosine(i, floats);
                    const double other = of[k][i + 1] / cosine(i + 1, floats);
                    return std::array{std::abs(one - other),
                                      std::max(std::abs(one), std::abs(other))};
                };
                const auto [exact, exact_size] = gap(exact_, false);
                const auto [emitted, emitted_size] = gap(emitted_, true);
                if (exact_size > 0) row.exact = std::max(row.exact, exact / exact_size);
                if (emitted_size > 0) {
                    const double asymmetry = emitted / emitted_size;
                    if (asymmetry > row.value) {
                        row.value = asymmetry;
                        row.where = function_.inputs().describe(batch_.point(i));
                    }
                }
                double may_round = 0, may_move = 0;
                for (const std::size_t at : {i, i + 1}) {
                    may_round += allowed[k][at] / cosine(at, true);
                    may_move += std::abs(exact_[k][at] / cosine(at, false) -
                                         at_floats[k][at] / cosine(at, true));
                }
                // A double operation errs 2^-29 times as much as a float's; twice, as unit
                // vectors are rounded as well.
                row.kept &= exact <= may_round * 0x1p-28 && emitted <= may_round + may_move;
            }
    }

private:
    /// As a float where the shader's was one.
    double cosine(std::size_t at, bool floats) const
    {
        return floats ? static_cast<double>(static_cast<float>(cosines_[at])) : cosines_[at];
    }

    EmittedFunction& function_;
    EmittedFunction::Batch batch_;
    std::vector<double> cosines_;
    ResultColumns exact_;
    ResultColumns emitted_;
};

}  // namespace

std::vector<PhysicsRow> reciprocal_rows(EmittedFunction& function)
{
    std::vector<PhysicsRow> rows;
    ResultColumns defaults;
    const auto add = [&](const PhysicsSetting& setting, bool surface) -> std::string {
        Swapped swapped{function, setting};
        if (std::string why = swapped.run(); !why.empty()) return why;
        if (!surface && swapped.exact() == defaults) return {};  // it does nothing alone
        PhysicsRow& row = rows.emplace_back();
        row.subject = physics_subject(function.name(), setting.text);
        row.law = Law::reciprocal;
        swapped.fill(row);
        return {};
    };
    std::string why;
    for (const PhysicsSetting& setting : surface_settings(function.inputs()))
        if (why.empty()) why = add(setting, true);
    const std::vector<ParameterEnd> ends = parameter_ends(function.inputs());
    if (!ends.empty()) {
        Swapped plain{function, parameters_at_defaults(function.inputs(), ends.front().alone)};
        if (why.empty()) why = plain.run();
        defaults = plain.exact();
    }
    for (const ParameterEnd& end : ends)
        if (why.empty()) why = add(end.alone, false);
    if (!why.empty()) return {failed_row(function.name(), Law::reciprocal, std::move(why))};
    return rows;
}

std::vector<PhysicsRow> positive_rows(EmittedFunction& function)
{
    const Points corners = corner_points(function.inputs(), grid_of(evaluate::Precision::float32));
    EmittedFunction::Batch batch{function.inputs().columns()};
    EntryInputs::Values values(corners.columns.size());
    for (std::size_t point = 0; point < corners.size(); ++point) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = corners.columns[i][point];
        batch.add(values);
    }
    ResultColumns emitted;
    if (std::string why = function.emitted(batch, emitted); !why.empty())
        return {failed_row(function.name(), Law::positive, std::move(why))};
    const ResultColumns exact = function.exact(batch);

    PhysicsRow row;
    row.subject = function.name();
    row.law = Law::positive;
    row.value = HUGE_VAL;
    for (std::size_t k = 0; k < emitted.size(); ++k)
        for (std::size_t at = 0; at < batch.size(); ++at) {
            if (!(emitted[k][at] < row.value)) continue;
            row.value = emitted[k][at];
            row.exact = exact[k][at];
            row.where = function.inputs().describe(batch.point(at));
        }
    row.kept = row.value >= 0;
    if (!row.kept) row.note = "negative";
    return {row};
}

}  // namespace lobe::analyze
