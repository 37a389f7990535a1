// Diffs before git itself: what `git apply` makes of them.
#include "engine/diff.h"
#include "engine/tree.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

namespace lobe::engine {
namespace {

/// A folder that goes when it is no longer needed.
class Folder {
public:
    Folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "lobe-diff-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        path_ = name;
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    void write(const std::string& path, const std::string& bytes) const
    {
        std::filesystem::create_directories((path_ / path).parent_path());
        std::ofstream{path_ / path, std::ios::binary} << bytes;
    }

    Files files() const
    {
        Files result;
        for (const auto& entry : std::filesystem::recursive_directory_iterator{path_}) {
            if (!entry.is_regular_file()) continue;
            std::ifstream file{entry.path(), std::ios::binary};
            result[std::filesystem::relative(entry.path(), path_).string()] =
                std::string{std::istreambuf_iterator<char>{file}, {}};
        }
        return result;
    }

    /// Runs git on a diff, away from any repository around.
    bool git_apply(const std::string& diff, const std::string& options) const
    {
        const Folder outside{};
        outside.write("x.diff", diff);
        const std::string command = fmt::format(
            "cd '{}' && env -u GIT_DIR -u GIT_WORK_TREE -u GIT_INDEX_FILE "
            "GIT_CEILING_DIRECTORIES='{}' git apply --whitespace=nowarn {} '{}/x.diff'",
            path_.string(), path_.parent_path().string(), options, outside.path_.string());
        return std::system(command.c_str()) == 0;
    }

private:
    std::filesystem::path path_;
};

/// git makes the one of the other, both ways.
void check_with_git(const std::vector<Change>& changes)
{
    Files before, after;
    const Folder folder;
    for (const Change& change : changes) {
        if (change.before) before[change.path] = *change.before;
        if (change.after) after[change.path] = *change.after;
    }
    for (const auto& [path, bytes] : before) folder.write(path, bytes);
    const std::string diff = unified_diff(changes);
    INFO(diff);
    REQUIRE(folder.git_apply(diff, "--check"));
    REQUIRE(folder.git_apply(diff, ""));
    REQUIRE(folder.files() == after);
    REQUIRE(folder.git_apply(diff, "--reverse"));
    REQUIRE(folder.files() == before);
}

class Random {
public:
    int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

    std::string line()
    {
        static const char* const words[] = {"a", "b", "", "  ", "- x", "+ y", "@@", "\\", "\xff"};
        return words[below(9)];
    }

    std::string end() { return below(3) == 0 ? "\r\n" : "\n"; }

    std::string text(int most)
    {
        std::string result;
        for (int count = below(most); count > 0; --count) result += line() + end();
        if (below(3) == 0) result += "last";
        return result;
    }

