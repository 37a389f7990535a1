// `lobec cost`: what terms and models cost, and whether that is more than it was.
#include "analyze/cost/cost.h"

#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "cli/settings.h"
#include "ir/shade.h"
#include "optimize/spelling.h"
#include "report/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace lobe::cli {
namespace {

/// A spelling as it is typed: `as-written`.
std::string option_name(optimize::Spelling spelling)
{
    std::string text{optimize::name(spelling)};
    std::ranges::replace(text, ' ', '-');
    return text;
}

/// A format as it is typed: `packed`.
std::string option_name(analyze::Format format)
{
    return format == analyze::Format::packed16 ? "packed" : std::string{analyze::name(format)};
}

constexpr std::array all_formats{analyze::Format::float32, analyze::Format::float16,
                                 analyze::Format::packed16};

template <class Values>
std::vector<std::string> option_names(const Values& values)
{
    std::vector<std::string> names;
    for (const auto value : values) names.push_back(option_name(value));
    return names;
}

struct Cost {
    std::vector<std::string> inputs;
    std::vector<std::string> terms;
    std::vector<std::string> families;
    std::vector<std::string> formats{"float"};
    std::vector<std::string> spellings{"stable"};
    std::vector<std::string> settings;
    std::string device;
    std::string json;
    std::string baseline;
    std::string fail_above;
    CacheOptions cache;
    unsigned jobs = 0;
    bool from_vectors = false;
    bool nanoseconds = false;

