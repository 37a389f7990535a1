#include "analyze/trade/yardstick.h"

#include "analyze/packing/radiance_search.h"
#include "analyze/points.h"
#include "analyze/tasks.h"
#include "analyze/trade/rows.h"
#include "analyze/trade/tally.h"
#include "analyze/trade/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

namespace lobe::analyze {
namespace {

constexpr std::size_t least_hostile = 1024;
constexpr std::size_t most_shared = 512;  ///< worst points that everyone is tried on

bool same_input(const ir::Input& a, const ir::Input& b)
{
    return a.origin == b.origin && a.name == b.name;
}

}  // namespace

Yardstick::Yardstick(const ir::Module& module, const std::vector<ir::FunctionId>& outputs,
                     bool radiance)
    : module_{&module}, function_{radiance_of(module, outputs)}, box_{whole_box(module, function_)},
      radiance_{radiance}
{
    note_vectors();
}

void Yardstick::note_vectors()
{
    vectors_.clear();
    std::size_t coordinate = 0;
    for (const ir::Input& input : function_.inputs) {
        if (input.origin == ir::Origin::geometry) vectors_.push_back(coordinate);
        coordinate += static_cast<std::size_t>(ir::components(input.type));
    }
}

void Yardstick::widen(const ir::Module& module, const std::vector<ir::FunctionId>& outputs)
{
    const ir::Function other = radiance_of(module, outputs);
    const RadianceBox box = whole_box(module, other);
    for (const ir::Input& input : other.inputs)
        if (std::ranges::none_of(function_.inputs,
                                 [&](const ir::Input& own) { return same_input(own, input); }))
            function_.inputs.push_back(input);
    for (std::size_t i = 0; i < box.width(); ++i) {
        const Coordinate& coordinate = box.coordinates[i];
        auto own = std::ranges::find(box_.coordinates, coordinate.name, &Coordinate::name);
        if (own == box_.coordinates.end()) {
            box_.coordinates.push_back(coordinate);
            own = box_.coordinates.end() - 1;
        }
        const auto at = static_cast<std::size_t>(own - box_.coordinates.begin());
        if (std::ranges::count(box.values, i) > 0 && std::ranges::count(box_.values, at) == 0)
            box_.values.push_back(at);
        if (box.light == i) box_.light = at;
        if (box.view == i) box_.view = at;
        if (box.roughness == i) box_.roughness = at;
        if (box.alpha == i) box_.alpha = at;
    }
    note_vectors();
}

std::string Yardstick::text() const
{
    std::string text = fmt::format("{}\n", radiance_ ? "radiance" : "value");
    for (std::size_t i = 0; i < box_.width(); ++i) {
        const Coordinate& coordinate = box_.coordinates[i];
        text += fmt::format("{} {} {}{}{}\n", coordinate.name, coordinate.low, coordinate.high,
                            coordinate.whole ? " whole" : "",
                            std::ranges::count(box_.values, i) > 0 ? " varies" : "");
    }
    return text + evaluate::dump(box_.tape);
}

namespace {

/// A tape, and where its inputs are.
struct Wired {
    const evaluate::Tape* tape;
    std::vector<std::size_t> columns;
};

/// What is asked about one way: how far it is over the reals, and how far its contenders are.
struct Question {
    Wired real;
    std::vector<Wired> contenders;
    Tally model;
    struct OfContender {
        Tally rounding;
        Tally total;
    };
    std::vector<OfContender> tallies;
};

class Measurement {
public:
    Measurement(const Yardstick& yardstick, std::span<const Way> ways,
                const DeviationOptions& options)
        : yardstick_{yardstick}, ways_{ways}, options_{options},
          nothing_stored_(yardstick.box().width(), nullptr)
    {
        for (const Way& way : ways) {
            Question question;
            question.real = {&way.real, columns_of(yardstick.box(), way.real)};
            for (const Contender& contender : way.contenders)
                question.contenders.push_back(
                    {&contender.tape, columns_of(yardstick.box(), contender.tape)});
            question.tallies.resize(way.contenders.size());
            questions_.push_back(std::move(question));
        }
    }

