// Every code of every channel comes back: counted out in whole numbers, computed on the CPU, run on
// the device as emitted, promised by the contract.
#include "analyze/round_trip.h"
#include "analyze/table.h"
#include "analyze/verify.h"
#include "emit/packings.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

using namespace lobe;

namespace {

device::Device open_device()
{
    std::string why;
    auto device = device::Device::open("", why);
    INFO(why);
    REQUIRE(device.has_value());
    return std::move(*device);
}

std::string text_of(const std::optional<analyze::LostCode>& lost)
{
    if (!lost) return "";
    return lost->channel + " from " + lost->stored + ": " + std::to_string(lost->returned) +
           " instead of " + std::to_string(lost->expected);
}

}  // namespace

TEST_CASE("every code comes back, on the CPU, on the device and by the contract",
          "[round_trip][device]")
{
    const tests::Builder b = tests::packed_skin();
    const analyze::TripReference reference = analyze::trip_reference(b.module, 0);
    const analyze::RoundTrip& outcome = reference.outcome;
    CHECK(outcome.packing == "skin on ue4");
    CHECK(outcome.channels == 6);
    // Six channels of 8 bits, and the field of 10 bits that lies in two of them.
    CHECK(outcome.codes == 6 * 256 + 1024);
    CHECK(outcome.points == 3 * outcome.codes);
    INFO(text_of(outcome.processor.example));
    CHECK(outcome.processor.ok());
    CHECK(outcome.promised == outcome.points);

    device::Device device = open_device();
    for (const emit::Target& target : emit::targets()) {
        CAPTURE(target.name);
        const analyze::RoundTrip trip =
            analyze::round_trip(b.module, b.sources, 0, target, reference, &device);
        for (const analyze::Judgement& judgement : trip.judgements)
            for (const analyze::Remark& remark : judgement.remarks) UNSCOPED_INFO(remark.text);
        CHECK(trip.failure == "");
        REQUIRE(trip.executed);
        INFO(text_of(trip.direct.example));
        CHECK(trip.direct.lost == 0);
        CHECK(trip.direct.outside == 0);
        CHECK(trip.direct.other_bits == 0);
        CHECK(trip.optimized.lost == 0);
        CHECK(trip.optimized.other_bits == 0);
        CHECK(trip.ok());
    }
}

TEST_CASE("a decode that does not undo its encode is found, with the code", "[round_trip][device]")
{
    const tests::Builder good = tests::packed_skin();
    tests::Builder bad = good;
    // falloff: 0.75 + (code - 12) * 0.0625 becomes 0.75 + (code - 12) * 0.0625 * 0.95: from code 2
    // down it is more than half a code off.
    ir::Function& decode = bad.module.functions[bad.module.packings[0].fields[1].decode.index];
    const ir::ExprId twelve = decode.graph.literal("12");
    const ir::ExprId code = decode.graph.input(0, ir::Type::scalar);
    const ir::ExprId distance = decode.graph.apply(ir::Op::subtract, {code, twelve});
    const ir::ExprId step = decode.graph.literal("0.059375");
    decode.result =
        decode.graph.apply(ir::Op::add, {decode.graph.literal("0.75"),
                                         decode.graph.apply(ir::Op::multiply, {distance, step})});

    const analyze::TripReference reference = analyze::trip_reference(bad.module, 0);
    CHECK_FALSE(reference.outcome.processor.ok());
    CHECK(reference.outcome.processor.outside == 0);  // it is what the functions say
    CHECK(reference.outcome.promised < reference.points());
    REQUIRE(reference.outcome.processor.example);
    CHECK(reference.outcome.processor.example->channel == "d.g");

    // The same text against the reference of the right one: a device that computes another thing.
    const analyze::TripReference right = analyze::trip_reference(good.module, 0);
    device::Device device = open_device();
    const analyze::RoundTrip trip =
        analyze::round_trip(bad.module, bad.sources, 0, *emit::find_target("ue4"), right, &device);
    REQUIRE(trip.executed);
    CHECK(trip.processor.ok());
    CHECK(trip.direct.lost == reference.outcome.processor.lost);
    CHECK(trip.optimized.lost == trip.direct.lost);
    CHECK(trip.direct.outside > 0);
    CHECK_FALSE(trip.ok());
}

