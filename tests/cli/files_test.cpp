// Writing files: all or none, unchanged ones left alone, nothing half-written.
#include "cli/files.h"
#include "command.h"

#include <catch2/catch.hpp>
#include <sys/resource.h>

#include <csignal>

using namespace lobe;
using namespace lobe::cli;
using lobe::tests::Scratch;

TEST_CASE("files are written with their folders, and left alone when they already hold the text")
{
    const Scratch scratch;
    const std::string one = (scratch.path() / "a/b/one.txt").string();
    const std::string two = (scratch.path() / "two.txt").string();
    const Written first = write_files({{one, "1"}, {two, "2"}});
    CHECK(first.why.empty());
    CHECK(first.written == 2);

    const auto stamp = std::filesystem::last_write_time(one);
    const Written again = write_files({{one, "1"}, {two, "3"}});
    CHECK(again.written == 1);
    CHECK(again.unchanged == 1);
    CHECK(std::filesystem::last_write_time(one) == stamp);
    CHECK(scratch.read("two.txt") == "3");
}

TEST_CASE("when one file cannot be written, none is and no folder stays behind")
{
    const Scratch scratch;
    scratch.write("blocked", "a file where a folder is wanted");
    const Written written = write_files({{(scratch.path() / "new/one.txt").string(), "1"},
                                         {(scratch.path() / "blocked/two.txt").string(), "2"}});
    CHECK_THAT(written.why, Catch::Contains("blocked"));
    CHECK(scratch.entries() == 1);
}

TEST_CASE("a disk that fills up leaves the old files as they were")
{
    const Scratch scratch;
    scratch.write("one.txt", "old");

    // A limit on the size of files fails the same write that a full disk fails.
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    const rlimit tight{4096, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &tight) == 0);
    const Written written =
        write_files({{(scratch.path() / "one.txt").string(), "new"},
                     {(scratch.path() / "two.txt").string(), std::string(1 << 20, 'x')}});
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    std::signal(SIGXFSZ, handler);

    CHECK_THAT(written.why, Catch::Contains("two.txt"));
    CHECK(scratch.entries() == 1);
    CHECK(scratch.read("one.txt") == "old");
}

TEST_CASE("reading refuses folders and what is larger than allowed, and says why")
{
    const Scratch scratch;
    scratch.write("large", std::string(3 << 20, 'x'));
    CHECK(read_file((scratch.path() / "absent").string(), 10).why == "no such file");
    CHECK(read_file(scratch.path().string(), 10).why == "it is a folder");
    CHECK(read_file((scratch.path() / "large").string(), 2 << 20).why == "it is larger than 2 MiB");
    CHECK(read_file((scratch.path() / "large").string(), 4 << 20).text->size() == 3 << 20);
}
