// `lobec pack`: where parameters live in the GBuffer and what that does to the picture; and, with
// --suggest, a search for a better layout.
#include "cli/pack.h"

#include "cli/commands.h"
#include "cli/outputs.h"
#include "report/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>

namespace lobe::cli {
namespace {

struct Pack {
    std::vector<std::string> inputs;
    std::string model;
    bool suggest = false;
    SearchRequest request;
    std::string json;
    std::string svg;
    std::string html;
    std::size_t points = analyze::RadianceOptions{}.points;
    unsigned jobs = 0;

    analyze::RadianceOptions radiance() const { return {points, jobs}; }
    std::vector<Output> outputs() const
    {
        return {{"--json", json}, {"--svg", svg}, {"--html", html}};
    }

    int run(const Terminal& terminal) const
    {
        if (const std::string why = conflict(outputs()); !why.empty()) return fail(terminal, why);
        if (!suggest && request.is_set())
            return fail(terminal,
                        fmt::format("{} only says something to --suggest", request.first_option()));
        Program program = read_and_check(terminal, inputs);
        if (program.status != success) {
            print(terminal, program.diagnostics, program.sources);
            return program.status;
        }
        return suggest ? search(terminal, program) : measure(terminal, program);
    }

    /// Every packing as it is written.
    int measure(const Terminal& terminal, Program& program) const
    {
        std::vector<std::string> names;
        std::deque<ir::Module> modules;  // optimized; reports point into them
        std::vector<report::Packed> reports;
        {
            Progress progress{terminal};
            for (const ir::Module& checked : program.modules) {
                if (checked.packings.empty()) continue;
                const ir::Module& module = modules.emplace_back(middle(checked));
                for (const ir::Packing& packing : module.packings) {
                    names.push_back(packing.model.name);
                    if (!model.empty() && packing.model.name != model) continue;
                    progress.show(fmt::format("measuring {}", packing.model.name));
                    reports.push_back(measured(module, packing, radiance(), program.diagnostics));
                }
            }
        }
        if (reports.empty()) return no_packing(terminal, program, names);
        const int status = show(terminal, reports);
        print(terminal, program.diagnostics, program.sources);
        return status == success && program.diagnostics.has_errors() ? findings : status;
    }

    int search(const Terminal& terminal, Program& program) const
    {
        Subject subject;
        if (std::string why = choose_subject(program, model, request.gbuffer, subject);
            !why.empty())
            return fail(terminal, why);
        analyze::SuggestOptions options;
        if (std::string why = understand(request, subject, options); !why.empty())
            return fail(terminal, why);
        options.radiance = radiance();

        std::optional<report::Packed> written;
        analyze::Suggestion suggestion;
        std::optional<ir::Module> optimized;
        {
            Progress progress{terminal};
            if (subject.is_written) {
                optimized = middle(*subject.original);
                Diagnostics ignored;  // what is wrong with the written one is why one searches
                written =
                    measured(*optimized, optimized->packings[subject.packing], radiance(), ignored);
            }
            options.progress = [&progress](std::size_t done, std::size_t total) {
                progress.show(fmt::format("searching: {} of {}", done, total));
            };
            suggestion = analyze::suggest(subject.module, subject.packing, options);
        }

        // A search without a limit of its own has the source's.
        std::optional<double> limit = options.error;
        if (!limit) limit = subject.module.packings[subject.packing].radiance_limit;
        report::Packed found;
        std::optional<ir::Module> suggested;
        if (suggestion.found) {
            suggested = middle(suggestion.module);
            found.module = &*suggested;
            found.packing = &suggested->packings.back();
            found.codes = analyze::field_codes(*suggested, *found.packing);
            found.errors = suggestion.errors;
            found.met = !limit || found.errors.whole.worst < *limit;
        } else {
            // Nothing to draw; the packing is for its names alone.
            found.module = &subject.module;
            found.packing = &subject.module.packings[subject.packing];
            found.met = false;
        }
        found.room = options.room;
        found.suggestion = &suggestion;
        found.limit = limit;
        if (written) {
            found.written_error = written->errors.whole.worst;
            for (const ir::Field& field : written->packing->fields)
                found.written_bits += field.bits;
        }
        const int status = show(terminal, {&found, 1});
        for (const std::string& note : subject.notes) fmt::print(stderr, "note: {}\n", note);
        return status == success && !found.met ? findings : status;
    }

