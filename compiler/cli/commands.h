// The commands of `lobec`, one file each. `add_*` declares a command; running it sets `status`.
#pragma once

#include "cli/terminal.h"

#include <CLI/CLI.hpp>

namespace lobe::cli {

void add_build(CLI::App& app, const Terminal& terminal, int& status);
void add_check(CLI::App& app, const Terminal& terminal, int& status);
void add_cost(CLI::App& app, const Terminal& terminal, int& status);
void add_format(CLI::App& app, const Terminal& terminal, int& status);
void add_evaluate(CLI::App& app, const Terminal& terminal, int& status);
void add_pack(CLI::App& app, const Terminal& terminal, int& status);
void add_pareto(CLI::App& app, const Terminal& terminal, int& status);
void add_patch(CLI::App& app, const Terminal& terminal, int& status);
void add_scene(CLI::App& app, const Terminal& terminal, int& status);
void add_specialize(CLI::App& app, const Terminal& terminal, int& status);
void add_ladder(CLI::App& app, const Terminal& terminal, int& status);
void add_render(CLI::App& app, const Terminal& terminal, int& status);
void add_verify(CLI::App& app, const Terminal& terminal, int& status);
void add_stability(CLI::App& app, const Terminal& terminal, int& status);
void add_table(CLI::App& app, const Terminal& terminal, int& status);
void add_explain(CLI::App& app, const Terminal& terminal, int& status);
void add_devices(CLI::App& app, const Terminal& terminal, int& status);

}  // namespace lobe::cli
