// From file names to modules: what build, check, verify and evaluate have in common.
#pragma once

#include "cli/terminal.h"
#include "compile.h"

#include <string>
#include <vector>

namespace lobe::cli {

/// The .lobe files that arguments name: files as they are, folders as the .lobe files in them,
/// sorted. Reports what is missing to `terminal` and returns nothing then.
std::optional<std::vector<std::string>> expand_inputs(const Terminal& terminal,
                                                      const std::vector<std::string>& inputs);

/// Every module of one command, with the sources their spans point into.
struct Program {
    Sources sources;
    Diagnostics diagnostics;
    std::vector<ir::Module> modules;  ///< checked, in the order of the inputs
    int status = success;             ///< what the command should exit with so far
};

/// Reads and checks the inputs. Diagnostics are collected, not yet printed; a file that cannot be
/// read is E0001 and makes the status `broken`.
Program read_and_check(const Terminal& terminal, const std::vector<std::string>& inputs);

/// What `read_and_check` does, and then measures what packings ask of radiance: a module that does
/// not keep it is refused like any other.
Program load(const Terminal& terminal, const std::vector<std::string>& inputs);

/// Says that a module has no such term, what may have been meant and what there is. Returns what
/// the command should exit with.
int unknown_term(const Terminal& terminal, const std::string& input, const ir::Module& module,
                 const std::string& term);

/// Every module for every target, in this order. Each module is compiled on a thread of its own.
std::vector<emit::Artifact> build(const Program& program,
                                  const std::vector<const emit::Target*>& targets);

/// The targets that `--target` names, in the order of the table; all when it names none.
std::vector<const emit::Target*> choose_targets(const std::vector<std::string>& names);

}  // namespace lobe::cli
