#include "cli/engine_tree.h"

#include "cli/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// More than any source file of an engine.
constexpr std::size_t largest_engine_file = std::size_t{64} << 20;

constexpr std::string_view journal_name = ".lobec-journal";
constexpr std::string_view journal_heading = "lobec journal 1";
constexpr std::string_view staged_suffix = ".lobec-new";

fs::path journal_of(const std::string& root) { return fs::path{root} / journal_name; }

std::string why_not(std::string_view what, const fs::path& path, int reason)
{
    return fmt::format("cannot {} {}: {}", what, path.generic_string(), std::strerror(reason));
}

/// The absolute path of a file. What is behind a link is changed, not the link.
fs::path place_of(const std::string& root, const std::string& path)
{
    const fs::path whole = fs::path{root} / path;
    std::error_code error;
    const fs::path real = fs::canonical(whole, error);
    return error ? fs::absolute(whole) : real;
}

/// Bytes on the disk itself, not in a cache, when this returns.
std::string write_durably(const fs::path& path, std::string_view text, fs::perms mode)
{
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return why_not("write", path, errno);
    int reason = 0;
    while (!text.empty() && reason == 0) {
        const ssize_t count = ::write(file, text.data(), text.size());
        if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
        if (count < 0 && errno != EINTR) reason = errno;
    }
    if (reason == 0 && ::fchmod(file, static_cast<mode_t>(mode)) != 0) reason = errno;
    if (reason == 0 && ::fsync(file) != 0) reason = errno;
    if (::close(file) != 0 && reason == 0) reason = errno;
    return reason == 0 ? std::string{} : why_not("write", path, reason);
}

/// Names are on the disk too.
void sync_folder(const fs::path& folder)
{
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;
    ::fsync(file);
    ::close(file);
}

struct Step {
    bool removes = false;
    fs::path place;
};

fs::path staged(const fs::path& place) { return place.string() + std::string{staged_suffix}; }

/// One line each: `put path` or `remove path`, below the heading; an `end` tells a whole journal.
std::string journal_text(const std::vector<Step>& steps)
{
    std::string text = fmt::format("{}\n", journal_heading);
    for (const Step& step : steps)
        text += fmt::format("{} {}\n", step.removes ? "remove" : "put", step.place.string());
    return text + "end\n";
}

std::optional<std::vector<Step>> read_journal(const std::string& root)
{
    const Read read = read_file(journal_of(root).string(), largest_engine_file);
    if (!read.text) return std::nullopt;
    std::istringstream lines{*read.text};
    std::string line;
    std::vector<Step> steps;
    if (!std::getline(lines, line) || line != journal_heading) return std::nullopt;
    while (std::getline(lines, line)) {
        if (line == "end") return steps;
        const bool removes = line.starts_with("remove ");
        if (!removes && !line.starts_with("put ")) return std::nullopt;
        steps.push_back({removes, line.substr(removes ? 7 : 4)});
    }
    return std::nullopt;
}

/// Step 3, from wherever it was left.
std::string carry_out(const std::string& root, const std::vector<Step>& steps,
                      const std::function<void()>& before_step)
{
    for (const Step& step : steps) {
        before_step();
        std::error_code error;
        if (step.removes)
            fs::remove(step.place, error);
        else if (fs::exists(staged(step.place), error))
            fs::rename(staged(step.place), step.place, error);
        if (error)
            return fmt::format("cannot finish {}: {}; run the command again",
                               step.place.generic_string(), error.message());
        sync_folder(step.place.parent_path());
    }
    before_step();
    std::error_code error;
    fs::remove(journal_of(root), error);
    return error ? fmt::format("cannot remove {}: {}", journal_of(root).generic_string(),
                               error.message())
                 : std::string{};
}

void remove_staged(const std::vector<Step>& steps)
{
    std::error_code ignored;
    for (const Step& step : steps)
        if (!step.removes) fs::remove(staged(step.place), ignored);
}

std::string stage(const fs::path& place, const std::string& text)
{
    std::error_code error;
    const fs::file_status now = fs::status(place, error);
    const bool is_new = now.type() == fs::file_type::not_found;
    if (!is_new && now.type() != fs::file_type::regular)
        return fmt::format("{} stands where a file has to be", place.generic_string());
    if (is_new) {
        fs::create_directories(place.parent_path(), error);
        if (error)
            return fmt::format("cannot make {}: {}", place.parent_path().generic_string(),
                               error.message());
    }
    const fs::perms mode = is_new ? fs::perms{0644} : now.permissions();
    return write_durably(staged(place), text, mode);
}

}  // namespace

engine::Tree disk_tree(const std::string& root)
{
    engine::Tree tree;
    tree.read = [root](const std::string& path) {
        return read_file((fs::path{root} / path).string(), largest_engine_file).text;
    };
    tree.refuses_write = [root](const std::string& path) -> std::string {
        constexpr auto any_write =
            fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
        std::error_code error;
        const fs::path place = place_of(root, path);
        const fs::file_status status = fs::status(place, error);
        if (status.type() == fs::file_type::not_found) {
            // A new file needs a folder that takes it; the nearest one that is there decides.
            fs::path folder = place.parent_path();
            while (!folder.empty() && !fs::exists(folder, error)) folder = folder.parent_path();
            if (::access(folder.c_str(), W_OK) == 0) return {};
            return why_not("write into", folder, errno);
        }
        if ((status.permissions() & any_write) == fs::perms::none)
            return "the file is read-only; check it out of version control first";
        if (::access(place.c_str(), W_OK) != 0) return std::strerror(errno);
        if (::access(place.parent_path().c_str(), W_OK) != 0)
            return why_not("write into", place.parent_path(), errno);
        return {};
    };
    return tree;
}

bool is_interrupted(const std::string& root)
{
    std::error_code error;
    return fs::exists(journal_of(root), error);
}

std::string finish_interrupted(const std::string& root)
{
    const auto steps = read_journal(root);
    if (!steps)
        return fmt::format("{} is no journal of lobec; remove it if nothing else needs it",
                           journal_of(root).generic_string());
    return carry_out(root, *steps, [] {});
}

std::string apply_changes(const std::string& root, const std::vector<engine::Change>& changes,
                          const std::function<void()>& before_step)
{
    const auto step_begins = [&before_step] {
        if (before_step) before_step();
    };
    if (changes.empty()) return {};
    std::vector<Step> steps;
    for (const engine::Change& change : changes) {
        const Step step{!change.after, place_of(root, change.path)};
        steps.push_back(step);
        if (!change.after) continue;
        step_begins();
        std::string why = stage(step.place, *change.after);
        if (why.empty()) continue;
        remove_staged(steps);
        return why;
    }
    step_begins();
    // The journal appears whole: written under another name, then renamed.
    const fs::path journal = journal_of(root);
    const fs::path unfinished = journal.string() + ".part";
    std::string why = write_durably(unfinished, journal_text(steps), fs::perms{0644});
    if (why.empty() && std::rename(unfinished.c_str(), journal.c_str()) != 0)
        why = why_not("write", journal, errno);
    if (!why.empty()) {
        std::error_code ignored;
        fs::remove(unfinished, ignored);
        remove_staged(steps);
        return why;
    }
    sync_folder(journal.parent_path());
    return carry_out(root, steps, step_begins);
}

}  // namespace lobe::cli
