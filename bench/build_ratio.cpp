// Claim: compiling every model to every target takes at most a tenth of the time that glslang
// then needs to parse the same files.
//
// Twice. In this process: the stages on values against the parser on texts, on one thread and as
// the command runs them. And as a build script runs both: `lobec build`, against
// `glslangValidator` with process start and files: all GLSL in one process, and HLSL, for which it
// insists on writing SPIR-V, file by file. In turn, on the same texts; the medians and their ratios
// are printed.
// Usage: bench-build [models-folder]
#include "cli/program.h"
#include "compile.h"
#include "verify/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

double seconds(const auto& work)
{
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> times)
{
    std::ranges::sort(times);
    return times[times.size() / 2];
}

lobe::verify::Dialect dialect(lobe::emit::Language language)
{
    switch (language) {
    case lobe::emit::Language::glsl: return lobe::verify::Dialect::glsl;
    case lobe::emit::Language::essl: return lobe::verify::Dialect::essl;
    case lobe::emit::Language::hlsl: return lobe::verify::Dialect::hlsl;
    }
    return lobe::verify::Dialect::glsl;
}

}  // namespace

int main(int argc, char** argv)
{
    using namespace lobe;
    const std::string models = argc > 1 ? argv[1] : "models";
    const cli::Terminal terminal;
    const std::vector<const emit::Target*> targets = cli::choose_targets({});

    std::vector<emit::Artifact> artifacts;  // per module, one per target
    const auto load = [&] {
        cli::Program program = cli::read_and_check(terminal, {models});
        if (program.status != cli::success) {
            cli::print(terminal, program.diagnostics, program.sources);
            std::exit(program.status);
        }
        return program;
    };
    const auto build_alone = [&] {
        const cli::Program program = load();
        artifacts.clear();
        for (const ir::Module& module : program.modules)
            for (emit::Artifact& artifact : back(middle(module), program.sources, targets))
                artifacts.push_back(std::move(artifact));
    };
    const auto build = [&] { artifacts = cli::build(load(), targets); };

    // `callisto/ue4/Callisto.ush`
    const auto target_of = [](const emit::Artifact& artifact) -> const emit::Target& {
        const std::size_t begin = artifact.path.find('/') + 1;
        return *emit::find_target(
            artifact.path.substr(begin, artifact.path.find('/', begin) - begin));
    };

    build();
    struct Text {
        std::string text;
        verify::Dialect dialect;
    };
    std::vector<Text> texts;
    for (std::size_t i = 0; i < artifacts.size(); ++i) {
        const emit::Target& target = target_of(artifacts[i]);
        texts.push_back({emit::frame(artifacts[i], target).text, dialect(target.language)});
    }
    const auto parse = [&] {
        for (const Text& text : texts)
            if (!verify::parse_only(text.text, text.dialect, verify::Stage::fragment).accepted)
                std::exit(1);
    };

    const auto folder = std::filesystem::temp_directory_path() / "lobe-bench-build";
    const std::string build_command =
        fmt::format("'{}' -q build '{}' -o '{}'", LOBEC, models, (folder / "generated").string());
    std::string parse_glsl = "glslangValidator";
    std::vector<std::string> compile_hlsl;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string file = (folder / fmt::format("{}.frag", i)).string();
        std::ofstream{file, std::ios::binary} << texts[i].text;
        if (texts[i].dialect == verify::Dialect::hlsl)
            compile_hlsl.push_back(
                fmt::format("glslangValidator -D -e main -V '{0}' -o '{0}.spv'", file));
        else
            parse_glsl += fmt::format(" '{}'", file);
    }
    const auto command = [](const std::string& line) {
        if (std::system((line + " >/dev/null").c_str()) == 0) return;
        fmt::print(stderr, "failed: {}\n", line);
        std::exit(1);
    };
    const bool has_validator = std::system("glslangValidator --version >/dev/null 2>&1") == 0;

    std::vector<double> times[6];
    constexpr int rounds = 15;
    for (int i = 0; i < rounds; ++i) {
        times[0].push_back(seconds(build_alone));
        times[1].push_back(seconds(build));
        times[2].push_back(seconds(parse));
        if (!has_validator) continue;
        // As in a fresh checkout: nothing is there to be left alone.
        std::filesystem::remove_all(folder / "generated");
        times[3].push_back(seconds([&] { command(build_command); }));
        times[4].push_back(seconds([&] { command(parse_glsl); }));
        times[5].push_back(seconds([&] {
            for (const std::string& line : compile_hlsl) command(line);
        }));
    }
    std::filesystem::remove_all(folder);

    const auto line = [&](const char* what, const std::vector<double>& of, double beside) {
        const double time = median(of);
        fmt::print("  {:<34}{:8.2f} ms{:8.3f}\n", what, time * 1e3, time / beside);
    };
    const double parsed = median(times[2]);
    fmt::print("{} files; ratios are to all of glslang (claim: at most 0.1)\n", texts.size());
    fmt::print("in one process\n");
    line("all stages, one thread", times[0], parsed);
    line("all stages, as lobec runs them", times[1], parsed);
    line("glslang, parsing", times[2], parsed);
    if (!has_validator) return 0;
    const double validated = median(times[4]) + median(times[5]);
    fmt::print("as commands\n");
    line("lobec build, radiance measured", times[3], validated);
    line("glslangValidator, GLSL at once", times[4], validated);
    line("glslangValidator, HLSL one by one", times[5], validated);
    return 0;
}
