// Mistakes in blocks of lines: one message each, and the lines around them are read all the same.
#include "syntax/meaning.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::meaning;
using lobe::tests::parsed;

namespace {

/// The only message about some items, with the text that it points at and the edit that it offers.
std::string only(std::string_view items)
{
    const auto result = parsed(fmt::format("module m\n{}\n", items));
    if (result.diagnostics.all().size() != 1) return codes(result.diagnostics);
    const Diagnostic& diagnostic = result.diagnostics.all().front();
    return fmt::format("{} {} [{}]{}", id(diagnostic.code), diagnostic.message,
                       result.sources.text(diagnostic.primary.span),
                       diagnostic.fix ? " -> " + diagnostic.fix->replacement : "");
}

std::string in_packing(std::string_view line)
{
    return only(fmt::format("packing m on g {{\n  {}\n  without a\n}}", line));
}
std::string in_engine(std::string_view line)
{
    return only(fmt::format("engine g for m {{\n  {}\n  pin a = b\n}}", line));
}
std::string in_gbuffer(std::string_view line)
{
    return only(fmt::format("gbuffer g {{\n  {}\n}}", line));
}
std::string in_target(std::string_view line)
{
    return in_gbuffer(fmt::format("target t \"T\" {{\n  {}\n  channel x \"X\"\n  }}", line));
}
std::string in_code(std::string_view lines)
{
    return only(fmt::format("code c(x: unit) {}", lines));
}

std::string help(std::string_view items)
{
    const auto result = parsed(fmt::format("module m\n{}\n", items));
    REQUIRE(result.diagnostics.all().size() == 1);
    REQUIRE(result.diagnostics.all()[0].helps.size() == 1);
    return result.diagnostics.all()[0].helps[0];
}

/// What was wrong, and what was understood.
std::string mended(std::string_view items)
{
    const auto result = parsed(fmt::format("module m\n{}\n", items));
    return codes(result.diagnostics) + " " + meaning(result.tree).substr(9);
}

}  // namespace

TEST_CASE("fields and clauses say what they are made of")
{
    CHECK(in_packing("d = a : unorm 8") == "E0201 expected `.` and a channel, found `=` [=]");
    CHECK(in_packing("d[3] = a : unorm 8") == "E0201 expected `.` and a channel, found `[` [[]");
    CHECK(in_packing("d.r = a unorm 8") ==
          "E0201 expected `:` and a storage such as `unorm 8`, found `unorm` [unorm]");
    CHECK(in_packing("d.r = a : unorm") == "E0201 expected the number of bits after `unorm` []");
    CHECK(in_packing("d.r = a : 8") == "E0201 expected a storage such as `unorm 8`, found `8` [8]");
    CHECK(in_packing("d.r = : unorm 8") == "E0201 expected the name of a parameter, found `:` [:]");
    CHECK(in_packing("d.r : unorm 8") ==
          "E0201 expected `=` and the name of a parameter, found `:` [:]");
    CHECK(in_packing("d.r, = a : unorm 8") == "E0201 expected the name of a target, found `=` [=]");
    CHECK(in_packing("d.r = a : unorm 8 foo") ==
          "E0201 expected the end of the line, found `foo` [foo]");
    CHECK(in_packing("d.r = a : unorm 8 code (1)") ==
          "E0201 expected the name of a code, found `(` [(]");
    CHECK(in_packing("d.r = a : unorm 8 in (0, 1)") == "E0201 expected `[`, found `(` [(]");
    CHECK(in_packing("d.r = a : unorm 8 code power(8 1)") ==
          "E0201 expected `,` or `)`, found `1` [1]");
    CHECK(in_packing("{ }") ==
          "E0201 expected a field `target.channel = parameter : unorm 8`, a clause or `}`, "
          "found `{` [{]");
    CHECK(in_packing("pin a = b") ==
          "E0201 expected a field `target.channel = parameter : unorm 8`, a clause or `}`, "
          "found `pin` [pin]");
    CHECK(in_packing("require a == 1") ==
          "E0201 expected `exact` or `radiance error`, found `a` [a]");
    CHECK(in_packing("require exact a = 1") ==
          "E0201 `=` gives a name a value; it does not compare [=] -> ==");
    CHECK(in_packing("require exact a >= 1") == "E0201 expected `==` and a value, found `>=` [>=]");
    CHECK(in_packing("require exact a == 1 == b") ==
          "E0201 expected the end of the line, found `==` [==]");
    CHECK(in_packing("require radiance < 2%") ==
          "E0201 expected `error <` and a number in percent, found `<` [<]");
    CHECK(in_packing("require radiance error <= 2%") ==
          "E0201 expected `<` and a number in percent, found `<=` [<=]");
    CHECK(in_packing("require radiance error < 2") == "E0201 expected `%` after `2` []");
    CHECK(in_packing("require radiance error < two%") ==
          "E0201 expected a number in percent, found `two` [two]");
    CHECK(in_packing("require radiance error < .5%") == "E0103 `.5` is not a number [.5] -> 0.5");
    CHECK(in_packing("supports a = b") ==
          "E0201 `=` gives a name a value; it does not compare [=] -> ==");
    CHECK(in_packing("supports a != b") ==
          "E0201 expected `==` and the values that have to work, found `!=` [!=]");
    CHECK(in_packing("over f0 [0, 1]") == "E0201 expected `in` and a range, found `[` [[]");
    CHECK(in_packing("over f0 in [0..1]") ==
          "E0201 expected `,` and the upper end of the range, found `..` [..]");
    CHECK(in_packing("without") ==
          "E0201 expected what a channel of the gbuffer holds after `without` []");
    CHECK(in_packing("over a in [0,") == "E0201 expected an expression after `,` []");
}

