#include "cli/told.h"

#include "analyze/agreement/gain.h"
#include "optimize/explain.h"
#include "optimize/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace lobe::cli {
namespace {

constexpr std::size_t points_per_function = 4096;

std::string describe(const analyze::FloatError& error)
{
    std::string text =
        fmt::format("{:.1e} ({:.1e} in 99 of 100)", error.typical, error.worst_of_99);
    if (error.not_finite > 0)
        text += fmt::format(", {} of {} not finite", error.not_finite, error.results);
    return text;
}

/// One line, without the room that an expression takes on several.
std::string one_line(std::string_view text)
{
    std::string result;
    for (const char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (!space)
            result += c;
        else if (!result.empty() && result.back() != ' ')
            result += ' ';
    }
    return result;
}

std::string told(const ir::Module& checked, const Sources& sources)
{
    std::vector<optimize::Note> notes;
    const ir::Module emitted = optimize::optimize(checked, notes);
    const ir::Module written = optimize::spell(checked, optimize::Spelling::as_written);

    std::map<std::size_t, std::vector<const optimize::Note*>> by_function;
    for (const optimize::Note& note : notes) by_function[note.function.index].push_back(&note);

    std::string text = fmt::format("{}\n", checked.path);
    std::vector<ir::FunctionId> roots = emitted.roots();
    std::ranges::copy(emitted.shading_roots(), std::back_inserter(roots));
    for (const ir::FunctionId id : emitted.reachable(roots)) {
        auto found = by_function.find(id.index);
        if (found == by_function.end()) continue;
        const auto key = [](const optimize::Note* note) {
            return std::tuple{note->span.source, note->span.begin, note->span.end,
                              note->action.name};
        };
        auto& own = found->second;
        std::ranges::stable_sort(own, {}, key);
        own.erase(std::unique(own.begin(), own.end(),
                              [&](const auto* a, const auto* b) { return key(a) == key(b); }),
                  own.end());

        text += fmt::format("  {}: float error {} as written, {} as emitted\n", emitted[id].name,
                            describe(analyze::float_error(written, id, points_per_function)),
                            describe(analyze::float_error(emitted, id, points_per_function)));
        for (const optimize::Note* note : own) {
            const optimize::Action& action = note->action;
            text +=
                fmt::format("    {}: `{}`\n      {} {}: {} -> {}; {}\n", sources.cite(note->span),
                            one_line(sources.text(note->span)), name(action.kind), action.name,
                            action.pattern, action.replacement, action.reason);
        }
    }
    return text;
}

}  // namespace

std::string told(const Program& program)
{
    std::string text;
    for (const ir::Module& module : program.modules) text += told(module, program.sources);
    return text;
}

}  // namespace lobe::cli
