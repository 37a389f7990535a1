// What is proved of everything that ships: finite, and closer to what is observed than the figures
// demand. And that it is true: points of random boxes stay in their bounds.
#include "analyze/checked.h"
#include "analyze/proof/bounds.h"
#include "analyze/proof/finite.h"
#include "analyze/proof/proof.h"
#include "analyze/proof/zeros.h"
#include "analyze/random.h"
#include "compile.h"
#include "evaluate/bounds.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <mutex>

using namespace lobe;
using namespace lobe::analyze;
using evaluate::Machine;
using evaluate::Precision;

namespace {

ir::Module model(const std::string& name)
{
    return middle(tests::checked_model("../models/" + name + ".lobe").module);
}

ir::Module text(const std::string& source) { return middle(tests::checked_text(source).module); }

std::vector<ir::FunctionId> terms(const ir::Module& module)
{
    std::vector<ir::FunctionId> result;
    for (const ir::FunctionId id : checked_functions(module))
        if (module[id].kind != ir::Function::Kind::storage) result.push_back(id);
    return result;
}

Proof only(const ir::Module& module, const ProofOptions& options)
{
    const auto all = proofs(module, options, {});
    REQUIRE(all.size() == 1);
    return all.front();
}

/// A random part of a box: some halves of halves.
Box part_of(const Subject& subject, Random& random)
{
    Box box = subject.box;
    for (std::uint32_t i = random.below(24); i-- > 0 && !box.empty();) {
        std::vector<Cut> cuts;
        const std::size_t side = random.below(static_cast<std::uint32_t>(box.size()));
        cuts_of(box[side], side, cuts);
        if (cuts.empty()) continue;
        const Cut cut = cuts[random.below(static_cast<std::uint32_t>(cuts.size()))];
        auto [low, high] = halves(subject, box, cut);
        box = random.coin() ? std::move(low) : std::move(high);
    }
    return box;
}

/// How many points of random parts were held against the bounds of these.
std::size_t hold(const Subject& subject, std::size_t boxes, std::size_t points)
{
    evaluate::RoundingBounds bounds{
        subject.steps, evaluate::rounding(Machine::kernels, subject.precision), subject.floor};
    Random random{subject.output};
    std::vector<Observed> values;
    for (std::size_t i = 0; i < boxes; ++i) {
        const Box box = part_of(subject, random);
        const evaluate::BoxError error = bounds.error(box);
        const auto inside = points_in(subject, box, points, random.bits());
        evaluate_points(subject, inside, values);
        for (std::size_t p = 0; p < values.size(); ++p) {
            const Observed& value = values[p];
            INFO(subject.tape.output_names[subject.output] << " at "
                                                           << describe(subject, inside[p]));
            INFO("computed " << value.computed << ", exact " << value.exact << ", proved ["
                             << error.computed.low << ", " << error.computed.high << "], "
                             << error.absolute << ", " << error.relative << ", " << error.jump);
            if (!std::isfinite(value.computed)) {
                REQUIRE((error.jump == evaluate::infinity || error.absolute == evaluate::infinity));
                continue;
            }
            REQUIRE(error.computed.low <= value.computed);
            REQUIRE(value.computed <= error.computed.high);
            // The exact value is a double's: right to 2^-40 of the sizes on the way, which a bound
            // that is not below half a unit of a float does not see.
            const double slack = 1 + 0x1p-20;
            const double off = error_of(subject, value, Measure::absolute);
            REQUIRE(off <= (error.absolute + error.jump) * slack);
            if (error.jump == 0)
                REQUIRE(error_of(subject, value, Measure::relative) <= error.relative * slack);
        }
    }
    return boxes * points;
}

const std::vector<std::string> shipped{"microfacet", "callisto", "ue4", "lights", "environment"};

}  // namespace

TEST_CASE("points of shipped terms never leave a proved bound, in float and in half", "[proof]")
{
    std::size_t held = 0;
    for (const std::string& name : shipped) {
        const ir::Module module = model(name);
        for (const ir::FunctionId id : terms(module))
            for (const Precision precision : {Precision::float32, Precision::float16})
                for (const Subject& subject : subjects(module, module[id], precision))
                    held += hold(subject, 48, 256);
    }
    // Two precisions of some sixty terms and models.
    CHECK(held > 1'000'000);
}

