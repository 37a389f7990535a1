#include "base/diagnostic.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace lobe;

TEST_CASE("the registry is in order of its own rules")
{
    std::set<std::string_view> ids;
    for (const Code code : all_codes()) {
        CAPTURE(id(code));
        CHECK(ids.insert(id(code)).second);
        REQUIRE(id(code).size() == 5);
        CHECK((id(code)[0] == 'E' || id(code)[0] == 'W'));
        CHECK(std::all_of(id(code).begin() + 1, id(code).end(),
                          [](char c) { return c >= '0' && c <= '9'; }));
        CHECK(severity(code) == (id(code)[0] == 'E' ? Severity::error : Severity::warning));
        CHECK(find_code(id(code)) == code);
        CHECK(!summary(code).empty());
        CHECK(summary(code).back() != '.');
    }
    CHECK(find_code("e0501") == Code::divisor_reaches_zero);
    CHECK(!find_code("E9999"));
    CHECK(!find_code(""));
}

TEST_CASE("the nearest name is one that could have been meant")
{
    const std::vector<std::string> names{"diffuse_fresnel", "cos_d", "term", "ab"};
    CHECK(nearest("diffuse_frensel", names) == "diffuse_fresnel");
    CHECK(nearest("DIFFUSE_FRESNEL", names) == "diffuse_fresnel");
    CHECK(nearest("cosd", names) == "cos_d");
    CHECK(nearest("tem", names) == "term");
    CHECK(nearest("terms", names) == "term");
    CHECK_FALSE(nearest("xy", names));
    CHECK_FALSE(nearest("roughness", names));
    CHECK_FALSE(nearest("", names));
    CHECK_FALSE(nearest(std::string(1000, 'a'), names));
}

TEST_CASE("diagnostics are counted and sorted by place")
{
    Diagnostics diagnostics;
    CHECK(diagnostics.empty());
    diagnostics.report({.code = Code::unknown_name, .message = "b", .primary = {{0, 9, 9}, ""}});
    diagnostics.report({.code = Code::unused_name, .message = "a", .primary = {{0, 2, 3}, ""}});
    diagnostics.report({.code = Code::unknown_name, .message = "c", .primary = {{0, 9, 9}, ""}});
    CHECK(diagnostics.error_count() == 2);
    CHECK(diagnostics.warning_count() == 1);
    CHECK(diagnostics.has_errors());
    std::string order;
    for (const Diagnostic& diagnostic : diagnostics.sorted()) order += diagnostic.message;
    CHECK(order == "abc");
}
