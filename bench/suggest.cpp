// What the search for a packing claims: how long it takes for the eight scalars of Callisto's base
// and advanced tiers in the four free channels, and how much better the result is than 8 linear
// bits for each of them.
#include "analyze/packing/suggest.h"

#include "compile.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <iterator>

using namespace lobe;

namespace {

std::optional<std::uint32_t> add(Sources& sources, const std::string& folder,
                                 std::string_view module)
{
    const std::string path = fmt::format("{}/{}.lobe", folder, module);
    std::ifstream file{path, std::ios::binary};
    if (!file) return std::nullopt;
    return sources.add(path, {std::istreambuf_iterator<char>{file}, {}});
}

}  // namespace

int main(int argc, char** argv)
{
    const std::string folder = argc > 1 ? argv[1] : "models";
    Sources sources;
    Diagnostics diagnostics;
    const auto root = add(sources, folder, "callisto");
    const auto module = root ? front(
                                   sources, *root,
                                   [&](Sources& into, std::string_view name, std::string_view) {
                                       return add(into, folder, name);
                                   },
                                   diagnostics)
                             : std::nullopt;
    if (!module || module->packings.empty()) {
        fmt::print(stderr, "no callisto.lobe with a packing that compiles in {}\n", folder);
        return 2;
    }
    const ir::Packing& packing = module->packings[0];
    analyze::SuggestOptions options;
    for (const ir::Field& field : packing.fields)
        if (options.parameters.empty() || options.parameters.back() != field.parameter)
            options.parameters.push_back(field.parameter);
    options.room = analyze::room(*module->find_gbuffer(packing.gbuffer), packing);

    const auto start = std::chrono::steady_clock::now();
    const analyze::Suggestion found = analyze::suggest(*module, 0, options);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (!found.found) {
        fmt::print("{}\n", found.why_not);
        return 1;
    }
    fmt::print("{}\n", found.text);
    fmt::print("{:<58}{:>8.2f}   {}\n", "seconds of the search", time.count(), "at most 10");
    fmt::print("{:<58}{:>8.2f}   {}\n", "worst error of 8 linear bits each / of the suggestion",
               found.linear.whole.worst / found.errors.whole.worst, "at least 5");
    return 0;
}