TEST_CASE("bits are whole numbers below 64, written low..high")
{
    CHECK(in_packing("d.r[64] = a : unorm 8") ==
          "E0201 expected the number of a bit, found `64` [64]");
    CHECK(in_packing("d.r[1.5] = a : unorm 8") ==
          "E0201 expected the number of a bit, found `1.5` [1.5]");
    CHECK(in_packing("d.r[-1] = a : unorm 8") ==
          "E0201 expected the number of a bit, found `-` [-]");
    CHECK(in_packing("d.r[0..64] = a : unorm 8") ==
          "E0201 expected the number of the last bit, found `64` [64]");
    CHECK(in_packing("d.r[99999999999999999999] = a : unorm 8") ==
          "E0201 expected the number of a bit, found `99999999999999999999` "
          "[99999999999999999999]");
    CHECK(in_packing("d.r[1e1] = a : unorm 8") ==
          "E0201 expected the number of a bit, found `1e1` [1e1]");
    CHECK(in_packing("d.r = a : unorm 64") == "E0201 expected the number of bits, found `64` [64]");
    CHECK(in_packing("d.r[0..3 = a : unorm 4") == "E0201 expected `..` or `]`, found `=` [=]");
    CHECK(in_packing("d.r[0...3] = a : unorm 4") == "E0103 `.3` is not a number [.3] -> 0.3");
    CHECK(help("packing m on g {\n d.r[64] = a : unorm 8\n}") == "bits are whole numbers below 64");
    const auto slot = [](std::string_view bits) {
        return mended(fmt::format("packing m on g {{\n  d.r{} = a : unorm 4\n}}", bits));
    };
    CHECK(slot("[4:7]") == "E0201 packing m on g d.r[4 7], = a unorm:4; \n");
    CHECK(slot("[4-7]") == "E0201 packing m on g d.r[4 7], = a unorm:4; \n");
    CHECK(slot("[4,7]") == "E0201 packing m on g d.r[4 7], = a unorm:4; \n");
    CHECK(slot("[7..4]") == "E0201 packing m on g d.r[4 7], = a unorm:4; \n");
    CHECK(in_packing("d.r[7..4] = a : unorm 4") ==
          "E0201 bits are written from the least to the most significant [[7..4]] -> [4..7]");
    CHECK(in_packing("d.r[4:7] = a : unorm 4") ==
          "E0201 the bits of a channel are written `[low..high]` [:] -> ..");
}