TEST_CASE("one result that is off is one point", "[round_trip]")
{
    const tests::Builder b = tests::packed_skin();
    const analyze::TripReference reference = analyze::trip_reference(b.module, 0);
    std::vector<float> results = reference.results;
    CHECK(analyze::compare(reference, results).ok());

    const std::size_t point = 100;
    float& stored = results[point * reference.outputs + 1];
    const float right = stored;
    // The next float stores the same code, and no operation on the way may be off by that.
    stored = std::nextafter(right, 2.0f);
    analyze::Trip trip = analyze::compare(reference, results);
    CHECK(trip.lost == 0);
    CHECK(trip.other_bits == 1);
    CHECK_FALSE(trip.example);
    // The next code does not.
    stored = right + 1.0f / 255;
    trip = analyze::compare(reference, results);
    CHECK(trip.lost == 1);
    CHECK(trip.outside == 1);
    REQUIRE(trip.example);
    CHECK(trip.example->channel == "d.r");
    CHECK(trip.example->returned == Approx(trip.example->expected + 1));
    stored = std::numeric_limits<float>::quiet_NaN();
    trip = analyze::compare(reference, results);
    CHECK(trip.lost == 1);
    CHECK(trip.outside == 1);
    stored = right;
    // A value that is no channel only has to be one that the contract allows.
    results[(point + 1) * reference.outputs - 1] += 0.5f;
    trip = analyze::compare(reference, results);
    CHECK(trip.lost == 0);
    CHECK(trip.outside == 1);
    CHECK_FALSE(trip.ok());
}

TEST_CASE("codes that floats cannot tell apart are lost, and are not promised", "[round_trip]")
{
    // The square of 1/4095 is as far from 0 as two floats below 1 are from each other, and decode
    // starts from 1.
    tests::Builder b{"fine"};
    ir::Parameter gain;
    gain.name = "gain";
    gain.type = ir::Type::scalar;
    gain.quantity = ir::Quantity::number;
    gain.range = {0, 1};
    gain.default_value = {1};
    gain.module = "fine";
    b.module.parameters.push_back(gain);
    ir::Gbuffer gbuffer;
    gbuffer.name = "wide";
    gbuffer.targets.push_back({"a", "A", "", {}});
    ir::Channel channel;
    channel.name = "r";
    channel.formats = {{ir::Storage::unorm, 12}};
    channel.exists = {true};
    gbuffer.channels.push_back(channel);
    ir::Packing packing;
    packing.model.name = "none";
    packing.gbuffer = "wide";
    packing.module = "fine";
    packing.supported = {true};
    ir::Field field;
    field.slots = {{0, 0, 12}};
    field.bits = 12;
    field.range = gain.range;
    field.code.kind = ir::Code::Kind::square_root;
    packing.fields.push_back(field);
    b.module.gbuffers.push_back(gbuffer);
    ir::build_functions(b.module, packing, gbuffer);
    b.module.packings.push_back(packing);

    const analyze::TripReference reference = analyze::trip_reference(b.module, 0);
    const analyze::RoundTrip& outcome = reference.outcome;
    CHECK(outcome.codes == 4096);
    CHECK(outcome.processor.lost > 0);
    CHECK(outcome.processor.lost < 3 * 16);  // only where the square is some units of 2^-24
    REQUIRE(outcome.processor.example);
    CHECK(outcome.processor.example->stored == "a.r = 1/4095");
    CHECK(outcome.promised + outcome.processor.lost <= outcome.points);
    CHECK(outcome.promised > outcome.points * 9 / 10);
    CHECK_FALSE(outcome.ok());
}

