// The front end on any bytes. What must hold, whatever they are:
//
//   - parse returns, reports at most 20 errors, and every span lies in the text;
//   - every diagnostic can be rendered in every form;
//   - a text without errors can be formatted, the result parses, and formatting it again changes
//     nothing.
//
// Run with -max_len=1024: limits that need longer inputs have tests of their own in tests/syntax.
#include "base/render.h"
#include "syntax/format.h"
#include "syntax/parse.h"

#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

using namespace lobe;

void require(bool condition)
{
    if (!condition) std::abort();
}

void check_span(const Sources& sources, const Span& span)
{
    require(span.source < sources.size());
    require(span.begin <= span.end && span.end <= sources[span.source].text().size());
}

void check_spans(const Sources& sources, const syntax::Tree& tree, const Diagnostics& diagnostics)
{
    for (const Diagnostic& diagnostic : diagnostics.all()) {
        check_span(sources, diagnostic.primary.span);
        for (const Label& label : diagnostic.secondary) check_span(sources, label.span);
        if (diagnostic.fix) check_span(sources, diagnostic.fix->span);
    }
    for (const syntax::Item& item : tree.items) check_span(sources, item.span);
    for (const syntax::Expression& expression : tree.expressions)
        check_span(sources, expression.span);
}

void check_format(Sources& sources, const syntax::Tree& tree)
{
    const std::string canonical = syntax::format(tree);
    const std::uint32_t index = sources.add("again.lobe", canonical);
    Diagnostics diagnostics;
    const syntax::Tree again = syntax::parse(sources, index, diagnostics);
    require(diagnostics.empty());
    require(syntax::format(again) == canonical);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Sources sources;
    sources.add("fuzz.lobe", std::string{reinterpret_cast<const char*>(data), size});
    Diagnostics diagnostics;
    const syntax::Tree tree = syntax::parse(sources, 0, diagnostics);
    require(diagnostics.error_count() <= 20);
    check_spans(sources, tree, diagnostics);
    if (diagnostics.has_errors()) {
        require(!render_text(sources, diagnostics, size % 2 == 0).empty());
        require(!render_short(sources, diagnostics).empty());
        // The long forms cost more than all else; some inputs are enough for them.
        if (size % 4 == 0) require(!render_json(sources, diagnostics).empty());
        if (size % 16 == 0) require(!render_sarif(sources, diagnostics, "0").empty());
    } else {
        check_format(sources, tree);
    }
    return 0;
}
