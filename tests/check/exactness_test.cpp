// What codes make of values: what is refused, what is said about it, and that what is proposed
// works.
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>

using namespace lobe;
using namespace lobe::tests;

namespace {

/// A packing of `p` and others; lines of the packing.
Checked check_packed(const std::string& declarations, const std::string& uses,
                     const std::string& lines)
{
    return check_layout(declarations + "/// m\nmodel lit(g: geometry) { out = g.cos_i * " + uses +
                        " }\npacking lit on console {\n" + lines +
                        "\n  supports lighting == live\n}\n");
}

Checked check_gain(const std::string& range, const std::string& default_value,
                   const std::string& storage, const std::string& more = "")
{
    return check_packed("/// p\nparam p : float in " + range + " = " + default_value + "\n", "p",
                        "  d.r = p : " + storage + "\n  " + more);
}

bool contains(const std::string& text, std::string_view part)
{
    return text.find(part) != std::string::npos;
}

/// What stands between "`code " and "`" in a help.
std::string proposed(const Checked& checked)
{
    for (const Diagnostic& diagnostic : checked.diagnostics.all())
        for (const std::string& help : diagnostic.helps)
            if (help.starts_with("`code ")) return help.substr(6, help.find('`', 6) - 6);
    return {};
}

}  // namespace

TEST_CASE("eight linear bits over 256 lose 1, and a power keeps it")
{
    const Checked linear = check_gain("[0, 256]", "1", "unorm 8");
    const std::string said = only_error(linear);
    CHECK(contains(said, "E0606 the default of `p` does not survive in d.r"));
    CHECK(contains(said, "1 is stored as code 1 and comes back as 1.003922"));
    CHECK(contains(said, "the codes around it are 0, which is 0, and 1, which is 1.003922"));
    CHECK(proposed(linear) == "power(8, 127/255)");
    CHECK(check_gain("[0, 256]", "1", "unorm 8 code power(8, 127/255)").errors().empty());
    // The slides' logarithm: 1 is beside a code, and a pivot puts it on one.
    const Checked log = check_gain("[0, 256]", "1", "unorm 8 code log2");
    CHECK(contains(only_error(log), "1 is stored as code 32 and comes back as 1.006"));
    CHECK(proposed(log) == "log2(31/255)");
    CHECK(check_gain("[0, 256]", "1", "unorm 8 code log2(31/255)").errors().empty());
}

TEST_CASE("three quarters are code 189 of 252")
{
    const Checked linear = check_gain("[0, 1]", "0.75", "unorm 8");
    CHECK(linear.errors() == "E0606");
    CHECK(proposed(linear) == "linear(252/255)");
    CHECK(check_gain("[0, 1]", "0.75", "unorm 8 code linear(252/255)").errors().empty());
    CHECK(check_gain("[0, 1]", "0.75", "unorm 8 in [0, 0.9375]").errors().empty());
    CHECK(check_gain("[0, 1]", "0.7", "unorm 8 in [0, 0.9375]").errors() == "E0606");
    CHECK(check_packed("/// p\nparam p : unit = 0.75\n", "p",
                       "  d.r[0..3] = p : unorm 4 in [0, 0.9375]")
              .errors()
              .empty());
}

TEST_CASE("what is proposed is accepted")
{
    int proposals = 0;
    for (const int bits : {3, 4, 5, 6, 8}) {
        for (const double high : {1.0, 2.0, 14.0, 256.0}) {
            for (const double value : {0.0, 0.25, 0.3, 0.5, 0.75, 1.0, 2.0, 14.0}) {
                for (const char* code : {"", " code sqrt", " code log2"}) {
                    if (value > high) continue;
                    const auto check = [&](const std::string& with) {
                        return check_packed(
                            fmt::format("/// p\nparam p : float in [0, {}] = {}\n", high, value),
                            "p",
                            fmt::format("  d.r[0..{}] = p : unorm {}{}", bits - 1, bits, with));
                    };
                    const Checked checked = check(code);
                    CAPTURE(bits, high, value, code);
                    if (checked.errors().empty()) {
                        CHECK(proposed(checked).empty());
                        continue;
                    }
                    CHECK(checked.errors() == "E0606");
                    const std::string other = proposed(checked);
                    if (other.empty()) continue;
                    CAPTURE(other);
                    CHECK(check(" code " + other).errors().empty());
                    ++proposals;
                }
            }
        }
    }
    CHECK(proposals > 100);
}

TEST_CASE("a power is proposed that bends as much as the range is wide")
{
    const auto bent = [](const std::string& range, const std::string& value) {
        return proposed(check_packed("/// p\nparam p : float in " + range + " = " + value + "\n",
                                     "p", "  d.r[0..3] = p : unorm 4"));
    };
    CHECK(bent("[0, 1]", "0.3") == "power(2, 8/15)");
    CHECK(bent("[0, 16.5]", "1") == "power(4, 7/15)");
    CHECK(bent("[0, 256]", "1") == "power(8, 7/15)");
    // Nearly straight: 1 + x is between 1 and 2.
    CHECK(proposed(check_gain("[0, 1]", "0.75", "unorm 8 code log2")) == "linear(252/255)");
}

