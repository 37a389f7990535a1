// Every witness at once: text, judges, device and evaluator on functions built by hand.
#include "analyze/agreement/kill.h"
#include "analyze/models.h"
#include "analyze/verify.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace lobe;
using analyze::Fate;
using analyze::Mutation;

namespace {

Sources sources()
{
    Sources all;
    all.add("sample.lobe", "module sample\n");
    return all;
}

}  // namespace

TEST_CASE("functions agree on every target, before and after the optimizer", "[verify][device]")
{
    const ir::Module module = tests::sample_module();
    analyze::VerifyOptions options;
    options.points = 8192;
    options.jobs = 2;
    const Sources texts = sources();
    const analyze::Verification result = analyze::verify(module, texts, options);
    REQUIRE(result.no_device == "");
    for (const analyze::Judgement& judgement : result.judgements) {
        CAPTURE(judgement.artifact, judgement.judge);
        for (const analyze::Remark& remark : judgement.remarks) UNSCOPED_INFO(remark.text);
        CHECK(judgement.accepted);
    }
    std::set<std::pair<std::string, std::string>> seen;
    for (const analyze::Row& row : result.rows) {
        CAPTURE(row.term, row.target, row.failure);
        for (const analyze::Judgement& judgement : row.judgements) {
            CAPTURE(judgement.judge);
            for (const analyze::Remark& remark : judgement.remarks) UNSCOPED_INFO(remark.text);
            CHECK(judgement.accepted);
        }
        INFO((row.direct.example ? row.direct.example->inputs : ""));
        CHECK(row.executed);
        CHECK(row.direct.outside == 0);
        CHECK(row.optimized.outside == 0);
        CHECK(row.direct.points == options.points);
        seen.emplace(row.term, row.target);
    }
    CHECK(seen.size() == module.functions.size() * emit::targets().size());
}

TEST_CASE("the number of threads changes nothing but the times", "[verify][device]")
{
    const ir::Module module = tests::sample_module();
    const Sources texts = sources();
    analyze::VerifyOptions options;
    options.points = 1024;
    options.targets = {emit::find_target("glsl450"), emit::find_target("hlsl")};
    options.jobs = 1;
    const auto one = analyze::verify(module, texts, options);
    options.jobs = 3;
    const auto three = analyze::verify(module, texts, options);
    REQUIRE(one.rows.size() == three.rows.size());
    for (std::size_t i = 0; i < one.rows.size(); ++i) {
        CHECK(one.rows[i].term == three.rows[i].term);
        CHECK(one.rows[i].target == three.rows[i].target);
        CHECK(one.rows[i].direct.ulp.size == three.rows[i].direct.ulp.size);
        CHECK(one.rows[i].direct.undefined == three.rows[i].direct.undefined);
    }
}

TEST_CASE("without a device the judges still judge, and the reason is said", "[verify]")
{
    const ir::Module module = tests::sample_module();
    const Sources texts = sources();
    analyze::VerifyOptions options;
    options.points = 256;
    options.device = "no device has this name";
    options.targets = {emit::find_target("glsl450")};
    const auto result = analyze::verify(module, texts, options);
    CHECK(result.no_device.find("no device has this name") != std::string::npos);
    REQUIRE_FALSE(result.rows.empty());
    for (const analyze::Row& row : result.rows) {
        CHECK_FALSE(row.executed);
        CHECK_FALSE(row.judgements.empty());
    }
}

TEST_CASE("a judge's refusal is quoted and points at the place in the model", "[verify]")
{
    emit::Artifact artifact;
    artifact.path = "sample/glsl450/sample.glsl";
    artifact.text = "float f(float x)\n{\n    return y;\n}\n";
    const Span place{0, 3, 9};
    artifact.origins = {{1, 2, Span{0, 0, 1}}, {3, 3, place}};
    const auto judgements = analyze::judge_file(artifact, *emit::find_target("glsl450"));
    REQUIRE(judgements.size() == 1);  // nobody is asked about what the front end refused
    CHECK_FALSE(judgements[0].accepted);
    REQUIRE_FALSE(judgements[0].remarks.empty());
    CHECK(judgements[0].remarks[0].line == 3);
    CHECK(judgements[0].remarks[0].place == place);

    analyze::Verification verification;
    verification.judgements = judgements;
    const Diagnostics said = analyze::complaints(verification, tests::sample_module());
    REQUIRE(said.all().size() == 1);
    const Diagnostic& diagnostic = said.all().front();
    CHECK(id(diagnostic.code) == "E0701");
    CHECK(diagnostic.message == "glslang rejects `sample/glsl450/sample.glsl`");
    CHECK(diagnostic.primary.span == place);
    REQUIRE_FALSE(diagnostic.notes.empty());
    CHECK(diagnostic.notes.front().find(judgements[0].remarks[0].text) != std::string::npos);
}

TEST_CASE("verify catches every class of mistake", "[kill][device]")
{
    const ir::Module module = tests::sample_module();
    const Sources texts = sources();
    analyze::KillOptions options;
    options.mutants = 0;
    options.points = 8192;
    options.jobs = 2;
    for (const char* target : {"glsl450", "hlsl"}) {
        CAPTURE(target);
        options.targets = {emit::find_target(target)};
        const analyze::KillSubject subject{&module, &texts};
        const analyze::KillReport report = analyze::kill({&subject, 1}, options);
        REQUIRE(report.no_device == "");
        CHECK(report.unusable.empty());
        std::set<Mutation> made, killed;
        for (const analyze::MutantFate& mutant : report.mutants) {
            made.insert(mutant.mutant.mutation);
            if (mutant.fate == Fate::killed) killed.insert(mutant.mutant.mutation);
        }
        for (const Mutation mutation : analyze::all_mutations()) {
            CAPTURE(analyze::name(mutation));
            CHECK(made.count(mutation) == 1);
            CHECK(killed.count(mutation) == 1);
        }
    }
}

TEST_CASE("a swap of inputs in which a function is symmetric is no missed kill", "[kill][device]")
{
    ir::Module module = tests::sample_module();
    module.functions = {tests::smith()};
    const Sources texts = sources();
    analyze::KillOptions options;
    options.mutants = 0;
    options.points = 4096;
    options.targets = {emit::find_target("glsl450")};
    const analyze::KillSubject subject{&module, &texts};
    const analyze::KillReport report = analyze::kill({&subject, 1}, options);
    const auto found = std::ranges::find_if(report.mutants, [](const analyze::MutantFate& fate) {
        return fate.mutant.swapped == std::pair{1, 2};
    });
    REQUIRE(found != report.mutants.end());
    CHECK(found->fate == Fate::equivalent);
    CHECK(found->reason == "symmetric in cos_i and cos_o");
}
