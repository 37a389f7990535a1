// `lobec check`: diagnostics and nothing else.
#include "cli/commands.h"
#include "cli/program.h"

#include <fmt/format.h>

#include <memory>

namespace lobe::cli {

void add_check(CLI::App& app, const Terminal& terminal, int& status)
{
    struct Check {
        std::vector<std::string> inputs;
        std::string format = "text";
    };
    auto* command = app.add_subcommand("check", "Report what is wrong with models, write nothing");
    auto check = std::make_shared<Check>();
    command->add_option("FILE", check->inputs, "A .lobe file, or a folder of them")->required();
    command
        ->add_option("--format,--message-format", check->format,
                     "text, short (one line each), json (one object a line), sarif")
        ->check(CLI::IsMember({"text", "short", "json", "sarif"}))
        ->capture_default_str();
    command->footer("Example: lobec check models --format sarif > findings.sarif");
    command->callback([check, &terminal, &status] {
        Terminal chosen = terminal;
        chosen.format = check->format;
        const Program program = load(chosen, check->inputs);
        print(chosen, program.diagnostics, program.sources);
        if (program.status == success && !chosen.quiet && chosen.format == "text") {
            std::size_t terms = 0;
            for (const ir::Module& module : program.modules)
                terms += module.roots().size() + module.shadings.size();
            fmt::print("{} {}, {} exported functions: no errors\n", program.modules.size(),
                       program.modules.size() == 1 ? "module" : "modules", terms);
        }
        status = program.status;
    });
}

}  // namespace lobe::cli
