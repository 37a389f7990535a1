// What is suggested for a model that ships compiles in place of the packing that it has, says the
// same when it is formatted, and keeps what has to stay exact.
#include "analyze/packing/suggest.h"
#include "base/render.h"
#include "compile.h"
#include "evaluate/run.h"
#include "evaluate/tape.h"
#include "syntax/format.h"
#include "syntax/parse.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

using namespace lobe;

namespace {

std::string read_model(std::string_view name)
{
    std::ifstream in{"../models/" + std::string{name} + ".lobe", std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::optional<std::uint32_t> add_model(Sources& sources, std::string_view name)
{
    std::string text = read_model(name);
    if (text.empty()) return std::nullopt;
    return sources.add("models/" + std::string{name} + ".lobe", std::move(text));
}

struct Compiled {
    Sources sources;
    Diagnostics diagnostics;
    std::optional<ir::Module> module;

    explicit Compiled(std::string text)
    {
        const auto root = sources.add("models/callisto.lobe", std::move(text));
        module = front(
            sources, root,
            [](Sources& all, std::string_view name, std::string_view) {
                return add_model(all, name);
            },
            diagnostics);
    }
};

/// The text with the block that starts at `packing callisto` replaced.
std::string with_packing(const std::string& text, const std::string& block)
{
    const std::size_t begin = text.find("\npacking callisto ") + 1;
    const std::size_t end = text.find("\n}\n", begin) + 3;
    return text.substr(0, begin) + block + text.substr(end);
}

analyze::SuggestOptions all_of(const ir::Module& module, const ir::Packing& packing)
{
    analyze::SuggestOptions options;
    for (const ir::Field& field : packing.fields)
        if (std::ranges::find(options.parameters, field.parameter) == options.parameters.end())
            options.parameters.push_back(field.parameter);
    options.room = analyze::room(*module.find_gbuffer(packing.gbuffer), packing);
    options.radiance.points = std::size_t{1} << 13;
    return options;
}

}  // namespace

TEST_CASE("what is suggested for Callisto compiles in its place", "[suggest][shipped]")
{
    const std::string text = read_model("callisto");
    const Compiled original{text};
    INFO(render_text(original.sources, original.diagnostics));
    REQUIRE(original.module);
    REQUIRE_FALSE(original.module->packings.empty());
    const ir::Packing& written = original.module->packings[0];
    const auto options = all_of(*original.module, written);
    const analyze::Suggestion found = analyze::suggest(*original.module, 0, options);
    INFO(found.text << found.why_not);
    REQUIRE(found.found);

    const Compiled suggested{with_packing(text, found.text)};
    INFO(render_text(suggested.sources, suggested.diagnostics));
    REQUIRE(suggested.module);
    REQUIRE(suggested.module->packings.size() == original.module->packings.size());
    const ir::Packing& again = suggested.module->packings[0];
    REQUIRE(again.fields.size() == options.parameters.size());

    // The error is that of the text, not only of what it was written from.
    const ir::Module legal = middle(*suggested.module);
    const auto errors = analyze::packing_errors(legal, legal.packings[0], options.radiance);
    CHECK(errors.whole.worst == found.errors.whole.worst);

    // It is as `lobec format` would have it.
    Diagnostics ignored;
    const syntax::Tree tree = syntax::parse(suggested.sources, 0, ignored);
    CHECK(syntax::format(tree).find(found.text) != std::string::npos);

    // Every default survives, by the functions that are emitted.
    for (const ir::Field& field : again.fields) {
        const ir::Parameter& parameter = legal.parameters[field.parameter];
        CAPTURE(parameter.name);
        const auto run = [&](ir::FunctionId id, float value) {
            const evaluate::Tape tape = evaluate::compile(legal, legal[id]);
            const float* const in[] = {&value};
            float result = 0;
            float* const out[] = {&result};
            evaluate::run(tape, evaluate::Columns<float>{in, tape.inputs.size()}, out, 1);
            return result;
        };
        const ir::Field& live =
            *std::ranges::find_if(legal.packings[0].fields, [&](const ir::Field& one) {
                return one.parameter == field.parameter;
            });
        const auto standard = static_cast<float>(parameter.default_value[0]);
        CHECK(run(live.decode, run(live.encode, standard)) == standard);
    }
    // What is suggested is not worse than what a person wrote.
    const ir::Module as_written = middle(*original.module);
    const auto by_hand =
        analyze::packing_errors(as_written, as_written.packings[0], options.radiance);
    CHECK(found.errors.whole.worst <= by_hand.whole.worst);
}
