#include "command.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>

namespace lobe::tests {
namespace fs = std::filesystem;

Scratch::Scratch()
{
    std::string pattern = (fs::temp_directory_path() / "lobe-test-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
}

Scratch::~Scratch()
{
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void Scratch::write(const std::string& name, const std::string& text) const
{
    std::ofstream{path_ / name, std::ios::binary} << text;
}

std::string Scratch::read(const std::string& name) const
{
    std::ifstream in{path_ / name, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

int Scratch::entries() const
{
    int count = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator{path_}) ++count;
    return count;
}

Outcome Scratch::run(const std::string& command) const
{
    // Output goes beside the folder, so that `entries` counts only what lobec left in it.
    const std::string out = path_.string() + ".out";
    const std::string err = path_.string() + ".err";
    const std::string script =
        fmt::format("cd '{}' && lobec() {{ '{}' \"$@\"; }} && {{ {}\n}} >'{}' 2>'{}' </dev/null",
                    path_.string(), LOBEC, command, out, err);
    Outcome outcome;
    const int status = std::system(script.c_str());
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const auto slurp = [](const std::string& path) {
        std::ifstream in{path, std::ios::binary};
        std::string text{std::istreambuf_iterator<char>{in}, {}};
        fs::remove(path);
        return text;
    };
    outcome.out = slurp(out);
    outcome.err = slurp(err);
    return outcome;
}

}  // namespace lobe::tests
