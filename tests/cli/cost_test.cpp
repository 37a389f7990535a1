// `lobec cost` as a user runs it: tables, JSON, baselines, exit codes, and what it keeps.
#include "command.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using Catch::Contains;
using lobe::tests::Outcome;
using lobe::tests::Scratch;

namespace {

const std::string model = R"(module small
param gain : float in [0, 4] = 1  "Gain"

/// Schlick's weight.
term weight(cos_d: unit) -> unit = (1 - cos_d)^5

/// Scaled.
term scaled(cos_d: unit) -> float = gain * weight(cos_d)

/// A model.
model small(g: geometry, s: surface) { diffuse = s.f0 * scaled(g.cos_d) * g.cos_i }
)";

/// A folder with the model, and a cache of its own.
struct Place : Scratch {
    Place() { write("small.lobe", model); }

    Outcome cost(const std::string& options) const
    {
        return run("lobec cost small.lobe --cache cache " + options);
    }
    nlohmann::json json(const std::string& options) const
    {
        const Outcome outcome = cost(options + " --json -");
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        return nlohmann::json::parse(outcome.out);
    }
};

double issue(const nlohmann::json& report, const std::string& name, const char* family = "rdna2")
{
    for (const auto& row : report["rows"])
        if (row["name"] == name) return row["families"][family]["issue_cycles"];
    return -1;
}

}  // namespace

TEST_CASE("cost tells terms and models on every family, the same each time")
{
    const Place place;
    const Outcome first = place.cost("--json one.json");
    INFO(first.err);
    REQUIRE(first.status == 0);
    CHECK_THAT(first.out, Contains("term or model  gcn4  gcn5  rdna1  rdna2  rdna3  SPIR-V\n"));
    CHECK_THAT(first.out, Contains("model small"));
    CHECK_THAT(first.out, Contains("issue cycles of one evaluation more by radv"));
    const Outcome second = place.cost("-j 1 --json two.json");
    CHECK(second.out == first.out);
    CHECK(place.read("one.json") == place.read("two.json"));
    CHECK(place.run("lobec cost small.lobe --no-cache --json three.json").status == 0);
    CHECK(place.read("one.json") == place.read("three.json"));

    // Three products: who calls it knows 1 - cos_d, which needs no subtraction.
    CHECK(issue(nlohmann::json::parse(place.read("one.json")), "weight") == 3);
    CHECK(issue(nlohmann::json::parse(place.read("one.json")), "weight", "gcn5") == 12);
}

TEST_CASE("cost shows what one family is known for, and only what is asked")
{
    const Place place;
    const Outcome outcome = place.cost("--on rdna3 --term weight --format float,half,packed");
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("term or model  format  issue  VALU  trans  throughput  "
                                     "latency  VGPRs  waves  SPIR-V\n"));
    CHECK_THAT(outcome.out, Contains("RDNA3 (gfx1100)"));
    const auto families = place.json("--on rdna3,gcn4 --term weight")["rows"][0]["families"];
    CHECK(families.size() == 2);
    CHECK(families.contains("gcn4"));
    CHECK(families.contains("rdna3"));
    CHECK_THAT(outcome.out, !Contains("scaled"));

    const auto fixed = place.json("--term scaled --set gain=1");
    CHECK(issue(fixed, "scaled") == issue(place.json("--term weight"), "weight"));
    CHECK(issue(place.json("--term small --from-vectors"), "small") >
          issue(place.json("--term small"), "small"));
    // By hand a fifth power is `pow`: two transcendental instructions.
    CHECK(place.json(
              "--term weight --spelling naive")["rows"][0]["families"]["rdna2"]["transcendental"] ==
          2);
}

TEST_CASE("cost times what it is asked to time")
{
    const Place place;
    const Outcome outcome = place.cost("--term weight --nanoseconds --json times.json");
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("device ns  CPU ns\n"));
    const auto row = nlohmann::json::parse(place.read("times.json"))["rows"][0];
    CHECK(row["measured"]["tape_nanoseconds"] > 0);
    CHECK(row["measured"]["device_nanoseconds"] >= 0);
}

