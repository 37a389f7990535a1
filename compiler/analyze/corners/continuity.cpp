#include "analyze/corners/continuity.h"

#include "analyze/corners/continuity_boundaries.h"
#include "analyze/heads.h"
#include "analyze/kept_lines.h"
#include "analyze/tasks.h"
#include "evaluate/run.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

namespace lobe::analyze {
namespace {

using Values = EntryInputs::Values;

/// Distances of 2^-k along a way.
constexpr int farthest = 2;
constexpr int nearest = 96;
constexpr int stride = 2;

/// Double looks from here; what it cannot tell from a jump goes on to MPFR.
constexpr int near = 48;
/// A difference below this part of the greatest value is no jump: it is what a slope of 2^8 leaves
/// at that distance, and the roundings of double.
constexpr double visible = 0x1p-40;

/// Many points at once, in double; the greatest component counts.
class Sampler {
public:
    explicit Sampler(const evaluate::Tape& tape) : tape_(tape), columns_(tape.inputs.size()) {}

    void clear()
    {
        for (auto& column : columns_) column.clear();
    }
    void add(const Crossing& crossing, double distance)
    {
        for (std::size_t i = 0; i < columns_.size(); ++i)
            columns_[i].push_back(crossing.at[i] + distance * crossing.direction[i]);
    }
    void run()
    {
        size_ = columns_.empty() ? 1 : columns_.front().size();
        results_.assign(tape_.outputs.size(), std::vector<double>(size_));
        evaluate::run(tape_, evaluate::Columns<double>{heads(columns_)},
                      evaluate::Results<double>{heads(results_)}, size_);
    }
    double difference(std::size_t a, std::size_t b) const
    {
        double greatest = 0;
        for (const auto& result : results_) {
            if (result[a] == result[b]) continue;
            const double gap = std::abs(result[a] - result[b]);
            greatest = std::isnan(gap) ? HUGE_VAL : std::max(greatest, gap);
        }
        return greatest;
    }
    double size(std::size_t at) const
    {
        double greatest = 0;
        for (const auto& result : results_)
            if (std::isfinite(result[at])) greatest = std::max(greatest, std::abs(result[at]));
        return greatest;
    }

private:
    const evaluate::Tape& tape_;
    std::vector<std::vector<double>> columns_;
    std::vector<std::vector<double>> results_;
    std::size_t size_ = 0;
};

/// What double sees of one crossing.
struct Glance {
    double gap = 0;    ///< of both sides and the boundary, near it
    double spike = 0;  ///< greatest change on the way that does not fall
    double scale = 0;  ///< greatest magnitude met
    bool flat = true;  ///< nothing changes at all
};

class FunctionContinuity {
public:
    FunctionContinuity(const ir::Module& module, ir::FunctionId function)
        : module_(module), inputs_(module, function, grid_of(evaluate::Precision::float32)),
          tape_(evaluate::compile(module, inputs_.entry())), sampler_(tape_)
    {
    }

    /// All that the rows depend on.
    std::string key() const
    {
        std::string key = "continuity 3\n" + inputs_.entry().name + "\n" + evaluate::dump(tape_);
        for (const Scalar& scalar : inputs_.scalars())
            write_line(key, scalar.low, scalar.high, scalar.neutral, scalar.parameter);
        for (const ir::Effect& effect : module_.effects)
            write_line(key, effect.name, effect.condition);
        return key;
    }

    std::string rows()
    {
        std::string text;
        const bool parameters =
            std::ranges::any_of(inputs_.values(), &EntryInputs::Value::parameter);
        for (const Boundary& boundary : boundaries(module_, inputs_, Parameters::at_defaults))
            if (!parameters || boundary.value == nullptr)
                add_row(text, boundary, Parameters::at_defaults, "");
        if (!parameters) return text;
        for (const Boundary& boundary : boundaries(module_, inputs_, Parameters::anywhere))
            add_row(text, boundary, Parameters::anywhere,
                    boundary.value == nullptr ? ", any parameters" : "");
        return text;
    }

    static void read(std::string_view text, std::vector<Continuity>& out)
    {
        for (LineReader reader{text}; !reader.done();) {
            Continuity& row = out.emplace_back();
            reader(row.function);
            reader(row.across);
            reader(row.jump);
            reader(row.scale);
            reader(row.continuous);
            reader(row.at);
        }
    }

private:
    void add_row(std::string& text, const Boundary& boundary, Parameters parameters,
                 std::string_view suffix)
    {
        const std::vector<Glance> glances = look(boundary.crossings);
        if (std::ranges::all_of(glances, &Glance::flat)) return;
        double scale = 0;
        for (const Glance& glance : glances) scale = std::max(scale, glance.scale);
        const auto widest = std::ranges::max_element(glances, {}, &Glance::gap);
        const auto sharpest = std::ranges::max_element(glances, {}, &Glance::spike);
        const auto crossing_of = [&](auto glance) {
            return boundary.crossings[static_cast<std::size_t>(glance - glances.begin())];
        };

        Limits found;
        std::optional<Crossing> where;
        const auto try_crossing = [&](const Crossing& crossing) {
            const Limits limit = limits(tape_, crossing);
            if (limit.jump <= std::max(found.jump, visible * std::max(scale, limit.scale))) return;
            found = limit;
            where = crossing;
        };
        if (widest->gap > visible * scale)
            try_crossing(climb(crossing_of(widest), boundary.value, parameters));
        if (sharpest->spike > visible * scale) try_crossing(crossing_of(sharpest));

        std::string at;
        if (where) {
            at = inputs_.describe(where->at);
            scale = std::max(scale, found.scale);
            if (found.distance != 0)
                at += fmt::format("; a guard switches {:.4g} away", std::abs(found.distance));
            if (found.within != 0) at += fmt::format("; a ramp within {:.2g}", found.within);
        }
        write_line(text, inputs_.entry().name, fmt::format("{}{}", boundary.name, suffix),
                   found.jump, scale, found.jump == 0, at);
    }

