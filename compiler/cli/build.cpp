// `lobec build`: compile models to the files of each target, or check that those files are fresh.
#include "cli/choice.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/program.h"
#include "cli/settings.h"
#include "cli/told.h"
#include "lobe/lobe.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>

namespace lobe::cli {
namespace {

struct Build {
    std::vector<std::string> inputs;
    std::vector<std::string> target_names;
    std::string output = "generated";
    ChoiceRequest choice;
    bool check = false;
    bool explain = false;

    int run(const Terminal& terminal) const
    {
        Limit limit;
        if (choice.is_set()) {
            if (const std::string why = understand(choice, limit); !why.empty())
                return fail(terminal, why);
        } else if (choice.says_where()) {
            return fail(terminal, "--on only says something to --max-error and --budget");
        }
        const Program program = load(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        if (explain) fmt::print("{}", told(program));

        std::vector<emit::Artifact> artifacts;
        if (choice.is_set()) {
            const int status = choose_and_build(terminal, program, limit, artifacts);
            if (status != success) return status;
        } else {
            artifacts = cli::build(program, choose_targets(target_names));
        }
        std::vector<OutputFile> files;
        for (emit::Artifact& artifact : artifacts)
            files.push_back({(std::filesystem::path{output} / artifact.path).generic_string(),
                             std::move(artifact.text)});
        return check ? compare(files) : write(terminal, files);
    }

    /// Every module with the forms that the limit asks for.
    int choose_and_build(const Terminal& terminal, const Program& program, const Limit& limit,
                         std::vector<emit::Artifact>& artifacts) const
    {
        const analyze::Store store = open_cache(choice.cache);
        std::string summary;
        for (const ir::Module& checked : program.modules) {
            Chosen chosen;
            {
                Progress progress{terminal};
                chosen = choose(checked, program.sources, limit, choice.jobs, progress, store);
            }
            if (!chosen.module) {
                fmt::print(stderr, "error: nothing in {} fits {}: {}\n", checked.path,
                           limit.options, chosen.why);
                return findings;
            }
            summary += chosen.summary;
            std::vector<emit::Artifact> files =
                back(*chosen.module, program.sources, choose_targets(target_names));
            std::ranges::move(files, std::back_inserter(artifacts));
        }
        if (!terminal.quiet) fmt::print("{}", summary);
        return success;
    }

    int write(const Terminal& terminal, const std::vector<OutputFile>& files) const
    {
        const Written written = write_files(files);
        if (!written.why.empty()) return fail(terminal, written.why + "; nothing was written");
        if (!terminal.quiet)
            fmt::print("{} files in {}: {} written, {} unchanged\n", files.size(), output,
                       written.written, written.unchanged);
        return success;
    }

    /// Both directions: what is generated must be there, and what is there must be generated.
    int compare(const std::vector<OutputFile>& files) const
    {
        std::set<std::string> expected;
        int stale = 0;
        for (const OutputFile& file : files) {
            expected.insert(file.path);
            if (holds(file)) continue;
            ++stale;
            fmt::print("{} is {}\n", file.path,
                       std::filesystem::exists(file.path) ? "stale" : "missing");
        }
        for (const std::string& path : files_below(output)) {
            const std::string whole = (std::filesystem::path{output} / path).generic_string();
            if (expected.contains(whole)) continue;
            ++stale;
            fmt::print("{} is an orphan: nothing generates it\n", whole);
        }
        return stale == 0 ? success : findings;
    }
};

}  // namespace

void add_build(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("build", "Compile models to shader files");
    auto build = std::make_shared<Build>();
    command->add_option("FILE", build->inputs, "A .lobe file, or a folder of them")->required();
    command->add_option("-t,--target", build->target_names, "Targets (default: all)")
        ->check(CLI::IsMember(lobe::target_names()))
        ->delimiter(',');
    command->add_option("-o,--output", build->output, "The folder to write into")
        ->capture_default_str();
    command->add_flag("--check", build->check,
                      "Write nothing; exit 1 when a file in the output folder is stale, missing "
                      "or an orphan");
    command->add_flag("--explain", build->explain,
                      "Say which rewrite or guard was used where, why, and what it gained");
    const std::string group = "Choosing forms";
    ChoiceRequest& choice = build->choice;
    command
        ->add_option("--max-error", choice.max_error,
                     "The cheapest forms whose error stays below this, such as 0.5%")
        ->group(group);
    command
        ->add_option("--budget", choice.budget,
                     "The most accurate forms within so many issue cycles")
        ->group(group);
    command->add_option("--on", choice.family, "The GPU family to judge on (default: rdna2)")
        ->check(CLI::IsMember(family_names()))
        ->group(group);
    command->add_option("-j,--jobs", choice.jobs, "Threads (default: one per core)")->group(group);
    add_cache_options(*command, choice.cache);
    command->footer("Writes nothing unless everything compiled, and leaves unchanged files alone.\n"
                    "What was chosen is in the banner of every file; `lobec pareto` shows between\n"
                    "what. Exits with 1 when nothing fits.\n"
                    "Example: lobec build models -o generated -t ue4,glsl450\n"
                    "         lobec build models/callisto.lobe --max-error 5% --on rdna2");
    command->callback([build, &terminal, &status] { status = build->run(terminal); });
}

}  // namespace lobe::cli
