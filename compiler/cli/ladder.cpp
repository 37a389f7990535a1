// `lobec ladder`: what the shaders of several scenes cost, beside the general one.
#include "analyze/residual/ladder.h"

#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/scene_file.h"
#include "report/ladder.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace lobe::cli {
namespace {

struct LadderCommand {
    std::string input;
    std::vector<std::string> scenes;
    std::vector<std::string> references;
    std::string device;
    std::string json;
    std::string markdown;
    CacheOptions cache;
    unsigned jobs = 0;
    bool nanoseconds = false;

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}, {"--markdown", markdown}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);
        const ModelFile file = load_model(terminal, input);
        if (file.status != success) return file.status;
        std::vector<ModelFile> others;
        for (const std::string& reference : references) {
            others.push_back(load_model(terminal, reference));
            if (others.back().status != success) return others.back().status;
        }
        std::vector<analyze::LadderScene> rungs;
        bool complete = true;
        for (const std::string& path : scenes) {
            auto read = read_facts(terminal, path, file);
            complete = complete && read;
            if (read)
                rungs.push_back(
                    {std::filesystem::path{path}.stem().string(), std::move(read->facts)});
        }
        if (!complete) return broken;
        const analyze::Ladder ladder = measure(terminal, file, rungs, others);
        if (!terminal.quiet && !is_piped(outputs))
            fmt::print("{}",
                       report::to_text(ladder, {terminal.color_on_stdout(), terminal.width()}));
        outputs[0].text = report::to_json(ladder);
        outputs[1].text = report::to_markdown(ladder);
        return write(terminal, outputs, success);
    }

    analyze::Ladder measure(const Terminal& terminal, const ModelFile& file,
                            const std::vector<analyze::LadderScene>& rungs,
                            const std::vector<ModelFile>& others) const
    {
        Progress progress{terminal};
        analyze::CostOptions options;
        options.nanoseconds = nanoseconds;
        options.device = device;
        options.jobs = jobs;
        options.progress = [&](const analyze::Progress& at) {
            progress.show(fmt::format("{} of {} {}", at.done, at.total, at.what));
        };
        std::vector<analyze::LadderReference> compared;
        for (const ModelFile& other : others)
            compared.push_back(
                {fmt::format("{}, by hand", other.model), &other.module(), other.model});
        return analyze::ladder(file.module(), file.model, file.program.sources, rungs, compared,
                               options, open_cache(cache));
    }
};

}  // namespace

void add_ladder(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "ladder", "Show what several scenes' shaders cost, beside the shader for everything");
    auto ladder = std::make_shared<LadderCommand>();
    command->add_option("FILE", ladder->input, "A .lobe file, or FILE:MODEL")->required();
    command->add_option("SCENE", ladder->scenes, ".gltf or .glb files")->required();
    command
        ->add_option("--beside", ladder->references,
                     "Also this model, FILE or FILE:MODEL, written by hand; can be repeated")
        ->allow_extra_args(false);
    auto* const time = command->add_flag("--nanoseconds", ladder->nanoseconds,
                                         "Also run them, on a device and on the CPU");
    command
        ->add_option("-d,--device", ladder->device,
                     "A number or part of a name from `lobec devices` (default: software)")
        ->needs(time);
    command->add_option("--json", ladder->json,
                        "Write the results as JSON; `-` is standard output");
    command->add_option("--markdown", ladder->markdown,
                        "Write the table as Markdown; `-` likewise");
    command->add_option("-j,--jobs", ladder->jobs, "Threads (default: one per core)");
    add_cache_options(*command, ladder->cache);
    command->footer(
        "One shader per scene, for all of its materials. Costs are issue cycles of one evaluation\n"
        "more from vectors, per GPU family, without a GPU.\n"
        "Example: lobec ladder models/callisto.lobe base.gltf skin.gltf all.gltf --markdown -");
    command->callback([ladder, &terminal, &status] { status = ladder->run(terminal); });
}

}  // namespace lobe::cli
