// The search for a packing: shares and layouts against all there are, and what it suggests for
// models whose errors are known.
#include "analyze/packing/curves.h"
#include "analyze/packing/layout.h"
#include "analyze/packing/shares.h"
#include "analyze/packing/suggest.h"
#include "analyze/random.h"
#include "analyze/toy.h"
#include "evaluate/run.h"
#include "evaluate/tape.h"
#include "optimize/optimize.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

using namespace lobe;
using analyze::ShareOption;
using Catch::Detail::Approx;
using tests::Toy;

namespace {

using Curves = std::vector<std::vector<ShareOption>>;

struct Total {
    int bits = 0;
    double cost = 0;
    double most = 0;
};

Total total(const Curves& curves, const std::vector<std::size_t>& options)
{
    Total sum;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        sum.bits += curves[i][options[i]].bits;
        sum.cost += curves[i][options[i]].cost;
        sum.most = std::max(sum.most, curves[i][options[i]].cost);
    }
    return sum;
}

/// Calls `visit` with every choice of options that fits.
template <class Visit>
void every_choice(const Curves& curves, int bits, const Visit& visit)
{
    std::vector<std::size_t> options(curves.size());
    for (;;) {
        const Total sum = total(curves, options);
        if (sum.bits <= bits) visit(sum);
        std::size_t i = 0;
        while (i < curves.size() && ++options[i] == curves[i].size()) options[i++] = 0;
        if (i == curves.size()) return;
    }
}

/// Costs are whole numbers, so that sums are exact and ties happen.
Curves random_curves(analyze::Random& random)
{
    Curves curves(1 + random.below(4));
    for (auto& curve : curves) {
        int bits = 0;
        const std::uint32_t count = 1 + random.below(5);
        for (std::uint32_t i = 0; i < count; ++i) {
            bits += 1 + static_cast<int>(random.below(3));
            curve.push_back({bits, static_cast<double>(random.below(12))});
        }
    }
    return curves;
}

}  // namespace

TEST_CASE("bits are shared out as well as they can be", "[suggest]")
{
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        CAPTURE(seed);
        analyze::Random random{seed};
        const Curves curves = random_curves(random);
        const int bits = static_cast<int>(random.below(24));
        constexpr double none = std::numeric_limits<double>::infinity();
        Total best{0, none, none};
        double least_most = none;
        every_choice(curves, bits, [&](const Total& sum) {
            if (sum.cost < best.cost || (sum.cost == best.cost && sum.bits < best.bits)) best = sum;
            least_most = std::min(least_most, sum.most);
        });
        double even_cost = none;
        every_choice(curves, bits, [&](const Total& sum) {
            if (sum.most == least_most) even_cost = std::min(even_cost, sum.cost);
        });

        const auto found = analyze::share(curves, bits);
        const auto even = analyze::share_evenly(curves, bits);
        REQUIRE(found.has_value() == (best.cost < none));
        REQUIRE(even.has_value() == (best.cost < none));
        if (!found) continue;
        CHECK(total(curves, *found).cost == best.cost);
        CHECK(total(curves, *found).bits == best.bits);
        CHECK(total(curves, *even).most == least_most);
        CHECK(total(curves, *even).cost == even_cost);
        CHECK(total(curves, *even).bits <= bits);
    }
}

namespace {

/// The least number of cuts over all orders of the fields, laid one after the other with gaps
/// wherever the next field does not fit: every layout without a field in three pieces is one.
int least_cuts(const std::vector<int>& bits, const std::vector<ir::Slot>& room)
{
    std::vector<std::size_t> order(bits.size());
    std::iota(order.begin(), order.end(), 0);
    int least = 1 << 20;
    const auto lay = [&](auto&& self, std::size_t field, std::size_t slot, int left,
                         int cuts) -> void {
        if (cuts >= least) return;
        if (field == order.size()) {
            least = cuts;
            return;
        }
        if (slot == room.size()) return;
        const int wanted = bits[order[field]];
        if (wanted <= left) {
            self(self, field + 1, slot, left - wanted, cuts);
            return;
        }
        const bool more = slot + 1 < room.size();
        if (more) self(self, field, slot + 1, room[slot + 1].bits, cuts);
        if (more && left > 0 && wanted - left <= room[slot + 1].bits)
            self(self, field + 1, slot + 1, room[slot + 1].bits - (wanted - left), cuts + 1);
    };
    do {
        lay(lay, 0, 0, room[0].bits, 0);
    } while (std::next_permutation(order.begin(), order.end()));
    return least;
}

}  // namespace

