#include "check/checking.h"

#include "evaluate/run.h"

#include <catch2/catch.hpp>

namespace lobe::tests {

const ir::Function& Checked::function(std::string_view name) const
{
    REQUIRE(module);
    const auto found = module->find(name);
    CAPTURE(std::string{name});
    REQUIRE(found);
    return (*module)[*found];
}

namespace {

std::string codes(const Diagnostics& diagnostics, Severity wanted)
{
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics.sorted())
        if (severity(diagnostic.code) == wanted)
            result += (result.empty() ? "" : " ") + std::string{id(diagnostic.code)};
    return result;
}

}  // namespace

std::string Checked::errors() const { return codes(diagnostics, Severity::error); }
std::string Checked::warnings() const { return codes(diagnostics, Severity::warning); }

Checked check_text(const std::string& text, const std::map<std::string, std::string>& others)
{
    Checked checked;
    const std::uint32_t root = checked.sources.add("m.lobe", "module m\n" + text);
    const check::Loader loader = [&](Sources& sources, std::string_view name,
                                     std::string_view) -> std::optional<std::uint32_t> {
        const auto found = others.find(std::string{name});
        if (found == others.end()) return std::nullopt;
        return sources.add(found->first + ".lobe", found->second);
    };
    checked.module = check::check(checked.sources, root, loader, checked.diagnostics);
    CHECK(checked.module.has_value() == !checked.diagnostics.has_errors());
    if (checked.module) {
        const auto broken = ir::verify(*checked.module);
        CAPTURE(broken.value_or(""));
        CHECK(!broken);
    }
    return checked;
}

std::string inputs_of(const ir::Function& function)
{
    std::string names;
    for (const ir::Input& input : function.inputs) names += (names.empty() ? "" : " ") + input.name;
    return names;
}

double value_at(const ir::Module& module, const ir::Function& function,
                const std::vector<double>& point, int component)
{
    const evaluate::Tape tape = evaluate::compile(module, function);
    REQUIRE(tape.inputs.size() == point.size());
    std::vector<const double*> columns;
    for (const double& value : point) columns.push_back(&value);
    std::vector<double> results(tape.outputs.size());
    std::vector<double*> outputs;
    for (double& value : results) outputs.push_back(&value);
    evaluate::run(tape, evaluate::Columns<double>{columns}, evaluate::Results<double>{outputs}, 1);
    return results.at(static_cast<std::size_t>(component));
}

}  // namespace lobe::tests