TEST_CASE("points never leave a bound that starts at a waist", "[proof]")
{
    std::size_t waists = 0;
    for (const std::string& name : shipped) {
        const ir::Module module = model(name);
        for (const ir::FunctionId id : terms(module))
            for (const Precision precision : {Precision::float32, Precision::float16})
                for (const Subject& subject : subjects(module, module[id], precision)) {
                    INFO(module[id].name);
                    std::vector<Observed> values;
                    std::vector<Point> points = points_in(subject, subject.box, 2048, 1);
                    for (Point& point : points_at_zeros(subject, subject.box, 512, 2))
                        points.push_back(std::move(point));
                    evaluate_points(subject, points, values);
                    // What overflows is told as a jump, and so is what a turned decision does.
                    std::vector<Point> finite;
                    for (std::size_t i = 0; i < points.size(); ++i)
                        if (std::isfinite(values[i].computed)) finite.push_back(points[i]);
                    evaluate_points(subject, finite, values);
                    Worst worst{subject, Measure::absolute};
                    worst.consider(finite, values);
                    for (const Subject& from : from_waists(subject, Machine::kernels, false)) {
                        Division division{from, Machine::kernels, Measure::absolute, worst};
                        division.refine(1 << 8, 1);
                        // As above: the exact value is a double's.
                        REQUIRE(worst.error() <= division.bound() * (1 + 0x1p-20));
                        ++waists;
                    }
                }
    }
    CHECK(waists > 1000);
}

TEST_CASE("a falloff is proved of the distance, not of three coordinates", "[proof]")
{
    const ir::Module module = text("module m\n"
                                   "term f(p: float3 in [-2^20, 2^20]) -> float =\n"
                                   "  (1 - min(dot(p, p) / 2^30, 1))^2 / (dot(p, p) + 1)\n");
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 12;
    CHECK(only(module, options).ieee.ratio() < 10);
}

TEST_CASE("points are found at which several sums vanish together", "[proof]")
{
    // The middle of a segment, as seen from its end: a direction that rounding turns.
    const ir::Module module =
        text("module m\n"
             "term f(p: float3 in [-2^20, 2^20], axis: direction, s: float in [0, 4096])\n"
             "  -> float3 = normalize(p - s * axis)\n");
    const Subject subject = subjects(module, module[terms(module).front()], Precision::float32)[0];
    std::vector<Observed> values;
    const auto worst_of = [&](const std::vector<Point>& points) {
        evaluate_points(subject, points, values);
        double worst = 0;
        for (const Observed& value : values)
            worst = std::max(worst, error_of(subject, value, Measure::absolute));
        return worst;
    };
    constexpr std::size_t count = 1 << 14;
    CHECK(worst_of(points_in(subject, subject.box, count, 1)) < 0.1);
    CHECK(worst_of(points_at_zeros(subject, subject.box, count, 1)) > 0.1);
}

TEST_CASE("every shipped function is finite in float on any device", "[proof]")
{
    for (const std::string& name : shipped) {
        const ir::Module module = model(name);
        for (const ir::FunctionId id : terms(module))
            for (const Subject& subject : subjects(module, module[id], Precision::float32)) {
                const Finite proof = prove_finite(subject, subject.box, 1 << 14);
                INFO(module[id].name);
                CHECK(proof.open.empty());
            }
    }
}

TEST_CASE("bounds are close to what is observed", "[proof]")
{
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 14;
    // The whole tables take minutes; `lobec stability` prints them.
    for (const Proof& proof : proofs(model("microfacet"), options, {})) {
        INFO(proof.function);
        CHECK(proof.finite);
        CHECK(proof.ieee.ratio() < 10);
        CHECK(proof.ieee.ratio() >= 1);
        CHECK(proof.vulkan.absolute >= proof.ieee.observed_absolute);
    }
}

TEST_CASE("what may overflow is open, and its boxes are tested", "[proof]")
{
    const ir::Module module = text("module m\nterm f(x: float in [-4, 4]) -> float =\n"
                                   "  exp(exp(x * x))\n");
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 12;
    const Proof proof = only(module, options);
    CHECK_FALSE(proof.finite);
    REQUIRE(proof.open_count == proof.open.size());
    REQUIRE(proof.open_count == 2);
    // exp(y) overflows from y = 88.72 on, x = sqrt(ln 88.72) = 2.1178.
    for (const NamedBox& box : proof.open) {
        const evaluate::Interval side = box.sides.at(0).second;
        const double edge = std::min(std::abs(side.low), std::abs(side.high));
        CHECK(edge > 2.0);
        CHECK(edge < 2.1179);
        CHECK(std::max(std::abs(side.low), std::abs(side.high)) == 4);
    }
    CHECK(proof.open_tested > 0);
    CHECK(proof.open_not_finite > 0);
    CHECK(proof.open_not_finite < proof.open_tested);
}

