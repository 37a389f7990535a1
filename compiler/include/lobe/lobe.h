// Lobe as a library: .lobe text in, shader files and messages out.
//
// Hermetic: no file is read or written, no clock or environment looked at, and equal inputs give
// equal bytes. Link `lobe::lobe`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lobe {

struct File {
    std::string path;  ///< names the file in messages and in generated comments
    std::string text;
};

/// Finds an imported module: its name and the path of the file that imports it.
using Importer =
    std::function<std::optional<File>(const std::string& module, const std::string& importing)>;

struct Options {
    std::vector<std::string> targets;  ///< names of `target_names()`; empty means all
};

struct Message {
    std::string code;  ///< `E0501`
    bool is_error = true;
    std::string path;
    int line = 1;    ///< from 1
    int column = 1;  ///< from 1, in characters
    std::string text;
};

struct Result {
    std::vector<File> files;  ///< paths relative to an output folder; empty unless `ok()`
    std::vector<Message> messages;
    bool ok() const;  ///< no message is an error
};

/// `ue4`, `glsl450`, …
std::vector<std::string> target_names();

/// Compiles one model file with what it imports.
Result compile(const File& file, const Importer& importer, const Options& options = {});

}  // namespace lobe
