// The corner suite: that it goes where it says, that it sees what is not finite, and that nothing
// that ships is.
#include "analyze/corners/corners.h"
#include "analyze/emitted.h"
#include "analyze/models.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <set>

using namespace lobe;
using namespace lobe::tests;
using analyze::CornerRow;
using analyze::EntryInputs;
using evaluate::Precision;

namespace {

EntryInputs inputs_of(const ir::Module& module, const std::string& function,
                      Precision precision = Precision::float32)
{
    const auto id = module.find(function);
    INFO(function);
    REQUIRE(id);
    return {module, *id, analyze::grid_of(precision)};
}

analyze::Points points_of(const EntryInputs& inputs, Precision precision = Precision::float32)
{
    return analyze::corner_points(inputs, analyze::grid_of(precision));
}

/// The columns l.x .. n.z of a point.
std::array<float, 9> vectors(const analyze::Points& points, std::size_t point)
{
    std::array<float, 9> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = points.columns[i][point];
    return out;
}

/// A module of one function of a geometry, built as optimize would never leave it.
ir::Module module_of(ir::Function function)
{
    ir::Module module;
    module.name = "sample";
    module.path = "sample.lobe";
    module.functions = {std::move(function)};
    return module;
}

std::vector<CornerRow> rows_of(const ir::Module& module)
{
    analyze::CornerOptions options;
    options.continuity = false;
    const analyze::Corners corners = analyze::corners(module, {}, options, {});
    REQUIRE(corners.no_device == "");
    return corners.rows;
}

}  // namespace

TEST_CASE("corner points lie in the declared ranges, and are the same every time", "[corners]")
{
    const Precision precision = GENERATE(Precision::float32, Precision::float16);
    const ir::Module& module = emitted_model("callisto").module;
    const EntryInputs inputs = inputs_of(module, "callisto_diffuse", precision);
    const analyze::Points points = points_of(inputs, precision);
    CHECK(points.size() > 20000);
    CHECK(points.size() < 100000);
    for (std::size_t i = 0; i < points.columns.size(); ++i) {
        CAPTURE(points.names[i]);
        REQUIRE(points.columns[i].size() == points.size());
        const auto [low, high] = std::ranges::minmax(points.columns[i]);
        CHECK(low >= inputs.scalars()[i].low);
        CHECK(high <= inputs.scalars()[i].high);
    }
    CHECK(points_of(inputs, precision).columns == points.columns);
}

TEST_CASE("corner points have every relation of light, view and normal", "[corners]")
{
    const ir::Module& module = emitted_model("callisto").module;
    const analyze::Points points = points_of(inputs_of(module, "lambert_cos"));
    std::map<std::string, int> seen;
    std::set<float> cosines;
    for (std::size_t at = 0; at < points.size(); ++at) {
        const auto [lx, ly, lz, vx, vy, vz, nx, ny, nz] = vectors(points, at);
        const bool axis = nz == 1;
        if (axis) cosines.insert(lz);
        seen["l = v"] += lx == vx && ly == vy && lz == vz;
        seen["l = -v"] += lx == -vx && ly == -vy && lz == -vz;
        seen["mirrored"] += axis && lx == -vx && ly == -vy && lz == vz && lz < 1;
        seen["l = n"] += lx == nx && ly == ny && lz == nz;
        seen["both on the horizon"] += axis && lz == 0 && vz == 0;
        seen["light below, view above"] += axis && lz < 0 && vz > 0;
        seen["another normal"] += nx != 0 && ny != 0 && nz != 0;
    }
    for (const auto& [what, count] : seen) {
        CAPTURE(what);
        CHECK(count >= 5);
    }
    // Both neighbors of the horizon, of what `else` counts as 0, and the last normal number.
    for (const float cosine : {0.0F, 0x1p-149F, -0x1p-149F, 0x1p-126F, 0x1p-64F, 0x1.000002p-64F,
                               0x1.fffffep-65F, 1e-4F, -1e-4F, -1.0F}) {
        CAPTURE(cosine);
        CHECK(cosines.count(cosine) == 1);
    }
}

TEST_CASE("corner points set every value to its ends and next to them", "[corners]")
{
    const ir::Module& module = emitted_model("callisto").module;
    const EntryInputs inputs = inputs_of(module, "callisto_diffuse");
    const analyze::Points points = points_of(inputs);
    const analyze::Grid& grid = analyze::grid_of(Precision::float32);
    std::vector<std::set<float>> values;
    for (const auto& column : points.columns) values.emplace_back(column.begin(), column.end());
    for (const EntryInputs::Value& value : inputs.values()) {
        const analyze::Scalar& scalar = inputs.scalars()[value.first];
        for (const double wanted :
             {scalar.low, analyze::next_above(scalar.low, grid), scalar.neutral,
              analyze::next_below(scalar.high, grid), scalar.high}) {
            CAPTURE(value.name, wanted);
            CHECK(values[value.first].count(static_cast<float>(wanted)) == 1);
        }
    }
}

