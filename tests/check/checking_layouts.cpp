#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

namespace lobe::tests {

std::string file_text(const std::string& path)
{
    std::ifstream in{path, std::ios::binary};
    CAPTURE(path);
    REQUIRE(in);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

Checked check_layout(const std::string& text)
{
    return check_text("import cloth { cloth }\nimport console { console }\n" + text,
                      {{"cloth", file_text("diagnostics/cloth.lobe")},
                       {"console", file_text("diagnostics/console.lobe")}});
}

std::string words(const Diagnostic& diagnostic)
{
    std::string text = std::string{id(diagnostic.code)} + " " + diagnostic.message + "\n" +
                       diagnostic.primary.text + "\n";
    for (const Label& label : diagnostic.secondary) text += label.text + "\n";
    for (const std::string& note : diagnostic.notes) text += note + "\n";
    for (const std::string& help : diagnostic.helps) text += help + "\n";
    if (diagnostic.fix) text += diagnostic.fix->replacement + "\n";
    return text;
}

std::string only_error(const Checked& checked)
{
    std::string found;
    for (const Diagnostic& diagnostic : checked.diagnostics.sorted())
        if (severity(diagnostic.code) == Severity::error) found += words(diagnostic);
    CAPTURE(found);
    CHECK(checked.diagnostics.error_count() == 1);
    return found;
}

}  // namespace lobe::tests
