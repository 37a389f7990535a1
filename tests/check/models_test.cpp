// The models of the repository: they check without a word, and their ranges hold.
#include "check/checking.h"
#include "evaluate/run.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <random>
#include <sstream>

using namespace lobe;

namespace {

std::optional<std::string> read(const std::string& path)
{
    std::ifstream in{path, std::ios::binary};
    if (!in) return std::nullopt;
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

ir::Module load(const std::string& name)
{
    Sources sources;
    Diagnostics diagnostics;
    const auto find = [](Sources& all, std::string_view module,
                         std::string_view) -> std::optional<std::uint32_t> {
        const std::string path = "../models/" + std::string{module} + ".lobe";
        auto text = read(path);
        if (!text) return std::nullopt;
        return all.add(path, std::move(*text));
    };
    const auto root = find(sources, name, "");
    REQUIRE(root);
    auto module = check::check(sources, *root, find, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.all()) UNSCOPED_INFO(diagnostic.message);
    CHECK(diagnostics.empty());
    REQUIRE(module);
    CHECK(!ir::verify(*module));
    return std::move(*module);
}

}  // namespace

TEST_CASE("the proved range of every function holds at every point tried", "[check][models]")
{
    constexpr std::size_t count = 2000;
    for (const std::string name : {"microfacet", "callisto", "ue4", "environment"}) {
        const ir::Module module = load(name);
        for (const ir::Function& function : module.functions) {
            CAPTURE(name, function.name, function.range.low, function.range.high);
            CHECK(function.range.low <= function.range.high);
            if (function.declared_range) {
                CHECK(function.range.low >= function.declared_range->low);
                CHECK(function.range.high <= function.declared_range->high);
            }
            const evaluate::Tape tape = evaluate::compile(module, function);
            std::mt19937 random{11};
            std::vector<std::vector<double>> points(tape.inputs.size());
            for (std::size_t i = 0; i < points.size(); ++i) {
                const ir::Range& range = function.inputs[tape.inputs[i].input].range;
                for (std::size_t p = 0; p < count; ++p) {
                    const double t = static_cast<double>(random()) / 4294967295.0;
                    const bool end = random() % 4 == 0;
                    points[i].push_back(end ? (t < 0.5 ? range.low : range.high)
                                            : range.low + (range.high - range.low) * t);
                }
            }
            std::vector<const double*> columns;
            for (const auto& column : points) columns.push_back(column.data());
            std::vector<std::vector<double>> results(tape.outputs.size(),
                                                     std::vector<double>(count));
            std::vector<double*> outputs;
            for (auto& column : results) outputs.push_back(column.data());
            evaluate::run(tape, evaluate::Columns<double>{columns},
                          evaluate::Results<double>{outputs}, count);
            // Doubles round: the longest body here has some 600 operations, each right to half a
            // unit in the last place of what it is made of.
            const double rounding =
                600 * 0x1p-53 *
                std::max({1.0, std::abs(function.range.low),
                          std::isinf(function.range.high) ? 1.0 : std::abs(function.range.high)});
            for (const auto& column : results)
                for (const double value : column)
                    if (!(value >= function.range.low - rounding &&
                          value <= function.range.high + rounding))
                        FAIL(function.name << " is " << value);
        }
    }
}
