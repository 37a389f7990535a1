#include "cli/outputs.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::cli {

bool is_piped(const std::vector<Output>& outputs)
{
    return std::ranges::any_of(outputs, [](const Output& each) { return each.path == "-"; });
}

std::string conflict(const std::vector<Output>& outputs)
{
    std::vector<std::string> piped;
    for (const Output& output : outputs)
        if (output.path == "-") piped.push_back(output.option);
    if (piped.size() < 2) return {};
    return fmt::format("only one of {} can be standard output", fmt::join(piped, ", "));
}

int write(const Terminal& terminal, const std::vector<Output>& outputs, int otherwise)
{
    std::vector<OutputFile> files;
    for (const Output& output : outputs)
        if (output.path == "-")
            fmt::print("{}", output.text);
        else if (!output.path.empty())
            files.push_back({output.path, output.text});
    const Written written = write_files(files);
    return written.why.empty() ? otherwise : fail(terminal, written.why);
}

}  // namespace lobe::cli
