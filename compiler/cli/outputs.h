// What a command writes beside what it prints: `--json F`, `--html F` and the like, where F may be
// `-` for standard output, which then has nothing else on it.
#pragma once

#include "cli/files.h"
#include "cli/terminal.h"

#include <string>
#include <vector>

namespace lobe::cli {

/// The values of such options, by the option's name.
struct Output {
    std::string option;  ///< `--json`
    std::string path;    ///< empty: not asked for
    std::string text = {};
};

bool is_piped(const std::vector<Output>& outputs);

/// `only one of --json and --html can be standard output`, or nothing.
std::string conflict(const std::vector<Output>& outputs);

/// Prints the piped one, and writes the files, all or none. Returns what the command should exit
/// with: `otherwise`, or Exit::broken when something could not be written.
int write(const Terminal& terminal, const std::vector<Output>& outputs, int otherwise);

}  // namespace lobe::cli