TEST_CASE("corner points have every combination of the ends of three inputs", "[corners]")
{
    const ir::Module& module = emitted_model("callisto").module;
    const EntryInputs inputs = inputs_of(module, "callisto_diffuse");
    REQUIRE(inputs.values().size() > 10);  // else all combinations of all inputs are there
    const analyze::Points points = points_of(inputs);
    const std::size_t count = inputs.values().size();
    // Per point and input: 0 and 1 for an end, 2 for what is between.
    std::vector<std::vector<int>> ends(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t column = inputs.values()[i].first;
        const analyze::Scalar& scalar = inputs.scalars()[column];
        for (const float value : points.columns[column])
            ends[i].push_back(value == scalar.low ? 0 : value == scalar.high ? 1 : 2);
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = 0; k < j; ++k) {
                std::set<int> found;
                for (std::size_t at = 0; at < points.size() && found.size() < 8; ++at)
                    if (ends[i][at] < 2 && ends[j][at] < 2 && ends[k][at] < 2)
                        found.insert(4 * ends[i][at] + 2 * ends[j][at] + ends[k][at]);
                CAPTURE(i, j, k);
                CHECK(found.size() == 8);
            }
}

TEST_CASE("an open box becomes points", "[corners]")
{
    const ir::Module& module = emitted_model("callisto").module;
    const EntryInputs inputs = inputs_of(module, "callisto_diffuse");
    // Sides that no special value meets.
    const analyze::NamedBox box{{{"retroreflection", {17, 19}}, {"cos_i", {0, 0.25}}}};
    const analyze::Points without = points_of(inputs);
    const analyze::Points with =
        analyze::corner_points(inputs, analyze::grid_of(Precision::float32), {&box, 1});
    CHECK(with.size() > without.size());
    const auto column = static_cast<std::size_t>(std::ranges::find(with.names, "retroreflection") -
                                                 with.names.begin());
    for (const float value : {17.0F, 18.0F, 19.0F}) {
        CHECK(std::ranges::count(without.columns[column], value) == 0);
        CHECK(std::ranges::count(with.columns[column], value) > 0);
    }
    // The points of the box are the last ones; their light is where the box says.
    for (std::size_t at = without.size(); at < with.size(); ++at) {
        const auto [lx, ly, lz, vx, vy, vz, nx, ny, nz] = vectors(with, at);
        // Three products of components up to 1, and two sums: an ulp each on any device.
        CHECK(lx * nx + ly * ny + lz * nz < 0.25 + 5 * 0x1p-23);
    }
}

TEST_CASE("half is required where it is proved, and nowhere else", "[corners][device]")
{
    FunctionBuilder f{"large"};
    const auto cos_i = f.geometry(ir::GeometryField::cos_i);
    const auto scaled = f(ir::Op::multiply, {cos_i, f.literal("1000")});
    const ir::Module module = module_of(f.finish(f(ir::Op::multiply, {scaled, scaled})));
    const auto half_rows = [&](const analyze::HalfClaim& claim) {
        analyze::CornerOptions options;
        options.continuity = false;
        options.half = {claim};
        std::vector<CornerRow> rows = analyze::corners(module, {}, options, {}).rows;
        std::erase_if(
            rows, [](const CornerRow& row) { return row.precision != emit::Precision::float16; });
        return rows;
    };
    const auto rows_without = rows_of(module);
    const auto whole =
        std::ranges::find(rows_without, emit::Precision::float16, &CornerRow::precision);
    REQUIRE(whole != rows_without.end());

    // 125^2 is a half; from 256^2 on there is none.
    const std::vector<CornerRow> rows =
        half_rows({"large", analyze::NamedBox{{{"cos_i", {0, 0.125}}}}, ""});
    REQUIRE(rows.size() == 4);  // the evaluator and one target
    for (std::size_t i = 0; i < rows.size(); i += 2) {
        CAPTURE(rows[i].target);
        CHECK(rows[i].target == rows[i + 1].target);
        CHECK(rows[i].required);
        CHECK(rows[i].claim == "cos_i in [0, 0.125]");
        CHECK(rows[i].points > 0);
        CHECK(rows[i].infinite == 0);
        CHECK_FALSE(rows[i + 1].required);
        CHECK(rows[i + 1].infinite > 0);
        CHECK(rows[i].points + rows[i + 1].points == whole->points);
    }
    // A claim that is not true is found out.
    const std::vector<CornerRow> wrong =
        half_rows({"large", analyze::NamedBox{{{"cos_i", {0, 1}}}}, ""});
    CHECK(wrong.front().required);
    CHECK(wrong.front().infinite > 0);

    const std::vector<CornerRow> refused = half_rows({"large", {}, "multiply may overflow"});
    REQUIRE(refused.size() == 2);
    CHECK_FALSE(refused.front().required);
    CHECK(refused.front().claim == "multiply may overflow");
    CHECK(refused.front().infinite == whole->infinite);
}