TEST_CASE("fields lie in the room, whole where they can", "[suggest]")
{
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        CAPTURE(seed);
        analyze::Random random{seed};
        std::vector<ir::Slot> room;
        int there = 0;
        for (std::size_t channel = 0; channel < 2 + seed % 3; ++channel) {
            const int width = 4 + static_cast<int>(random.below(5));
            room.push_back({channel, static_cast<int>(random.below(3)), width});
            there += width;
        }
        std::vector<int> bits;
        int wanted = 0;
        while (bits.size() < 6) {
            const int more = 1 + static_cast<int>(random.below(8));
            if (wanted + more > there) break;
            bits.push_back(more);
            wanted += more;
        }
        const auto places = analyze::lay_out(bits, room);
        REQUIRE(places);
        REQUIRE(places->size() == bits.size());
        std::vector<std::vector<bool>> used(room.size(), std::vector<bool>(16));
        int cuts = 0;
        bool in_three = false;
        for (std::size_t i = 0; i < bits.size(); ++i) {
            int sum = 0;
            for (const ir::Slot& slot : (*places)[i]) {
                sum += slot.bits;
                const ir::Slot& in = room[slot.channel];
                REQUIRE(slot.low >= in.low);
                REQUIRE(slot.low + slot.bits <= in.low + in.bits);
                for (int bit = slot.low; bit < slot.low + slot.bits; ++bit) {
                    const auto at = static_cast<std::size_t>(bit);
                    REQUIRE_FALSE(used[slot.channel][at]);
                    used[slot.channel][at] = true;
                }
            }
            CHECK(sum == bits[i]);
            cuts += (*places)[i].size() > 1 ? 1 : 0;
            in_three = in_three || (*places)[i].size() > 2;
        }
        const int least = least_cuts(bits, room);
        if (!in_three) CHECK(cuts == least);
        // Three pieces only where nothing else does.
        if (in_three) CHECK(least == 1 << 20);
    }
    CHECK_FALSE(analyze::lay_out({9}, {{0, 0, 8}}));
}

TEST_CASE("a channel is filled from its high bits, a cut field goes on in the next", "[suggest]")
{
    const auto places = analyze::lay_out({6, 6, 4}, {{0, 0, 8}, {1, 0, 8}});
    REQUIRE(places);
    CHECK((*places)[0] == std::vector<ir::Slot>{{0, 2, 6}});
    CHECK((*places)[1] == std::vector<ir::Slot>{{0, 0, 2}, {1, 4, 4}});
    CHECK((*places)[2] == std::vector<ir::Slot>{{1, 0, 4}});
}

namespace {

/// Two gains of unlike range on a GBuffer with two free channels and a lent one.
struct TwoGains : Toy {
    analyze::SuggestOptions options;

