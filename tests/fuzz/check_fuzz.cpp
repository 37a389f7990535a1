// Parse and check on any bytes, without imports. A module comes out exactly when nothing was wrong,
// and every diagnostic can be rendered. Texts that do not parse are front_fuzz.cpp's.
#include "base/render.h"
#include "check/check.h"
#include "syntax/parse.h"

#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace lobe;

    Sources sources;
    sources.add("fuzz.lobe", std::string{reinterpret_cast<const char*>(data), size});
    Diagnostics syntax_errors;
    syntax::parse(sources, 0, syntax_errors);
    // One in four refused texts goes on: the checker has to live with what parsing left of it.
    if (syntax_errors.has_errors() && size % 4 != 0) return 0;

    Diagnostics diagnostics;
    const auto module = check::check(sources, 0, {}, diagnostics);
    if (module.has_value() == diagnostics.has_errors()) std::abort();
    if (!diagnostics.empty() && render_text(sources, diagnostics).empty()) std::abort();
    return 0;
}
