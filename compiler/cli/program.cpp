#include "cli/program.h"

#include "analyze/packing/radiance.h"
#include "cli/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <thread>

namespace lobe::cli {
namespace fs = std::filesystem;

std::optional<std::vector<std::string>> expand_inputs(const Terminal& terminal,
                                                      const std::vector<std::string>& inputs)
{
    std::vector<std::string> files;
    for (const std::string& input : inputs) {
        std::error_code error;
        if (!fs::is_directory(input, error)) {
            files.push_back(input);
            continue;
        }
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator{input, error})
            if (entry.path().extension() == ".lobe") found.push_back(entry.path().generic_string());
        if (found.empty()) {
            fail(terminal, fmt::format("no .lobe file in {}", input));
            return std::nullopt;
        }
        std::ranges::sort(found);
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

Program read_and_check(const Terminal& terminal, const std::vector<std::string>& inputs)
{
    Program program;
    const auto files = expand_inputs(terminal, inputs);
    if (!files) {
        program.status = broken;
        return program;
    }
    for (const std::string& path : *files) {
        auto read = read_file(path, largest_source);
        if (!read.text) {
            const auto source = program.sources.add(path, "");
            program.diagnostics.report(
                {.code = Code::file_unreadable,
                 .message = fmt::format("cannot read `{}`: {}", path, read.why),
                 .primary = {{source, 0, 0}, ""}});
            program.status = broken;
            continue;
        }
        const auto root = program.sources.add(path, std::move(*read.text));
        const int errors = program.diagnostics.error_count();
        auto module = front(program.sources, root, folder_loader(terminal.imports), program.diagnostics);
        if (module) program.modules.push_back(std::move(*module));
        if (program.diagnostics.error_count() > errors && program.status == success)
            program.status = findings;
    }
    return program;
}

namespace {

/// True when every packing of a checked module keeps what it asks of radiance.
bool keeps_radiance(const ir::Module& checked, Diagnostics& diagnostics)
{
    const auto asks = [](const ir::Packing& packing) { return packing.radiance_limit.has_value(); };
    if (std::ranges::none_of(checked.packings, asks)) return true;
    const ir::Module module = middle(checked);
    const int errors = diagnostics.error_count();
    for (const ir::Packing& packing : module.packings) {
        if (!asks(packing)) continue;
        const Diagnostics found =
            analyze::unmet(module, packing, analyze::packing_errors(module, packing));
        for (const Diagnostic& diagnostic : found.all()) diagnostics.report(diagnostic);
    }
    return diagnostics.error_count() == errors;
}

}  // namespace

Program load(const Terminal& terminal, const std::vector<std::string>& inputs)
{
    Program program = read_and_check(terminal, inputs);
    std::erase_if(program.modules, [&program](const ir::Module& module) {
        if (keeps_radiance(module, program.diagnostics)) return false;
        if (program.status == success) program.status = findings;
        return true;
    });
    return program;
}

int unknown_term(const Terminal& terminal, const std::string& input, const ir::Module& module,
                 const std::string& term)
{
    std::vector<std::string> names;
    for (const ir::FunctionId id : module.roots()) names.push_back(module[id].name);
    for (const ir::FunctionId id : module.packing_roots()) names.push_back(module[id].name);
    for (const ir::FunctionId id : module.shading_roots()) names.push_back(module[id].name);
    const auto near = nearest(term, names);
    return fail(terminal, fmt::format("{} has no term `{}`{}\n  = note: it exports {}", input, term,
                                      near ? fmt::format("; did you mean `{}`?", *near) : "",
                                      fmt::join(names, ", ")));
}

std::vector<const emit::Target*> choose_targets(const std::vector<std::string>& names)
{
    std::vector<const emit::Target*> chosen;
    for (const emit::Target& target : emit::targets())
        if (names.empty() || std::ranges::count(names, target.name) > 0) chosen.push_back(&target);
    return chosen;
}

std::vector<emit::Artifact> build(const Program& program,
                                  const std::vector<const emit::Target*>& targets)
{
    const auto& modules = program.modules;
    std::vector<std::vector<emit::Artifact>> built(modules.size());
    // A fixed stride: what a thread does depends on nothing but the number of threads.
    const std::size_t count = std::clamp<std::size_t>(
        modules.size(), 1, std::max(1U, std::thread::hardware_concurrency()));
    const auto work = [&](std::size_t first) {
        for (std::size_t i = first; i < modules.size(); i += count)
            built[i] = back(middle(modules[i]), program.sources, targets);
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(work, i);
    work(0);
    for (std::thread& thread : threads) thread.join();

    std::vector<emit::Artifact> artifacts;
    for (auto& files : built) std::ranges::move(files, std::back_inserter(artifacts));
    return artifacts;
}

}  // namespace lobe::cli