    TwoGains()
    {
        module.parameters.clear();
        add_parameter("gain", {0, 256}, 1);
        add_parameter("sheen", {0, 4}, 1);
        use_gain();
        tests::FunctionBuilder f{"shining"};
        const auto cosine = f.geometry(ir::GeometryField::cos_o);
        const auto sheen = f.parameter(module, 1);
        const auto both = f(ir::Op::multiply, {cosine, sheen});
        packing.model.outputs.push_back(
            {"specular",
             add(f.finish(f(ir::Op::multiply, {both, f.geometry(ir::GeometryField::cos_i)})))});
        packing.model.module = "toy";
        module.models = {packing.model};

        ir::Gbuffer gbuffer;
        gbuffer.name = "g";
        gbuffer.settings.push_back({"quality", "quality", {"low", "high"}, 0, "", {}});
        gbuffer.targets.push_back({"d", "GBufferD", "", {}});
        for (const char* name : {"r", "g", "b"}) {
            ir::Channel channel;
            channel.name = name;
            channel.field = std::string{"GBuffer."} + name;
            channel.formats = {{ir::Storage::unorm, 8}, {ir::Storage::unorm, 8}};
            channel.exists = {true, true};
            gbuffer.channels.push_back(channel);
        }
        gbuffer.channels[2].holders.push_back({"metallic", "metallic", true, {true, true}, {}});
        module.gbuffers = {gbuffer};
        packing.gbuffer = "g";
        packing.module = "toy";
        packing.supported = {false, true};
        module.packings = {packing};

        options.parameters = {0, 1};
        options.room = analyze::room(module.gbuffers[0], packing);
        options.radiance.points = std::size_t{1} << 12;
    }

    analyze::Suggestion suggest() const { return analyze::suggest(module, 0, options); }
};

float run_one(const ir::Module& module, ir::FunctionId id, float value)
{
    const evaluate::Tape tape = evaluate::compile(module, module[id]);
    const float* const in[] = {&value};
    float result = 0;
    float* const out[] = {&result};
    evaluate::run(tape, evaluate::Columns<float>{in, tape.inputs.size()}, out, 1);
    return result;
}

}  // namespace

TEST_CASE("the room is what is free, and what is lent to those who go without", "[suggest]")
{
    TwoGains toy;
    CHECK(toy.options.room == std::vector<ir::Slot>{{0, 0, 8}, {1, 0, 8}});
    ir::Packing packing = toy.packing;
    packing.without = {"metallic"};
    CHECK(analyze::room(toy.module.gbuffers[0], packing).size() == 3);
    toy.module.gbuffers[0].channels[0].formats[0] = {ir::Storage::floating, 16};
    CHECK(analyze::room(toy.module.gbuffers[0], packing).size() == 3);  // low is not supported
    toy.module.gbuffers[0].channels[0].formats[1] = {ir::Storage::floating, 16};
    CHECK(analyze::room(toy.module.gbuffers[0], packing).size() == 2);
}

TEST_CASE("a suggestion uses the room, keeps defaults and says its error", "[suggest]")
{
    const TwoGains toy;
    const analyze::Suggestion found = toy.suggest();
    INFO(found.text << found.why_not);
    REQUIRE(found.found);
    const ir::Packing& packing = found.module.packings.back();
    REQUIRE(packing.fields.size() == 2);
    int bits = 0;
    for (const ir::Field& field : packing.fields) {
        bits += field.bits;
        const float code = run_one(found.module, field.encode, 1);
        CHECK(run_one(found.module, field.decode, code) == 1);
        // The high end comes back too: nothing of the range is clamped.
        const auto high = static_cast<float>(field.range.high);
        const float top = run_one(found.module, field.encode, high);
        CHECK(run_one(found.module, field.decode, top) >= 0.9F * high);
    }
    CHECK(bits <= 16);

    // The reported error is that of the packing that is handed out.
    const ir::Module legal = optimize::optimize(found.module);
    const auto again = analyze::packing_errors(legal, legal.packings.back(), toy.options.radiance);
    CHECK(again.whole.worst == found.errors.whole.worst);
    CHECK(found.errors.whole.worst > 0);
    CHECK(found.linear.whole.worst > 5 * found.errors.whole.worst);

    // A block that has its fields, and the clause that narrows where it has to work.
    CHECK(found.text.starts_with("packing toy on g {\n  d.r"));
    CHECK(found.text.find("= gain  : unorm ") != std::string::npos);
    CHECK(found.text.find("code power(") != std::string::npos);
    CHECK(found.text.find("  supports quality == high\n") != std::string::npos);
}