TEST_CASE("every required value has to be on a code of its own")
{
    const std::string power = "unorm 8 code power(8, 127/255)";
    CHECK(check_gain("[0, 256]", "1", power, "require exact p == 0, p == 256").errors().empty());
    CHECK(check_gain("[0, 256]", "1", power, "require exact p == 2").errors() == "E0606");
    // On the code 126, which is not where decode is anchored.
    const std::string pivot = "unorm 8 code linear(252/255)";
    CHECK(check_gain("[0, 1]", "0.75", pivot, "require exact p == 0.5, p == 0, p == 1")
              .errors()
              .empty());
    CHECK(check_gain("[0, 1]", "0.75", pivot, "require exact p == 0.51").errors() == "E0606");
    // No float, so the nearest one: on code 25 of 250.
    CHECK(check_gain("[0, 1]", "0.1", "unorm 8 code linear(250/255)").errors().empty());
    const Checked both = check_gain("[0, 256]", "1", "unorm 8", "require exact p == 2");
    CHECK(both.errors() == "E0606 E0606");
    CHECK(contains(words(both.diagnostics.all()[0]),
                   "`code power(8, 127/255)` keeps 1, but no linear code or power with these bits "
                   "keeps all of 1, 2"));
}

TEST_CASE("an effect that is off stays off")
{
    const auto check = [](const std::string& condition, const std::string& default_value,
                          const std::string& storage) {
        return check_packed("/// p\nparam p : float in [0, 2] = " + default_value +
                                "\n/// q\nparam q : unit = 1\neffect \"E\" off when " + condition +
                                "\n",
                            "p * q", "  d.r = p : " + storage + "\n  d.g = q : unorm 8");
    };
    // Off at a value that is no default.
    const Checked beside = check("p == 1", "0", "unorm 8");
    CHECK(contains(only_error(beside),
                   "E0606 the effect `E` is off at `p == 1`, and no longer once that is stored"));
    CHECK(proposed(beside) == "linear(254/255)");
    CHECK(check("p == 1", "0", "unorm 8 code linear(254/255)").errors().empty());
    CHECK(check("p == 1", "0", "unorm 8 in [0, 0.5]").errors() == "E0606");
    // Of a product, with the other one at its default.
    CHECK(check("p * q == 1", "0", "unorm 8").errors() == "E0606");
    CHECK(check("p * q == 0", "0", "unorm 8").errors().empty());
    // Nearly off is off enough here.
    CHECK(check("abs(p - 1) < 0.01", "0", "unorm 8").errors().empty());
    // The default says it once.
    CHECK(check("p == 1", "1", "unorm 8").errors() == "E0606");
}

TEST_CASE("codes that end before the range do not clamp in silence")
{
    const Checked power = check_gain("[0, 256]", "1", "unorm 8 code power(8, 128/255)");
    const std::string said = only_error(power);
    CHECK(contains(said, "E0607 the codes of `p` end before its range"));
    CHECK(contains(said, "`power(8, 128/255)` reaches 248.1085 of 256"));
    CHECK(contains(said, "`power(8, 127/255)` reaches the end"));
    CHECK(contains(said, "in [0, 248]"));
    CHECK(
        check_gain("[0, 256]", "1", "unorm 8 in [0, 248] code power(8, 128/255)").errors().empty());
    CHECK(check_gain("[0, 8]", "1", "unorm 8 code log2(85/255)").errors() == "E0607");
    CHECK(check_gain("[0, 7]", "1", "unorm 8 code log2(85/255)").errors().empty());
}

TEST_CASE("a halving keeps its default, and what else lies on a code")
{
    const auto check = [](const std::string& pivot, const std::string& more = "") {
        return check_gain("[0, 1]", "0.75",
                          "unorm 8 in [0, 0.9375] code halving(" + pivot + "/255)", more);
    };
    // Four halvings to the end, two to the default.
    CHECK(check("127").errors().empty());
    CHECK(check("126", "require exact p == 0, p == 0.5, p == 0.875, p == 0.9375").errors().empty());
    const Checked beside = check("127", "require exact p == 0.5");
    CHECK(contains(only_error(beside), "E0606 `p == 0.5` is required to be exact"));
    CHECK(proposed(beside) == "halving(126/255)");
    // The end of the parameter is for other codes.
    CHECK(contains(only_error(check("127", "require exact p == 1")),
                   "let the field carry it, with a code that reaches it: `in [0, 1]`"));

    const Checked early = check("200");
    const std::string said = only_error(early);
    CHECK(contains(said, "E0607 the codes of `p` end before its range"));
    CHECK(contains(said, "`halving(200/255)` reaches 0.829"));
    CHECK(contains(said, "`halving(127/255)` reaches the end"));
    CHECK(contains(said, "in [0, 0.829]"));
    CHECK(check_gain("[0, 1]", "0.75", "unorm 8 in [0, 0.829] code halving(200/255)")
              .errors()
              .empty());
    // No less than the default.
    CHECK(contains(
        only_error(check_gain("[0, 1]", "0.7512", "unorm 8 in [0, 0.9375] code halving(255/255)")),
        "in [0, 0.7512]"));
}

