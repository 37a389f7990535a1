// `lobec stability`: hazards and their remedies, proofs, the corner suite and physics.
#include "analyze/stability.h"

#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "lobe/lobe.h"
#include "report/stability.h"

#include <fmt/format.h>

#include <memory>

namespace lobe::cli {
namespace {

struct Stability {
    std::vector<std::string> inputs;
    std::vector<std::string> target_names;
    std::string device;
    std::string json;
    std::string junit;
    std::string html;
    CacheOptions cache;
    std::size_t boxes = analyze::ProofOptions{}.boxes;
    unsigned jobs = 0;
    bool no_hazards = false;
    bool no_execution = false;

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}, {"--junit", junit}, {"--html", html}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);
        const Program program = read_and_check(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;

        std::vector<analyze::Stability> results;
        {
            Progress progress{terminal};
            const analyze::Store store = open_cache(cache);
            for (std::size_t i = 0; i < program.modules.size(); ++i) {
                const ir::Module& module = program.modules[i];
                const auto show = [&](std::string_view stage) {
                    return [&, stage](const analyze::Progress& at) {
                        progress.show(fmt::format("{} ({} of {}), {}: {} of {} {}", module.name,
                                                  i + 1, program.modules.size(), stage, at.done,
                                                  at.total, at.what));
                    };
                };
                results.push_back(
                    analyze::stability(module, program.sources, options(show), store));
            }
        }
        return report(terminal, program, results, outputs);
    }

    template <class Show>
    analyze::StabilityOptions options(const Show& show) const
    {
        analyze::StabilityOptions out;
        out.proof.boxes = boxes;
        out.proof.jobs = out.hazard.jobs = out.corner.jobs = out.physics.jobs = jobs;
        out.corner.targets = choose_targets(target_names);
        out.corner.device = out.physics.device = device;
        out.corner.execute = out.physics.execute = !no_execution;
        out.hazards = !no_hazards;
        out.proof.progress = show("proofs");
        out.hazard.progress = show("hazards");
        out.corner.progress = show("corners");
        out.physics.progress = show("physics");
        return out;
    }

    int report(const Terminal& terminal, const Program& program,
               const std::vector<analyze::Stability>& results, std::vector<Output>& outputs) const
    {
        if (!is_piped(outputs) && !terminal.quiet) {
            const report::Look look{terminal.color_on_stdout(), terminal.width()};
            for (const analyze::Stability& result : results)
                fmt::print("{}", report::to_text(result, look));
            fmt::print("{}", report::summary(results, look));
        }
        outputs[0].text = report::to_json(results);
        outputs[1].text = report::to_junit(results);
        report::Document page;
        page.title = "Stability";
        page.verdict = report::stability_verdict(results);
        bool ok = true;
        for (std::size_t i = 0; i < results.size(); ++i) {
            ok = ok && results[i].ok();
            for (report::Section& section :
                 report::stability_sections(results[i], program.modules[i].path))
                page.sections.push_back(std::move(section));
        }
        outputs[2].text = report::to_page(page);
        return write(terminal, outputs, ok ? success : findings);
    }
};

}  // namespace

void add_stability(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "stability", "Prove what is finite, bound errors, and find what a naive spelling would do");
    auto stability = std::make_shared<Stability>();
    command->add_option("FILE", stability->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("-t,--target", stability->target_names, "Targets (default: all)")
        ->check(CLI::IsMember(lobe::target_names()))
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_option("-d,--device", stability->device,
                        "Vulkan device: a number or a part of its name (default: software)");
    command->add_option("--json", stability->json,
                        "Write the results as JSON; `-` is standard output");
    command->add_option("--junit", stability->junit,
                        "Write the results as JUnit XML; `-` likewise");
    command->add_option("--html", stability->html, "Write a self-contained page; `-` likewise");
    command->add_option("--boxes", stability->boxes, "Boxes that a proof may take")
        ->check(CLI::Range(1, 1 << 24))
        ->capture_default_str();
    command->add_flag("--no-hazards", stability->no_hazards,
                      "Leave the naive spelling alone; judge only what is emitted");
    command->add_flag("--no-execution", stability->no_execution,
                      "Use no device; corners and physics are the evaluator's");
    command->add_option("-j,--jobs", stability->jobs, "Threads (default: one per core)");
    add_cache_options(*command, stability->cache);
    command->footer(
        "Exits with 1 when a float function is not proved finite over its declared ranges, or "
        "gives\n"
        "NaN or an infinity at a corner. Laws of physics that a model does not keep are stated.\n"
        "Example: lobec stability models --junit stability.xml --html stability.html");
    command->callback([stability, &terminal, &status] { status = stability->run(terminal); });
}

}  // namespace lobe::cli
