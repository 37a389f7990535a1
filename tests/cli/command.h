// Runs `lobec` in a scratch folder of its own and tells what it did.
#pragma once

#include <filesystem>
#include <string>

namespace lobe::tests {

struct Outcome {
    int status = -1;
    std::string out;
    std::string err;
};

/// A folder that is gone when this goes out of scope.
class Scratch {
public:
    Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch();

    const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;
    /// How many files and folders are below it.
    int entries() const;

    /// Runs a shell command in the folder, `lobec` standing for the binary under test.
    Outcome run(const std::string& command) const;

private:
    std::filesystem::path path_;
};

}  // namespace lobe::tests