TEST_CASE("half is proved on a part of the box, or refused with the operation", "[proof]")
{
    ProofOptions options;
    options.precisions = {Precision::float16};
    options.boxes = 1 << 12;

    // 1 / x^2 is a half for x from 2^-8 on.
    const Proof part =
        only(text("module m\nterm f(x: float in [1/1024, 1]) -> float = 1 / x^2\n"), options);
    CHECK(part.finite);
    REQUIRE(part.over);
    const evaluate::Interval side = part.over->sides.at(0).second;
    CHECK(side.high == 1);
    CHECK(side.low >= 0x1p-8);
    CHECK(side.low <= 0x1p-7);
    CHECK(part.ieee.ratio() < 10);

    const Proof refused =
        only(text("module m\nterm f(x: float in [1, 2]) -> float = x * 70000\n"), options);
    CHECK_FALSE(refused.finite);
    CHECK_FALSE(refused.refused.empty());
    CHECK(refused.open_not_finite == refused.open_tested);
}

TEST_CASE("a jump is told apart from an error", "[proof]")
{
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 14;
    const Proof proof = only(text("module m\nterm f(x: unit, y: unit) -> float =\n"
                                  "  if x * y < 0.3 then 0 else 1\n"),
                             options);
    CHECK(proof.finite);
    CHECK(proof.ieee.absolute == 0);
    CHECK(proof.ieee.jump == Approx(1).epsilon(1e-6));
    // Rounding turns the condition where x y is within 2^-25 of 0.3; the search gets there.
    CHECK(proof.ieee.observed_jump == 1);
}

TEST_CASE("proofs are kept by content", "[proof]")
{
    const ir::Module module = text("module m\nterm f(x: unit) -> float = x * (1 - x)\n");
    std::map<std::string, std::string> kept;
    std::mutex mutex;
    std::size_t saved = 0;
    Store store;
    store.load = [&](std::string_view key) -> std::optional<std::string> {
        const std::lock_guard lock{mutex};
        const auto found = kept.find(std::string{key});
        if (found == kept.end()) return std::nullopt;
        return found->second;
    };
    store.save = [&](std::string_view key, std::string_view value) {
        const std::lock_guard lock{mutex};
        ++saved;
        kept[std::string{key}] = value;
    };
    ProofOptions options;
    options.boxes = 1 << 10;
    const auto first = proofs(module, options, store);
    const auto second = proofs(module, options, store);
    CHECK(saved == 2);  // float and half
    REQUIRE(first.size() == second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        CHECK(first[i].ieee.absolute == second[i].ieee.absolute);
        CHECK(first[i].ieee.at == second[i].ieee.at);
        CHECK(first[i].vulkan.relative == second[i].vulkan.relative);
        CHECK(first[i].boxes == second[i].boxes);
    }
    // A damaged entry is proved again.
    for (auto& [key, value] : kept) value = "{";
    CHECK(proofs(module, options, store)[0].ieee.absolute == first[0].ieee.absolute);
}

TEST_CASE("results do not depend on the number of threads", "[proof]")
{
    const ir::Module module = model("microfacet");
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 9;
    options.jobs = 1;
    const auto alone = proofs(module, options, {});
    options.jobs = 4;
    const auto together = proofs(module, options, {});
    REQUIRE(alone.size() == together.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(alone[i].function == together[i].function);
        CHECK(alone[i].ieee.absolute == together[i].ieee.absolute);
        CHECK(alone[i].ieee.relative == together[i].ieee.relative);
        CHECK(alone[i].ieee.at == together[i].ieee.at);
    }
}

TEST_CASE("the fields are proved of the vectors", "[proof]")
{
    ProofOptions options;
    options.precisions = {Precision::float32};
    options.boxes = 1 << 14;
    const auto fields = field_proofs(model("microfacet"), options, {});
    CHECK(fields.size() >= 8);
    for (const Proof& field : fields) {
        INFO(field.function);
        CHECK(field.finite);
        // Products and sums of components up to 2, each off by at most some tens of units of 2^-24.
        CHECK(field.ieee.absolute < 0x1p-15);
        CHECK(field.ieee.ratio() < 100);
    }
}