    /// What is measured, in the order of the table.
    struct Plan {
        std::vector<ir::Module> modules;  ///< by module and spelling; subjects point into it
        std::vector<analyze::CostSubject> subjects;
        std::vector<report::CostRow> rows;  ///< of the subjects, without their costs
    };

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}};
        std::optional<double> limit;
        if (!fail_above.empty()) {
            limit = fail_above == "0" || fail_above == "0%" ? 0.0 : fraction_of(fail_above);
            if (!limit)
                return fail(terminal,
                            fmt::format("--fail-above: `{}` is no share; `2%` is one", fail_above));
        }
        std::optional<report::CostReport> before;
        if (!baseline.empty()) {
            std::string why;
            before = read_baseline(why);
            if (!before) return fail(terminal, fmt::format("cannot use {}: {}", baseline, why));
        }
        Program program = read_and_check(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        if (const std::string why = specialize(program, settings); !why.empty())
            return fail(terminal, why);
        const Plan plan = make_plan(program.modules);
        if (const std::string why = unknown_term(program.modules, plan); !why.empty())
            return fail(terminal, why);

        report::CostReport report;
        const analyze::Costs costs = measure(terminal, program.sources, plan);
        if (!device.empty() && !costs.no_device.empty()) return fail(terminal, costs.no_device);
        report.rows = plan.rows;
        for (std::size_t i = 0; i < costs.costs.size(); ++i) report.rows[i].cost = costs.costs[i];
        report.driver = costs.driver;
        report.device = costs.device;
        report.from_vectors = from_vectors;

        if (!terminal.quiet && !is_piped(outputs)) show(terminal, report, costs);
        outputs[0].text = report::to_json(report);
        int status = success;
        if (before) {
            keep_comparable(*before, plan);
            const auto comparison = report::compare(*before, report, chosen_families());
            if (!is_piped(outputs))
                fmt::print("{}", report::to_text(comparison, look_of(terminal)));
            if (limit && comparison.regressed(*limit)) status = findings;
        }
        return write(terminal, outputs, status);
    }

    std::vector<analyze::Family> chosen_families() const
    {
        std::vector<analyze::Family> chosen;
        for (const analyze::Family family : analyze::all_families)
            if (families.empty() || std::ranges::count(families, analyze::name(family)) > 0)
                chosen.push_back(family);
        return chosen;
    }

    static report::Look look_of(const Terminal& terminal)
    {
        return {terminal.color_on_stdout(), terminal.width()};
    }

    bool wants(const std::string& name) const
    {
        return terms.empty() || std::ranges::count(terms, name) > 0;
    }

    /// Terms and their forms, then models, lights and what shades; what a packing stores only where
    /// it is named.
    Plan make_plan(const std::vector<ir::Module>& modules) const
    {
        Plan plan;
        std::vector<optimize::Spelling> chosen;
        for (const optimize::Spelling spelling : optimize::spellings())
            if (std::ranges::count(spellings, option_name(spelling)) > 0)
                chosen.push_back(spelling);
        plan.modules.reserve(modules.size() * chosen.size());
        for (const ir::Module& module : modules) {
            const std::size_t first = plan.modules.size();
            for (const optimize::Spelling spelling : chosen)
                plan.modules.push_back(optimize::spell(module, spelling));
            const auto add = [&](const std::string& name, bool whole_model,
                                 const std::vector<std::string>& functions) {
                for (std::size_t i = 0; i < chosen.size(); ++i)
                    for (const analyze::Format format : all_formats)
                        if (std::ranges::count(formats, option_name(format)) > 0)
                            add_subject(plan, plan.modules[first + i], chosen[i], format, name,
                                        whole_model, functions);
            };
            for (const ir::FunctionId id : analyze::checked_functions(module)) {
                const ir::Function& function = module[id];
                const bool is_term = function.kind == ir::Function::Kind::term ||
                                     function.kind == ir::Function::Kind::form;
                if (wants(function.name) && (is_term || !terms.empty()))
                    add(function.name, false, {function.name});
            }
            for (const auto* list : {&module.models, &module.lights})
                for (const ir::Model& model : *list) {
                    std::vector<std::string> functions;
                    for (const ir::ModelOutput& output : model.outputs)
                        functions.push_back(module[output.function].name);
                    if (wants(model.name)) add(model.name, true, functions);
                }
            for (const ir::Shading& shading : module.shadings) {
                const std::string name = ir::shade_name(shading.model, shading.light);
                if (wants(name)) add(name, false, {name});
            }
        }
        return plan;
    }

    void add_subject(Plan& plan, const ir::Module& module, optimize::Spelling spelling,
                     analyze::Format format, const std::string& name, bool whole_model,
                     const std::vector<std::string>& functions) const
    {
        analyze::CostSubject subject{&module, {}, format, from_vectors};
        for (const std::string& function : functions) {
            const auto id = module.find(function);
            if (!id) return;  // this spelling has no use for it
            subject.functions.push_back(*id);
        }
        plan.subjects.push_back(std::move(subject));
        plan.rows.push_back(
            {module.name, name, whole_model, option_name(spelling), option_name(format), {}});
    }

    std::string unknown_term(const std::vector<ir::Module>& modules, const Plan& plan) const
    {
        for (const std::string& term : terms) {
            if (std::ranges::count(plan.rows, term, &report::CostRow::name) > 0) continue;
            std::vector<std::string> names;
            for (const ir::Module& module : modules) {
                for (const ir::FunctionId id : analyze::checked_functions(module))
                    names.push_back(module[id].name);
                for (const auto* list : {&module.models, &module.lights})
                    for (const ir::Model& model : *list) names.push_back(model.name);
                for (const ir::Shading& shading : module.shadings)
                    names.push_back(ir::shade_name(shading.model, shading.light));
            }
            const auto near = nearest(term, names);
            return fmt::format("no term or model `{}`{}", term,
                               near ? fmt::format("; did you mean `{}`?", *near) : "");
        }
        return plan.rows.empty() ? "no term and no model to measure" : "";
    }

    analyze::Costs measure(const Terminal& terminal, const Sources& sources, const Plan& plan) const
    {
        Progress progress{terminal};
        analyze::CostOptions options;
        options.families = chosen_families();
        options.nanoseconds = nanoseconds;
        options.device = device;
        options.jobs = jobs;
        options.progress = [&](const analyze::Progress& at) {
            progress.show(fmt::format("{} of {} {}", at.done, at.total, at.what));
        };
        return analyze::measure_costs(plan.subjects, sources, options, open_cache(cache));
    }

    void show(const Terminal& terminal, const report::CostReport& report,
              const analyze::Costs& costs) const
    {
        const auto chosen = chosen_families();
        fmt::print("{}\n", report::render(report::cost_table(report, chosen), look_of(terminal)));
        const std::string_view with = from_vectors ? ", with what its fields take," : "";
        if (!costs.no_statistics.empty())
            fmt::print("no cycles: {}\n", costs.no_statistics);
        else if (chosen.size() == 1)
            fmt::print("cycles of one evaluation more{} on {}, by {}\n", with,
                       analyze::title(chosen.front()), report.driver);
        else
            fmt::print("issue cycles of one evaluation more{} by {}; --on rdna2 shows all that is "
                       "known of one family\n",
                       with, report.driver);
        if (nanoseconds && costs.no_device.empty())
            fmt::print("nanoseconds of one evaluation on {}, and on one core\n", report.device);
        else if (nanoseconds)
            fmt::print("no nanoseconds of a device: {}\n", costs.no_device);
    }

    std::optional<report::CostReport> read_baseline(std::string& why) const
    {
        const Read file = read_file(baseline, largest_source);
        if (!file.text) {
            why = file.why;
            return std::nullopt;
        }
        auto before = report::read_costs(*file.text, why);
        if (before && before->from_vectors != from_vectors) {
            why = before->from_vectors ? "it was measured with --from-vectors"
                                       : "it was measured without --from-vectors";
            return std::nullopt;
        }
        for (const std::string& family : families)
            if (before && std::ranges::any_of(before->rows, [&](const report::CostRow& row) {
                    return !row.cost.families.empty() &&
                           !row.cost.families.contains(*analyze::find_family(family));
                })) {
                why = fmt::format("it has no cycles on {}", family);
                return std::nullopt;
            }
        return before;
    }

    /// Rows of the baseline that were not asked for now are not gone.
    void keep_comparable(report::CostReport& before, const Plan& plan) const
    {
        std::erase_if(before.rows, [&](const report::CostRow& row) {
            const bool asked = wants(row.name) && std::ranges::count(formats, row.format) > 0 &&
                               std::ranges::count(spellings, row.spelling) > 0 &&
                               std::ranges::count(plan.modules, row.module, &ir::Module::name) > 0;
            return !asked;
        });
    }
};

}  // namespace

