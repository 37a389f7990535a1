// `lobec evaluate`: a term over a table of inputs, in a chosen kind of number.
#include "analyze/table.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/program.h"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

namespace lobe::cli {
namespace {

struct Evaluate {
    std::string input;
    std::string term;
    std::string table = "-";
    std::string output = "-";
    std::string number = "double";

    int run(const Terminal& terminal) const
    {
        const auto kind = analyze::find_number_kind(number);
        if (!kind)
            return fail(terminal, fmt::format("unknown kind of number `{}`; there are {}", number,
                                              analyze::number_kinds));

        const Program program = load(terminal, {input});
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        if (program.modules.size() != 1)
            return fail(terminal, "evaluate takes one file, not a folder");

        const ir::Module module = middle(program.modules.front());
        const auto function = analyze::find_function(module, term);
        if (!function) return unknown_term(terminal, input, module, term);

        std::ifstream file;
        if (table != "-") {
            file.open(table, std::ios::binary);
            if (!file) return fail(terminal, fmt::format("cannot read `{}`", table));
        }
        std::istream& in = table == "-" ? std::cin : file;

        if (output == "-")
            return finish(terminal,
                          analyze::evaluate_table(module, *function, *kind, in, std::cout));
        // Nothing half-written: the file appears only when the whole table is computed.
        std::ostringstream whole;
        const int status =
            finish(terminal, analyze::evaluate_table(module, *function, *kind, in, whole));
        if (status != success) return status;
        const Written written = write_files({{output, whole.str()}});
        return written.why.empty() ? success : fail(terminal, written.why);
    }

    int finish(const Terminal& terminal, const analyze::TableOutcome& outcome) const
    {
        for (const std::string& warning : outcome.warnings)
            fmt::print(stderr, "warning: {}\n", warning);
        if (!outcome.error) return success;
        const std::string name = table == "-" ? "standard input" : table;
        const std::string place =
            outcome.error->line > 0 ? fmt::format("{}:{}", name, outcome.error->line) : name;
        const std::string column = outcome.error->column.empty()
                                       ? ""
                                       : fmt::format(", column `{}`", outcome.error->column);
        fail(terminal, fmt::format("{}{}: {}", place, column, outcome.error->message));
        for (const std::string& hint : outcome.error->hints)
            fmt::print(stderr, "  = help: {}\n", hint);
        return broken;
    }
};

}  // namespace

void add_evaluate(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command =
        app.add_subcommand("evaluate", "Compute a term for every row of a table of inputs");
    auto evaluate = std::make_shared<Evaluate>();
    command->add_option("FILE", evaluate->input, "A .lobe file")->required();
    command
        ->add_option("--term", evaluate->term,
                     "A term, a form (`F_Schlick.spherical_gaussian`), a model's output "
                     "(`callisto.diffuse`), or what packs and unpacks (`pack_d_r`, "
                     "`unpack_retroreflection`)")
        ->required();
    command->add_option("--csv", evaluate->table, "The table; `-` reads standard input")
        ->capture_default_str();
    command
        ->add_option("--number", evaluate->number,
                     "double, float, half, half:flush, interval, acceptance, acceptance:half, "
                     "mpfr:BITS")
        ->capture_default_str();
    command->add_option("-o,--output", evaluate->output, "Where to write; `-` is standard output")
        ->capture_default_str();
    command->footer(
        "One column per input: geometry as l.x .. v.z (n defaults to 0, 0, 1), colors as .r .g "
        ".b,\n"
        "a missing parameter takes its default. Result columns are appended, with digits enough "
        "to\n"
        "read back exactly.\n"
        "Example: lobec evaluate models/microfacet.lobe --term F_Schlick --csv in.csv --number "
        "mpfr:200");
    command->callback([evaluate, &terminal, &status] { status = evaluate->run(terminal); });
}

}  // namespace lobe::cli