TEST_CASE("dots and percents stand in their places only")
{
    CHECK(only("term t() = a % b") == "E0201 `%` is not an operator [%]");
    CHECK(only("term t() = %") == "E0201 expected an expression, found `%` [%]");
    CHECK(only("term t() = 0..1") == "E0201 expected the end of the declaration, found `..` [..]");
    CHECK(help("term t() -> float in [0..1] = 1") ==
          "a range is written `[low, high]`; `..` stands between the bits of a channel and "
          "the ends of a sum");
}

TEST_CASE("what a gbuffer is made of")
{
    CHECK(in_gbuffer("setting : a = a") == "E0201 expected the name of the setting, found `:` [:]");
    CHECK(in_gbuffer("setting s : a = a") ==
          "E0201 expected what the engine calls it, in double quotes, found `:` [:]");
    CHECK(in_gbuffer("setting s \"S\" : a, b") ==
          "E0201 expected `,` or `=` and the default value after `b` []");
    CHECK(in_gbuffer("target t { }") ==
          "E0201 expected what the engine calls it, in double quotes, found `{` [{]");
    CHECK(in_gbuffer("target t \"T\"\n") ==
          "E0201 expected `{` and the channels of the target after a text []");
    CHECK(in_gbuffer("channel x \"X\" { field \"f\" }") ==
          "E0201 expected `setting`, `target`, `pin` or `}`, found `channel` [channel]");
    CHECK(in_gbuffer("pin p \"P\"") ==
          "E0201 expected `in` and a range, or `=` and a number after a text []");
    CHECK(in_gbuffer("pin p \"P\" in [0, 1]") ==
          "E0201 expected `=` and what it is when nothing is connected after `]` []");
    CHECK(in_target("exists a == b") == "E0201 expected `when` and a condition, found `a` [a]");
    CHECK(in_target("exists when a = b") ==
          "E0201 `=` gives a name a value; it does not compare [=] -> ==");
    CHECK(in_target("format unorm 8 when a = b") ==
          "E0201 `=` gives a name a value; it does not compare [=] -> ==");
    CHECK(in_target("format unorm 8 when a else b") ==
          "E0208 `else` names the limit of a division, and this is none [else]");
    CHECK(in_target("format unorm when a") ==
          "E0201 expected the number of bits, found `when` [when]");
    CHECK(in_target("holds \"t\"") ==
          "E0201 expected a name for the content, found a text [\"t\"]");
    CHECK(in_target("also who") ==
          "E0201 expected who else reads it, in double quotes, found `who` [who]");
    CHECK(in_target("field a.b") ==
          "E0201 expected what shaders call it, in double quotes, found `a` [a]");
    CHECK(in_target("channel { field \"f\" }") ==
          "E0201 expected the name of the channel, found `{` [{]");
    CHECK(in_target("channel y \"Y\" { channel z \"Z\" }") ==
          "E0201 expected a fact about the channel, or `}`, found `channel` [channel]");
    CHECK(only("gbuffer g\nterm t() = 1") ==
          "E0201 expected `{` and what the gbuffer has after `g` []");
    CHECK(only("gbuffer { }") == "E0201 expected the name of the gbuffer, found `{` [{]");
}

