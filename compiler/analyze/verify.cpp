#include "analyze/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace lobe::analyze {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A function in one precision, and the rows that are judged against its reference.
struct Subject {
    enum class State {
        waiting,
        preparing,
        ready
    };

    ir::FunctionId function;
    emit::Precision precision{};
    std::vector<std::size_t> rows;  ///< indices into Verification::rows
    State state = State::waiting;
    std::size_t taken = 0;     ///< of `rows`
    std::size_t finished = 0;  ///< of `rows`
    std::optional<Reference> reference;
    const emit::BxdfCheck* bxdf = nullptr;  ///< set: a BxDF's output, with a module of its own
};

struct File {
    const emit::Target* target;
    emit::Artifact artifact;
    std::vector<Judgement> judgements;
};

/// What there is to do, handed out to workers one job at a time. Rows of a ready subject come
/// first, then the reference of the next subject, so that few references are alive at once.
class Schedule {
public:
    struct Job {
        enum class Kind {
            judge_file,
            round_trip,
            prepare,
            run_row
        } kind{};
        std::size_t index = 0;  ///< of the file, the round trip or the subject
        std::size_t row = 0;
    };

    Schedule(std::vector<Subject>& subjects, std::size_t files, std::size_t trips,
             std::size_t total, const std::function<void(const Progress&)>& progress)
        : subjects_(subjects), files_(files), trips_(trips), total_(total), progress_(progress)
    {
    }

    /// The next job; waits until there is one. Nothing when all is handed out.
    std::optional<Job> take()
    {
        std::unique_lock lock{mutex_};
        for (;;) {
            if (next_file_ < files_) return Job{Job::Kind::judge_file, next_file_++, 0};
            if (next_trip_ < trips_) return Job{Job::Kind::round_trip, next_trip_++, 0};
            bool all_taken = true;
            for (std::size_t i = 0; i < subjects_.size(); ++i) {
                Subject& subject = subjects_[i];
                if (subject.taken == subject.rows.size()) continue;
                all_taken = false;
                if (subject.state == Subject::State::ready)
                    return Job{Job::Kind::run_row, i, subject.rows[subject.taken++]};
            }
            if (all_taken) return std::nullopt;
            for (std::size_t i = 0; i < subjects_.size(); ++i)
                if (subjects_[i].state == Subject::State::waiting) {
                    subjects_[i].state = Subject::State::preparing;
                    return Job{Job::Kind::prepare, i, 0};
                }
            changed_.wait(lock);
        }
    }

    void finish(const Job& job, std::string_view what)
    {
        const std::lock_guard lock{mutex_};
        if (job.kind == Job::Kind::prepare) {
            subjects_[job.index].state = Subject::State::ready;
        } else {
            ++done_;
            if (progress_) progress_({done_, total_, what});
        }
        if (job.kind == Job::Kind::run_row) {
            Subject& subject = subjects_[job.index];
            if (++subject.finished == subject.rows.size()) subject.reference.reset();
        }
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Subject>& subjects_;
    std::size_t files_;
    std::size_t next_file_ = 0;
    std::size_t trips_;
    std::size_t next_trip_ = 0;
    std::size_t done_ = 0;
    std::size_t total_;
    const std::function<void(const Progress&)>& progress_;
};

class Verifier {
public:
    Verifier(const ir::Module& module, const Sources& sources, const VerifyOptions& options)
        : module_(module), sources_(sources), options_(options)
    {
        targets_ = options.targets;
        if (targets_.empty())
            for (const emit::Target& target : emit::targets()) targets_.push_back(&target);
    }

    Verification run()
    {
        const auto start = Clock::now();
        out_.module = module_.name;
        if (options_.execute) device_ = device::Device::open(options_.device, out_.no_device);
        if (device_)
            out_.device =
                fmt::format("{}; driver {}", device_->facts().name, device_->facts().driver);
        plan();

        const std::size_t trips = out_.round_trips.size();
        Schedule schedule{subjects_, files_.size(), trips, files_.size() + trips + out_.rows.size(),
                          options_.progress};
        const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
        const unsigned workers = options_.jobs > 0 ? options_.jobs : cores;
        std::vector<std::thread> threads;
        for (unsigned i = 1; i < workers; ++i)
            threads.emplace_back([this, &schedule] { work(schedule); });
        work(schedule);
        for (std::thread& thread : threads) thread.join();

        for (File& file : files_)
            std::ranges::move(file.judgements, std::back_inserter(out_.judgements));
        out_.seconds = seconds_since(start);
        return std::move(out_);
    }

private:
    bool wants(const emit::Target& target, emit::Precision precision)
    {
        if (precision == emit::Precision::float32) return true;
        if (target.name != "glsl450") return false;  // the one target that emits half precision
        if (!device_ || device_->facts().float16) return true;
        note("float16: the device does not compute in it");
        return false;
    }

