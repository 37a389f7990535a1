// `lobec`: arguments in, one command run, an exit code out.
#include "cli/commands.h"
#include "device/statistics.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>

int main(int argc, char** argv)
{
    using namespace lobe::cli;

    // What `lobec cost` starts, one per chip.
    if (const auto status = lobe::device::serve_statistics(argc, argv)) return *status;

    // A file that grows past a limit is an error to report, like a full disk, not a signal to die
    // of.
    std::signal(SIGXFSZ, SIG_IGN);

    CLI::App app{"lobec: a compiler for BRDF terms.\n"
                 "One .lobe file becomes Unreal .ush, GLSL, ESSL and HLSL, each validated by real\n"
                 "compilers, executed, and held against a CPU evaluator.",
                 "lobec"};
    app.set_version_flag("--version", "lobec " LOBE_VERSION);
    app.require_subcommand(1);
    app.fallthrough();
    app.footer("Examples:\n"
               "  lobec build models/callisto.lobe -o out\n"
               "  lobec pack models/callisto.lobe --svg layout.svg\n"
               "  lobec patch models/callisto.lobe --engine ~/UnrealEngine -o callisto.patch\n"
               "  lobec verify models --json result.json\n"
               "  lobec explain E0501\n"
               "`lobec COMMAND --help` shows each command with an example.\n"
               "Exit codes: 0 success, 1 findings, 2 usage or unreadable input.");

    Terminal terminal;
    app.add_option("--color", terminal.color, "Color: auto (on a terminal), always, never")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->capture_default_str();
    app.add_flag("-q,--quiet", terminal.quiet, "No progress and no summary, only findings");

    app.add_option("-I,--imports", terminal.imports,
                   "Look for imported modules here too; can be repeated")
        ->type_name("FOLDER")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->check(CLI::ExistingDirectory);

    int status = success;
    add_build(app, terminal, status);
    add_check(app, terminal, status);
    add_cost(app, terminal, status);
    add_format(app, terminal, status);
    add_evaluate(app, terminal, status);
    add_pack(app, terminal, status);
    add_pareto(app, terminal, status);
    add_patch(app, terminal, status);
    add_scene(app, terminal, status);
    add_specialize(app, terminal, status);
    add_ladder(app, terminal, status);
    add_render(app, terminal, status);
    add_stability(app, terminal, status);
    add_table(app, terminal, status);
    add_verify(app, terminal, status);
    add_explain(app, terminal, status);
    add_devices(app, terminal, status);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // CLI11 has its own exit codes; ours are a promise.
        return app.exit(error) == 0 ? success : broken;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return broken;
    }
    // Results on a full disk or a closed pipe are not results.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        fmt::print(stderr, "error: cannot write to standard output\n");
        return broken;
    }
    return status;
}
