#include "cli/terminal.h"

#include "base/render.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace lobe::cli {
namespace {

bool wants_color(const std::string& choice, int descriptor)
{
    if (choice != "auto") return choice == "always";
    const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org
    const char* terminal = std::getenv("TERM");
    return isatty(descriptor) == 1 && (no_color == nullptr || *no_color == '\0') &&
           (terminal == nullptr || std::string_view{terminal} != "dumb");
}

}  // namespace

bool Terminal::color_on_stdout() const { return wants_color(color, STDOUT_FILENO); }
bool Terminal::color_on_stderr() const { return wants_color(color, STDERR_FILENO); }
bool Terminal::progress() const { return !quiet && isatty(STDERR_FILENO) == 1; }

int Terminal::width() const
{
    winsize size{};
    if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
    return size.ws_col;
}

void print(const Terminal& terminal, const Diagnostics& diagnostics, const Sources& sources)
{
    if (terminal.format == "json") {
        fmt::print("{}", render_json(sources, diagnostics));
    } else if (terminal.format == "sarif") {
        fmt::print("{}", render_sarif(sources, diagnostics, LOBE_VERSION));
    } else if (terminal.format == "short") {
        fmt::print(stderr, "{}", render_short(sources, diagnostics));
    } else {
        fmt::print(stderr, "{}", render_text(sources, diagnostics, terminal.color_on_stderr()));
        if (!diagnostics.empty() && !terminal.quiet)
            fmt::print(stderr, "\n{}\n", render_count(diagnostics));
    }
}

int fail(const Terminal& terminal, const std::string& message)
{
    fmt::print(stderr, "{}: {}\n", terminal.color_on_stderr() ? "\x1b[1;31merror\x1b[0m" : "error",
               message);
    return broken;
}

Progress::Progress(const Terminal& terminal) : on_(terminal.progress()) {}

Progress::~Progress()
{
    if (on_ && shown_ > 0) fmt::print(stderr, "\r{:{}}\r", "", shown_);
}

void Progress::show(const std::string& text)
{
    if (!on_) return;
    fmt::print(stderr, "\r{:<{}}", text, shown_);
    std::fflush(stderr);
    shown_ = text.size();
}

}  // namespace lobe::cli
