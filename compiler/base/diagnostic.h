// Diagnostics as data: what was seen, where, what follows from it, and the way out.
//
// Stages append to a `Diagnostics`; `render.h` is the only printer. The registry of codes is
// `diagnostics.def`; every code there has a page in docs/diagnostics/ and a test.
#pragma once

#include "base/source.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

enum class Severity {
    error,
    warning
};

/// Every diagnostic the compiler can report. The enumerator is the name, `id()` the number.
enum class Code {
#define LOBE_DIAGNOSTIC(id, name, summary) name,
#include "base/diagnostics.def"
#undef LOBE_DIAGNOSTIC
};

/// `E0501`, as printed and as `lobec explain` takes it.
std::string_view id(Code code);
/// One line that says what the code is about, for lists and SARIF rules.
std::string_view summary(Code code);
/// The code with this id, if there is one; case does not matter.
std::optional<Code> find_code(std::string_view id);
/// All codes in the order of the registry.
const std::vector<Code>& all_codes();
/// From the first letter of the id: E is an error, W a warning.
Severity severity(Code code);

/// A place and what is to be seen there. The text may be empty.
struct Label {
    Span span;
    std::string text;
};

/// An edit that would cure the problem, shown as the corrected line.
struct Fix {
    Span span;  ///< what to replace; empty spans insert
    std::string replacement;
    std::string text;  ///< what the edit does, lower case: "start the range above zero"
};

struct Diagnostic {
    Code code{};
    std::string message;  ///< one lower-case sentence without a full stop; code in `backticks`
    Label primary;
    std::vector<Label> secondary = {};    ///< in source order
    std::vector<std::string> notes = {};  ///< facts the reader cannot see in the source
    std::vector<std::string> helps = {};  ///< ways out that are not edits
    std::optional<Fix> fix = std::nullopt;
};

/// The sink that stages report to. Keeps the order of reporting; `sorted()` orders by place.
class Diagnostics {
public:
    void report(Diagnostic diagnostic);

    bool has_errors() const { return errors_ > 0; }
    int error_count() const { return errors_; }
    int warning_count() const { return static_cast<int>(all_.size()) - errors_; }
    bool empty() const { return all_.empty(); }
    const std::vector<Diagnostic>& all() const { return all_; }

    /// By source, then position; equal places keep the order of reporting.
    std::vector<Diagnostic> sorted() const;

private:
    std::vector<Diagnostic> all_;
    int errors_ = 0;
};

/// The candidate nearest to a misspelt name: equal but for case, or at most two edits away
/// (insert, delete, replace, swap neighbours) and less than half the name.
std::optional<std::string> nearest(std::string_view name,
                                   const std::vector<std::string>& candidates);

}  // namespace lobe
