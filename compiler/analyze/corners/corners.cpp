#include "analyze/corners/corners.h"

#include "analyze/corners/fields.h"
#include "analyze/heads.h"
#include "analyze/kept_lines.h"
#include "analyze/tasks.h"
#include "verify/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <optional>

namespace lobe::analyze {
namespace {

using evaluate::HalfMode;

/// A function in one precision; its points are shared by all targets.
struct Subject {
    const ir::Module* module;
    ir::FunctionId function;
    emit::Precision precision{};
    const emit::BxdfCheck* bxdf = nullptr;  ///< set: a BxDF's output, on its one target
};

/// NaN and infinities among results.
struct Count {
    std::size_t results = 0;
    std::size_t not_a_number = 0;
    std::size_t infinite = 0;
    std::optional<std::size_t> example;  ///< a point; of a NaN if there is one
    float value = 0;

    /// `components`: of the result at a point.
    void add(std::size_t point, std::span<const float> components)
    {
        bool nan = false, infinity = false;
        for (const float component : components) {
            if (std::isfinite(component)) continue;
            nan |= std::isnan(component);
            infinity |= std::isinf(component);
            if (!example || (std::isnan(component) && !std::isnan(value))) {
                example = point;
                value = component;
            }
        }
        ++results;
        not_a_number += nan;
        infinite += infinity;
    }
};

/// FNV-1a over the bits of all points: what a kept result depends on, besides a text.
std::uint64_t hash_of(const std::vector<float>& points)
{
    std::uint64_t hash = 14695981039346656037U;
    for (const float value : points)
        hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 1099511628211U;
    return hash;
}

/// The rows of one subject.
class SubjectRun {
public:
    SubjectRun(const Subject& subject, const Sources& sources, const CornerOptions& options,
               const Store& store, device::Device* device)
        : subject_(subject), sources_(sources), store_(store), device_(device),
          inputs_(*subject.module, subject.function, grid_of(table_of(subject.precision)))
    {
        std::vector<NamedBox> open;
        for (const auto& [function, box] : options.open)
            if (function == inputs_.entry().name) open.push_back(box);
        points_ = corner_points(inputs_, grid_of(table_of(subject.precision)), open);
        input_ = interleaved(points_);
        hash_ = hash_of(input_);
        if (subject.precision == emit::Precision::float16)
            for (const HalfClaim& claim : options.half)
                if (claim.function == inputs_.entry().name) take(claim);
    }

    std::vector<CornerRow> run(const std::vector<const emit::Target*>& targets)
    {
        std::vector<CornerRow> rows;
        if (subject_.bxdf == nullptr) rows = evaluator();
        if (device_ == nullptr) return rows;
        for (const emit::Target* target : targets) {
            const bool half = subject_.precision == emit::Precision::float16;
            // One target emits half, and not every device computes in it.
            if (half && (target->name != "glsl450" || !device_->facts().float16)) continue;
            if (subject_.bxdf != nullptr && target->name != "ue4") continue;
            std::ranges::move(on_device(*target), std::back_inserter(rows));
        }
        return rows;
    }

private:
    void take(const HalfClaim& claim)
    {
        why_not_ = claim.refused;
        if (!claim.over) return;
        claim_ = describe(*claim.over);
        why_not_ = "outside of " + claim_;
        claimed_ =
            inside(inputs_, points_, evaluate::Precision::float16, *claim.over, Inside::certainly);
    }

    bool is_claimed(std::size_t point) const { return !claimed_.empty() && claimed_[point]; }

    /// What a target's results are counted in: one row, or of half the points that are claimed and
    /// then the others.
    std::vector<CornerRow> blank(const std::string& target) const
    {
        CornerRow row;
        row.function = inputs_.entry().name;
        row.target = target;
        row.precision = subject_.precision;
        if (subject_.precision == emit::Precision::float32) return {row};
        std::vector<CornerRow> rows;
        if (std::ranges::find(claimed_, true) != claimed_.end()) {
            row.claim = claim_;
            rows.push_back(row);
        }
        if (rows.empty() || std::ranges::find(claimed_, false) != claimed_.end()) {
            row.required = false;
            row.claim = why_not_;
            rows.push_back(row);
        }
        return rows;
    }

    std::vector<CornerRow> evaluator() const
    {
        const evaluate::Tape tape = evaluate::compile(*subject_.module, inputs_.entry());
        const std::string key = fmt::format("corners 2 evaluator {} {:x} {} {}\n{}",
                                            static_cast<int>(subject_.precision), hash_,
                                            points_.size(), claim_, evaluate::dump(tape));
        return kept_rows(blank("evaluator"), key, [&](Counts& counts) -> std::string {
            const std::vector<const float*> inputs = heads(points_.columns);
            const std::size_t components = tape.outputs.size();
            std::vector<std::vector<float>> columns(components, std::vector<float>(points_.size()));
            const std::vector<float*> outputs = heads(columns);
            std::vector<float> results(components * points_.size());
            const auto gather = [&] {
                for (std::size_t k = 0; k < components; ++k)
                    for (std::size_t i = 0; i < points_.size(); ++i)
                        results[i * components + k] = columns[k][i];
                note(counts, results, components);
            };
            if (subject_.precision == emit::Precision::float32) {
                evaluate::run(tape, evaluate::Columns<float>{inputs},
                              evaluate::Results<float>{outputs}, points_.size());
                gather();
                return {};
            }
            for (const HalfMode mode : {HalfMode::keep_denormals, HalfMode::flush_denormals}) {
                evaluate::run_half(tape, mode, inputs, outputs, points_.size());
                gather();
            }
            return {};
        });
    }

