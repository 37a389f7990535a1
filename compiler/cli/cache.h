// Results of earlier runs, on disk: the analyses' store (analyze/store.h) as a folder of files.
//
// One file per result, named by a hash of its key and of this very program, and holding the whole
// key, so that neither two keys of one hash nor a rebuilt compiler can answer for another. A file
// is written beside its place and renamed, and carries a checksum: processes may share a folder,
// and a file that is damaged is no file. What cannot be read is computed, what cannot be written
// is not kept; neither is worth a message.
//
//     ab/cdef...   "lobe cache 1\n"  key length  value length  key  value  checksum of all before
#pragma once

#include "analyze/store.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace lobe::cli {

struct CacheOptions {
    std::string folder;  ///< empty: $XDG_CACHE_HOME/lobe, or ~/.cache/lobe
    bool off = false;
    /// How much is kept: above it, what was not asked for the longest goes.
    std::uintmax_t bytes = std::uintmax_t{256} << 20;
};

/// `--cache DIR` and `--no-cache`.
void add_cache_options(CLI::App& command, CacheOptions& options);

/// Empty where there is to be no cache, or no place for one.
analyze::Store open_cache(const CacheOptions& options);

}  // namespace lobe::cli
