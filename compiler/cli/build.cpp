// `lobec build`: compile models to the files of each target, or check that those files are fresh.
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/program.h"
#include "lobe/lobe.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

namespace lobe::cli {
namespace {

struct Build {
    std::vector<std::string> inputs;
    std::vector<std::string> target_names;
    std::string output = "generated";
    bool check = false;

    int run(const Terminal& terminal) const
    {
        const Program program = load(terminal, inputs);
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;

        std::vector<OutputFile> files;
        for (emit::Artifact& artifact : cli::build(program, choose_targets(target_names)))
            files.push_back({(std::filesystem::path{output} / artifact.path).generic_string(),
                             std::move(artifact.text)});
        return check ? compare(files) : write(terminal, files);
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
    command->footer("Writes nothing unless everything compiled, and leaves unchanged files alone.\n"
                    "Example: lobec build models -o generated -t ue4,glsl450");
    command->callback([build, &terminal, &status] { status = build->run(terminal); });
}

}  // namespace lobe::cli