    /// On the terminal, and into the files that were asked for.
    int show(const Terminal& terminal, std::span<const report::Packed> reports) const
    {
        std::vector<Output> written = outputs();
        written[0].text = report::to_json(reports);
        written[1].text = report::to_svg(reports);
        written[2].text = report::to_page(reports);
        if (!is_piped(written) && !terminal.quiet) {
            const report::Look look{terminal.color_on_stdout(), terminal.width()};
            for (std::size_t i = 0; i < reports.size(); ++i)
                fmt::print("{}{}", i > 0 ? "\n" : "", report::to_text(reports[i], look));
        }
        return write(terminal, written, success);
    }

    int no_packing(const Terminal& terminal, const Program& program,
                   const std::vector<std::string>& names) const
    {
        if (!names.empty()) {
            const auto near = nearest(model, names);
            return fail(terminal,
                        fmt::format("no packing of a model `{}`{}", model,
                                    near ? fmt::format("; did you mean `{}`?", *near) : ""));
        }
        std::string paths;
        for (const ir::Module& module : program.modules)
            paths += (paths.empty() ? "" : ", ") + module.path;
        return fail(terminal, fmt::format("no packing in {}\n  = help: `lobec pack FILE --suggest "
                                          "--on GBUFFER` searches for one",
                                          paths));
    }
};

}  // namespace

report::Packed measured(const ir::Module& module, const ir::Packing& packing,
                        const analyze::RadianceOptions& options, Diagnostics& diagnostics)
{
    report::Packed out;
    out.module = &module;
    out.packing = &packing;
    out.room = analyze::room(out.gbuffer(), packing);
    out.codes = analyze::field_codes(module, packing);
    out.errors = analyze::packing_errors(module, packing, options);
    const Diagnostics found = analyze::unmet(module, packing, out.errors);
    for (const Diagnostic& diagnostic : found.all()) diagnostics.report(diagnostic);
    out.limit = packing.radiance_limit;
    out.met = !found.has_errors();
    return out;
}

void add_pack(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "pack", "Show how parameters are packed into a GBuffer, what it costs, and what is better");
    auto pack = std::make_shared<Pack>();
    command->add_option("FILE", pack->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("--packing", pack->model, "Only the packing of this model");
    command->add_option("--json", pack->json, "Write the results as JSON; `-` is standard output");
    command->add_option("--svg", pack->svg, "Write the layout as a picture; `-` likewise");
    command->add_option("--html", pack->html, "Write a self-contained page; `-` likewise");
    command->add_option("--points", pack->points, "Points at which radiance is compared")
        ->check(CLI::Range(64, 1 << 24))
        ->capture_default_str();
    command->add_option("-j,--jobs", pack->jobs, "Threads (default: one per core)");
    command->add_flag("--suggest", pack->suggest,
                      "Search for the layout with the least radiance error, and show the trade");

    SearchRequest& request = pack->request;
    const std::string group = "With --suggest";
    command->add_option("--on", request.gbuffer, "The gbuffer (default: the packing's)")
        ->group(group);
    auto* parameters =
        command
            ->add_option("--parameters", request.parameters,
                         "What to place (default: what the packing has, or every scalar)")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->group(group);
    command->add_option("--tier", request.tiers, "Or: the scalars of these tiers")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->excludes(parameters)
        ->group(group);
    command->add_option("--channels", request.channels, "Use only these, such as d.r,d.g")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group(group);
    command->add_option("--bits", request.bits, "Use only so many bits")
        ->check(CLI::Range(1, 1024))
        ->group(group);
    command->add_option("--without", request.without, "Take content that the engine lends")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group(group);
    command
        ->add_option("--max-error", request.max_error,
                     "Find the fewest bits with less error than this, such as 10%")
        ->group(group);
    command->footer(
        "Error is the change of radiance, relative to the pixel or to a grey card lit alike,\n"
        "whichever is brighter: the worst, what 95 % of the points stay below, and the median.\n"
        "Exits with 1 when a `require radiance error` is not met, or nothing was found.\n"
        "Example: lobec pack models/callisto.lobe --svg layout.svg\n"
        "         lobec pack models/callisto.lobe --suggest --tier base --bits 24");
    command->callback([pack, &terminal, &status] { status = pack->run(terminal); });
}

}  // namespace lobe::cli
