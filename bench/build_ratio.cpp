// Claim: compiling every model to every target takes at most a tenth of the time that glslang
// then needs to parse the same files.
//
// Both run in this process, on the same texts, in turn; the medians and their ratio are printed.
// Usage: bench-build [models-folder]
#include "cli/program.h"
#include "compile.h"
#include "verify/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
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

    std::vector<const emit::Target*> targets;
    for (const emit::Target& target : emit::targets()) targets.push_back(&target);
    std::vector<std::vector<emit::Artifact>> artifacts;  // per module, one per target
    const auto build = [&] {
        artifacts.clear();
        const cli::Program program = cli::load(terminal, {models});
        if (program.status != cli::success) {
            cli::print(terminal, program.diagnostics, program.sources);
            std::exit(program.status);
        }
        for (const ir::Module& module : program.modules)
            artifacts.push_back(back(middle(module), program.sources, targets));
    };
    build();
    struct Text {
        std::string text;
        verify::Dialect dialect;
    };
    std::vector<Text> texts;
    for (const auto& files : artifacts)
        for (std::size_t i = 0; i < targets.size(); ++i)
            texts.push_back(
                {emit::frame(files[i], *targets[i]).text, dialect(targets[i]->language)});
    const auto parse = [&] {
        for (const Text& text : texts)
            if (!verify::parse_only(text.text, text.dialect, verify::Stage::fragment).accepted)
                std::exit(1);
    };

    parse();
    std::vector<double> build_times;
    std::vector<double> parse_times;
    constexpr int rounds = 15;
    for (int i = 0; i < rounds; ++i) {
        build_times.push_back(seconds(build));
        parse_times.push_back(seconds(parse));
    }
    const double built = median(build_times);
    const double parsed = median(parse_times);
    fmt::print("files                 {:8}\n", texts.size());
    fmt::print("lobec, all stages     {:8.2f} ms\n", built * 1e3);
    fmt::print("glslang, parsing      {:8.2f} ms\n", parsed * 1e3);
    fmt::print("ratio                 {:8.3f}   (claim: at most 0.1)\n", built / parsed);
    return 0;
}
