// What options say in words: shares, numbers, values of parameters, GPU families.
#pragma once

#include "analyze/cost/cost.h"
#include "cli/program.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::cli {

/// What `--on` means where it is not given.
inline constexpr analyze::Family default_family = analyze::Family::rdna2;
std::vector<std::string> family_names();

/// A finite number above 0, whole text.
std::optional<double> positive_number(const std::string& text);
/// `0.5%`, `0.5 %` or `0.005`.
std::optional<double> fraction_of(std::string text);

/// Fixes parameters in every module that has them: `name=value`, `name=r,g,b`. Empty, or what was
/// not understood.
std::string specialize(Program& program, const std::vector<std::string>& settings);

}  // namespace lobe::cli