TEST_CASE("what is not finite is counted on every target, defined or not", "[corners][device]")
{
    FunctionBuilder f{"bare"};
    // Infinite at the horizon, and no number where the root's argument is negative.
    const auto cos_i = f.geometry(ir::GeometryField::cos_i);
    const auto cos_o = f.geometry(ir::GeometryField::cos_o);
    const auto root = f(ir::Op::square_root, {f(ir::Op::subtract, {cos_o, cos_i})});
    const auto result = f(ir::Op::divide, {root, cos_i});
    const std::vector<CornerRow> rows = rows_of(module_of(f.finish(result)));
    // The evaluator and six targets in float, the evaluator and one target in half.
    REQUIRE(rows.size() == 9);
    std::set<std::string> targets;
    for (const CornerRow& row : rows) {
        CAPTURE(row.target, row.failure);
        CHECK(row.failure == "");
        CHECK(row.not_a_number > 0);
        CHECK(row.infinite > 0);
        CHECK(row.not_a_number + row.infinite < row.points);
        CHECK(row.example.find("nan at l = (") != std::string::npos);
        CHECK(row.required == (row.precision == emit::Precision::float32));
        if (row.required) targets.insert(row.target);
    }
    CHECK(targets == std::set<std::string>{"essl300", "essl310", "evaluator", "glsl330", "glsl450",
                                           "hlsl", "ue4"});
}

TEST_CASE("half overflows where float does not", "[corners][device]")
{
    FunctionBuilder f{"large"};
    const auto cos_i = f.geometry(ir::GeometryField::cos_i);
    const auto square = f(ir::Op::multiply, {cos_i, f.literal("1000")});
    const auto result = f(ir::Op::multiply, {square, square});
    for (const CornerRow& row : rows_of(module_of(f.finish(result)))) {
        CAPTURE(row.target);
        CHECK(row.not_a_number == 0);
        CHECK((row.infinite > 0) == (row.precision == emit::Precision::float16));
    }
}

TEST_CASE("nothing that ships is infinite or no number in float", "[corners][device][shipped]")
{
    const std::string name =
        GENERATE("microfacet", "callisto", "callisto_skin", "ue4", "environment");
    CAPTURE(name);
    const Emitted& model = emitted_model(name);
    analyze::CornerOptions options;
    options.continuity = false;
    const analyze::Corners corners = analyze::corners(model.module, model.sources, options, {});
    REQUIRE(corners.no_device == "");
    REQUIRE(!corners.rows.empty());
    for (const CornerRow& row : corners.rows) {
        CAPTURE(row.function, row.target, row.claim, row.example);
        CHECK(row.failure == "");
        CHECK(row.points > 0);
        if (!row.required) continue;
        CHECK(row.not_a_number == 0);
        CHECK(row.infinite == 0);
    }
}

TEST_CASE("a second run takes everything from the store, with the same rows", "[corners][device]")
{
    const ir::Module module = sample_module();
    std::mutex mutex;
    std::map<std::string, std::string> known;
    std::atomic<int> missed = 0;
    analyze::Store store;
    store.load = [&](std::string_view key) -> std::optional<std::string> {
        const std::lock_guard lock{mutex};
        const auto found = known.find(std::string{key});
        if (found != known.end()) return found->second;
        ++missed;
        return std::nullopt;
    };
    store.save = [&](std::string_view key, std::string_view value) {
        const std::lock_guard lock{mutex};
        known.emplace(key, value);
    };
    const auto text = [&](unsigned jobs) {
        analyze::CornerOptions options;
        options.jobs = jobs;
        const analyze::Corners corners = analyze::corners(module, {}, options, store);
        std::string out;
        for (const CornerRow& row : corners.rows)
            out += row.function + row.target + std::to_string(row.points) + " " +
                   std::to_string(row.not_a_number) + " " + std::to_string(row.infinite) +
                   row.example + row.failure + "\n";
        for (const analyze::Continuity& row : corners.continuity)
            out += row.function + row.across + std::to_string(row.jump) + row.at + "\n";
        return out;
    };
    const std::string first = text(4);
    CHECK(missed > 0);
    missed = 0;
    CHECK(text(1) == first);
    CHECK(missed == 0);
    known.clear();
    CHECK(text(1) == first);
}