TEST_CASE("what a code is made of")
{
    CHECK(only("code c(x unit) { encode = x decode(u) = u }") ==
          "E0201 expected `:` and a type, found `unit` [unit]");
    CHECK(only("code c(x: unit, y: unit) { encode = x decode(u) = u }") ==
          "E0201 expected `)`, found `,` [,]");
    CHECK(only("code c { }") == "E0201 expected `(` and what the code stores, found `{` [{]");
    CHECK(in_code("= x") == "E0201 expected `{`, `encode` and `decode`, found `=` [=]");
    CHECK(in_code("{\n encode = x\n}") == "E0201 this code has no `decode` [}]");
    CHECK(in_code("{\n decode(u) = u\n}") == "E0201 this code has no `encode` [}]");
    CHECK(in_code("{ }") == "E0201 this code has no `encode` [}]");
    CHECK(in_code("{\n encode x\n decode(u) = u\n}") ==
          "E0201 expected `=` and what is stored, found `x` [x]");
    CHECK(in_code("{\n encode = x\n decode = u\n}") ==
          "E0201 expected `(` and a name for what was stored, found `=` [=]");
    CHECK(in_code("{\n encode = *\n}") == "E0201 expected an expression, found `*` [*]");
    CHECK(in_code("{\n encode = x\n let a = 1\n decode(u) = u\n}") ==
          "E0201 expected `encode`, `decode` or `}`, found `let` [let]");
    CHECK(in_code("{\n decode(u) = u\n encode = x\n}") ==
          "E0204 `encode` stands before `decode` [encode]");
    CHECK(in_code("{\n encode = x\n encode = x\n decode(u) = u\n}") ==
          "E0204 a code has one `encode` [encode]");
    CHECK(in_code("{\n encode = x\n decode(u) = u\n decode(u) = u\n}") ==
          "E0204 a code has one `decode` [decode]");
}

TEST_CASE("what an engine is made of")
{
    CHECK(in_engine("shading_model Callisto") ==
          "E0201 expected what the editor calls it, in double quotes, found `Callisto` [Callisto]");
    CHECK(in_engine("pin a b") ==
          "E0201 expected `=` and the parameter that it feeds, found `b` [b]");
    CHECK(in_engine("pin a = b c") == "E0201 expected the end of the line, found `c` [c]");
    CHECK(in_engine("node N { a }") ==
          "E0201 expected the name of the node in double quotes, found `N` [N]");
    CHECK(in_engine("node \"N\" { a b }") == "E0201 expected `,` or `}`, found `b` [b]");
    CHECK(in_engine("node \"N\" { }") == "E0201 expected the name of a parameter, found `}` [}]");
    CHECK(in_engine("node \"N\" { a, }") ==
          "E0201 expected the name of a parameter, found `}` [}]");
    CHECK(in_engine("node \"N\" a, b") ==
          "E0201 expected `{` and the parameters that it feeds, found `a` [a]");
    CHECK(in_engine("color 1, 2, 3") ==
          "E0201 expected `(` and red, green and blue, found `1` [1]");
    CHECK(in_engine("color (1, 2)") == "E0201 expected `,` and blue, found `)` [)]");
    CHECK(in_engine("color (1, 2, 3, 4)") == "E0201 expected `)`, found `,` [,]");
    CHECK(only("engine ue4 callisto { }") ==
          "E0201 expected `for` and the name of a model, found `callisto` [callisto]");
    CHECK(only("packing callisto of ue4 { }") ==
          "E0201 expected `on` and the name of a gbuffer, found `of` [of]");
    CHECK(only("packing callisto\nterm t() = 1") ==
          "E0201 expected `on` and the name of a gbuffer after `callisto` []");
}

