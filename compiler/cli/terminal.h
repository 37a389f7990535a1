// Where messages go: stderr for people, stdout for results; color and progress on terminals only.
#pragma once

#include "base/diagnostic.h"

#include <string>
#include <vector>

namespace lobe::cli {

/// Exit codes are a promise: scripts read them.
enum Exit : int {
    success = 0,
    findings = 1,  ///< the input was read and something is wrong with it
    broken = 2,    ///< usage, unreadable input, unwritable output
};

/// What the options that every command shares were set to.
struct Terminal {
    std::string color = "auto";   ///< auto, always, never
    std::string format = "text";  ///< text, short, json, sarif
    bool quiet = false;
    std::vector<std::string> imports;  ///< folders to look for modules in, after the importer's own

    bool color_on_stdout() const;
    bool color_on_stderr() const;
    bool progress() const;  ///< stderr is a terminal and nobody asked for quiet
    int width() const;      ///< columns of the terminal on stdout; 0 when it is none
};

/// Prints every diagnostic in the chosen form: text and short to stderr, json and sarif to
/// stdout. SARIF needs one call for the whole run.
void print(const Terminal& terminal, const Diagnostics& diagnostics, const Sources& sources);

/// `error: …` on stderr, for what has no place in a source. Returns Exit::broken.
int fail(const Terminal& terminal, const std::string& message);

/// One line on stderr that is rewritten in place, on terminals only. Erased when destroyed.
class Progress {
public:
    explicit Progress(const Terminal& terminal);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    void show(const std::string& text);

private:
    bool on_;
    std::size_t shown_ = 0;
};

}  // namespace lobe::cli
