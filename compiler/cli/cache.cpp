#include "cli/cache.h"

#include "cli/files.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "lobe cache 1\n";
constexpr std::size_t largest_entry = std::size_t{64} << 20;
constexpr std::size_t largest_program = std::size_t{1} << 30;

/// What tells this program from any other build of it: a hash of its bytes. Nothing where they
/// cannot be read; then nothing may be kept either.
std::optional<std::string> program_stamp()
{
    const Read program = read_file("/proc/self/exe", largest_program);
    if (!program.text) return std::nullopt;
    return fmt::format("{} {:016x}", LOBE_VERSION,
                       XXH3_64bits(program.text->data(), program.text->size()));
}

fs::path default_folder()
{
    // By the XDG base directory specification a relative path is to be ignored.
    if (const char* const folder = std::getenv("XDG_CACHE_HOME"); folder != nullptr)
        if (const fs::path path{folder}; path.is_absolute()) return path / "lobe";
    if (const char* const home = std::getenv("HOME"); home != nullptr)
        if (const fs::path path{home}; path.is_absolute()) return path / ".cache" / "lobe";
    return {};
}

void append(std::string& text, std::uint64_t number)
{
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text.append(bytes, sizeof number);
}

/// The number that a text starts with, which is then cut off.
std::optional<std::uint64_t> take(std::string_view& text)
{
    std::uint64_t number = 0;
    if (text.size() < sizeof number) return std::nullopt;
    std::memcpy(&number, text.data(), sizeof number);
    text.remove_prefix(sizeof number);
    return number;
}

std::string entry_text(std::string_view key, std::string_view value)
{
    std::string text{magic};
    append(text, key.size());
    append(text, value.size());
    text.append(key).append(value);
    append(text, XXH3_64bits(text.data(), text.size()));
    return text;
}

/// The value of an entry that is whole and has this key.
std::optional<std::string> value_of(std::string_view text, std::string_view key)
{
    if (text.size() < sizeof(std::uint64_t)) return std::nullopt;
    std::string_view checksum = text.substr(text.size() - sizeof(std::uint64_t));
    text.remove_suffix(sizeof(std::uint64_t));
    if (take(checksum) != XXH3_64bits(text.data(), text.size())) return std::nullopt;
    if (!text.starts_with(magic)) return std::nullopt;
    text.remove_prefix(magic.size());
    const auto key_size = take(text);
    const auto value_size = take(text);
    if (!key_size || !value_size || *key_size != key.size() ||
        text.size() != *key_size + *value_size || !text.starts_with(key))
        return std::nullopt;
    return std::string{text.substr(*key_size)};
}

class Cache {
public:
    Cache(fs::path folder, std::string stamp, std::uintmax_t limit)
        : folder_{std::move(folder)}, stamp_{std::move(stamp)}, limit_{limit}
    {
        prune();
    }

    std::optional<std::string> load(std::string_view key) const
    {
        const std::string whole = stamped(key);
        const fs::path place = place_of(whole);
        const Read entry = read_file(place.string(), largest_entry);
        if (!entry.text) return std::nullopt;
        auto value = value_of(*entry.text, whole);
        std::error_code ignored;
        if (value) fs::last_write_time(place, fs::file_time_type::clock::now(), ignored);
        return value;
    }

    void save(std::string_view key, std::string_view value)
    {
        const std::string whole = stamped(key);
        const std::string text = entry_text(whole, value);
        if (text.size() > std::min<std::uintmax_t>(largest_entry, limit_)) return;
        const fs::path place = place_of(whole);
        std::error_code error;
        fs::create_directories(place.parent_path(), error);
        if (error) return;
        // One count for all caches of this process: two of them may share a folder.
        static std::atomic<unsigned> writes{0};
        const fs::path temporary =
            place.string() + fmt::format(".{}.{}.partial", getpid(), ++writes);
        if (!write(temporary, text)) return;
        fs::rename(temporary, place, error);
        if (error) fs::remove(temporary, error);
        if ((written_ += text.size()) > limit_ / 4) {
            written_ = 0;
            prune();
        }
    }

private:
    std::string stamped(std::string_view key) const { return fmt::format("{}\n{}", stamp_, key); }

    fs::path place_of(std::string_view whole_key) const
    {
        const XXH128_hash_t hash = XXH3_128bits(whole_key.data(), whole_key.size());
        const std::string name = fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
        return folder_ / name.substr(0, 2) / name.substr(2);
    }

    static bool write(const fs::path& place, const std::string& text)
    {
        std::FILE* const out = std::fopen(place.c_str(), "wb");
        if (out == nullptr) return false;
        const bool whole = std::fwrite(text.data(), 1, text.size(), out) == text.size();
        if (std::fclose(out) == 0 && whole) return true;
        std::error_code ignored;
        fs::remove(place, ignored);
        return false;
    }

    /// Takes the oldest entries away until a quarter of the room is free, if there is none.
    void prune() const
    {
        struct Entry {
            fs::path path;
            fs::file_time_type used;
            std::uintmax_t bytes = 0;
        };
        std::vector<Entry> entries;
        std::uintmax_t total = 0;
        std::error_code error;
        for (fs::recursive_directory_iterator it{folder_, error}, end; !error && it != end;
             it.increment(error)) {
            // Files may go while they are looked at: another process prunes, too.
            std::error_code gone;
            if (!it->is_regular_file(gone)) continue;
            Entry entry{it->path(), it->last_write_time(gone), it->file_size(gone)};
            if (gone) continue;
            total += entry.bytes;
            entries.push_back(std::move(entry));
        }
        if (total <= limit_) return;
        std::ranges::sort(entries, {}, &Entry::used);
        for (const Entry& entry : entries) {
            if (total <= limit_ / 4 * 3) return;
            fs::remove(entry.path, error);
            total -= entry.bytes;
        }
    }

    fs::path folder_;
    std::string stamp_;
    std::uintmax_t limit_;
    std::atomic<std::uintmax_t> written_{0};
};

}  // namespace

void add_cache_options(CLI::App& command, CacheOptions& options)
{
    auto* const folder = command.add_option(
        "--cache", options.folder,
        "Keep results in this folder (default: $XDG_CACHE_HOME/lobe or ~/.cache/lobe)");
    command.add_flag("--no-cache", options.off, "Neither use nor keep results of other runs")
        ->excludes(folder);
}

analyze::Store open_cache(const CacheOptions& options)
{
    if (options.off) return {};
    const fs::path folder = options.folder.empty() ? default_folder() : fs::path{options.folder};
    auto stamp = program_stamp();
    if (folder.empty() || !stamp) return {};
    const auto cache = std::make_shared<Cache>(folder, std::move(*stamp), options.bytes);
    return {[cache](std::string_view key) { return cache->load(key); },
            [cache](std::string_view key, std::string_view value) { cache->save(key, value); }};
}

}  // namespace lobe::cli
