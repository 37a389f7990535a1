// `lobec format`: the one way to write a file.
#include "syntax/format.h"

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/program.h"
#include "syntax/parse.h"

#include <fmt/format.h>

#include <memory>

namespace lobe::cli {
namespace {

struct Format {
    std::vector<std::string> inputs;
    bool check = false;
    bool to_stdout = false;

    int run(const Terminal& terminal) const
    {
        const auto paths = expand_inputs(terminal, inputs);
        if (!paths) return broken;

        int status = success;
        std::vector<OutputFile> files;
        Sources sources;
        Diagnostics diagnostics;
        for (const std::string& path : *paths) {
            auto read = read_file(path, largest_source);
            if (!read.text)
                return fail(terminal, fmt::format("cannot read `{}`: {}", path, read.why));
            const auto source = sources.add(path, std::move(*read.text));
            const int errors = diagnostics.error_count();
            const syntax::Tree tree = syntax::parse(sources, source, diagnostics);
            if (diagnostics.error_count() > errors)
                status = findings;
            else
                files.push_back({path, syntax::format(tree)});
        }
        print(terminal, diagnostics, sources);
        if (status != success) return status;

        if (to_stdout) {
            for (const OutputFile& file : files) fmt::print("{}", file.text);
            return success;
        }
        if (!check) {
            const Written written = write_files(files);
            if (!written.why.empty()) return fail(terminal, written.why + "; nothing was written");
            if (!terminal.quiet)
                fmt::print("{} formatted, {} unchanged\n", written.written, written.unchanged);
            return success;
        }
        for (const OutputFile& file : files) {
            if (holds(file)) continue;
            fmt::print("{} is not in canonical form\n", file.path);
            status = findings;
        }
        return status;
    }
};

}  // namespace

void add_format(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("format", "Rewrite models in canonical form");
    auto format = std::make_shared<Format>();
    command->add_option("FILE", format->inputs, "A .lobe file, or a folder of them")->required();
    auto* check = command->add_flag("--check", format->check,
                                    "Write nothing; exit 1 when a file is not canonical");
    command->add_flag("--stdout", format->to_stdout, "Print instead of rewriting")->excludes(check);
    command->footer("Files with syntax errors are reported and left alone.\n"
                    "Example: lobec format models --check");
    command->callback([format, &terminal, &status] { status = format->run(terminal); });
}

}  // namespace lobe::cli