TEST_CASE("misspelt words are taken for what was meant")
{
    CHECK(in_packing("reqire exact a == 1") ==
          "E0201 unknown word `reqire`; did you mean `require`? [reqire] -> require");
    CHECK(in_packing("require exakt a == 1") ==
          "E0201 unknown word `exakt`; did you mean `exact`? [exakt] -> exact");
    CHECK(in_packing("require radiance eror < 1%") ==
          "E0201 expected `error <` and a number in percent, found `eror` [eror] -> error");
    CHECK(in_packing("Supports a == b") ==
          "E0201 unknown word `Supports`; did you mean `supports`? [Supports] -> supports");
    CHECK(in_target("chanel y \"Y\" { feild \"f\" }") == "E0201 E0201");
    CHECK(in_target("holds y \"Y\" lant when a") ==
          "E0201 expected `lent` or `when`, found `lant` [lant] -> lent");
    CHECK(in_target("holds y \"Y\" wen a") ==
          "E0201 expected `when` and a condition, found `wen` [wen] -> when");
    CHECK(in_engine("colour (0, 0, 0)") ==
          "E0201 unknown word `colour`; did you mean `color`? [colour] -> color");
    CHECK(mended("gbufer g { tarjet t \"T\" { chanel r \"R\" { feild \"f\" } } }\n"
                 "packng m on g {\n  d.r = a : unorm 8\n  witout b\n}\n"
                 "engin g for m {\n  nod \"N\" { a }\n}\ncod c(x: unit) {\n  encod = x\n"
                 "  decod(u) = u\n}") ==
          "E0201 E0201 E0201 E0201 E0201 E0201 E0201 E0201 E0201 E0201 E0201 "
          "gbuffer g target t \"T\" {channel r \"R\" {field \"f\"; }}\n"
          "packing m on g d.r, = a unorm:8; without  b,; \nengine g for m node   \"N\"a,; \n"
          "code c x:unit encode x decode u u\n");
}

TEST_CASE("parts stand in their order")
{
    CHECK(in_gbuffer("target t \"T\" { }\n setting s \"S\" : a = a") ==
          "E0204 settings stand before the targets and pins [setting]");
    CHECK(in_gbuffer("pin p \"P\" = 1\n target t \"T\" { }") ==
          "E0204 targets stand before the pins [target]");
    CHECK(in_gbuffer("target t \"T\" {\n channel r \"R\"\n format unorm 8\n}") ==
          "E0204 what holds for a target stands before its channels [format]");
    CHECK(in_packing("d.r = a : unorm 8 code power(8) in [0, 1]") ==
          "E0204 the range stands before the code [in]");
    CHECK(
        mended("gbuffer g {\n pin p \"P\" = 1\n target t \"T\" { }\n setting s \"S\" : a = a\n}") ==
        "E0204 E0204 gbuffer g setting s \"S\" a,= a; target t \"T\" {}pin p \"P\" = 1; \n");
}

TEST_CASE("a mistake in a block costs its line only")
{
    CHECK(mended("packing m on g {\n  d.r = a unorm 8\n  d.g = b : unorm 8 code (\n"
                 "  d.b = c : unorm 8\n  require exact *\n  over f0 in [0, 1\n  without x\n"
                 "  d.a[ = d : unorm 1\n  supports v == w\n}\nterm t() = 1")
              .find("d.b, = c unorm:8; ") != std::string::npos);
    const std::string engine =
        mended("engine g for m {\n  pin = a\n  node \"N\" { a b }\n  node \"O\" { c, }\n"
               "  color (1, 2)\n  shading_model M\n  pin p = q\n}\nterm t() = 1");
    CHECK(engine.starts_with("E0201 E0201 E0201 E0201 E0201 engine g for m "));
    CHECK(engine.find("pin p q; ") != std::string::npos);
    CHECK(engine.find("term t") != std::string::npos);
    const std::string gbuffer = mended(
        "gbuffer g {\n  setting s : a = a\n  setting v \"V\" : x, y = x\n  target t {\n    format "
        "unorm 8\n    channel a \"A\"\n  }\n  target u \"U\" {\n    format unorm\n    exists when\n"
        "    channel b { field \"x\" }\n    channel c \"C\" {\n      holds \"x\"\n      also y\n"
        "      field \"f\"\n    }\n    channel d \"D\"\n  }\n  pin p = 1\n  pin q \"Q\" = 1\n}\n"
        "term t() = 1");
    CHECK(gbuffer.starts_with("E0201 E0201 E0201 E0201 E0201 E0201 E0201 E0201 gbuffer g "));
    CHECK(gbuffer.find("setting v \"V\" x,y,= x; ") != std::string::npos);
    CHECK(gbuffer.find("field \"f\"; }channel d \"D\" {}}") != std::string::npos);
    CHECK(gbuffer.find("pin q \"Q\" = 1; ") != std::string::npos);
    CHECK(gbuffer.find("term t") != std::string::npos);
}