TEST_CASE("verify runs what packs and unpacks like any function, and every round trip",
          "[round_trip][verify][device]")
{
    const tests::Builder b = tests::packed_skin();
    analyze::VerifyOptions options;
    options.points = 4096;
    options.jobs = 2;
    const analyze::Verification result = analyze::verify(b.module, b.sources, options);
    REQUIRE(result.no_device == "");
    for (const analyze::Judgement& judgement : result.judgements) {
        CAPTURE(judgement.artifact, judgement.judge);
        for (const analyze::Remark& remark : judgement.remarks) UNSCOPED_INFO(remark.text);
        CHECK(judgement.accepted);
    }
    std::set<std::string> terms;
    for (const analyze::Row& row : result.rows) {
        CAPTURE(row.term, row.target, row.failure);
        INFO((row.direct.example ? row.direct.example->inputs : ""));
        CHECK(row.ok());
        CHECK(row.executed);
        const auto function = b.module.find(row.term);
        if (!function || b.module[*function].kind != ir::Function::Kind::storage) continue;
        CHECK(row.precision == emit::Precision::float32);
        // Out of range and between two codes there is always an answer.
        CHECK(row.direct.undefined == 0);
        terms.insert(row.term + " " + row.target);
    }
    // Nine fields, six channels, seven parameters.
    CHECK(terms.size() == (9 + 9 + 6 + 7) * emit::targets().size());
    CHECK(std::ranges::count(
              result.notes,
              "float16: what packs and unpacks; it has no whole numbers past 2,048") == 1);
    REQUIRE(result.round_trips.size() == emit::targets().size());
    for (std::size_t i = 0; i < result.round_trips.size(); ++i) {
        CHECK(result.round_trips[i].target == emit::targets()[i].name);
        CHECK(result.round_trips[i].executed);
        CHECK(result.round_trips[i].ok());
    }
    CHECK(result.ok());

    // Without execution the CPU and the judges still have their say.
    options.execute = false;
    options.targets = {emit::find_target("glsl450")};
    const analyze::Verification judged = analyze::verify(b.module, b.sources, options);
    REQUIRE(judged.round_trips.size() == 1);
    CHECK_FALSE(judged.round_trips[0].executed);
    CHECK(judged.round_trips[0].codes == 6 * 256 + 1024);
    CHECK_FALSE(judged.round_trips[0].judgements.empty());
}

TEST_CASE("what packs and unpacks is evaluated like any term", "[round_trip][table]")
{
    const tests::Builder b = tests::packed_skin();
    const auto evaluate = [&](const char* term, const std::string& table, const char* number) {
        const auto function = analyze::find_function(b.module, term);
        REQUIRE(function);
        std::istringstream in{table};
        std::ostringstream out;
        const auto outcome = analyze::evaluate_table(b.module, *function,
                                                     *analyze::find_number_kind(number), in, out);
        REQUIRE_FALSE(outcome.error);
        return out.str();
    };
    // 127 is the pivot of power(8, 127/255), the code of 1.
    CHECK(evaluate("encode_gain", "x\n1\n256\n1000\n", "float") ==
          "x,encode_gain\n1,127\n256,254\n1000,254\n");
    CHECK(evaluate("decode_gain", "code\n127\n0\n", "acceptance") ==
          "code,decode_gain.low,decode_gain.high,decode_gain.undefined\n127,1,1,0\n0,0,0,0\n");
    CHECK(evaluate("unpack_terminator", "d_a\n0.47058823529411764\n", "float") ==
          "d_a,unpack_terminator\n0.47058823529411764,0\n");
    // 120 times the float just below 1/255, as its decimal says; an absent depth is its default.
    CHECK(evaluate("pack_d_a", "terminator\n0\n", "mpfr:200")
              .starts_with("terminator,pack_d_a\n0,4.70588208000000000000"));
}

TEST_CASE("a lost code fails the verification", "[round_trip][verify]")
{
    analyze::Verification verification;
    verification.round_trips.emplace_back();
    CHECK(verification.ok());
    verification.round_trips[0].optimized.lost = 1;
    CHECK_FALSE(verification.ok());
    verification.round_trips[0] = {};
    verification.round_trips[0].failure = "no";
    CHECK_FALSE(verification.ok());
}
