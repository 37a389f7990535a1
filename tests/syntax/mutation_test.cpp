// Damaged texts: whatever is broken in them, parse returns, points into the text and can be
// rendered; and what it accepts can be formatted. The libFuzzer target looks further; this
// looks at the same inputs in every build.
#include "base/render.h"
#include "syntax/format.h"
#include "syntax/meaning.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::meaning;
using lobe::tests::parsed;

namespace {

std::vector<std::string> seeds()
{
    std::vector<std::string> paths;
    for (const char* folder : {"../models", "diagnostics"})
        for (const auto& entry : std::filesystem::directory_iterator{folder})
            if (entry.path().extension() == ".lobe") paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> texts;
    for (const std::string& path : paths) {
        std::ifstream file(path, std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        texts.push_back(text.str());
    }
    return texts;
}

/// Cuts, doubles, moves or replaces a piece, as an editor or a bad transfer might.
void damage(std::string& text, std::mt19937& random)
{
    static const std::vector<std::string> pieces{
        "(",      ")",          "{",        "}",          "[",       "]",     ",",
        ":",      "=",          "^",        "-",          "/",       "<",     "else",
        "then ",  "if ",        "let ",     "\nterm ",    "\nform ", "\"",    "//",
        "///",    "\n",         " ",        "1",          ".5",      "a",     "\xC3",
        "\u2212", "\r",         "\x01",     "in",         "not ",    " and ", "..",
        "%",      "\nchannel ", "\nfield ", "\nrequire ", " when ",  "code "};
    const auto below = [&](std::size_t bound) {
        return std::uniform_int_distribution<std::size_t>{0, bound}(random);
    };
    const std::size_t at = below(text.size());
    const std::size_t size = std::min(below(20), text.size() - at);
    switch (below(4)) {
    case 0: text.erase(at, size); break;
    case 1: text.insert(at, pieces[below(pieces.size() - 1)]); break;
    case 2: text.insert(below(text.size()), text.substr(at, size)); break;
    case 3:
        text.replace(at, std::min<std::size_t>(size, 1), pieces[below(pieces.size() - 1)]);
        break;
    default: text.resize(at); break;
    }
}

bool lies_in(const Span& span, const Sources& sources)
{
    return span.source == 0 && span.begin <= span.end && span.end <= sources[0].text().size();
}

void check_spans(const tests::Parsed& result)
{
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
        REQUIRE(lies_in(diagnostic.primary.span, result.sources));
        for (const Label& label : diagnostic.secondary)
            REQUIRE(lies_in(label.span, result.sources));
        if (diagnostic.fix) REQUIRE(lies_in(diagnostic.fix->span, result.sources));
    }
    for (const Item& item : result.tree.items) REQUIRE(lies_in(item.span, result.sources));
    for (const Expression& expression : result.tree.expressions)
        REQUIRE(lies_in(expression.span, result.sources));
}

}  // namespace

TEST_CASE("damaged texts are refused or understood")
{
    const std::vector<std::string> originals = seeds();
    REQUIRE(!originals.empty());
    std::mt19937 random{20260731};
    int refused = 0;
    int accepted = 0;
    for (int round = 0; round < 6000; ++round) {
        std::string text = originals[static_cast<std::size_t>(round) % originals.size()];
        // Models are long; a piece of one is damaged more thoroughly.
        if (text.size() > 2000 && round % 8 != 0)
            text = "module m\n" + text.substr(random() % (text.size() - 1000), 1000);
        for (unsigned count = 1 + random() % 4; count > 0; --count) damage(text, random);
        CAPTURE(text);

        auto result = parsed(text);
        check_spans(result);
        REQUIRE(result.diagnostics.error_count() <= 20);
        if (result.diagnostics.has_errors()) {
            ++refused;
            REQUIRE(!render_text(result.sources, result.diagnostics).empty());
            continue;
        }
        ++accepted;
        const std::string canonical = format(result.tree);
        const auto again = parsed(canonical);
        REQUIRE(!again.diagnostics.has_errors());
        REQUIRE(meaning(again.tree) == meaning(result.tree));
        REQUIRE(format(again.tree) == canonical);
    }
    // The damage is of the kind that this test is about: some of it goes unnoticed, most not.
    CHECK(refused > 1000);
    CHECK(accepted > 100);
}
