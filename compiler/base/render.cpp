// The short forms: one line a diagnostic, and the count.
#include "base/render.h"

#include <fmt/format.h>

namespace lobe {

std::string render_short(const Sources& sources, const Diagnostics& diagnostics)
{
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics.sorted()) {
        const Span& span = diagnostic.primary.span;
        if (span.source < sources.size()) {
            const Position place = sources.position(span);
            result +=
                fmt::format("{}:{}:{}: ", sources[span.source].path(), place.line, place.column);
        }
        const bool error = severity(diagnostic.code) == Severity::error;
        result += fmt::format("{}[{}]: {}\n", error ? "error" : "warning", id(diagnostic.code),
                              diagnostic.message);
    }
    return result;
}

std::string render_count(const Diagnostics& diagnostics)
{
    const auto count = [](int number, std::string_view word) {
        if (number == 0) return std::string{};
        return fmt::format("{} {}{}", number, word, number == 1 ? "" : "s");
    };
    const std::string errors = count(diagnostics.error_count(), "error");
    const std::string warnings = count(diagnostics.warning_count(), "warning");
    return errors + (errors.empty() || warnings.empty() ? "" : ", ") + warnings;
}

}  // namespace lobe
