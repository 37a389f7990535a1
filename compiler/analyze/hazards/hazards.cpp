#include "analyze/hazards/hazards.h"

#include "analyze/corners/corners.h"
#include "analyze/hazards/remedy.h"
#include "analyze/hazards/search.h"
#include "analyze/tasks.h"
#include "optimize/optimize.h"
#include "optimize/spelling.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <mutex>
#include <sstream>

namespace lobe::analyze {
namespace {

using evaluate::Precision;

/// One function in one precision: both spellings searched, and put into words.
class Analysis {
public:
    Analysis(const ir::Module& checked, const ir::Module& naive, const ir::Module& emitted,
             ir::FunctionId function, Precision precision)
        : function_{function}, precision_{precision}, space_{checked, function, precision},
          naive_{watch(naive, function, space_.inputs().names())},
          emitted_{watch(emitted, function, space_.inputs().names())}, checked_{checked}
    {
    }

    /// All that the kept numbers depend on.
    std::string key(std::size_t points) const
    {
        std::string key = fmt::format("hazards 1, {} points, {}\n", points,
                                      precision_ == Precision::float16 ? "half" : "float");
        for (const ir::Input& input : space_.inputs().entry().inputs)
            key += fmt::format("{} in {} .. {}\n", input.name, input.range.low, input.range.high);
        return key + evaluate::dump(naive_.tape) + evaluate::dump(emitted_.tape);
    }

    std::string search(std::size_t count) const
    {
        const Points corners = corner_points(space_.inputs(), space_.grid());
        std::string text = fmt::format("{} {}\n", not_finite_share(naive_, corners, precision_),
                                       not_finite_share(emitted_, corners, precision_));
        const Points where = points(checked_, space_.inputs().entry(), count, precision_);
        for (const WatchedLine* line : {&naive_, &emitted_})
            for (const FoundHazard& found :
                 search_hazards(*line, emitted_, space_, where, precision_)) {
                text += fmt::format("{} {} {} {} {}", line == &naive_ ? "naive" : "emitted",
                                    static_cast<int>(found.kind), found.instruction, found.share,
                                    found.lost_bits);
                for (const double value : found.witness) text += fmt::format(" {}", value);
                text += '\n';
            }
        return text;
    }

    FunctionHazards in_words(const std::string& kept, const Sources& sources,
                             std::span<const optimize::Application> applied) const
    {
        FunctionHazards out;
        out.function = checked_[function_].name;
        out.precision = precision_;
        std::istringstream in{kept};
        in >> out.naive_not_finite >> out.emitted_not_finite;
        std::string spelling;
        while (in >> spelling) {
            int kind = 0;
            FoundHazard found;
            in >> kind >> found.instruction >> found.share >> found.lost_bits;
            found.kind = static_cast<HazardKind>(kind);
            found.witness.resize(space_.inputs().names().size());
            for (double& value : found.witness) in >> value;
            if (spelling == "naive")
                out.naive.push_back(describe(found, naive_, sources, applied));
            else
                out.emitted.push_back(describe(found, emitted_, sources, {}));
        }
        return out;
    }

private:
    Hazard describe(const FoundHazard& found, const WatchedLine& line, const Sources& sources,
                    std::span<const optimize::Application> applied) const
    {
        Hazard out;
        const ir::ExprId owner = line.owner[found.instruction];
        out.kind = found.kind;
        out.operation = ir::name(line.function.graph[owner].op);
        out.expression = text_of(line, owner, sources);
        out.span = line.function.graph.span(owner);
        out.witness = space_.inputs().describe(found.witness);
        out.share = found.share;
        out.lost_bits = found.lost_bits;
        Trace trace{line, precision_};
        Trace truth{emitted_, precision_};
        trace.run(found.witness);
        truth.run(found.witness);
        truth.confirm(found.witness);
        const WorstResult worst = worst_result(trace, truth);
        const std::string result =
            std::isnan(worst.result) ? "NaN" : fmt::format("{:.6g}", worst.result);
        out.result = fmt::format("{} = {}, exactly {:.6g}", line.tape.output_names[worst.component],
                                 result, worst.exact);
        if (&line == &naive_) out.remedy = remedy_of(naive_, owner, emitted_, applied);
        return out;
    }

    ir::FunctionId function_;
    Precision precision_;
    HazardSpace space_;
    WatchedLine naive_;
    WatchedLine emitted_;
    const ir::Module& checked_;
};

}  // namespace

std::string_view name(HazardKind kind)
{
    switch (kind) {
    case HazardKind::domain: return "domain";
    case HazardKind::cancellation: return "cancellation";
    case HazardKind::overflow: return "overflow";
    case HazardKind::underflow: return "underflow";
    }
    return {};
}

std::vector<FunctionHazards> hazards(const ir::Module& checked, const Sources& sources,
                                     const HazardOptions& options, const Store& store)
{
    const ir::Module naive = optimize::spell(checked, optimize::Spelling::naive);
    const ir::Module emitted = optimize::spell(checked, optimize::Spelling::stable);
    std::vector<optimize::Application> applied;
    optimize::stabilize(optimize::simplify(checked), applied);

    const std::vector<ir::FunctionId> functions = checked_functions(checked);
    constexpr std::array precisions{Precision::float32, Precision::float16};
    std::vector<FunctionHazards> out(functions.size() * precisions.size());
    std::mutex mutex;
    Progress progress{0, out.size(), {}};
    for_each_task(out.size(), options.jobs, [&](std::size_t task) {
        const ir::FunctionId function = functions[task / precisions.size()];
        const Analysis analysis{checked, naive, emitted, function,
                                precisions[task % precisions.size()]};
        out[task] = analysis.in_words(kept(store, analysis.key(options.points),
                                           [&] { return analysis.search(options.points); }),
                                      sources, applied);
        const std::lock_guard lock{mutex};
        ++progress.done;
        progress.what = checked[function].name;
        if (options.progress) options.progress(progress);
    });
    if (options.costs) {
        const ir::Module as_written = optimize::spell(checked, optimize::Spelling::as_written);
        RemedyCosts costs{emitted, as_written};
        for (std::size_t task = 0; task < out.size(); ++task) {
            if (out[task].precision != Precision::float32) continue;
            for (Hazard& hazard : out[task].naive)
                if (hazard.remedy)
                    costs.ask(functions[task / precisions.size()], hazard.span, *hazard.remedy);
        }
        CostOptions how;
        how.jobs = options.jobs;
        how.progress = options.progress;
        costs.measure(sources, how, store);
    }
    return out;
}

}  // namespace lobe::analyze