    void plan()
    {
        for (const emit::Target* target : targets_)
            for (emit::Artifact& artifact : emit::emit(module_, sources_, *target))
                files_.push_back({target, std::move(artifact), {}});
        plan_round_trips();
        for (const ir::FunctionId function : checked_functions(module_)) {
            const std::size_t first = subjects_.size();
            for (const emit::Precision precision : options_.precisions)
                subjects_.push_back({function, precision, {}, {}, 0, 0, {}, nullptr});
            for (const emit::Target* target : targets_)
                for (std::size_t i = first; i < subjects_.size(); ++i) {
                    if (!wants(*target, subjects_[i].precision) ||
                        !has_codes(module_[function], subjects_[i].precision))
                        continue;
                    subjects_[i].rows.push_back(out_.rows.size());
                    Row& row = out_.rows.emplace_back();
                    row.term = module_[function].name;
                    row.target = target->name;
                    row.precision = subjects_[i].precision;
                }
        }
        std::erase_if(subjects_, [](const Subject& subject) { return subject.rows.empty(); });
        plan_bxdfs();
    }

    /// False, with a note, where a precision has not the whole numbers that codes are.
    bool has_codes(const ir::Function& function, emit::Precision precision)
    {
        if (function.kind != ir::Function::Kind::storage || precision == emit::Precision::float32)
            return true;
        note("float16: what packs and unpacks; it has no whole numbers past 2,048");
        return false;
    }

    void note(const std::string& text)
    {
        if (std::ranges::find(out_.notes, text) == out_.notes.end()) out_.notes.push_back(text);
    }

    void plan_round_trips()
    {
        for (std::size_t i = 0; i < module_.packings.size(); ++i)
            for (const emit::Target* target : targets_) {
                out_.round_trips.emplace_back();
                trips_.emplace_back(i, target);
            }
        trip_references_.resize(module_.packings.size());
        trip_begun_ = std::vector<std::once_flag>(module_.packings.size());
    }

    /// The outputs of every BxDF, which exist for one target and in one precision.
    void plan_bxdfs()
    {
        const bool wanted = std::ranges::count(targets_, "ue4", &emit::Target::name) > 0 &&
                            std::ranges::count(options_.precisions, emit::Precision::float32) > 0;
        if (!wanted) return;
        bxdfs_ = emit::bxdf_checks(module_, sources_);
        for (const emit::BxdfCheck& bxdf : bxdfs_) {
            subjects_.push_back(
                {bxdf.function, emit::Precision::float32, {out_.rows.size()}, {}, 0, 0, {}, &bxdf});
            Row& row = out_.rows.emplace_back();
            row.term = bxdf.module[bxdf.function].name;
            row.target = "ue4";
            row.precision = emit::Precision::float32;
        }
    }

    void work(Schedule& schedule)
    {
        while (const auto job = schedule.take()) {
            std::string what;
            switch (job->kind) {
            case Schedule::Job::Kind::judge_file: {
                File& file = files_[job->index];
                file.judgements = judge_file(file.artifact, *file.target);
                what = file.artifact.path;
                break;
            }
            case Schedule::Job::Kind::round_trip: what = run_round_trip(job->index); break;
            case Schedule::Job::Kind::prepare: prepare(subjects_[job->index]); break;
            case Schedule::Job::Kind::run_row: {
                Row& row = out_.rows[job->row];
                run_row(row, subjects_[job->index]);
                what = fmt::format("{}, {}", row.term, row.target);
                break;
            }
            }
            schedule.finish(*job, what);
        }
    }

    /// What it was, for people.
    std::string run_round_trip(std::size_t index)
    {
        const std::size_t packing = trips_[index].first;
        const emit::Target& target = *trips_[index].second;
        std::call_once(trip_begun_[packing],
                       [&] { trip_references_[packing] = trip_reference(module_, packing); });
        RoundTrip& trip = out_.round_trips[index];
        trip = round_trip(module_, sources_, packing, target, trip_references_[packing],
                          device_ ? &*device_ : nullptr);
        return fmt::format("{}, {}", trip.packing, trip.target);
    }

    void prepare(Subject& subject)
    {
        if (!device_) return;
        const ir::Module& module = subject.bxdf != nullptr ? subject.bxdf->module : module_;
        subject.reference =
            reference(module, subject.function, table_of(subject.precision), options_.points);
        const std::lock_guard lock{mutex_};
        out_.acceptance_seconds += subject.reference->seconds;
        out_.acceptance_points += options_.points;
    }