TEST_CASE("no share of the bits is better than the one suggested", "[suggest]")
{
    // All 16-bit layouts of two parameters, each measured by itself.
    const TwoGains toy;
    const analyze::Suggestion found = toy.suggest();
    REQUIRE(found.found);
    REQUIRE(found.curves.size() == 2);
    for (const analyze::CurvePoint& a : found.curves[0].points)
        for (const analyze::CurvePoint& b : found.curves[1].points) {
            if (a.bits + b.bits > 16 || a.bits + b.bits < 14) continue;
            CAPTURE(a.bits, b.bits);
            ir::Module module = toy.module;
            ir::Packing packing = toy.packing;
            const auto add = [&](std::uint32_t parameter, const analyze::CurvePoint& point) {
                analyze::Placed placed;
                placed.parameter = parameter;
                placed.range = module.parameters[parameter].range;
                packing.fields.push_back(analyze::field_of(placed, 0, point));
            };
            add(0, a);
            add(1, b);
            const auto places = analyze::lay_out({a.bits, b.bits}, toy.options.room);
            for (std::size_t i = 0; i < 2; ++i) packing.fields[i].slots = (*places)[i];
            ir::build_functions(module, packing, module.gbuffers[0]);
            module.packings = {packing};
            const ir::Module legal = optimize::optimize(module);
            const auto errors =
                analyze::packing_errors(legal, legal.packings[0], toy.options.radiance);
            // Searches differ by little; shares by a factor of about 2 per bit.
            CHECK(errors.whole.worst > 0.95 * found.errors.whole.worst);
        }
}

TEST_CASE("more bits are never predicted to be worse", "[suggest]")
{
    const analyze::Suggestion found = TwoGains{}.suggest();
    REQUIRE(found.trade.size() > 4);
    for (std::size_t i = 1; i < found.trade.size(); ++i) {
        CAPTURE(found.trade[i].bits);
        CHECK(found.trade[i].bits > found.trade[i - 1].bits);
        CHECK(found.trade[i].measured <= found.trade[i - 1].measured * 1.05);
    }
    CHECK(found.trade.back().bits <= 16);
}

TEST_CASE("for an error, the fewest bits that stay below it", "[suggest]")
{
    TwoGains toy;
    toy.options.error = 0.25;
    const analyze::Suggestion found = toy.suggest();
    REQUIRE(found.found);
    CHECK(found.errors.whole.worst < 0.25);
    int bits = 0;
    for (const ir::Field& field : found.module.packings.back().fields) bits += field.bits;
    CHECK(bits < 16);
    for (const analyze::TradePoint& point : found.trade)
        if (point.bits < bits) CHECK(point.measured >= 0.25);
}

TEST_CASE("what does not fit says why, and what would help", "[suggest]")
{
    TwoGains toy;
    toy.options.room = {{0, 0, 2}};
    const analyze::Suggestion cramped = toy.suggest();
    CHECK_FALSE(cramped.found);
    INFO(cramped.why_not);
    CHECK(cramped.why_not.find("2 parameters need at least") != std::string::npos);
    REQUIRE_FALSE(cramped.give_ups.empty());
    CHECK(std::ranges::any_of(cramped.give_ups, [](const std::string& text) {
        return text.starts_with("`without metallic`, 8 bits more: ");
    }));

    toy.options.room = analyze::room(toy.module.gbuffers[0], toy.packing);
    toy.options.error = 1e-9;
    const analyze::Suggestion strict = toy.suggest();
    CHECK_FALSE(strict.found);
    CHECK(strict.why_not.find("no layout in 16 bits stays below") != std::string::npos);
    CHECK(strict.errors.whole.worst > 0);
}

TEST_CASE("a suggestion is the same on any number of threads", "[suggest]")
{
    TwoGains toy;
    toy.options.radiance.jobs = 1;
    const analyze::Suggestion one = toy.suggest();
    toy.options.radiance.jobs = 4;
    const analyze::Suggestion four = toy.suggest();
    CHECK(one.text == four.text);
    CHECK(one.errors.whole.worst == four.errors.whole.worst);
    CHECK(one.give_ups == four.give_ups);
    REQUIRE(one.trade.size() == four.trade.size());
    for (std::size_t i = 0; i < one.trade.size(); ++i)
        CHECK(one.trade[i].measured == four.trade[i].measured);
}

