// What a URI of a scene stands for: bytes of its own, or a file beside the scene.
#pragma once

#include <string>
#include <string_view>
#include <variant>

namespace lobe::scene {

/// Bytes in a `data:` URI.
struct InlineBytes {
    std::string bytes;
};

/// A file, by its path from the scene's folder: percent-decoded, without `.` and `..`.
struct FilePath {
    std::string path;
};

/// What is wrong with a URI.
struct BadUri {
    std::string message;
    std::string help;
};

/// Only files below the scene's folder can be named: no scheme, no absolute path, no `..` beyond
/// the folder, no backslash. Of data only base64 is read.
std::variant<InlineBytes, FilePath, BadUri> resolve(std::string_view uri);

}  // namespace lobe::scene
