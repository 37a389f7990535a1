#include "analyze/trade/lookup.h"

#include "analyze/trade/rows.h"
#include "analyze/trade/tally.h"
#include "evaluate/half.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lobe::analyze {
namespace {

constexpr std::size_t least_operations = 64;

enum class Texels : std::uint8_t {
    unorm16,
    half
};

struct Kind {
    std::size_t size = 0;
    Texels texels{};
};
constexpr std::array kinds{Kind{32, Texels::unorm16}, Kind{128, Texels::unorm16},
                           Kind{32, Texels::half}, Kind{128, Texels::half}};

double stored(double value, Texels texels)
{
    if (texels == Texels::half)
        return evaluate::round_to_half(value, evaluate::HalfMode::keep_denormals);
    return std::floor(std::clamp(value, 0.0, 1.0) * 65535 + 0.5) / 65535;
}

/// The texels of one component, row by row.
struct Table {
    std::size_t size = 0;
    std::vector<double> texels;

    /// `u` and `v` in texels, from 0 to size - 1; weights in steps of 1 / `steps`, or exact for 0.
    double at(double u, double v, double steps) const
    {
        const auto last = static_cast<double>(size - 1);
        const auto split = [&](double x) {
            double low = std::clamp(std::floor(x), 0.0, last - 1);
            double weight = x - low;
            if (steps > 0) weight = std::floor(weight * steps + 0.5) / steps;
            return std::pair{static_cast<std::size_t>(low), weight};
        };
        const auto [column, across] = split(u);
        const auto [line, down] = split(v);
        const double* const first = &texels[line * size + column];
        const double* const second = first + size;
        return std::lerp(std::lerp(first[0], first[1], across),
                         std::lerp(second[0], second[1], across), down);
    }
};

class Lookup {
public:
    Lookup(const Yardstick& yardstick, std::size_t size) : yardstick_{yardstick}, size_{size}
    {
        Rows grid{yardstick, size * size};
        for (std::size_t line = 0; line < size; ++line)
            for (std::size_t column = 0; column < size; ++column) {
                const std::size_t row = line * size + column;
                grid.column(0)[row] = place(0, column);
                grid.column(1)[row] = place(1, line);
            }
        grid.settle();
        const std::size_t outputs = yardstick.box().tape.outputs.size();
        for (std::size_t k = 0; k < outputs; ++k) {
            const auto first = grid.exact().begin() + static_cast<std::ptrdiff_t>(k * size * size);
            exact_.push_back({size, {first, first + static_cast<std::ptrdiff_t>(size * size)}});
        }
    }

    bool fits(Texels texels) const
    {
        return std::ranges::all_of(exact_, [texels](const Table& table) {
            return std::ranges::all_of(table.texels, [texels](double value) {
                return texels == Texels::half ? std::abs(value) <= evaluate::largest_half
                                              : 0 <= value && value <= 1;
            });
        });
    }

    Candidate candidate(const std::string& term, Texels texels,
                        const std::vector<Rows>& ground) const
    {
        std::vector<Table> kept = exact_;
        for (Table& table : kept)
            for (double& value : table.texels) value = stored(value, texels);
        Tally model;
        Tally rounding;
        Tally total;
        std::vector<double> real;
        std::vector<double> sampled;
        for (const Rows& rows : ground) {
            sample(rows, exact_, 0, real);
            sample(rows, kept, 256, sampled);
            const Tally::Where where{&rows, true};
            model.add(where, rows.exact(), real);
            rounding.add(where, real, sampled);
            total.add(where, rows.exact(), sampled);
        }
        Candidate out;
        out.choice = {{term, fmt::format("table {0} x {0}, {1}", size_,
                                         texels == Texels::half ? "half" : "unorm 16")}};
        out.spelling = optimize::Spelling::stable;
        out.selectable = false;
        out.note = "two multiply-adds and one filtered sample; not emitted";
        out.model = report(model);
        out.rounding = report(rounding);
        out.total = report(total);
        return out;
    }

private:
    float place(std::size_t coordinate, std::size_t texel) const
    {
        const Coordinate& at = yardstick_.box().coordinates[coordinate];
        const double share = static_cast<double>(texel) / static_cast<double>(size_ - 1);
        return std::clamp(static_cast<float>(std::lerp(double{at.low}, double{at.high}, share)),
                          at.low, at.high);
    }

    void sample(const Rows& rows, const std::vector<Table>& tables, double steps,
                std::vector<double>& results) const
    {
        results.resize(tables.size() * rows.size());
        const auto in_texels = [&](std::size_t coordinate, std::size_t row) {
            const Coordinate& at = yardstick_.box().coordinates[coordinate];
            return (double{rows.column(coordinate)[row]} - at.low) / (double{at.high} - at.low) *
                   static_cast<double>(size_ - 1);
        };
        for (std::size_t row = 0; row < rows.size(); ++row)
            for (std::size_t k = 0; k < tables.size(); ++k)
                results[k * rows.size() + row] =
                    tables[k].at(in_texels(0, row), in_texels(1, row), steps);
    }

    /// Tables have no more digits to ask for.
    static Deviation report(const Tally& tally)
    {
        return tally.report([](const Rows&, std::size_t) { return Confirmed{}; });
    }

    const Yardstick& yardstick_;
    std::size_t size_;
    std::vector<Table> exact_;
};

bool suits(const TradeSubject& subject, const Yardstick& yardstick)
{
    const RadianceBox& box = yardstick.box();
    return !subject.is_model() && !subject.has_geometry() && box.width() == 2 &&
           box.values.size() == 2 && box.tape.code.size() >= least_operations &&
           std::ranges::none_of(box.coordinates, [](const Coordinate& coordinate) {
               return coordinate.whole || !std::isfinite(coordinate.high - coordinate.low);
           });
}

}  // namespace

std::vector<Candidate> lookup_candidates(const TradeSubject& subject, const Yardstick& yardstick,
                                         const ParetoOptions& options)
{
    std::vector<Candidate> out;
    if (!suits(subject, yardstick)) return out;
    const std::vector<Rows> ground = survey(yardstick, options.points, options.cost.jobs);
    for (const Kind& kind : kinds) {
        const Lookup lookup{yardstick, kind.size};
        if (lookup.fits(kind.texels))
            out.push_back(lookup.candidate(subject.name(), kind.texels, ground));
    }
    return out;
}

}  // namespace lobe::analyze