    void run_row(Row& row, const Subject& subject)
    {
        const auto start = Clock::now();
        const emit::Target& target = *emit::find_target(row.target);
        const emit::Harness harness =
            subject.bxdf != nullptr
                ? subject.bxdf->harness
                : emit::harness(module_, sources_, subject.function, target, subject.precision);
        Judged judged = judge_harness(harness, target, subject.precision);
        row.judgements = std::move(judged.judgements);
        row.judge_seconds = seconds_since(start);
        if (!device_ || judged.direct.empty()) return;

        const auto start_of_run = Clock::now();
        std::vector<float> results;
        const auto run = [&](const std::vector<std::uint32_t>& spirv, Agreement& agreement) {
            if (const auto why = execute(*device_, *subject.reference, harness, spirv, results))
                row.failure = *why;
            else
                agreement = compare(*subject.reference, results);
        };
        run(judged.direct, row.direct);
        if (row.failure.empty()) run(judged.optimized, row.optimized);
        row.executed = row.failure.empty();
        row.run_seconds = seconds_since(start_of_run);
    }

    const ir::Module& module_;
    const Sources& sources_;
    const VerifyOptions& options_;
    std::vector<const emit::Target*> targets_;
    std::optional<device::Device> device_;  ///< shared: it may be called from several threads
    Verification out_;
    std::vector<File> files_;
    std::vector<Subject> subjects_;
    std::vector<emit::BxdfCheck> bxdfs_;
    std::vector<std::pair<std::size_t, const emit::Target*>> trips_;  ///< packing, target
    std::vector<TripReference> trip_references_;                      ///< per packing
    std::vector<std::once_flag> trip_begun_;
    std::mutex mutex_;  ///< guards the sums in `out_`
};

}  // namespace

bool Row::ok() const
{
    return failure.empty() && direct.agrees() && optimized.agrees() &&
           std::ranges::all_of(judgements, &Judgement::accepted);
}

bool Verification::ok() const
{
    return std::ranges::all_of(rows, &Row::ok) &&
           std::ranges::all_of(round_trips, &RoundTrip::ok) &&
           std::ranges::all_of(judgements, &Judgement::accepted);
}

std::size_t Verification::outside() const
{
    std::size_t sum = 0;
    for (const Row& row : rows) sum += row.direct.outside + row.optimized.outside;
    return sum;
}

std::vector<ir::FunctionId> checked_functions(const ir::Module& module)
{
    std::vector<bool> is_condition(module.functions.size());
    for (const ir::Effect& effect : module.effects) is_condition[effect.off_when.index] = true;
    std::vector<ir::FunctionId> result;
    for (std::size_t i = 0; i < module.functions.size(); ++i)
        if (module.owns(module.functions[i]) && !is_condition[i])
            result.push_back(ir::FunctionId{i});
    return result;
}

Verification verify(const ir::Module& module, const Sources& sources, const VerifyOptions& options)
{
    return Verifier{module, sources, options}.run();
}

Diagnostics complaints(const Verification& verification, const ir::Module& module)
{
    Diagnostics out;
    const auto complain = [&out](const Judgement& judgement, const Span& fallback) {
        if (judgement.accepted) return;
        Diagnostic diagnostic;
        diagnostic.code = Code::judge_rejects;
        diagnostic.message = fmt::format("{} rejects `{}`", judgement.judge, judgement.artifact);
        diagnostic.primary.span = fallback;
        bool placed = false;
        for (const Remark& remark : judgement.remarks) {
            if (remark.place && !placed) {
                diagnostic.primary = {*remark.place, "the rejected line was written for this"};
                placed = true;
            }
            diagnostic.notes.push_back(remark.line > 0
                                           ? fmt::format("line {}: {}", remark.line, remark.text)
                                           : remark.text);
        }
        diagnostic.helps.push_back("this is a fault of the compiler, not of the model");
        out.report(std::move(diagnostic));
    };

    // A file's place, when a judge names none, is the first thing that the module declares.
    const auto own = checked_functions(module);
    const Span start = own.empty() ? Span{} : module[own.front()].span;
    for (const Judgement& judgement : verification.judgements) complain(judgement, start);
    for (const Row& row : verification.rows) {
        const auto function = module.find(row.term);
        for (const Judgement& judgement : row.judgements)
            complain(judgement, function ? module[*function].span : start);
    }
    for (const RoundTrip& trip : verification.round_trips)
        for (const Judgement& judgement : trip.judgements) complain(judgement, start);
    return out;
}

}  // namespace lobe::analyze
