// The only place that touches the disk: reading sources, writing results whole or not at all.
#pragma once

#include "check/check.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::cli {

/// The bytes of a file, or why they cannot be had, in words for a person. Refuses folders and
/// anything above `limit` bytes without reading it.
struct Read {
    std::optional<std::string> text;
    std::string why;
};
Read read_file(const std::string& path, std::size_t limit);

/// How much of a source is read at most. More than the parser takes, so that a file in between is
/// refused by it, with its own message (E0003).
inline constexpr std::size_t largest_source = std::size_t{64} << 20;

/// Finds `<module>.lobe` in the folder of the importing file, else in the first of these that has it.
check::Loader folder_loader(std::vector<std::string> folders);

struct OutputFile {
    std::string path;
    std::string text;
};

/// True when the file is there and its text is already this one.
bool holds(const OutputFile& file);

struct Written {
    int written = 0;
    int unchanged = 0;
    std::string why;  ///< empty on success
};

/// Writes all files or none: every file is first written beside its place, then all are renamed.
/// Files that already hold the text are left alone, so that build systems see real changes only.
/// On failure (unwritable folder, full disk) nothing half-written stays behind.
Written write_files(const std::vector<OutputFile>& files);

/// Regular files below a folder, as paths relative to it, sorted. Empty if there is none.
std::vector<std::string> files_below(const std::string& folder);

}  // namespace lobe::cli