    std::vector<Deviations> run()
    {
        survey();
        each([this](std::size_t way) { meet(questions_[way], ways_[way], ground_, Extent::box); });
        each([this](std::size_t way) { count_hostile(questions_[way], ways_[way]); });
        std::vector<std::vector<std::vector<float>>> peaks(ways_.size());
        each([&](std::size_t way) { peaks[way] = ascend(way); });
        share(peaks);
        each([this](std::size_t way) {
            meet(questions_[way], ways_[way], std::span{&own_[way], 1}, Extent::worst);
            meet(questions_[way], ways_[way], std::span{&*shared_, 1}, Extent::worst);
        });
        std::vector<Deviations> results(ways_.size());
        each([&](std::size_t way) { results[way] = report(questions_[way], ways_[way]); });
        return results;
    }

private:
    template <class Body>
    void each(const Body& body)
    {
        for_each_task(ways_.size(), options_.jobs, [&](std::size_t way) {
            body(way);
            if (!options_.progress) return;
            const std::scoped_lock lock{reporting_};
            options_.progress({++done_, 5 * ways_.size(), "errors"});
        });
    }

    /// The points over the box, and those where only NaN and infinities are looked for.
    void survey()
    {
        ground_ = analyze::survey(yardstick_, options_.points, options_.jobs);
        const Points hostile = points(yardstick_.module(), yardstick_.function(),
                                      std::max(least_hostile, options_.points / 4));
        hostile_.emplace(yardstick_, hostile.size());
        for (std::size_t i = 0; i < hostile.columns.size(); ++i)
            std::ranges::copy(hostile.columns[i], hostile_->column(i));
        hostile_->settle();
    }

    enum class Extent : std::uint8_t {
        box,   ///< every second point is a usual one
        worst  ///< points that someone was worst at
    };

    void meet(Question& question, const Way& way, std::span<const Rows> ground, Extent extent)
    {
        std::vector<double> real;
        std::vector<double> rounded;
        for (const Rows& rows : ground) {
            if (rows.size() == 0) continue;
            const Tally::Where where{&rows, extent == Extent::box};
            rows.run(*question.real.tape, question.real.columns, std::nullopt, real);
            question.model.add(where, rows.exact(), real);
            for (std::size_t k = 0; k < way.contenders.size(); ++k) {
                const Wired& contender = question.contenders[k];
                rows.run(*contender.tape, contender.columns, way.contenders[k].format, rounded);
                question.tallies[k].rounding.add(where, real, rounded);
                question.tallies[k].total.add(where, rows.exact(), rounded);
            }
        }
    }

    void count_hostile(Question& question, const Way& way)
    {
        const Rows& rows = *hostile_;
        std::vector<double> results;
        rows.run(*question.real.tape, question.real.columns, std::nullopt, results);
        question.model.count(rows, results);
        for (std::size_t k = 0; k < way.contenders.size(); ++k) {
            const Wired& contender = question.contenders[k];
            rows.run(*contender.tape, contender.columns, way.contenders[k].format, results);
            question.tallies[k].rounding.count(rows, results);
            question.tallies[k].total.count(rows, results);
        }
    }

    /// Uphill from the worst points of the way over the reals and of its contenders.
    std::vector<std::vector<float>> ascend(std::size_t way)
    {
        Question& question = questions_[way];
        std::vector<std::vector<float>> peaks;
        ascend(question.real, std::nullopt, question.model, way, peaks);
        const std::size_t count = options_.every_contender
                                      ? question.contenders.size()
                                      : std::min<std::size_t>(question.contenders.size(), 1);
        for (std::size_t k = 0; k < count; ++k)
            ascend(question.contenders[k], ways_[way].contenders[k].format,
                   question.tallies[k].total, way, peaks);
        return peaks;
    }

    void ascend(const Wired& wired, std::optional<Format> format, const Tally& tally,
                std::size_t way, std::vector<std::vector<float>>& peaks)
    {
        constexpr std::size_t block = 128;  // rows of a step uphill
        Rows rows{yardstick_, block};
        std::vector<double> results;
        std::vector<double> errors(block);
        const Measure measure = [&](RadianceMeter& meter) -> const std::vector<double>& {
            rows.take(meter);
            rows.settle();
            rows.run(*wired.tape, wired.columns, format, results);
            for (std::size_t row = 0; row < block; ++row)
                errors[row] = scaled_error(rows, row, rows.exact(), results);
            return errors;
        };
        for (const std::vector<float>& start : tally.worst_points(options_.climbs))
            peaks.push_back(climb(yardstick_.box(), nothing_stored_, start, options_.rounds,
                                  way << 8 | peaks.size(), measure)
                                .point);
    }

