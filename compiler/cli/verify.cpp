// `lobec verify`: every output before the judges, on a device, and against the evaluator; and,
// with --mutants, whether that check can fail at all.
#include "analyze/verify.h"

#include "analyze/agreement/kill.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "lobe/lobe.h"
#include "report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace lobe::cli {
namespace {

struct Verify {
    std::vector<std::string> inputs;
    std::vector<std::string> target_names;
    std::vector<std::string> precisions{"float32", "float16"};
    std::string device;
    std::string json;
    std::string junit;
    std::string html;
    std::size_t points = 65536;
    std::size_t mutants = 0;
    unsigned jobs = 0;
    bool judges_only = false;
    bool times = false;

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}, {"--junit", junit}, {"--html", html}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);
        const Program program = load(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        std::vector<ir::Module> modules;
        for (const ir::Module& module : program.modules) modules.push_back(middle(module));
        return mutants > 0 ? kill(terminal, program.sources, modules)
                           : verify(terminal, program.sources, modules, outputs);
    }

    int verify(const Terminal& terminal, const Sources& sources,
               const std::vector<ir::Module>& modules, std::vector<Output>& outputs) const
    {
        std::vector<analyze::Verification> verifications;
        Diagnostics complaints;
        {
            Progress progress{terminal};
            for (std::size_t i = 0; i < modules.size(); ++i) {
                analyze::VerifyOptions options;
                options.targets = choose_targets(target_names);
                options.precisions.clear();
                for (const emit::Precision precision :
                     {emit::Precision::float32, emit::Precision::float16})
                    if (std::ranges::count(precisions, report::name(precision)) > 0)
                        options.precisions.push_back(precision);
                options.points = points;
                options.device = device;
                options.jobs = jobs;
                options.execute = !judges_only;
                options.progress = [&](const analyze::Progress& at) {
                    progress.show(fmt::format("{} ({} of {}): {} of {} {}", modules[i].name, i + 1,
                                              modules.size(), at.done, at.total, at.what));
                };
                verifications.push_back(analyze::verify(modules[i], sources, options));
                if (!verifications.back().no_device.empty() && !judges_only) break;
                const Diagnostics found = analyze::complaints(verifications.back(), modules[i]);
                for (const Diagnostic& complaint : found.all()) complaints.report(complaint);
            }
        }
        if (!judges_only && !verifications.back().no_device.empty())
            return fail(terminal, verifications.back().no_device +
                                      "; --judges-only checks without executing");

        print(terminal, complaints, sources);
        outputs[0].text = report::to_json(verifications, times);
        outputs[1].text = report::to_junit(verifications, times);
        outputs[2].text = report::to_page(verifications, times);
        const int status = report::totals(verifications).ok() ? success : findings;
        if (!is_piped(outputs)) show(terminal, verifications);
        return write(terminal, outputs, status);
    }

    void show(const Terminal& terminal,
              const std::vector<analyze::Verification>& verifications) const
    {
        const report::Look look{terminal.color_on_stdout(), terminal.width()};
        if (!terminal.quiet) {
            fmt::print("{}\n", report::render(report::verification_table(verifications), look));
            fmt::print("{}\n", report::render(report::judge_table(verifications), look));
            if (const auto trips = report::round_trip_table(verifications); !trips.rows.empty())
                fmt::print("{}\n", report::render(trips, look));
        }
        if (const std::string found = report::findings(verifications, look); !found.empty())
            fmt::print("{}\n", found);
        if (!terminal.quiet) fmt::print("{}", report::summary(verifications, look, true));
    }

    int kill(const Terminal& terminal, const Sources& sources,
             const std::vector<ir::Module>& modules) const
    {
        std::vector<analyze::KillSubject> subjects;
        for (const ir::Module& module : modules) subjects.push_back({&module, &sources});
        analyze::KillOptions options;
        options.mutants = mutants;
        options.points = points;
        if (!target_names.empty()) options.targets = choose_targets(target_names);
        options.device = device;
        options.jobs = jobs;

        analyze::KillReport report;
        {
            Progress progress{terminal};
            options.progress = [&](const analyze::Progress& at) {
                progress.show(fmt::format("mutant {} of {}: {}", at.done, at.total, at.what));
            };
            report = analyze::kill(subjects, options);
        }
        if (!report.no_device.empty()) return fail(terminal, report.no_device);
        return print_kills(terminal, report);
    }

    /// One row per kind of mutation, then every mutant that lived, by name.
    int print_kills(const Terminal& terminal, const analyze::KillReport& report) const
    {
        using analyze::Fate;
        constexpr Fate fates[] = {Fate::killed, Fate::rejected, Fate::equivalent, Fate::unchanged,
                                  Fate::tolerated};
        report::Table table;
        table.columns = {{"mutation"}, {"mutants", true}};
        for (const Fate fate : fates)
            table.columns.push_back({std::string{analyze::name(fate)}, true});
        for (const analyze::Mutation mutation : analyze::all_mutations()) {
            std::map<Fate, std::size_t> counts;
            std::size_t all = 0;
            for (const analyze::MutantFate& mutant : report.mutants)
                if (mutant.mutant.mutation == mutation) {
                    ++counts[mutant.fate];
                    ++all;
                }
            std::vector<report::Cell> row{{std::string{analyze::name(mutation)}},
                                          {std::to_string(all)}};
            for (const Fate fate : fates)
                row.push_back({std::to_string(counts[fate]),
                               counts[fate] > 0 && fate > Fate::equivalent ? report::Style::bad
                                                                           : report::Style::plain});
            table.rows.push_back(std::move(row));
        }
        const report::Look look{terminal.color_on_stdout(), terminal.width()};
        fmt::print("{}\n", report::render(table, look));

        for (const analyze::MutantFate& mutant : report.mutants)
            if (mutant.fate == Fate::unchanged || mutant.fate == Fate::tolerated)
                fmt::print("{}: {} on {}, line {}: `{}` became `{}`{}{}\n",
                           analyze::name(mutant.fate), mutant.term, mutant.target,
                           mutant.mutant.line, mutant.mutant.before, mutant.mutant.after,
                           mutant.reason.empty() ? "" : ": ", mutant.reason);
        for (const std::string& term : report.unusable)
            fmt::print("left out: {} is not itself in agreement\n", term);
        fmt::print("{} of {} mutants that are not equivalent were killed ({:.1f} %); "
                   "{} of {} possible mutants, {}\n",
                   report.count(Fate::killed),
                   report.count(Fate::killed) + report.count(Fate::unchanged) +
                       report.count(Fate::tolerated),
                   100 * report.kill_rate(), report.mutants.size(), report.available,
                   report.device);
        return report.unusable.empty() ? success : findings;
    }
};

}  // namespace

