#include "cli/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace lobe::cli {
namespace fs = std::filesystem;

Read read_file(const std::string& path, std::size_t limit)
{
    std::error_code error;
    const auto status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) return {std::nullopt, "no such file"};
    if (error) return {std::nullopt, error.message()};
    if (fs::is_directory(status)) return {std::nullopt, "it is a folder"};

    std::ifstream in{path, std::ios::binary};
    if (!in) return {std::nullopt, std::strerror(errno)};
    // One byte more than allowed tells a large file from an endless one, and reads neither.
    std::string text;
    std::string block(1 << 16, '\0');
    while (in && text.size() <= limit) {
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        text.append(block, 0, static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) return {std::nullopt, "reading failed"};
    if (text.size() > limit)
        return {std::nullopt, fmt::format("it is larger than {} MiB", limit >> 20)};
    return {std::move(text), {}};
}

check::Loader folder_loader(std::vector<std::string> folders)
{
    return
        [folders = std::move(folders)](Sources& sources, std::string_view module,
                                       std::string_view importing) -> std::optional<std::uint32_t> {
            const fs::path name{std::string{module} + ".lobe"};
            std::vector<fs::path> places{fs::path{importing}.parent_path()};
            places.insert(places.end(), folders.begin(), folders.end());
            for (const fs::path& place : places) {
                auto read = read_file((place / name).string(), largest_source);
                if (read.text)
                    return sources.add((place / name).generic_string(), std::move(*read.text));
            }
            return std::nullopt;
        };
}

namespace {

/// Files that were written beside their place and not yet renamed, and folders made for them.
/// Whatever is left when this goes out of scope is removed again.
class Staging {
public:
    Staging() = default;
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;
    ~Staging()
    {
        std::error_code ignored;
        for (const auto& [temporary, place] : staged_) fs::remove(temporary, ignored);
        for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, ignored);
    }

    /// Why it failed, or nothing.
    std::string add(const OutputFile& file)
    {
        const fs::path place{file.path};
        if (auto why = make_folders(place.parent_path()); !why.empty()) return why;
        const fs::path temporary = place.string() + fmt::format(".{}.partial", getpid());
        std::FILE* out = std::fopen(temporary.c_str(), "wb");
        if (out == nullptr)
            return fmt::format("cannot write {}: {}", file.path, std::strerror(errno));
        staged_.emplace_back(temporary, place);
        const bool whole =
            std::fwrite(file.text.data(), 1, file.text.size(), out) == file.text.size() &&
            std::fflush(out) == 0;
        const int reason = errno;
        const bool closed = std::fclose(out) == 0;
        if (!whole || !closed)
            return fmt::format("cannot write {}: {}", file.path,
                               std::strerror(whole ? errno : reason));
        return {};
    }

    std::string commit()
    {
        while (!staged_.empty()) {
            std::error_code error;
            fs::rename(staged_.back().first, staged_.back().second, error);
            if (error)
                return fmt::format("cannot write {}: {}", staged_.back().second.string(),
                                   error.message());
            staged_.pop_back();
        }
        made_.clear();
        return {};
    }

private:
    std::string make_folders(const fs::path& folder)
    {
        if (folder.empty()) return {};
        std::error_code error;
        std::vector<fs::path> missing;
        for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path())
            missing.push_back(at);
        for (auto it = missing.rbegin(); it != missing.rend(); ++it) {
            fs::create_directory(*it, error);
            if (error) return fmt::format("cannot make {}: {}", it->string(), error.message());
            made_.push_back(*it);
        }
        if (!fs::is_directory(folder, error))
            return fmt::format("cannot write into {}: it is not a folder", folder.string());
        return {};
    }

    std::vector<std::pair<fs::path, fs::path>> staged_;
    std::vector<fs::path> made_;
};

}  // namespace

bool holds(const OutputFile& file)
{
    return read_file(file.path, file.text.size() + 1).text == file.text;
}

Written write_files(const std::vector<OutputFile>& files)
{
    Written result;
    Staging staging;
    for (const OutputFile& file : files) {
        if (holds(file)) {
            ++result.unchanged;
            continue;
        }
        result.why = staging.add(file);
        if (!result.why.empty()) return result;
        ++result.written;
    }
    result.why = staging.commit();
    return result;
}

std::vector<std::string> files_below(const std::string& folder)
{
    std::vector<std::string> result;
    std::error_code error;
    for (fs::recursive_directory_iterator it{folder, error}, end; !error && it != end;
         it.increment(error))
        if (it->is_regular_file(error))
            result.push_back(fs::relative(it->path(), folder, error).generic_string());
    std::ranges::sort(result);
    return result;
}

}  // namespace lobe::cli