    std::vector<CornerRow> on_device(const emit::Target& target) const
    {
        const emit::Harness harness =
            subject_.bxdf != nullptr ? subject_.bxdf->harness
                                     : emit::harness(*subject_.module, sources_, subject_.function,
                                                     target, subject_.precision);
        const std::string key = fmt::format("corners 2 {} {} {:x} {} {}\n{}", device_->facts().name,
                                            device_->facts().driver, hash_, points_.size(), claim_,
                                            harness.artifact.text);
        return kept_rows(blank(target.name), key, [&](Counts& counts) -> std::string {
            const auto direct = spirv_of(harness.artifact.text, target, harness.entry);
            if (direct.empty()) return "a judge refused it";
            const verify::Verdict optimized = verify::optimize(direct);
            if (!optimized.accepted) return "spirv-opt refused it";
            std::vector<float> results;
            for (const auto* spirv : {&direct, &optimized.spirv}) {
                if (const auto why =
                        execute(*device_, input_, points_.size(), harness, *spirv, results))
                    return *why;
                note(counts, results, static_cast<std::size_t>(harness.outputs));
            }
            return {};
        });
    }

    struct Counts {
        Count claimed;  ///< of half
        Count others;
    };

    /// Adds one run over all points: the components of point 0, of point 1, …
    void note(Counts& counts, std::span<const float> results, std::size_t components) const
    {
        for (std::size_t i = 0; i < points_.size(); ++i)
            (is_claimed(i) ? counts.claimed : counts.others)
                .add(i, results.subspan(i * components, components));
    }

    /// Counts, failure and example of the rows, kept between runs. `make` counts, and says why it
    /// could not.
    template <class Make>
    std::vector<CornerRow> kept_rows(std::vector<CornerRow> rows, const std::string& key,
                                     const Make& make) const
    {
        const std::string text = kept(store_, key, [&] {
            Counts counts;
            const std::string failure = one_line(make(counts));
            std::string lines;
            for (const CornerRow& row : rows) {
                const bool is_claim = row.required && !claimed_.empty();
                const Count& count = is_claim ? counts.claimed : counts.others;
                write_line(lines, count.results, count.not_a_number, count.infinite, example(count),
                           failure);
            }
            return lines;
        });
        LineReader read{text};
        for (CornerRow& row : rows) {
            read(row.points);
            read(row.not_a_number);
            read(row.infinite);
            read(row.example);
            read(row.failure);
        }
        return rows;
    }

    std::string example(const Count& count) const
    {
        if (!count.example) return {};
        // The sign of a NaN says nothing.
        return fmt::format("{} at {}", std::isnan(count.value) ? NAN : count.value,
                           describe_inputs(inputs_.entry(), points_, *count.example));
    }

    /// A driver's message may have several.
    static std::string one_line(std::string text)
    {
        for (char& c : text)
            if (c == '\n' || c == '\t') c = ' ';
        return text;
    }

    const Subject& subject_;
    const Sources& sources_;
    const Store& store_;
    device::Device* device_;
    EntryInputs inputs_;
    Points points_;
    std::vector<float> input_;
    std::uint64_t hash_ = 0;
    std::vector<bool> claimed_;  ///< by point, of half that is proved in a box; else empty
    std::string claim_;          ///< that box
    std::string why_not_;        ///< the other points are not claimed
};

std::vector<Subject> subjects_of(const ir::Module& module,
                                 const std::vector<emit::BxdfCheck>& bxdfs)
{
    std::vector<Subject> subjects;
    for (const ir::FunctionId function : checked_functions(module)) {
        subjects.push_back({&module, function, emit::Precision::float32});
        // What packs and unpacks has whole numbers that halves have not.
        if (module[function].kind != ir::Function::Kind::storage)
            subjects.push_back({&module, function, emit::Precision::float16});
    }
    for (const emit::BxdfCheck& bxdf : bxdfs)
        subjects.push_back({&bxdf.module, bxdf.function, emit::Precision::float32, &bxdf});
    return subjects;
}

}  // namespace

Corners corners(const ir::Module& module, const Sources& sources, const CornerOptions& options,
                const Store& store)
{
    Corners out;
    std::optional<device::Device> device;
    if (options.execute) device = device::Device::open(options.device, out.no_device);
    if (device)
        out.device = fmt::format("{}; driver {}", device->facts().name, device->facts().driver);
    std::vector<const emit::Target*> targets = options.targets;
    if (targets.empty())
        for (const emit::Target& target : emit::targets()) targets.push_back(&target);

    const std::vector<emit::BxdfCheck> bxdfs =
        device ? emit::bxdf_checks(module, sources) : std::vector<emit::BxdfCheck>{};
    const std::vector<Subject> subjects = subjects_of(module, bxdfs);
    std::vector<std::vector<CornerRow>> rows(subjects.size());
    std::mutex mutex;
    std::size_t done = 0;
    for_each_task(subjects.size(), options.jobs, [&](std::size_t task) {
        SubjectRun run{subjects[task], sources, options, store, device ? &*device : nullptr};
        rows[task] = run.run(targets);
        const std::lock_guard lock{mutex};
        ++done;
        if (options.progress)
            options.progress(
                {done, subjects.size(), (*subjects[task].module)[subjects[task].function].name});
    });
    for (auto& some : rows) std::ranges::move(some, std::back_inserter(out.rows));
    if (options.continuity)
        out.continuity = continuity(module, {options.jobs, options.progress}, store);
    return out;
}

}  // namespace lobe::analyze
