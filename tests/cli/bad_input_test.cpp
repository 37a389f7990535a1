// Every kind of broken input gets one clear message, the right exit code, and leaves nothing.
#include "command.h"
#include "lobe/lobe.h"

#include <catch2/catch.hpp>

#include <algorithm>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;

namespace {

/// How many errors a rendering reports.
long errors(const std::string& text)
{
    long count = 0;
    for (std::size_t at = 0; (at = text.find("error", at)) != std::string::npos; ++at)
        if (at == 0 || text[at - 1] == '\n') ++count;
    return count;
}

const std::string term = "/// Twice x.\nterm twice(x: unit) -> float = 2 * x\n";

/// Builds one source and expects one error with this code, exit 1, and no output folder.
void refuses(const std::string& source, const std::string& code)
{
    const Scratch scratch;
    scratch.write("bad.lobe", source);
    const Outcome outcome = scratch.run("lobec build bad.lobe -o out");
    CAPTURE(source.substr(0, 200), outcome.err.substr(0, 2000));
    CHECK(outcome.status == 1);
    CHECK(errors(outcome.err) == 1);
    CHECK_THAT(outcome.err, Contains("error[" + code + "]"));
    CHECK(scratch.entries() == 1);
}

}  // namespace

TEST_CASE("a missing file")
{
    const Scratch scratch;
    const Outcome outcome = scratch.run("lobec build absent.lobe -o out");
    CHECK(outcome.status == 2);
    CHECK(errors(outcome.err) == 1);
    CHECK_THAT(outcome.err,
               Contains("E0001") && Contains("absent.lobe") && Contains("no such file"));
    CHECK(scratch.entries() == 0);
}

TEST_CASE("a file that is not UTF-8") { refuses("module bad\n// \xff\xfe\n" + term, "E0002"); }

TEST_CASE("an empty file") { refuses("", "E0004"); }

TEST_CASE("a cycle of imports")
{
    const Scratch scratch;
    scratch.write("a.lobe", "module a\nimport b { one }\n/// A.\nterm two(x: unit) -> float = x\n");
    scratch.write("b.lobe", "module b\nimport a { two }\n/// B.\nterm one(x: unit) -> float = x\n");
    const Outcome outcome = scratch.run("lobec build a.lobe -o out");
    CAPTURE(outcome.err);
    CHECK(outcome.status == 1);
    CHECK(errors(outcome.err) == 1);
    CHECK_THAT(outcome.err, Contains("error[E0305]"));
    CHECK(scratch.entries() == 2);
}

TEST_CASE("an import is looked for beside its importer, then where -I says")
{
    const Scratch scratch;
    const std::string user =
        "module a\nimport b { one }\n/// A.\nterm two(x: unit) -> float = one(x)\n";
    REQUIRE(scratch.run("mkdir mine shared").status == 0);
    scratch.write("mine/a.lobe", user);
    scratch.write("shared/b.lobe", "module b\n/// B.\nterm one(x: unit) -> float = x\n");
    CHECK(scratch.run("lobec check mine/a.lobe").status == 1);
    CHECK(scratch.run("lobec -I shared check mine/a.lobe").status == 0);
    CHECK(scratch.run("lobec check mine/a.lobe --imports mine -I shared").status == 0);

    // Its own folder comes first.
    scratch.write("mine/b.lobe", "module b\n/// B.\nterm other(x: unit) -> float = x\n");
    CHECK_THAT(scratch.run("lobec -I shared check mine/a.lobe").err, Contains("error[E0304]"));

    const Outcome outcome = scratch.run("lobec -I absent check mine/a.lobe");
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("absent"));
}

TEST_CASE("a name declared twice") { refuses("module bad\n" + term + term, "E0302"); }

TEST_CASE("a parameter's default outside its range")
{
    refuses("module bad\nparam gain : float in [0, 1] = 2\n/// G.\nterm g(x: unit) -> float = gain "
            "* x\n",
            "E0504");
}

TEST_CASE("a form with another signature")
{
    refuses("module bad\n/// F.\nterm f(x: unit) -> float = x\n  form other = float3(x, x, x)\n",
            "E0404");
}

TEST_CASE("a division by a range with 0")
{
    refuses("module bad\n/// I.\nterm inverse(x: unit) -> float = 1 / x\n", "E0501");
}

TEST_CASE("a term that calls itself")
{
    refuses("module bad\n/// R.\nterm again(x: unit) -> float = again(x)\n", "E0306");
}

TEST_CASE("ten thousand nested parentheses")
{
    refuses("module bad\n/// D.\nterm deep(x: unit) -> float = " + std::string(10000, '(') + "x" +
                std::string(10000, ')') + "\n",
            "E0203");
}

TEST_CASE("a file of 50 MB")
{
    std::string source = "module bad\n";
    while (source.size() < 50'000'000)
        source += "// a line that says nothing at all, many times over\n";
    refuses(source + term, "E0003");
}

TEST_CASE("no Vulkan device")
{
    const Scratch scratch;
    scratch.write("good.lobe", "module good\n" + term);
    const Outcome outcome =
        scratch.run("VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent lobec verify "
                    "good.lobe --json out.json");
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(errors(outcome.err) == 1);
    CHECK_THAT(outcome.err, Contains("Vulkan"));
    CHECK(scratch.entries() == 1);
}

TEST_CASE("an output folder that cannot be written")
{
    const Scratch scratch;
    scratch.write("good.lobe", "module good\n" + term);
    scratch.write("out", "a file");
    const Outcome outcome = scratch.run("lobec build good.lobe -o out");
    CAPTURE(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(errors(outcome.err) == 1);
    CHECK_THAT(outcome.err, Contains("nothing was written"));
    CHECK(scratch.entries() == 2);
}

TEST_CASE("a disk that fills up")
{
    const Scratch scratch;
    // A limit of 1 KiB per file at most, and a comment that makes every generated file longer.
    std::string source = "// A long story.\n";
    while (source.size() < 4096) source += "// It goes on, and every generated file repeats it.\n";
    scratch.write("good.lobe", source + "module good\n" + term);
    const Outcome outcome = scratch.run("ulimit -f 1; lobec build good.lobe -o out");
    CAPTURE(outcome.err);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("nothing was written"));
    CHECK(scratch.entries() == 1);

    const Outcome full = scratch.run("lobec explain > /dev/full");
    CHECK(full.status == 2);
}

TEST_CASE("usage errors exit with 2 and name what was wrong")
{
    const Scratch scratch;
    for (const char* command :
         {"lobec", "lobec frobnicate", "lobec build", "lobec build x --target nope",
          "lobec explain E9999", "lobec evaluate x.lobe"}) {
        const Outcome outcome = scratch.run(command);
        CAPTURE(command, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_FALSE(outcome.err.empty());
    }
}

TEST_CASE("a target that is not known")
{
    const lobe::Result result =
        lobe::compile({"good.lobe", "module good\n" + term}, {}, {.targets = {"ue5"}});
    REQUIRE(result.messages.size() == 1);
    CHECK(result.messages[0].code == "E0702");
    CHECK_THAT(result.messages[0].text, Contains("ue5"));
    CHECK_FALSE(result.ok());
    CHECK(result.files.empty());
}
