// Claim: `lobec patch` on a tree of the size of an engine (100,000 files) takes less than a second
// and 200 MB, because it reads only the files that its edits name.
//
// The tree is the stand-in of the tests among as many other files; every file that edits name is
// filled up to the size of the engine's largest one, 0.7 MB. Each command runs in its own process,
// which is what is measured: time from start to end, and the most memory it held. For comparison,
// all files of the tree are read once, from the same warm cache.
// Usage: bench-patch [model [files]]
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

double seconds(const auto& work)
{
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string read(const fs::path& path)
{
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

void write(const fs::path& path, std::string_view bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream{path, std::ios::binary} << bytes;
}

/// Functions that nothing asks for, in front of what edits look for.
std::string filled(const std::string& text, std::size_t size)
{
    std::string front;
    for (int i = 0; front.size() + text.size() < size; ++i)
        front +=
            fmt::format("static int Filler{0}(int X)\n{{\n\treturn X > 0 ? X + {0} : 0; // of no "
                        "consequence\n}}\n\n",
                        i);
    return front + text;
}

void copy_stand_in(const fs::path& from, const fs::path& tree)
{
    for (const auto& entry : fs::recursive_directory_iterator{from / "Engine"}) {
        if (!entry.is_regular_file()) continue;
        const fs::path path = tree / fs::relative(entry.path(), from);
        const bool is_code = path.extension() != ".version";
        write(path, is_code ? filled(read(entry.path()), 700'000) : read(entry.path()));
    }
}

struct Cost {
    double seconds = 0;
    double megabytes = 0;
    int status = 0;
};

Cost run(std::vector<std::string> command)
{
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    Cost cost;
    cost.seconds = seconds([&] {
        const pid_t child = fork();
        if (child == 0) {
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
            execv(arguments[0], arguments.data());
            _exit(127);
        }
        int status = 0;
        rusage usage{};
        wait4(child, &status, 0, &usage);
        cost.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
        cost.megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
    });
    return cost;
}

/// A tree that goes when the program ends.
struct Folder {
    fs::path path;
    Folder()
    {
        std::string name = (fs::temp_directory_path() / "lobe-bench-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) std::exit(2);
        path = name;
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

}  // namespace

int main(int argc, char** argv)
{
    const std::string model = argc > 1 ? argv[1] : "models/callisto.lobe";
    const int files = argc > 2 ? std::atoi(argv[2]) : 100'000;
    const Folder folder;
    const fs::path tree = folder.path / "tree";
    for (int i = 0; i < files; ++i)
        write(tree / fmt::format("Engine/Other/{:03}/File{:06}.cpp", i % 1000, i),
              filled({}, 4000));
    copy_stand_in("tests/data/engine/common", tree);

    std::size_t bytes = 0;
    const double all = seconds([&] {
        for (const auto& entry : fs::recursive_directory_iterator{tree})
            if (entry.is_regular_file()) bytes += read(entry.path()).size();
    });
    fmt::print("{} files and the stand-in engine, {} MB; reading all of it: {:.2f} s\n", files,
               bytes / 1'000'000, all);

    int status = 0;
    const std::string diff = (folder.path / "x.diff").string();
    const std::vector<std::pair<std::string, std::vector<std::string>>> commands = {
        {"the diff, without the shaders", {"--skip-shaders", "-o", diff}},
        {"the diff", {"-o", diff}},
        {"--apply", {"--apply"}},
        {"--check", {"--check"}},
        {"--revert", {"--revert"}}};
    for (const auto& [name, options] : commands) {
        std::vector<std::string> command = {LOBEC, "patch", model, "--engine", tree.string()};
        command.insert(command.end(), options.begin(), options.end());
        const Cost cost = run(command);
        fmt::print("{:<32} {:6.3f} s {:6.1f} MB   {:5.1f} % of reading all\n", name, cost.seconds,
                   cost.megabytes, 100 * cost.seconds / all);
        if (cost.status != 0) fmt::print("that failed with status {}\n", cost.status);
        status |= cost.status;
    }
    return status;
}