TEST_CASE("cost against a baseline says what changed, and fails past a limit")
{
    const Place place;
    REQUIRE(place.cost("--json old.json").status == 0);
    const Outcome same = place.cost("--baseline old.json --fail-above 0%");
    CHECK(same.status == 0);
    CHECK_THAT(same.out, Contains("issue cycles on RDNA2 (navi21): 0 helped, 0 hurt, 3 unchanged"));

    std::string dearer = model;
    dearer.replace(dearer.find("gain * weight"), 4, "(gain + 1)");
    place.write("small.lobe", dearer);
    const Outcome hurt = place.cost("--baseline old.json --fail-above 2%");
    CHECK(hurt.status == 1);
    CHECK_THAT(hurt.out, Contains("hurt    small: scaled: 4 -> 5 (+25.0 %)"));
    CHECK(place.cost("--baseline old.json --fail-above 30%").status == 0);
    CHECK(place.cost("--baseline old.json").status == 0);
    CHECK(place.cost("--baseline old.json --fail-above 2% --term weight").status == 0);
    // A file of one family is about that family.
    REQUIRE(place.cost("--on rdna2 --json one.json").status == 0);
    const Outcome one = place.cost("--baseline one.json");
    CHECK(one.status == 0);
    CHECK_THAT(one.out, Contains("issue cycles on RDNA2 (navi21): 0 helped") &&
                            !Contains("on GCN4") && !Contains("SPIR-V instructions"));
    CHECK(place.run("lobec cost small.lobe -q --baseline old.json --fail-above 2%").status == 1);
}

TEST_CASE("cost says what it does not understand")
{
    const Place place;
    const auto refused = [&](const std::string& options, const std::string& message) {
        const Outcome outcome = place.cost(options);
        CAPTURE(options, outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Contains(message));
    };
    refused("--on rdna9", "rdna9");
    refused("--term wieght", "no term or model `wieght`; did you mean `weight`?");
    refused("--set gian=1", "gian");
    refused("--format quarter", "quarter");
    refused("--baseline none.json", "cannot use none.json: no such file");
    place.write("foreign.json", "{\"rows\": []}");
    refused("--baseline foreign.json", "it is not what `lobec cost --json` writes");
    refused("--fail-above 2%", "--baseline");
    place.write("cut.json", "{\"kind\": \"lobe cost\", \"schema\": 1, \"rows\": [{\"na");
    refused("--baseline cut.json", "it is not what `lobec cost --json` writes");
    place.write("damaged.json", R"({"kind": "lobe cost", "schema": 1, "driver": "radv",
        "from_vectors": false, "rows": [{"module": "small", "name": "weight"}]})");
    refused("--baseline damaged.json", "it is damaged");
    refused("--baseline .", "cannot use .: ");
    REQUIRE(place.cost("--on rdna2 --json one.json").status == 0);
    refused("--baseline one.json --on gcn4", "it has no cycles on gcn4");
    refused("--nanoseconds --device nowhere", "nowhere");
    REQUIRE(place.cost("--json old.json").status == 0);
    refused("--baseline old.json --fail-above much", "`much` is no share");
    refused("--baseline old.json --from-vectors", "without --from-vectors");
    refused("--json small.lobe/x.json", "small.lobe");
    refused("--device llvmpipe", "--nanoseconds");
    CHECK(place.run("lobec cost none.lobe").status == 2);
    place.write("broken.lobe", "module broken\nterm x( = 1\n");
    CHECK(place.run("lobec cost broken.lobe").status == 1);
}

TEST_CASE("cost without a driver counts SPIR-V and says what is missing")
{
    const Place place;
    const Outcome outcome = place.run("VK_DRIVER_FILES=/none.json VK_ICD_FILENAMES=/none.json "
                                      "lobec cost small.lobe --no-cache");
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.err.empty());
    CHECK_THAT(outcome.out, Contains("term or model  SPIR-V\n"));
    CHECK_THAT(outcome.out, Contains("no cycles: no Vulkan driver is installed; the package "
                                     "`mesa-vulkan-drivers`"));
}
