// Results on disk: found again, never another's, and no worse than none when the disk is not what
// it should be.
#include "cli/cache.h"
#include "command.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

using namespace lobe;
namespace fs = std::filesystem;

namespace {

cli::CacheOptions in(const fs::path& folder) { return {folder.string(), false, 1U << 20}; }

std::vector<fs::path> entries(const fs::path& folder)
{
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator{folder})
        if (entry.is_regular_file()) found.push_back(entry.path());
    return found;
}

std::string read(const fs::path& path)
{
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

void write(const fs::path& path, const std::string& text)
{
    std::ofstream{path, std::ios::binary} << text;
}

}  // namespace

TEST_CASE("a result is found under its key, by the next run, and under no other")
{
    const tests::Scratch scratch;
    const fs::path folder = scratch.path() / "not" / "yet";
    const std::string key{"a key\nof lines and \0 bytes", 25};
    {
        const analyze::Store store = cli::open_cache(in(folder));
        CHECK_FALSE(store.load(key));
        store.save(key, "the value");
        store.save("empty", "");
    }
    const analyze::Store store = cli::open_cache(in(folder));
    CHECK(store.load(key) == "the value");
    CHECK(store.load("empty") == "");
    CHECK_FALSE(store.load("another"));
    CHECK_FALSE(store.load(std::string_view{key}.substr(0, 20)));
    store.save(key, "a newer one");
    CHECK(store.load(key) == "a newer one");
    CHECK(entries(folder).size() == 2);

    int made = 0;
    const auto make = [&made] { return std::to_string(++made); };
    CHECK(analyze::kept(store, "made", make) == "1");
    CHECK(analyze::kept(store, "made", make) == "1");
    CHECK(analyze::kept(analyze::Store{}, "made", make) == "2");
}

TEST_CASE("a damaged entry is none, whichever byte is wrong")
{
    const tests::Scratch scratch;
    const analyze::Store store = cli::open_cache(in(scratch.path()));
    store.save("key", "value");
    const auto files = entries(scratch.path());
    REQUIRE(files.size() == 1);
    const std::string whole = read(files[0]);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        write(files[0], damaged);
        CHECK_FALSE(store.load("key"));
        write(files[0], whole.substr(0, i));
        CHECK_FALSE(store.load("key"));
    }
    write(files[0], whole + "x");
    CHECK_FALSE(store.load("key"));
    write(files[0], whole);
    CHECK(store.load("key") == "value");

    // Another key's entry in its place: what two keys of one hash would be.
    store.save("other", "another's");
    fs::path other;
    for (const fs::path& path : entries(scratch.path()))
        if (path != files[0]) other = path;
    fs::copy_file(other, files[0], fs::copy_options::overwrite_existing);
    CHECK_FALSE(store.load("key"));
    store.save("key", "mended");
    CHECK(store.load("key") == "mended");
}

TEST_CASE("where nothing can be kept nothing is, without a word")
{
    const tests::Scratch scratch;
    scratch.write("file", "in the way");
    const analyze::Store blocked = cli::open_cache(in(scratch.path() / "file"));
    blocked.save("key", "value");
    CHECK_FALSE(blocked.load("key"));
    CHECK(scratch.read("file") == "in the way");

    cli::CacheOptions off = in(scratch.path() / "off");
    off.off = true;
    const analyze::Store none = cli::open_cache(off);
    CHECK_FALSE(none.load);
    CHECK_FALSE(none.save);
    CHECK_FALSE(fs::exists(scratch.path() / "off"));
}

TEST_CASE("a full cache loses what was not asked for the longest")
{
    const tests::Scratch scratch;
    cli::CacheOptions options = in(scratch.path());
    options.bytes = 40'000;
    const std::string value(1000, 'x');
    const analyze::Store store = cli::open_cache(options);
    for (int i = 0; i < 30; ++i) store.save("key " + std::to_string(i), value);
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours{1};
    for (const fs::path& path : entries(scratch.path())) fs::last_write_time(path, hour_ago);
    CHECK(store.load("key 3"));  // asked for, and so the youngest of these
    for (int i = 30; i < 80; ++i) store.save("key " + std::to_string(i), value);
    const analyze::Store next = cli::open_cache(options);
    std::uintmax_t bytes = 0;
    for (const fs::path& path : entries(scratch.path())) bytes += fs::file_size(path);
    CHECK(bytes <= options.bytes);
    CHECK(next.load("key 79"));
    CHECK_FALSE(next.load("key 4"));
    CHECK(entries(scratch.path()).size() > 20);
}

TEST_CASE("threads may keep and ask for the same at the same time")
{
    const tests::Scratch scratch;
    const analyze::Store one = cli::open_cache(in(scratch.path()));
    const analyze::Store two = cli::open_cache(in(scratch.path()));
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread)
        threads.emplace_back([&, thread] {
            const analyze::Store& store = thread % 2 == 0 ? one : two;
            for (int i = 0; i < 200; ++i) {
                const std::string key = std::to_string(i % 10);
                store.save(key, std::string(10'000, key.front()));
                const auto found = store.load(key);
                if (!found || *found != std::string(10'000, key.front())) ++wrong;
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
    CHECK(entries(scratch.path()).size() == 10);
}
