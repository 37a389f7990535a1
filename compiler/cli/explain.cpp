// `lobec explain`: the page of a diagnostic code.
#include "base/diagnostic.h"
#include "base/embedded.h"
#include "cli/commands.h"

#include <fmt/format.h>

#include <memory>

namespace lobe::cli {
namespace {

int explain(const Terminal& terminal, const std::string& text)
{
    const auto code = find_code(text);
    if (!code) {
        std::vector<std::string> ids;
        for (const Code known : all_codes()) ids.emplace_back(id(known));
        const auto near = nearest(text, ids);
        return fail(terminal,
                    fmt::format("there is no diagnostic {}{}; `lobec explain` lists them", text,
                                near ? fmt::format("; did you mean {}?", *near) : ""));
    }
    for (const Embedded& page : embedded_diagnostic_pages())
        if (page.name == fmt::format("{}.md", id(*code))) {
            fmt::print("{}", page.text);
            return success;
        }
    return fail(terminal, fmt::format("{}: {}", id(*code), summary(*code)));
}

}  // namespace

void add_explain(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("explain", "What a diagnostic means, and the ways out");
    auto code = std::make_shared<std::string>();
    command->add_option("CODE", *code, "A code as printed, such as E0501; none lists all");
    command->footer("Example: lobec explain E0501");
    command->callback([code, &terminal, &status] {
        if (!code->empty()) {
            status = explain(terminal, *code);
            return;
        }
        for (const Code known : all_codes()) fmt::print("{}  {}\n", id(known), summary(known));
        status = success;
    });
}

}  // namespace lobe::cli