TEST_CASE("roots come back wherever the default is, unless the low end is too far up")
{
    for (const char* value : {"0", "1"}) {
        const auto check = [&](const std::string& field) {
            return check_packed(std::string{"/// p\nparam p : unit = "} + value + "\n", "p", field)
                .errors();
        };
        CHECK(check("  d.r, d.g[0..3] = p : unorm 12 code sqrt").empty());
        CHECK(check("  d.r, d.g = p : unorm 16 code sqrt").empty());
    }
    const auto far = [](const std::string& field) {
        return check_packed("/// p\nparam p : float in [100, 101] = 101\n", "p", field);
    };
    CHECK(far("  d.r = p : unorm 8 code sqrt").errors().empty());
    // (1/1023)^2 is less than a float's step next to 100.
    CHECK(contains(only_error(far("  d.r, d.g[0..1] = p : unorm 10 code sqrt")),
                   "E0609 the values of the codes of `p` do not rise\ncodes 0 and 1 are both 100"));
    CHECK(contains(only_error(far("  d.r, d.g[0] = p : unorm 9 code sqrt")), "E0608 code "));
}

TEST_CASE("codes that float cannot tell apart are refused")
{
    // Next to 1000 a float has steps of 6e-5.
    const std::string far = "/// p\nparam p : float in [1000, 1001] = 1000\n";
    const std::string sixteen = "  d.r, d.g = p : unorm 16";
    CHECK(check_packed(far, "p", sixteen).errors() == "E0609");
    CHECK(check_packed(far, "p", "  d.r = p : unorm 8").errors().empty());
    // Next to 100 it has fewer than three to a code.
    const Checked near = check_packed("/// p\nparam p : float in [100, 101] = 100\n", "p", sixteen);
    CHECK(contains(only_error(near), "E0608 code "));
    // (1/127)^8 is nothing beside 1.
    CHECK(check_gain("[1, 257]", "1", "unorm 8 code power(8, 127/255)").errors() == "E0609");
}

TEST_CASE("codes that no value is stored as are refused")
{
    const Checked upper = check_packed(
        "code upper(x: float in [0, 256]) {\n  encode = 0.5 * (x / 256) + 0.5\n"
        "  decode(u) = 256 * max(2 * u - 1, 0)\n}\n/// p\nparam p : float in [0, 256] = 256\n",
        "p", "  d.r = p : unorm 8 code upper");
    CHECK(contains(only_error(upper), "the codes below are never written"));
}

TEST_CASE("a declared code keeps what lies on its codes")
{
    const auto check = [](const std::string& default_value, const std::string& more) {
        return check_packed("code eighth(x: float in [0, 256]) {\n  encode = (x / 256)^(1 / 8)\n"
                            "  decode(u) = 256 * u^8\n}\n/// p\nparam p : float in [0, 256] = " +
                                default_value + "\n",
                            "p", "  d.r = p : unorm 8 code eighth\n  " + more);
    };
    CHECK(check("0", "").errors().empty());
    CHECK(check("256", "").errors().empty());
    // 127.5 codes.
    CHECK(check("1", "").errors() == "E0606");
    // 51 codes: (1/5)^8 of 256.
    CHECK(check("0.001", "").errors() == "E0606");
    CHECK(check("0.00065536", "require exact p == 0, p == 256").errors().empty());
}

TEST_CASE("the three components of a color have one finding")
{
    const std::string tint = "/// p\nparam p : color = (0.75, 0.75, 0.75)\n";
    CHECK(check_packed(tint, "p", "  d.rgb = p : unorm 8").errors() == "E0606");
    CHECK(check_packed("/// p\nparam p : color = (0.75, 1, 0.25)\n", "p", "  d.rgb = p : unorm 8")
              .errors() == "E0606 E0606");
    CHECK(check_packed(tint, "p", "  d.rgb = p : unorm 8 code linear(252/255)").errors().empty());
}

TEST_CASE("a term does not take the name of what a packing makes")
{
    const std::string term = "/// t\nterm unpack_p(x: unit) = x\n";
    CHECK(check_packed(term + "/// p\nparam p : unit = 1\n", "unpack_p(p)", "  d.r = p : unorm 8")
              .errors() == "E0302");
}