TEST_CASE("a block that is not closed is one mistake")
{
    CHECK(only("packing m on g {\n  d.r = a : unorm 8\nterm t() = 1") ==
          "E0202 this `{` is not closed [{]");
    CHECK(only("engine g for m {\n  node \"N\" { a, b\n}") == "E0202 this `{` is not closed [{]");
    CHECK(only("engine g for m {\n  node \"N\" { a, b\n  color (0, 0, 0)\n}") ==
          "E0201 expected `,` or `}`, found `color` [color]");
    CHECK(only("code c(x: unit) {\n  encode = x\n  decode(u) = u\ncode d(x: unit) {\n  encode = x\n"
               "  decode(u) = u\n}") == "E0202 this `{` is not closed [{]");
    CHECK(only("gbuffer g {\n  target t \"T\" {\n    channel r \"R\"\n  pin p \"P\" = 1\n}") ==
          "E0202 this `{` is not closed [{]");
    CHECK(only("gbuffer g {\n  target t \"T\" {\n    channel r \"R\" {\n      field \"f\"\n"
               "    channel g \"G\" { field \"g\" }\n  }\n  pin p \"P\" = 1\n}\nterm t() = 1") ==
          "E0202 this `{` is not closed [{]");
    CHECK(only("packing m on g {\n  over f0 in [0, 1\n  without a\n}") ==
          "E0201 expected `]`, found `without` [without]");
}

TEST_CASE("doc comments in blocks document settings, targets, channels, pins and fields")
{
    CHECK(only("gbuffer g {\n /// a\n setting s \"S\" : a = a\n /// b\n target t \"T\" {\n"
               " /// c\n channel r \"R\"\n }\n /// d\n pin p \"P\" = 1\n}\n"
               "packing m on g {\n /// e\n d.r = a : unorm 8\n}") == "");
    for (const char* line : {"format unorm 8", "exists when a", "field \"f\"", "holds a \"b\"",
                             "also \"a\"", "changes \"a\""}) {
        CAPTURE(line);
        CHECK(in_target(fmt::format("/// doc\n{}", line)) ==
              "E0205 this doc comment documents nothing [/// doc]");
    }
    for (const char* line : {"require exact a == 1", "require radiance error < 1%",
                             "supports a == b", "over a in [0, 1]", "without a"}) {
        CAPTURE(line);
        CHECK(in_packing(fmt::format("/// doc\n{}", line)) ==
              "E0205 this doc comment documents nothing [/// doc]");
    }
    for (const char* line :
         {"pin a = b", "node \"N\" { a }", "color (0, 0, 0)", "shading_model \"M\""}) {
        CAPTURE(line);
        CHECK(in_engine(fmt::format("/// doc\n{}", line)) ==
              "E0205 this doc comment documents nothing [/// doc]");
    }
    CHECK(in_code("{\n /// doc\n encode = x\n decode(u) = u\n}") ==
          "E0205 this doc comment documents nothing [/// doc]");
    CHECK(in_code("{\n encode = x\n decode(u) = u\n /// doc\n}") ==
          "E0205 this doc comment documents nothing [/// doc]");
    CHECK(in_packing("d.r = a : unorm 8 /// doc") ==
          "E0205 this doc comment documents nothing [/// doc]");
    // What is skipped takes its comments along.
    CHECK(in_packing("d.r = a unorm /// inside\n 8 /// behind") ==
          "E0201 expected `:` and a storage such as `unorm 8`, found `unorm` [unorm]");
}
