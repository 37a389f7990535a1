// What each command does when all is well, and that it does it the same way every time.
#include "command.h"
#include "lobe/lobe.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;

namespace {

const std::string model = "module small\n\n/// Twice x.\nterm twice(x: unit) -> float = 2 * x\n";

}  // namespace

TEST_CASE("every command has help with an example")
{
    const Scratch scratch;
    for (const char* command : {"build", "check", "format", "evaluate", "pack", "cost", "pareto",
                                "verify", "explain", "devices"}) {
        const Outcome outcome = scratch.run(fmt::format("lobec {} --help", command));
        CAPTURE(command);
        CHECK(outcome.status == 0);
        CHECK_THAT(outcome.out, Contains(fmt::format("Example: lobec {}", command)));
    }
}

TEST_CASE("build writes every target, the same bytes each time, and touches nothing twice")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    const Outcome first = scratch.run("lobec build small.lobe -o out");
    CAPTURE(first.err);
    REQUIRE(first.status == 0);
    CHECK_THAT(first.out, Contains("0 unchanged"));
    const Outcome again = scratch.run("lobec build small.lobe -o out");
    CHECK_THAT(again.out, Contains("0 written"));
    CHECK(scratch.run("lobec build small.lobe -o other && diff -r out other").status == 0);
}

TEST_CASE("build --explain says what was done where, why, and what it gained")
{
    const Scratch scratch;
    scratch.write("small.lobe", "module small\n\n/// GGX.\n"
                                "term d(alpha: float in [1/4096, 1], g: geometry) -> float =\n"
                                "  alpha^2 / (pi * (g.cos_h^2 * (alpha^2 - 1) + 1)^2)\n\n"
                                "/// A power.\nterm p(x: unit, y: unit) -> float = x^y\n\n"
                                "/// Another.\nterm q(x: unit, y: unit) -> float = (1 + x)^y\n");
    const Outcome told = scratch.run("lobec --quiet build small.lobe -o out --explain");
    CAPTURE(told.out, told.err);
    REQUIRE(told.status == 0);
    for (const char* line :
         {"small.lobe\n  d: float error ",
          "    small.lobe:5: `g.cos_h^2 * (alpha^2 - 1) + 1`\n"
          "      rewrite blend_h: cos_h^2 (a - 1) + 1 -> ",
          "    small.lobe:8: `x^y`\n      guard guarded_power: x^y -> max(x, 2^-126)^y; ",
          "    small.lobe:11: `(1 + x)^y`\n      needless guard power_without_guard: "})
        CHECK_THAT(told.out, Contains(line));
    CHECK_THAT(told.out, !Contains("unchanged"));
    CHECK_THAT(scratch.run("lobec build small.lobe -o out --explain").out, Contains("unchanged"));
    CHECK_THAT(scratch.run("lobec build small.lobe -o out").out, !Contains("rewrite"));
}

TEST_CASE("build --check finds stale, missing and orphaned files")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    REQUIRE(scratch.run("lobec build small.lobe -o out").status == 0);
    CHECK(scratch.run("lobec build small.lobe -o out --check").status == 0);

    const Outcome orphan =
        scratch.run("touch out/old.ush && lobec build small.lobe -o out --check");
    CHECK(orphan.status == 1);
    CHECK_THAT(orphan.out, Contains("out/old.ush is an orphan"));

    const Outcome stale =
        scratch.run("rm out/old.ush; for f in $(find out -type f); do echo >> $f; done; "
                    "lobec build small.lobe -o out --check");
    CHECK(stale.status == 1);
    CHECK_THAT(stale.out, Contains("is stale"));

    const Outcome missing = scratch.run("rm -r out; lobec build small.lobe -o out --check");
    CHECK(missing.status == 1);
    CHECK_THAT(missing.out, Contains("is missing"));
}

TEST_CASE("check prints machine-readable findings on request")
{
    const Scratch scratch;
    scratch.write("bad.lobe", "module bad\n/// I.\nterm inverse(x: unit) -> float = 1 / x\n");
    CHECK_THAT(scratch.run("lobec check bad.lobe --format short").err,
               Contains("bad.lobe:3:") && Contains("error[E0501]"));
    CHECK_THAT(scratch.run("lobec check bad.lobe --format json").out, Contains("\"E0501\""));
    CHECK_THAT(scratch.run("lobec check bad.lobe --format sarif").out,
               Contains("\"2.1.0\"") && Contains("E0501"));
    CHECK(scratch.run("lobec check bad.lobe --format sarif").status == 1);
}

TEST_CASE("format rewrites, checks and prints")
{
    const Scratch scratch;
    scratch.write("loose.lobe", "module   loose\n/// Twice x.\nterm twice( x:unit )->float=2*x\n");
    CHECK(scratch.run("lobec format loose.lobe --check").status == 1);
    const Outcome printed = scratch.run("lobec format loose.lobe --stdout");
    CHECK(printed.status == 0);
    CHECK(scratch.run("lobec format loose.lobe").status == 0);
    CHECK(scratch.read("loose.lobe") == printed.out);
    CHECK(scratch.run("lobec format loose.lobe --check").status == 0);
}

TEST_CASE("evaluate appends results that read back exactly")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    scratch.write("in.csv", "note,x\na,0.1\nb,0.25\n");
    const Outcome outcome = scratch.run("lobec evaluate small.lobe --term twice --csv in.csv");
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.out == "note,x,twice\na,0.1,0.2\nb,0.25,0.5\n");

    const Outcome unknown = scratch.run("lobec evaluate small.lobe --term twic --csv in.csv");
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Contains("did you mean `twice`"));

    scratch.write("in.csv", "x\nhello\n");
    const Outcome bad =
        scratch.run("lobec evaluate small.lobe --term twice --csv in.csv -o out.csv");
    CHECK(bad.status == 2);
    CHECK_THAT(bad.err, Contains("in.csv:2") && Contains("hello"));
    CHECK(scratch.entries() == 2);
}

TEST_CASE("verify judges, executes and reports in every form")
{
    const Scratch scratch;
    scratch.write("small.lobe", model);
    const Outcome outcome = scratch.run(
        "lobec verify small.lobe --points 4096 --json out.json --junit out.xml --html out.html");
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("twice"));
    CHECK_THAT(scratch.read("out.json"), Contains("\"twice\""));
    CHECK_THAT(scratch.read("out.xml"), Contains("<testsuite"));
    CHECK_THAT(scratch.read("out.html"), Contains("<html") && Contains("twice"));
}

TEST_CASE("explain prints the page of a code, and all codes")
{
    const Scratch scratch;
    const Outcome page = scratch.run("lobec explain e0501");
    CHECK(page.status == 0);
    CHECK_THAT(page.out, Contains("E0501"));
    const Outcome all = scratch.run("lobec explain");
    CHECK_THAT(all.out, Contains("E0101") && Contains("E0501"));
}

TEST_CASE("the library compiles text to files without touching the disk")
{
    const lobe::Result result = lobe::compile({"small.lobe", model}, {}, {.targets = {"glsl450"}});
    REQUIRE(result.ok());
    REQUIRE(result.files.size() == 1);
    CHECK_THAT(result.files[0].text, Contains("twice"));

    const lobe::Result broken = lobe::compile({"bad.lobe", "module bad\nterm\n"}, {});
    CHECK_FALSE(broken.ok());
    CHECK(broken.files.empty());
    CHECK(broken.messages[0].path == "bad.lobe");
}