    /// The points that everyone is tried on: evenly spread over all that were found.
    void share(const std::vector<std::vector<std::vector<float>>>& peaks)
    {
        std::vector<const std::vector<float>*> all;
        for (const auto& of_way : peaks)
            for (const std::vector<float>& point : of_way) all.push_back(&point);
        // A way's own peaks count for it even where not all can be shared.
        for (const auto& of_way : peaks) own_.push_back(rows_of(of_way));
        std::vector<std::vector<float>> chosen;
        const std::size_t stride = (all.size() + most_shared - 1) / most_shared;
        for (std::size_t i = 0; i < all.size(); i += stride) chosen.push_back(*all[i]);
        shared_ = rows_of(chosen);
    }

    Rows rows_of(const std::vector<std::vector<float>>& points)
    {
        Rows rows{yardstick_, points.size()};
        if (points.empty()) return rows;
        for (std::size_t row = 0; row < points.size(); ++row)
            for (std::size_t i = 0; i < points[row].size(); ++i)
                rows.column(i)[row] = points[row][i];
        rows.settle();
        return rows;
    }

    Deviations report(Question& question, const Way& way)
    {
        const evaluate::Tape& definition = yardstick_.box().tape;
        const Wired exact{&definition, columns_of(yardstick_.box(), definition)};
        const auto confirmed = [&](const Tally& tally, const Wired* from, const Wired* to,
                                   std::optional<Format> format) {
            return tally.report([&](const Rows& rows, std::size_t row) {
                Confirmed values;
                values.from = rows.confirm(*from->tape, from->columns, row);
                if (!format) values.to = rows.confirm(*to->tape, to->columns, row);
                return values;
            });
        };
        Deviations out;
        out.model = confirmed(question.model, &exact, &question.real, std::nullopt);
        for (std::size_t k = 0; k < way.contenders.size(); ++k) {
            const Wired* wired = &question.contenders[k];
            const Format format = way.contenders[k].format;
            out.contenders.push_back(
                {confirmed(question.tallies[k].rounding, &question.real, wired, format),
                 confirmed(question.tallies[k].total, &exact, wired, format)});
        }
        return out;
    }

    const Yardstick& yardstick_;
    std::span<const Way> ways_;
    const DeviationOptions& options_;
    StoredAs nothing_stored_;
    std::vector<Question> questions_;
    std::vector<Rows> ground_;
    std::optional<Rows> hostile_;
    std::vector<Rows> own_;  ///< per way, its own peaks
    std::optional<Rows> shared_;
    std::mutex reporting_;
    std::size_t done_ = 0;
};

std::string key_of(const Yardstick& yardstick, std::span<const Way> ways,
                   const DeviationOptions& options)
{
    std::string key = fmt::format("deviations 2: {} points, {} climbs of {} rounds{}\n",
                                  options.points, options.climbs, options.rounds,
                                  options.every_contender ? "" : " for the first");
    key += yardstick.text();
    for (const Way& way : ways) {
        key += "way\n" + evaluate::dump(way.real);
        for (const Contender& contender : way.contenders)
            key += fmt::format("{}\n{}", name(contender.format), evaluate::dump(contender.tape));
    }
    return key;
}

std::optional<std::vector<Deviations>> read(std::string_view text, std::span<const Way> ways)
{
    std::vector<Deviations> results;
    Reader reader{text};
    for (const Way& way : ways) {
        Deviations& out = results.emplace_back();
        reader.take(out.model);
        out.contenders.resize(way.contenders.size());
        for (Deviations::OfContender& contender : out.contenders) {
            reader.take(contender.rounding);
            reader.take(contender.total);
        }
    }
    if (!reader.is_done()) return std::nullopt;
    return results;
}

}  // namespace

std::vector<Deviations> deviations(const Yardstick& yardstick, std::span<const Way> ways,
                                   const DeviationOptions& options, const Store& store)
{
    const std::string key = store.load || store.save ? key_of(yardstick, ways, options) : "";
    if (store.load)
        if (const auto text = store.load(key))
            if (auto results = read(*text, ways)) return std::move(*results);
    std::vector<Deviations> results = Measurement{yardstick, ways, options}.run();
    if (store.save) {
        std::string text;
        for (const Deviations& result : results) {
            put(text, result.model);
            for (const Deviations::OfContender& contender : result.contenders) {
                put(text, contender.rounding);
                put(text, contender.total);
            }
        }
        store.save(key, text);
    }
    return results;
}

}  // namespace lobe::analyze
