// The newcomer's path of the README, run: its edits apply, its commands print what it shows.
//
// Blocks of the section are taken in order. ```diff is applied with git; a block that starts with
// `$` is run, and the lines below each command, but for those that are `…`, stand in its output in
// this order.
#include "command.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>
#include <vector>

using lobe::tests::Outcome;
using lobe::tests::Scratch;

namespace {

struct Block {
    std::string language;
    std::vector<std::string> lines;
};

std::vector<Block> blocks_of(const std::string& heading)
{
    std::ifstream readme{ROOT "/README.md"};
    std::vector<Block> blocks;
    bool inside = false;
    bool open = false;
    for (std::string line; std::getline(readme, line);) {
        if (!open && line.starts_with("## ")) inside = line == heading;
        if (!inside) continue;
        if (line.starts_with("```")) {
            open = !open;
            if (open) blocks.push_back({line.substr(3), {}});
        } else if (open) {
            blocks.back().lines.push_back(line);
        }
    }
    return blocks;
}

/// A command and the lines shown below it.
struct Step {
    std::string command;
    std::vector<std::string> shown;
};

std::vector<Step> steps_of(const Block& block)
{
    std::vector<Step> steps;
    for (const std::string& line : block.lines) {
        if (line.starts_with("$ "))
            steps.push_back({line.substr(2), {}});
        else if (!steps.empty() && line != "…")
            steps.back().shown.push_back(line);
    }
    return steps;
}

/// The first line that does not stand in the text behind the ones before it; empty if all do.
std::string first_missing(const std::string& text, const std::vector<std::string>& lines)
{
    std::istringstream in{text};
    std::string line;
    for (const std::string& wanted : lines) {
        bool found = false;
        while (!found && std::getline(in, line)) found = line == wanted;
        if (!found) return wanted;
    }
    return {};
}

}  // namespace

TEST_CASE("the newcomer's path prints what the README shows")
{
    const Scratch scratch;
    const auto copy = [&scratch](const std::string& folder) {
        std::filesystem::create_directories((scratch.path() / folder).parent_path());
        std::filesystem::copy(ROOT "/" + folder, scratch.path() / folder,
                              std::filesystem::copy_options::recursive);
    };
    copy("models");
    copy("generated");
    copy("tests/data/engine/common");
    int edits = 0;
    int commands = 0;
    for (const Block& block : blocks_of("## One more parameter, from the model to the engine")) {
        if (block.language == "diff") {
            std::string patch;
            for (const std::string& line : block.lines) patch += line + "\n";
            scratch.write("edit.diff", patch);
            const Outcome outcome = scratch.run("git apply edit.diff");
            CAPTURE(patch, outcome.err);
            REQUIRE(outcome.status == 0);
            ++edits;
            continue;
        }
        for (const Step& step : steps_of(block)) {
            const Outcome outcome = scratch.run(step.command);
            CAPTURE(step.command, outcome.out.substr(0, 20000), outcome.err);
            // The first layout misses what the model asks for, and says so with its exit code.
            CHECK(outcome.status == (step.command.find("--suggest") != std::string::npos ? 1 : 0));
            CHECK(first_missing(outcome.out + outcome.err, step.shown) == "");
            ++commands;
        }
    }
    CHECK(edits == 2);
    CHECK(commands == 5);
}
