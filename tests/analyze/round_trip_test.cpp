// Every code of every channel comes back: counted out in whole numbers, computed on the CPU, run on
// the device as emitted, promised by the contract.
#include "analyze/agreement/kill.h"
#include "analyze/packing/round_trip.h"
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
    // The square of 1/4095 is a quarter of the distance between two floats above 2, from where
    // decode starts.
    tests::Builder b{"fine"};
    ir::Parameter gain;
    gain.name = "gain";
    gain.type = ir::Type::scalar;
    gain.quantity = ir::Quantity::number;
    gain.range = {2, 3};
    gain.default_value = {3};
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
    CHECK(outcome.processor.lost < 3 * 16);  // only where the square is some units of 2^-22
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

TEST_CASE("at the border of two codes both are accepted, at a code it alone", "[round_trip]")
{
    const tests::Builder b = tests::packed_skin();
    const ir::Field& gain = b.module.packings[0].fields[0];
    const evaluate::Tape tape = evaluate::compile(b.module, b.module[gain.encode]);
    const auto accepted = [&](double value) {
        const double read = static_cast<float>(value);
        const evaluate::Acceptance x{read, read, false};
        evaluate::Acceptance result;
        const evaluate::Acceptance* in[] = {&x};
        evaluate::Acceptance* out[] = {&result};
        evaluate::run_acceptance(tape, evaluate::Precision::float32, in, out, 1);
        return result;
    };
    for (int code = 1; code < 254; ++code) {
        CAPTURE(code);
        // power(8, 127/255)
        const auto value = [](double at) { return std::pow(at / 127, 8); };
        CHECK(accepted(value(code)) == evaluate::Acceptance{double(code), double(code), false});
        CHECK(accepted(value(code + 0.5)) == evaluate::Acceptance{double(code), code + 1.0, false});
        // Three roots and a product, each some units of 2^-24 off: a thousandth of a code is more.
        CHECK(accepted(value(code + 0.499)).high == code);
        CHECK(accepted(value(code + 0.501)).low == code + 1);
    }
}

TEST_CASE("mistakes in what packs and unpacks are caught", "[round_trip][kill][device]")
{
    const tests::Builder b = tests::packed_skin();
    analyze::KillOptions options;
    options.mutants = 0;
    options.points = 8192;
    options.jobs = 2;
    options.targets = {emit::find_target("glsl450")};
    const analyze::KillSubject subject{&b.module, &b.sources};
    const analyze::KillReport report = analyze::kill({&subject, 1}, options);
    REQUIRE(report.no_device == "");
    CHECK(report.unusable.empty());

    std::size_t killed = 0;
    std::set<std::string> terms;
    for (const analyze::MutantFate& mutant : report.mutants) {
        const auto function = b.module.find(mutant.term);
        REQUIRE(function);
        if (b.module[*function].kind != ir::Function::Kind::storage) continue;
        terms.insert(mutant.term);
        killed += mutant.fate == analyze::Fate::killed;
        CAPTURE(mutant.term, mutant.mutant.before, mutant.mutant.after, mutant.reason);
        CHECK(mutant.fate != analyze::Fate::tolerated);
        if (mutant.fate != analyze::Fate::unchanged) continue;
        // Three kinds of change are none. A decode's guard is for devices that round another way.
        if (mutant.mutant.mutation == analyze::Mutation::remove_guard) {
            CHECK(mutant.term.starts_with("decode_"));
            continue;
        }
        REQUIRE(mutant.mutant.mutation == analyze::Mutation::change_constant);
        const double constant = std::stod(mutant.mutant.before);
        const bool codes = mutant.term.starts_with("encode_") || mutant.term.starts_with("decode_");
        // The floor of a whole number over a power of two does not hear 1e-4 of it. The end of a
        // range by 1e-4 is far less than half a code, and past it there is none.
        int exponent = 0;
        const bool shift = std::frexp(constant, &exponent) == 0.5 && constant < 1;
        const bool is_end =
            std::ranges::any_of(b.module.packings[0].fields, [&](const auto& field) {
                if (field.encode != *function && field.decode != *function) return false;
                const auto pivot = static_cast<double>(field.code.pivot);
                return constant == field.range.high || constant == -field.range.low ||
                       constant == pivot;
            });
        CHECK((codes ? is_end : shift));
    }
    // encode, decode, pack, unpack; but nothing can be mistaken in what is one call.
    CHECK(terms.size() > 20);
    CHECK(killed > 100);
}

TEST_CASE("half of the points of what makes codes are at the borders of codes",
          "[round_trip][points]")
{
    const tests::Builder b = tests::packed_skin();
    const ir::Packing& packing = b.module.packings[0];
    constexpr std::size_t count = 4096;
    const auto points_of = [&](ir::FunctionId id) {
        return analyze::points(b.module, ir::entry_point(b.module, id), count);
    };
    // power(8, 127/255): a relative distance of 2^-8 or less is 2^-11 of the base, at most 254
    // codes of which are an eighth of a code.
    const analyze::Points gains = points_of(packing.fields[0].encode);
    std::size_t close = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool at_border = gains.cases[i].values == analyze::Values::at_borders;
        CHECK(at_border == (i % 2 == 0));
        if (!at_border) continue;
        const double position = 127 * std::pow(gains.columns[0][i], 0.125);
        const double off = std::abs(position - std::floor(position) - 0.5);
        CHECK(off < 0.13);
        close += off < 1e-4;
    }
    CHECK(close > count / 8);

    // Both channels of a field, each close to a code or half way to the next. Of points anywhere,
    // one in 500 would be so close.
    const analyze::Points depths = points_of(packing.parameters[6].unpack);
    REQUIRE(depths.columns.size() == 2);
    for (const auto& column : depths.columns) {
        close = 0;
        for (std::size_t i = 0; i < count; i += 2) {
            const double half = 2 * 255 * static_cast<double>(column[i]);
            close += std::abs(half - std::round(half)) < 1e-3;
            CHECK((0 <= column[i] && column[i] <= 1));
        }
        CHECK(close > count / 16);
    }
    // No other function has such points.
    for (const analyze::Case& each : points_of(packing.model.outputs[0].function).cases)
        CHECK(each.values != analyze::Values::at_borders);
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
