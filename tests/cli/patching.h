// A model, the GBuffer that it is packed on and a stand-in for an engine's source tree in a scratch
// folder, for running `lobec patch` there.
#pragma once

#include "cli/command.h"
#include "engine/stand_ins.h"

#include <filesystem>
#include <string>

namespace lobe::tests {

/// A small model with a packing, and its engine block.
extern const std::string patched_model;
extern const std::string engine_block;

/// The text with `to` in the place of the first `from`; fails the test where there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// A folder with a model (skin.lobe), the GBuffer and an engine's tree.
class Place {
public:
    explicit Place(const engine::Files& tree = engine::engine_tree("4.27"),
                   const std::string& source = patched_model + engine_block);

    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const { return scratch_.read(name); }
    std::filesystem::path path(const std::string& name) const { return scratch_.path() / name; }
    Outcome shell(const std::string& command) const { return scratch_.run(command); }

    /// Most of these tests are not about shaders, whose check takes most of the time.
    Outcome patch(const std::string& options = "", bool check_shaders = false) const;

    /// All files of the tree as they are now.
    engine::Files tree() const;

    /// One text for another in a file of the tree.
    void edit(const std::string& name, const std::string& from, const std::string& to) const;

private:
    Scratch scratch_;
};

/// A run that changes nothing and says why. Gives what it says.
std::string refuses(const Place& place, const std::string& options, int status,
                    bool check_shaders = false);

}  // namespace lobe::tests