    /// Lines go, come and change.
    std::string edited(const std::string& text)
    {
        std::string result;
        std::size_t at = 0;
        while (at < text.size()) {
            const auto behind = std::min(text.find('\n', at), text.size() - 1) + 1;
            const int what = below(12);
            if (what == 0) result += line() + end();
            if (what != 1) result += text.substr(at, behind - at);
            at = behind;
        }
        if (below(4) == 0) {
            if (!result.empty() && result.back() != '\n') result += end();
            result += "other last";
        }
        return result;
    }

private:
    std::mt19937 engine_{7};
};

}  // namespace

TEST_CASE("no change is no diff", "[engine][diff]")
{
    CHECK(unified_diff({}) == "");
    CHECK(unified_diff({{"a", "x\n", "x\n"}}) == "");
}

TEST_CASE("a diff reads as git writes it", "[engine][diff]")
{
    CHECK(unified_diff({{"folder/a", "1\n2\n3\n4\n5\n6\n", "1\n2\n3\n4\nfive\n6"}}) ==
          "diff --git a/folder/a b/folder/a\n"
          "--- a/folder/a\n"
          "+++ b/folder/a\n"
          "@@ -2,5 +2,5 @@\n"
          " 2\n"
          " 3\n"
          " 4\n"
          "-5\n"
          "-6\n"
          "+five\n"
          "+6\n"
          "\\ No newline at end of file\n");
    CHECK(unified_diff({{"new", std::nullopt, "1\n"}}) == "diff --git a/new b/new\n"
                                                          "new file mode 100644\n"
                                                          "--- /dev/null\n"
                                                          "+++ b/new\n"
                                                          "@@ -0,0 +1,1 @@\n"
                                                          "+1\n");
    CHECK(unified_diff({{"old", "1\n", std::nullopt}}) == "diff --git a/old b/old\n"
                                                          "deleted file mode 100644\n"
                                                          "--- a/old\n"
                                                          "+++ /dev/null\n"
                                                          "@@ -1,1 +0,0 @@\n"
                                                          "-1\n");
}

TEST_CASE("changes that are near share a hunk", "[engine][diff]")
{
    const std::string between = "1\n2\n3\n4\n5\n6\n";
    const auto hunks = [](const std::string& diff) {
        std::size_t count = 0;
        for (auto at = diff.find("\n@@"); at != std::string::npos; at = diff.find("\n@@", at + 1))
            ++count;
        return count;
    };
    CHECK(hunks(unified_diff({{"a", "x\n" + between + "y\n", "X\n" + between + "Y\n"}})) == 1);
    CHECK(hunks(unified_diff({{"a", "x\n" + between + "7\ny\n", "X\n" + between + "7\nY\n"}})) ==
          2);
}

TEST_CASE("git applies every kind of change", "[engine][diff]")
{
    check_with_git({{"crlf", "a\r\nb\r\nc\r\n", "a\r\nB\r\nc\r\n"},
                    {"ends", "a\r\nb\n", "a\nb\r\n"},
                    {"gains-newline", "a\nb", "a\nb\n"},
                    {"loses-newline", "a\nb\n", "a\nb"},
                    {"keeps-none", "a\nb\nc", "A\nb\nc"},
                    {"new/empty", std::nullopt, ""},
                    {"new/full", std::nullopt, "a\nb"},
                    {"gone/full", "a\r\nb\r\n", std::nullopt},
                    {"gone/empty", "", std::nullopt},
                    {"fills", "", "a\n"},
                    {"empties", "a\n", ""},
                    {"with blank/in name", "a\n", "b\n"},
                    {"with \"quotes\" and \\", "a\n", "b\n"},
                    {"with \xc3\xa4 and\ttab", "a\n", "b\n"},
                    {"binary-like", "\xff\xfe\x80\n\x01\n", "\xff\xfe\x81\n\x01\n"}});
}

TEST_CASE("git applies random changes", "[engine][diff]")
{
    Random random;
    std::vector<Change> changes;
    for (int i = 0; i < 400; ++i) {
        const std::string before = random.text(40);
        Change change{fmt::format("file{:03}", i), before, random.edited(before)};
        if (change.before != change.after) changes.push_back(std::move(change));
    }
    CHECK(changes.size() > 300);
    check_with_git(changes);
}

TEST_CASE("git applies the patch of a tree", "[engine][diff]")
{
    for (const Files& tree : {small_tree(), with_crlf(small_tree())}) {
        const Plan plan = plan_patch(tree_of(tree), small_list(), request_of("Gloss"));
        REQUIRE(plan.changes.size() == 4);
        check_with_git(plan.changes);
        const Files patched = applied(tree, plan);
        const Plan back = plan_revert(tree_of(patched), small_list(), request_of("Gloss"));
        REQUIRE(back.changes.size() == 4);
        check_with_git(back.changes);
    }
}

TEST_CASE("a diff has no more lines than changed", "[engine][diff]")
{
    // Lines that all look alike: only the shortest edit finds the two that came.
    std::string before;
    for (int i = 0; i < 1000; ++i) before += i % 2 == 0 ? "{\n" : "}\n";
    const std::string after = "{\n" + before + "}\n";
    const std::string diff = unified_diff({{"a", before, after}});
    const auto lines = std::count(diff.begin(), diff.end(), '\n');
    CHECK(lines <= 3 + 2 * (1 + 1 + 6));
    check_with_git({{"a", before, after}});
}

TEST_CASE("files that have nothing in common take no longer", "[engine][diff]")
{
    std::string before, after;
    for (int i = 0; i < 40000; ++i) {
        before += fmt::format("before {}\n", i);
        after += fmt::format("after {}\n", i);
    }
    const auto start = std::chrono::steady_clock::now();
    const std::string diff = unified_diff({{"a", before, after}});
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    CHECK(std::count(diff.begin(), diff.end(), '\n') == 80000 + 4);
    // A second in a build without optimization; the shortest edit itself would take minutes.
    CHECK(taken.count() < 5);
}

}  // namespace lobe::engine
