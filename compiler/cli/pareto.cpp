// `lobec pareto`: what accuracy costs. Every way to compute a term, and every joint choice of forms
// for a model, with its error and its cycles, and what dominates it.
#include "analyze/pareto.h"

#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "cli/settings.h"
#include "report/document.h"
#include "report/pareto.h"
#include "report/pareto_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace lobe::cli {
namespace {

struct Pareto {
    std::vector<std::string> inputs;
    std::string term;
    std::string model;
    std::string family{analyze::name(default_family)};
    std::vector<std::string> settings;
    std::string json;
    std::string html;
    std::string svg;
    CacheOptions cache;
    std::size_t points = analyze::ParetoOptions{}.points;
    unsigned jobs = 0;
    bool all = false;

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}, {"--html", html}, {"--svg", svg}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);
        Program program = read_and_check(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        if (const std::string why = specialize(program, settings); !why.empty())
            return fail(terminal, why);

        std::vector<analyze::Pareto> results;
        {
            Progress progress{terminal};
            const analyze::Store store = open_cache(cache);
            for (std::size_t i = 0; i < program.modules.size(); ++i) {
                const ir::Module& module = program.modules[i];
                analyze::ParetoOptions options = options_of(program, i);
                options.progress = [&](const analyze::Progress& at) {
                    progress.show(fmt::format("{} ({} of {}): {} of {} {}", module.name, i + 1,
                                              program.modules.size(), at.done, at.total, at.what));
                };
                options.cost.progress = options.progress;
                results.push_back(analyze::pareto(module, program.sources, options, store));
            }
        }
        if (std::ranges::all_of(results, [](const auto& each) { return each.trades.empty(); }))
            return nothing(terminal, program);
        return report(terminal, program, results, outputs);
    }

    analyze::ParetoOptions options_of(const Program& program, std::size_t which) const
    {
        analyze::ParetoOptions out;
        out.cost.jobs = jobs;
        out.points = points;
        out.terms = model.empty() || !term.empty();
        out.models = term.empty() || !model.empty();
        out.only_term = term;
        out.only_model = model;
        // A term is shown with the module that declares it, if that is one of the inputs.
        for (std::size_t i = 0; i < program.modules.size(); ++i)
            if (i != which) out.elsewhere.push_back(program.modules[i].name);
        return out;
    }

    int nothing(const Terminal& terminal, const Program& program) const
    {
        std::vector<std::string> names;
        for (const ir::Module& module : program.modules)
            if (!model.empty())
                for (const ir::Model& each : module.models) names.push_back(each.name);
            else
                for (const ir::Function& function : module.functions)
                    if (function.kind == ir::Function::Kind::term) names.push_back(function.name);
        const std::string& wanted = model.empty() ? term : model;
        if (wanted.empty()) return fail(terminal, "no term and no model with a choice");
        if (std::ranges::count(names, wanted) > 0)
            return fail(terminal, fmt::format("there is one way only to compute `{}`", wanted));
        const auto near = nearest(wanted, names);
        return fail(terminal, fmt::format("no {} `{}`{}", model.empty() ? "term" : "model", wanted,
                                          near ? fmt::format("; did you mean `{}`?", *near) : ""));
    }

    int report(const Terminal& terminal, const Program& program,
               const std::vector<analyze::Pareto>& results, std::vector<Output>& outputs) const
    {
        const analyze::Family on = *analyze::find_family(family);
        if (!svg.empty()) {
            const std::vector<const analyze::Trade*> trades = drawn(results);
            if (trades.size() != 1)
                return fail(terminal, fmt::format("--svg draws one trade, not {}: name it with "
                                                  "--model or --term",
                                                  trades.size()));
            if (const std::string& why = results.front().about.no_statistics; !why.empty())
                return fail(terminal, "--svg has no costs to draw: " + why);
            outputs[2].text = report::trade_svg(*trades.front());
        }
        std::string measured;
        for (const std::string& setting : settings) measured += " --set " + setting;
        if (points != analyze::ParetoOptions{}.points)
            measured += fmt::format(" --points {}", points);
        if (!is_piped(outputs) && !terminal.quiet) {
            const report::Look look{terminal.color_on_stdout(), terminal.width()};
            std::string given = measured;
            if (on != default_family) given += " --on " + family;
            if (all) given += " --all";
            for (std::size_t i = 0; i < results.size(); ++i) {
                fmt::print("{}", report::to_text(results[i], on, all, program.modules[i].path,
                                                 given, look));
                if (!results[i].about.no_statistics.empty())
                    fmt::print("no costs: {}\n", results[i].about.no_statistics);
            }
            fmt::print("issue cycles of one evaluation on {}, by {}\n", analyze::title(on),
                       results.front().about.driver);
        }
        outputs[0].text = report::to_json(results);
        report::Document page;
        page.title = "Error against cost";
        for (std::size_t i = 0; i < results.size(); ++i)
            for (report::Section& section :
                 report::pareto_sections(results[i], program.modules[i].path, measured))
                page.sections.push_back(std::move(section));
        outputs[1].text = report::to_page(page);
        return write(terminal, outputs, success);
    }

    /// What a picture could be of: models if there are any.
    static std::vector<const analyze::Trade*> drawn(const std::vector<analyze::Pareto>& results)
    {
        std::vector<const analyze::Trade*> models;
        std::vector<const analyze::Trade*> terms;
        for (const analyze::Pareto& result : results)
            for (const analyze::Trade& trade : result.trades)
                (trade.whole_model ? models : terms).push_back(&trade);
        return models.empty() ? terms : models;
    }
};

}  // namespace

void add_pareto(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "pareto", "Show error against cost: of every form of a term, and of joint choices");
    auto pareto = std::make_shared<Pareto>();
    command->add_option("FILE", pareto->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("--term", pareto->term, "Only this term");
    command->add_option("--model", pareto->model, "Only this model");
    command->add_option("--on", pareto->family, "The GPU family to judge on")
        ->check(CLI::IsMember(family_names()))
        ->capture_default_str();
    command
        ->add_option("--set", pareto->settings,
                     "Fix a parameter: name=value, or name=r,g,b; can be repeated")
        ->allow_extra_args(false);
    command->add_flag("--all", pareto->all, "Show the dominated ways of a model, too");
    command->add_option("--json", pareto->json,
                        "Write the results as JSON; `-` is standard output");
    command->add_option("--html", pareto->html, "Write a self-contained page; `-` likewise");
    command->add_option("--svg", pareto->svg, "Write one trade as a picture; `-` likewise");
    command->add_option("--points", pareto->points, "Points at which errors are measured")
        ->check(CLI::Range(1024, 1 << 24))
        ->capture_default_str();
    command->add_option("-j,--jobs", pareto->jobs, "Threads (default: one per core)");
    add_cache_options(*command, pareto->cache);
    command->footer(
        "model: what the form differs from the definition over the reals; rounding: what the\n"
        "number format adds, and a proved bound of it where arguments and fields are exact;\n"
        "worst: model and rounding together, relative to the exact value or to a grey card where\n"
        "that is brighter; codes: the same on an 8-bit display. A model is judged by what 99 % of\n"
        "its points stay below, a term by its worst. docs/pareto.md says more.\n"
        "Example: lobec pareto models/callisto.lobe --model callisto --on rdna3");
    command->callback([pareto, &terminal, &status] { status = pareto->run(terminal); });
}

}  // namespace lobe::cli