void add_cost(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "cost", "Measure what terms and models cost, per GPU family, without a GPU");
    auto cost = std::make_shared<Cost>();
    command->add_option("FILE", cost->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("--term", cost->terms, "Only these terms, forms, outputs or models")
        ->allow_extra_args(false);
    command->add_option("--on", cost->families, "GPU families (default: all)")
        ->check(CLI::IsMember(family_names()))
        ->delimiter(',');
    command->add_option("--format", cost->formats, "float, half, packed (default: float)")
        ->check(CLI::IsMember(option_names(all_formats)))
        ->delimiter(',');
    command
        ->add_option("--spelling", cost->spellings,
                     "stable, factored, as-written, naive (default: stable, what a build emits)")
        ->check(CLI::IsMember(option_names(optimize::spellings())))
        ->delimiter(',');
    command
        ->add_option("--set", cost->settings,
                     "Fix a parameter: name=value, or name=r,g,b; can be repeated")
        ->allow_extra_args(false);
    command->add_flag("--from-vectors", cost->from_vectors,
                      "With what the fields of the geometry take, from l, v and n");
    auto* const time = command->add_flag("--nanoseconds", cost->nanoseconds,
                                         "Also run them, on a device and on the CPU");
    command
        ->add_option("--device", cost->device,
                     "A number or part of a name from `lobec devices` (default: software)")
        ->needs(time);
    command->add_option("--json", cost->json, "Write the results as JSON; `-` is standard output");
    auto* const baseline = command->add_option(
        "--baseline", cost->baseline, "Say what was helped and hurt since this file of --json");
    command
        ->add_option("--fail-above", cost->fail_above,
                     "Exit with 1 if anything costs more than this share more: 2%")
        ->needs(baseline);
    command->add_option("-j,--jobs", cost->jobs, "Threads (default: one per core)");
    add_cache_options(*command, cost->cache);
    command->footer(
        "issue: cycles in which a wave keeps its unit busy; VALU, trans: vector instructions,\n"
        "transcendental ones apart; throughput, latency: the driver's estimates. All are "
        "marginal:\n"
        "of one evaluation more in a shader that runs already. docs/cost.md says how.\n"
        "Example: lobec cost models/microfacet.lobe --on rdna2 --json cost.json\n"
        "         lobec cost models/microfacet.lobe --baseline cost.json --fail-above 2%");
    command->callback([cost, &terminal, &status] { status = cost->run(terminal); });
}

}  // namespace lobe::cli
