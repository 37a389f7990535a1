// A change of a tree happens as a whole or not at all, also when it is killed at any moment.
#include "cli/engine_tree.h"
#include "command.h"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace lobe;
using lobe::tests::Scratch;

namespace {

const std::vector<engine::Change> changes{
    {"Shaders/New/Model.ush", std::nullopt, "new\n"},
    {"Shaders/Common.ush", "old\r\n", "changed\r\n"},
    {"Source/Gone.h", "gone\n", std::nullopt},
    {"Source/Types.h", "types", "more types"},
};

void make_tree(const Scratch& scratch)
{
    std::filesystem::create_directories(scratch.path() / "Shaders");
    std::filesystem::create_directories(scratch.path() / "Source");
    for (const engine::Change& change : changes)
        if (change.before) scratch.write(change.path, *change.before);
}

enum class State {
    before,
    after,
    between
};

State state_of(const Scratch& scratch)
{
    const engine::Tree tree = cli::disk_tree(scratch.path().string());
    std::size_t old_files = 0;
    std::size_t new_files = 0;
    for (const engine::Change& change : changes) {
        const auto text = tree.read(change.path);
        old_files += text == change.before ? 1 : 0;
        new_files += text == change.after ? 1 : 0;
    }
    if (old_files == changes.size()) return State::before;
    return new_files == changes.size() ? State::after : State::between;
}

/// Files that are no part of the tree: staged texts, journals.
int left_over(const Scratch& scratch)
{
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator{scratch.path()})
        if (entry.path().string().find("lobec") != std::string::npos) ++count;
    return count;
}

}  // namespace

TEST_CASE("a change is made whole and leaves nothing behind")
{
    const Scratch scratch;
    make_tree(scratch);
    const std::string types = (scratch.path() / "Source/Types.h").string();
    REQUIRE(chmod(types.c_str(), 0755) == 0);
    CHECK(cli::apply_changes(scratch.path().string(), changes).empty());
    CHECK(state_of(scratch) == State::after);
    CHECK(left_over(scratch) == 0);
    struct stat status {};
    REQUIRE(stat(types.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0755);
}

TEST_CASE("killed at any step, it has happened or it has not")
{
    int interrupted = 0;
    bool finished = false;
    for (int step = 1; !finished; ++step) {
        const Scratch scratch;
        make_tree(scratch);
        const std::string root = scratch.path().string();
        const pid_t child = fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            int reached = 0;
            cli::apply_changes(root, changes, [&] {
                if (++reached == step) _exit(9);
            });
            _exit(0);
        }
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        finished = WEXITSTATUS(status) == 0;

        CAPTURE(step);
        if (cli::is_interrupted(root)) {
            ++interrupted;
            CHECK(cli::finish_interrupted(root).empty());
            CHECK(state_of(scratch) == State::after);
            CHECK(left_over(scratch) == 0);
        } else {
            CHECK(state_of(scratch) == (finished ? State::after : State::before));
        }
        CHECK_FALSE(cli::is_interrupted(root));
        // What was left of a change that did not happen is in nobody's way.
        CHECK(cli::apply_changes(root, changes).empty());
        CHECK(state_of(scratch) == State::after);
        CHECK(left_over(scratch) == 0);
    }
    // Before each of four files, and before the journal goes.
    CHECK(interrupted == 5);
}

TEST_CASE("what cannot be written changes nothing")
{
    const Scratch scratch;
    make_tree(scratch);
    // A file where a folder has to be.
    scratch.write("Shaders/New", "in the way");
    const std::string why = cli::apply_changes(scratch.path().string(), changes);
    CHECK_THAT(why, Catch::Contains("Shaders/New"));
    CHECK(state_of(scratch) == State::before);
    CHECK(left_over(scratch) == 0);
}

TEST_CASE("a read-only file is refused, and a link is followed")
{
    const Scratch scratch;
    make_tree(scratch);
    const std::string root = scratch.path().string();
    const engine::Tree tree = cli::disk_tree(root);
    CHECK(tree.refuses_write("Source/Types.h").empty());
    CHECK(tree.refuses_write("Shaders/New/Deep/Model.ush").empty());
    REQUIRE(chmod((scratch.path() / "Source/Types.h").c_str(), 0444) == 0);
    CHECK_THAT(tree.refuses_write("Source/Types.h"), Catch::Contains("read-only"));

    scratch.write("elsewhere.h", "old");
    std::filesystem::create_symlink("../elsewhere.h", scratch.path() / "Source/Link.h");
    CHECK(cli::apply_changes(root, {{"Source/Link.h", "old", "new"}}).empty());
    CHECK(std::filesystem::is_symlink(scratch.path() / "Source/Link.h"));
    CHECK(scratch.read("elsewhere.h") == "new");
}

TEST_CASE("a journal that is none is not obeyed")
{
    const Scratch scratch;
    make_tree(scratch);
    scratch.write(".lobec-journal", "lobec journal 1\nremove /somewhere\n");
    CHECK(cli::is_interrupted(scratch.path().string()));
    CHECK_FALSE(cli::finish_interrupted(scratch.path().string()).empty());
    CHECK(state_of(scratch) == State::before);
}