void add_verify(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "verify", "Validate, execute and cross-check every output against the evaluator");
    auto verify = std::make_shared<Verify>();
    command->add_option("FILE", verify->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("-t,--target", verify->target_names, "Targets (default: all)")
        ->check(CLI::IsMember(lobe::target_names()))
        ->delimiter(',');
    command->add_option("--precision", verify->precisions, "float32, float16 (default: both)")
        ->check(CLI::IsMember({"float32", "float16"}))
        ->delimiter(',');
    command->add_option("--device", verify->device,
                        "A number or part of a name from `lobec devices` (default: software)");
    command
        ->add_option("--points", verify->points, "Points per function, a quarter of them hostile")
        ->check(CLI::Range(64, 1 << 24))
        ->capture_default_str();
    command->add_option("-j,--jobs", verify->jobs, "Threads (default: one per core)");
    command->add_option("--json", verify->json,
                        "Write the results as JSON; `-` is standard output");
    command->add_option("--junit", verify->junit, "Write the results as JUnit XML; `-` likewise");
    command->add_option("--html", verify->html, "Write a self-contained page; `-` likewise");
    command->add_flag("--times", verify->times, "Put measured times into the written files");
    command->add_flag("--judges-only", verify->judges_only, "Validate, but execute nothing");
    command->add_option("--mutants", verify->mutants,
                        "Instead: make this many wrong shaders and count how many are caught");
    command->footer(
        "Every result must lie in the acceptance interval of its own inputs: what the Vulkan\n"
        "precision table lets a conforming device return. Points that the contract leaves "
        "undefined\n"
        "are counted and shown.\n"
        "Example: lobec verify models --json result.json --junit result.xml");
    command->callback([verify, &terminal, &status] { status = verify->run(terminal); });
}

}  // namespace lobe::cli