TEST_CASE("a declared code is considered in the bits it was written for", "[suggest]")
{
    // u = (x / 4)^2 and back: 1 lies at 1/16, which is a code of no number of bits below 16, but
    // for what was found of it when it was checked, as here for 4 bits: code 1 of 15 is near.
    TwoGains toy;
    tests::FunctionBuilder encode{"steep_encode"};
    const auto x = encode.argument("x", 0, 4);
    const auto part = encode(ir::Op::multiply, {x, encode.literal("0.25")});
    ir::Field field;
    field.parameter = 1;
    field.bits = 4;
    field.range = {0, 4};
    field.code.kind = ir::Code::Kind::declared;
    field.code.name = "steep";
    field.code.encode = toy.add(encode.finish(encode(ir::Op::multiply, {part, part})));
    tests::FunctionBuilder decode{"steep_decode"};
    const auto u = decode.argument("u", 0, 1);
    const auto root = decode(ir::Op::square_root, {u});
    field.code.decode =
        toy.add(decode.finish(decode(ir::Op::multiply, {root, decode.literal("4")})));
    field.anchors = {{1, 1}};
    analyze::Placed placed;
    placed.parameter = 1;
    placed.range = field.range;
    placed.declared = {field};
    const analyze::CodeSearch subject = analyze::subject_of(toy.module, toy.packing, {placed});
    // Without it: linear over [0, 4] has 1 on a code only where its pivot is a multiple of 4.
    analyze::Placed plain = placed;
    plain.declared.clear();
    const analyze::CodeSearch without = analyze::subject_of(toy.module, toy.packing, {plain});
    const auto with_code = analyze::fit_curves(subject, {0}, {4, 4}, 0)[0];
    const auto without_code = analyze::fit_curves(without, {0}, {4, 4}, 0)[0];
    REQUIRE(with_code.size() == 1);
    REQUIRE(without_code.size() == 1);
    CHECK(with_code[0].point.error <= without_code[0].point.error);
    const ir::Field made = analyze::field_of(placed, 0, {4, false, field.code, 0});
    CHECK(made.anchors == field.anchors);
    CHECK(analyze::field_of(placed, 0, {5, false, field.code, 0}).anchors.empty());
}

TEST_CASE("a pivot is considered where it means the same for all components", "[suggest]")
{
    const auto bits_of = [](const std::vector<double>& standard) {
        Toy toy;
        ir::Parameter& tint = toy.module.parameters[0];
        tint.name = "tint";
        tint.type = ir::Type::vec3;
        tint.quantity = ir::Quantity::color;
        tint.range = {0, 1};
        tint.default_value = standard;
        tests::FunctionBuilder f{"tinted"};
        const auto color = f.parameter(toy.module, 0);
        const auto cosine = f.geometry(ir::GeometryField::cos_i);
        toy.packing.model.outputs.push_back(
            {"diffuse", toy.add(f.finish(f(ir::Op::multiply, {color, cosine})))});
        analyze::Placed placed;
        placed.parameter = 0;
        placed.components = 3;
        placed.range = tint.range;
        const analyze::CodeSearch subject = analyze::subject_of(toy.module, toy.packing, {placed});
        return analyze::fit_curves(subject, {0}, {2, 2}, 0)[0];
    };
    // Of two bits no linear code keeps a quarter.
    const auto alike = bits_of({0.25, 0.25, 0.25});
    REQUIRE(alike.size() == 1);
    CHECK(alike[0].point.code.kind == ir::Code::Kind::power);
    CHECK(alike[0].point.code.unit == 0.25);
    // By the first one's power(2, 1/3), 1 would be code 2, but the second one has it at the pivot.
    CHECK(bits_of({0.25, 1, 0.25}).empty());
}