    std::vector<Glance> look(const std::vector<Crossing>& crossings)
    {
        sampler_.clear();
        for (const Crossing& crossing : crossings) {
            add_look(crossing);
            for (const double side : {1.0, -1.0})
                for (int k = farthest; k <= nearest; k += stride) add(crossing, side, k);
        }
        sampler_.run();
        constexpr std::size_t along = (nearest - farthest) / stride + 1;
        std::vector<Glance> out(crossings.size());
        for (std::size_t i = 0; i < crossings.size(); ++i) {
            const std::size_t at = i * (2 * along + look_points);
            Glance& glance = out[i];
            glance.gap = gap_at(at);
            glance.flat = glance.gap == 0;
            for (const std::size_t side : {at + look_points, at + look_points + along}) {
                double previous = HUGE_VAL;
                for (std::size_t k = side; k + 1 < side + along; ++k) {
                    const double change = sampler_.difference(k, k + 1);
                    glance.flat &= change == 0;
                    glance.scale = std::max(glance.scale, sampler_.size(k));
                    if (change >= previous) glance.spike = std::max(glance.spike, change);
                    previous = change;
                }
            }
        }
        return out;
    }

    /// A point at a distance of 2^-k on one side; on the boundary where there is no such side.
    void add(const Crossing& crossing, double side, int k)
    {
        const bool exists = side > 0 ? crossing.after : crossing.before;
        sampler_.add(crossing, exists ? std::ldexp(side, -k) : 0);
    }

    /// The boundary and both sides, near it.
    static constexpr std::size_t look_points = 3;
    void add_look(const Crossing& crossing)
    {
        sampler_.add(crossing, 0);
        for (const double side : {1.0, -1.0}) add(crossing, side, near);
    }

    /// The greatest difference among the points of `add_look`, which begin at `first`.
    double gap_at(std::size_t first) const
    {
        return std::max({sampler_.difference(first, first + 1),
                         sampler_.difference(first, first + 2),
                         sampler_.difference(first + 1, first + 2)});
    }

    double gap_of(const Crossing& crossing)
    {
        sampler_.clear();
        add_look(crossing);
        sampler_.run();
        return gap_at(0);
    }

    /// The crossing with the values, one after the other, where the gap is greatest.
    Crossing climb(Crossing crossing, const EntryInputs::Value* crossed, Parameters parameters)
    {
        double greatest = gap_of(crossing);
        for (int sweep = 0; sweep < 2; ++sweep)
            for (const EntryInputs::Value& value : inputs_.values()) {
                if (crossed != nullptr && value.first == crossed->first) continue;
                if (value.parameter && parameters == Parameters::at_defaults) continue;
                const Scalar& scalar = inputs_.scalars()[value.first];
                for (const double to : {scalar.neutral, scalar.low, scalar.high}) {
                    Crossing other = crossing;
                    EntryInputs::set(other.at, value, to);
                    const double gap = gap_of(other);
                    if (gap <= greatest) continue;
                    greatest = gap;
                    crossing = std::move(other);
                }
            }
        return crossing;
    }

    const ir::Module& module_;
    EntryInputs inputs_;
    evaluate::Tape tape_;
    Sampler sampler_;
};

}  // namespace

std::vector<Continuity> continuity(const ir::Module& module, const ContinuityOptions& options,
                                   const Store& store)
{
    std::vector<ir::FunctionId> functions;
    for (const ir::FunctionId function : checked_functions(module))
        // Codes jump by design.
        if (module[function].kind != ir::Function::Kind::storage) functions.push_back(function);
    std::vector<std::string> texts(functions.size());
    std::mutex mutex;
    std::size_t done = 0;
    for_each_task(functions.size(), options.jobs, [&](std::size_t task) {
        FunctionContinuity of{module, functions[task]};
        texts[task] = kept(store, of.key(), [&] { return of.rows(); });
        const std::lock_guard lock{mutex};
        ++done;
        if (options.progress)
            options.progress({done, functions.size(), module[functions[task]].name});
    });
    std::vector<Continuity> out;
    for (const std::string& text : texts) FunctionContinuity::read(text, out);
    return out;
}

}  // namespace lobe::analyze
