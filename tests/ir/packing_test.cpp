// What is stored comes back: every code, under every rounding, in every layout.
#include "ir/field_functions.h"
#include "ir/packings.h"

#include <catch2/catch.hpp>

#include <cmath>

namespace lobe::tests {
namespace {

using evaluate::Acceptance;
using ir::Code;

/// A module of one parameter in one field from a.r on.
struct Stored {
    ir::Module module;
    ir::Gbuffer gbuffer = plain_gbuffer(2);
    ir::Packing packing;

    Stored(const ir::Parameter& parameter, const ir::Field& field,
           std::vector<ir::ExactRequirement> exact = {})
    {
        module.name = "m";
        module.parameters = {parameter};
        packing = laid_out(module, {field});
        packing.exact = std::move(exact);
        ir::build_functions(module, packing, gbuffer);
        const auto broken = ir::verify(module);
        CAPTURE(broken.value_or(""));
        CHECK(!broken);
    }

    const ir::Field& field() const { return packing.fields[0]; }

    template <class Number>
    std::vector<Number> decoded() const
    {
        return values<Number>(module, field().decode, {all_codes<Number>(field())});
    }
    template <class Number>
    std::vector<Number> encoded(const std::vector<Number>& decoded_values) const
    {
        return values<Number>(module, field().encode, {decoded_values});
    }
    /// All that a device may make of a code.
    Acceptance decoded(int code) const
    {
        const double value = code;
        return values<Acceptance>(module, field().decode, {{Acceptance{value, value, false}}})[0];
    }
};

Code code(Code::Kind kind, int pivot = 0)
{
    Code result;
    result.kind = kind;
    result.pivot = pivot;
    return result;
}

std::string text(const Acceptance& x)
{
    return std::to_string(x.low) + " .. " + std::to_string(x.high) + (x.undefined ? " ?" : "");
}

/// The code of the high end: what is past it decodes to it too.
int top_code(const Stored& stored)
{
    return static_cast<int>(
        values<double>(stored.module, stored.field().encode, {{stored.field().range.high}})[0]);
}

void check_round_trip(const Stored& stored)
{
    const int top = top_code(stored);
    const auto reals = stored.decoded<double>();
    const auto floats = stored.decoded<float>();
    const auto accepted = stored.decoded<Acceptance>();
    const auto codes_of_reals = stored.encoded(reals);
    const auto codes_of_floats = stored.encoded(floats);
    const auto codes_accepted = stored.encoded(accepted);
    const ir::Range range = stored.field().range;
    for (std::size_t at = 0; at < reals.size(); ++at) {
        const int i = static_cast<int>(at);
        CAPTURE(i, reals[at], floats[at], text(accepted[at]), text(codes_accepted[at]));
        // Never outside, for what comes next was proved over the range.
        REQUIRE((reals[at] >= range.low && reals[at] <= range.high));
        REQUIRE(accepted[at].low >= static_cast<double>(static_cast<float>(range.low)));
        REQUIRE(accepted[at].high <= static_cast<double>(static_cast<float>(range.high)));
        REQUIRE((accepted[at].low <= floats[at] && floats[at] <= accepted[at].high));
        if (i > top) continue;
        REQUIRE(codes_of_reals[at] == i);
        REQUIRE(codes_of_floats[at] == static_cast<float>(i));
        REQUIRE(codes_accepted[at] == Acceptance{static_cast<double>(i), static_cast<double>(i)});
        if (i > 0) REQUIRE(reals[at - 1] < reals[at]);
        if (i > 0) REQUIRE(floats[at - 1] < floats[at]);
    }
}

}  // namespace

TEST_CASE("every code of every width comes back under any rounding")
{
    for (int bits = 1; bits <= 12; ++bits) {
        const int last = (1 << bits) - 1;
        CAPTURE(bits);
        for (const ir::Range range : {ir::Range{0, 1}, ir::Range{0, 256}, ir::Range{1, 14},
                                      ir::Range{-2, 0.7}, ir::Range{0.02, 0.9}}) {
            CAPTURE(range.low, range.high);
            const ir::Parameter parameter = scalar("p", range, range.low);
            check_round_trip({parameter, field(0, bits, range)});
            // From the closest codes on, wherever the default is.
            for (const double value : {range.low, (range.low + range.high) / 2, range.high})
                check_round_trip({scalar("p", range, value),
                                  field(0, bits, range, code(Code::Kind::square_root))});
            check_round_trip({parameter, field(0, bits, range, code(Code::Kind::log2))});
            check_round_trip(
                {parameter, field(0, bits, range, code(Code::Kind::linear, last - last / 8))});
            // The first steps above 1 are too small for float next to a 1.
            for (const int exponent : {1, 2, 3, 8})
                if (range.low == 0 || exponent == 1)
                    check_round_trip(
                        {parameter, field(0, bits, range, power(exponent, (last + 1) / 2))});
        }
    }
}

TEST_CASE("a power has the default at its pivot, whatever that is")
{
    for (int bits = 3; bits <= 12; ++bits) {
        const ir::Parameter parameter = scalar("p", {0, 1}, 0.5);
        ir::Field raised = field(0, bits, {0, 0.875});
        CHECK(ir::power_unit(parameter, 0, raised.range) == 0.5);
        for (const int exponent : {2, 3, 8}) {
            CAPTURE(bits, exponent);
            raised.code = power(
                exponent, static_cast<int>(raised.last_code() / std::pow(1.75, 1.0 / exponent)));
            raised.code.unit = 0.5;
            const Stored stored{parameter, raised};
            check_round_trip(stored);
            const auto at = static_cast<std::size_t>(raised.code.pivot);
            CHECK(stored.decoded<Acceptance>()[at] == Acceptance{0.5, 0.5});
        }
    }
    CHECK(ir::power_unit(scalar("p", {0, 1}, 0), 0, {0, 1}) == 1);
}

TEST_CASE("halving codes come back, and the default is exact")
{
    for (int bits = 2; bits <= 12; ++bits) {
        const int last = (1 << bits) - 1;
        for (const auto& [range, carried, value] :
             std::vector<std::tuple<ir::Range, ir::Range, double>>{
                 {{0, 1}, {0, 0.9375}, 0.75}, {{-1, 1}, {-1, 0.9}, 0}, {{1, 14}, {1, 13}, 2}}) {
            CAPTURE(bits, carried.high);
            const ir::Parameter parameter = scalar("p", range, value);
            ir::Field halved = field(0, bits, carried);
            const double halvings =
                std::log2((range.high - value) / (range.high - carried.low)) /
                std::log2((range.high - carried.high) / (range.high - carried.low));
            const int pivot = std::max(1, static_cast<int>(last * halvings));
            halved.code = *ir::halving(parameter, 0, carried, pivot);
            const Stored stored{parameter, halved};
            check_round_trip(stored);
            const auto at = static_cast<std::size_t>(pivot);
            CHECK(stored.decoded<Acceptance>()[at] == Acceptance{value, value});
        }
    }
    const ir::Parameter parameter = scalar("p", {0, 1}, 0.75);
    CHECK_FALSE(ir::halving(parameter, 0, {0, 1}, 1).has_value());
    CHECK_FALSE(ir::halving(parameter, 0, {0, 0.5}, 1).has_value());
    CHECK_FALSE(ir::halving(parameter, 0, {0.75, 0.9}, 1).has_value());
}

TEST_CASE("the finest roots come back, whatever the default")
{
    const ir::Range unit{0, 1};
    for (const double value : {0.0, 0.5, 1.0})
        check_round_trip(
            {scalar("p", unit, value), field(0, 16, unit, code(Code::Kind::square_root))});
}

TEST_CASE("formulas for people say where the pivot is")
{
    const auto formulas = [](const ir::Range& range, double value, const ir::Range& carried,
                             int exponent) {
        const ir::Parameter parameter = scalar("p", range, value);
        ir::Field one = field(0, 4, carried);
        if (exponent == 0) {
            one.code = *ir::halving(parameter, 0, carried, 6);
        } else {
            one.code = power(exponent, 6);
            one.code.unit = ir::power_unit(parameter, 0, carried);
        }
        return std::pair{ir::encode_formula(one), ir::decode_formula(one)};
    };
    using Both = std::pair<std::string, std::string>;
    CHECK(formulas({0, 4}, 0, {0, 4}, 2) == Both{"round(6 * x^(1/2))", "(code / 6)^2"});
    CHECK(formulas({0, 4}, 2, {0, 4}, 2) == Both{"round(6 * (x / 2)^(1/2))", "2 * (code / 6)^2"});
    CHECK(formulas({1, 4}, 2, {1, 4}, 3) == Both{"round(6 * (x - 1)^(1/3))", "1 + (code / 6)^3"});
    CHECK(formulas({-1, 4}, 1, {-1, 4}, 3) ==
          Both{"round(6 * ((x + 1) / 2)^(1/3))", "-1 + 2 * (code / 6)^3"});
    CHECK(formulas({0, 1}, 0.75, {0, 0.9375}, 0) ==
          Both{"round(-3 * log2(1 - x))", "1 - 0.25^(code / 6)"});
    CHECK(formulas({-1, 3}, 1, {-1, 2}, 0) ==
          Both{"round(-6 * log2((3 - x) / 4))", "3 - 4 * 0.5^(code / 6)"});
}

TEST_CASE("a signed field has an exact 0 and exact ends")
{
    for (int bits = 2; bits <= 12; ++bits) {
        // The last three have steps without any rounding, so that no code needs to be cut off but
        // the one that nothing is stored as.
        const double middle = (1 << (bits - 1)) - 1;
        for (const double high : {1.0, 0.3, 5.0, middle, middle / 64, middle * 3}) {
            CAPTURE(bits, high);
            ir::Field signed_field = field(0, bits, {-high, high});
            signed_field.is_signed = true;
            const Stored stored{scalar("p", {-high, high}, 0), signed_field};
            check_round_trip(stored);
            const double end = static_cast<float>(high);
            CHECK(stored.decoded(stored.field().last_code() / 2) == Acceptance{0, 0, false});
            CHECK(stored.decoded(0) == Acceptance{-end, -end, false});
            CHECK(stored.decoded(stored.field().last_code()) == Acceptance{end, end, false});
            CHECK(stored.decoded(stored.field().last_code() + 1) == Acceptance{end, end, false});
        }
    }
}

namespace {

/// u = (x / 256)^(1/2), and a decode that goes past both ends.
Code quadratic(ir::Module& module)
{
    const auto add = [&module](const std::string& name, const auto& result_of) {
        ir::Function function;
        function.name = name;
        function.module = module.name;
        function.kind = ir::Function::Kind::storage;
        function.quantity = ir::Quantity::number;
        function.inputs = {
            {"x", ir::Type::scalar, ir::Quantity::number, {0, 256}, ir::Origin::argument, 0, {}}};
        ir::Writer write;
        function.result = result_of(write, write.graph.input(0, ir::Type::scalar, {}));
        function.graph = std::move(write.graph);
        module.functions.push_back(std::move(function));
        return ir::FunctionId{module.functions.size() - 1};
    };
    Code result;
    result.kind = Code::Kind::declared;
    result.name = "quadratic";
    result.encode = add("quadratic_encode", [](ir::Writer& write, ir::ExprId x) {
        return write.apply(ir::Op::square_root, write.times(x, 1.0 / 256));
    });
    result.decode = add("quadratic_decode", [](ir::Writer& write, ir::ExprId u) {
        return write.add(write.times(write.multiply(u, u), 258), -1);
    });
    return result;
}

}  // namespace

TEST_CASE("no code decodes to a value outside of the range, whatever a declaration says")
{
    for (int bits = 1; bits <= 10; ++bits) {
        const ir::Range range{0, 256};
        ir::Module module;
        module.name = "m";
        module.parameters = {scalar("p", range, 0)};
        const Code declared = quadratic(module);
        ir::Packing packing = laid_out(module, {field(0, bits, range, declared)});
        packing.fields[0].anchors = {{0, 0}};
        ir::build_functions(module, packing, plain_gbuffer(2));
        REQUIRE(!ir::verify(module));
        const auto decoded = values<Acceptance>(module, packing.fields[0].decode,
                                                {all_codes<Acceptance>(packing.fields[0])});
        for (const Acceptance& value : decoded) {
            CAPTURE(bits, text(value));
            REQUIRE((value.low >= 0 && value.high <= 256 && !value.undefined));
        }
        CHECK(decoded.front() == Acceptance{0, 0, false});
        CHECK(decoded.back() == Acceptance{256, 256, false});
    }
}

TEST_CASE("values that must survive decode to one float, wherever they lie")
{
    // Codes of all kinds, with a default on some code; the step between codes is no float.
    const auto check = [](const Stored& stored, double value) {
        const auto lies_on = ir::code_of(stored.field(), value);
        CAPTURE(value, ir::describe(stored.field().code, stored.field().bits));
        REQUIRE(lies_on);
        const double exact = static_cast<float>(value);
        CHECK(stored.decoded(*lies_on) == Acceptance{exact, exact, false});
        CHECK(stored.encoded(std::vector<Acceptance>{{exact, exact, false}})[0] ==
              Acceptance{static_cast<double>(*lies_on), static_cast<double>(*lies_on), false});
    };
    for (int bits = 2; bits <= 12; ++bits) {
        const int last = (1 << bits) - 1;
        CAPTURE(bits);
        for (const int at : {0, 1, last / 3, last / 2, last - 1, last}) {
            const ir::Range unit{0, 1};
            const double fraction = static_cast<double>(at) / last;
            const double other = static_cast<double>(last / 4) / last;
            // One value by the anchor, one by its own code.
            check({scalar("p", unit, fraction), field(0, bits, unit)}, fraction);
            check({scalar("p", unit, fraction), field(0, bits, unit), {{0, other, {}}}}, other);
            const double square = fraction * fraction;
            check({scalar("p", unit, square), field(0, bits, unit, code(Code::Kind::square_root))},
                  square);
            check({scalar("p", unit, 1),
                   field(0, bits, unit, code(Code::Kind::square_root)),
                   {{0, square, {}}}},
                  square);
            const ir::Range gains{0, 256};
            const int pivot = (last + 1) / 2;
            const double cube = std::pow(static_cast<double>(at) / pivot, 3);
            if (cube <= 256) {
                check({scalar("p", gains, cube), field(0, bits, gains, power(3, pivot))}, cube);
                check({scalar("p", gains, 1), field(0, bits, gains, power(3, pivot))}, 1);
            }
            const double power_of_two = std::exp2(static_cast<double>(at) / pivot) - 1;
            check({scalar("p", gains, power_of_two),
                   field(0, bits, gains, code(Code::Kind::log2, pivot))},
                  power_of_two);
            check({scalar("p", gains, 0), field(0, bits, gains, code(Code::Kind::log2, pivot))}, 1);
        }
    }
}

TEST_CASE("ends of a range are exact and values past them stay there")
{
    for (int bits = 1; bits <= 16; ++bits) {
        CAPTURE(bits);
        for (const ir::Range range : {ir::Range{0, 1}, ir::Range{0.1, 0.7}, ir::Range{-3, 12}}) {
            const double middle = (range.low + range.high) / 2;
            for (const Code::Kind kind : {Code::Kind::linear, Code::Kind::square_root}) {
                const Stored stored{scalar("p", range, middle), field(0, bits, range, code(kind))};
                const double low = static_cast<float>(range.low);
                const double high = static_cast<float>(range.high);
                CHECK(stored.decoded(0) == Acceptance{low, low, false});
                CHECK(stored.decoded(stored.field().last_code()) == Acceptance{high, high, false});
                CHECK(stored.encoded<float>({-1e30F, 1e30F}) ==
                      std::vector<float>{0, static_cast<float>(stored.field().last_code())});
            }
        }
    }
}

TEST_CASE("powers begin at 0 and end where they must")
{
    const ir::Range gains{0, 256};
    for (const int exponent : {1, 2, 3, 5, 8}) {
        for (int pivot = 1; pivot <= 255; pivot += 2) {
            CAPTURE(exponent, pivot);
            const Stored stored{scalar("p", gains, 1), field(0, 8, gains, power(exponent, pivot))};
            CHECK(stored.decoded(0) == Acceptance{0, 0, false});
            CHECK(stored.decoded(pivot) == Acceptance{1, 1, false});
            // A code past the last one would spill into the field beside it.
            CHECK(stored.encoded<float>({1e30F})[0] <= 255);
        }
    }
    // The end is a code by itself: (254 / 127)^8.
    const Stored end{scalar("p", gains, 256), field(0, 8, gains, power(8, 127))};
    CHECK(end.decoded(254) == Acceptance{256, 256, false});
    CHECK(end.decoded(255) == Acceptance{256, 256, false});
}

TEST_CASE("whole numbers and conditions are stored as they are")
{
    ir::Parameter times = scalar("times", {-2, 5}, 1);
    times.quantity = ir::Quantity::integer;
    Code whole;
    whole.pivot = 7;
    const Stored stored{times, field(0, 4, {-2, 5}, whole)};
    CHECK(stored.encoded<float>({-2, -1, 0, 5}) == std::vector<float>{0, 1, 2, 7});
    CHECK(values<float>(stored.module, stored.field().decode, {{0, 1, 2, 7}}) ==
          std::vector<float>{-2, -1, 0, 5});

    // Between ends that are none of them.
    times.range = {-1.75, 5.5};
    for (int bits = 3; bits <= 8; ++bits) {
        const Stored between{times, field(0, bits, times.range)};
        for (const float x : between.decoded<float>()) {
            CAPTURE(bits, x);
            REQUIRE((x == std::floor(x) && x >= -1 && x <= 5));
        }
    }

    ir::Parameter lit = scalar("lit", {0, 1}, 0);
    lit.type = ir::Type::boolean;
    lit.quantity = ir::Quantity::boolean;
    const Stored condition{lit, field(0, 1, {0, 1})};
    CHECK(condition.encoded<float>({0, 1}) == std::vector<float>{0, 1});
    CHECK(values<float>(condition.module, condition.field().decode, {{0, 1}}) ==
          std::vector<float>{0, 1});
}

TEST_CASE("functions that store are no roots, and two packings do not share a name")
{
    Stored stored{scalar("p", {0, 1}, 0), field(0, 8, {0, 1})};
    CHECK(stored.module.roots().empty());
    ir::Packing again = stored.packing;
    again.gbuffer = "other";
    ir::build_functions(stored.module, again, stored.gbuffer);
    CHECK(!ir::verify(stored.module));
    CHECK(stored.module[again.fields[0].encode].name == "encode_p_other");
    CHECK(stored.module[again.channels[0].pack].name == "pack_a_r_other");
}

namespace {

/// Numbers that are the same everywhere.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double unit()
    {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }
    int below(int count) { return static_cast<int>(unit() * count); }

private:
    std::uint64_t state_;
};

ir::Field random_field(Random& random, std::uint32_t parameter, const ir::Range& range)
{
    ir::Field result = field(parameter, 1 + random.below(12), range);
    const int last = result.last_code();
    switch (random.below(5)) {
    case 0: result.code = code(Code::Kind::square_root); break;
    case 1: result.code = power(2, last); break;
    case 2: result.code = code(Code::Kind::log2); break;
    case 3: result.code = code(Code::Kind::linear, std::max(1, last - last / 5)); break;
    default: break;
    }
    return result;
}

/// What an 8-bit unorm channel reads after it stored a value.
float through_channel(float value)
{
    return static_cast<float>(std::nearbyint(static_cast<double>(value) * 255) / 255);
}

}  // namespace

TEST_CASE("what is packed is what is unpacked, in layouts of any kind")
{
    Random random{2023};
    for (int round = 0; round < 60; ++round) {
        CAPTURE(round);
        ir::Module module;
        module.name = "m";
        std::vector<ir::Field> fields;
        // A color now and then, one field per component.
        for (std::uint32_t i = 0; i < 4; ++i) {
            const ir::Range range{0, random.below(2) == 0 ? 1.0 : 1 + 5 * random.unit()};
            ir::Parameter parameter = scalar("p" + std::to_string(i), range, range.low);
            if (random.below(4) == 0) {
                parameter.type = ir::Type::vec3;
                parameter.quantity = ir::Quantity::color;
                parameter.default_value.assign(3, 0);
            }
            module.parameters.push_back(parameter);
            for (int k = 0; k < ir::components(parameter.type); ++k) {
                fields.push_back(random_field(random, i, range));
                fields.back().component = k;
            }
        }
        const ir::Gbuffer gbuffer = plain_gbuffer(5);
        ir::Packing packing = laid_out(module, fields);
        ir::build_functions(module, packing, gbuffer);
        REQUIRE(!ir::verify(module));

        // Every code of one field, the others at random.
        for (std::size_t watched = 0; watched < packing.fields.size(); ++watched) {
            const auto codes = all_codes<float>(packing.fields[watched]);
            std::vector<std::vector<float>> stored(packing.fields.size());
            for (std::size_t i = 0; i < packing.fields.size(); ++i)
                for (std::size_t point = 0; point < codes.size(); ++point)
                    stored[i].push_back(i == watched ? codes[point]
                                                     : static_cast<float>(random.below(
                                                           packing.fields[i].last_code() + 1)));
            // Values that those codes mean, and what they mean after a round trip: past the end of
            // a range several codes mean the same.
            std::vector<std::vector<float>> value(packing.fields.size());
            std::vector<std::vector<float>> expected(packing.fields.size());
            for (std::size_t i = 0; i < packing.fields.size(); ++i) {
                const ir::Field& one = packing.fields[i];
                value[i] = values<float>(module, one.decode, {stored[i]});
                expected[i] = values<float>(module, one.decode,
                                            {values<float>(module, one.encode, {value[i]})});
            }

            std::vector<std::vector<float>> channels;
            for (const auto& channel : packing.channels) {
                std::vector<std::vector<float>> inputs;
                for (const ir::Input& input : module[channel.pack].inputs) {
                    REQUIRE(input.origin == ir::Origin::parameter);
                    for (std::size_t i = 0; i < packing.fields.size(); ++i)
                        if (packing.fields[i].parameter == input.which) inputs.push_back(value[i]);
                }
                channels.push_back(values<float>(module, channel.pack, inputs));
                for (float& x : channels.back()) {
                    REQUIRE((x >= 0 && x <= 1));
                    x = through_channel(x);
                }
            }
            for (const auto& parameter : packing.parameters) {
                std::vector<std::vector<float>> inputs;
                for (const std::size_t channel : parameter.channels)
                    inputs.push_back(channels[channel]);
                std::size_t component = 0;
                for (std::size_t i = 0; i < packing.fields.size(); ++i) {
                    if (packing.fields[i].parameter != parameter.parameter) continue;
                    CAPTURE(watched, i);
                    REQUIRE(values<float>(module, parameter.unpack, inputs, component) ==
                            expected[i]);
                    ++component;
                }
            }
        }
    }
}

TEST_CASE("a device can store and read nothing else than the code")
{
    // Every 8-bit code of a channel that two fields share with a third one.
    ir::Module module;
    module.name = "m";
    for (const char* name : {"p", "q", "r"}) module.parameters.push_back(scalar(name, {0, 1}, 0));
    ir::Packing packing =
        laid_out(module, {field(0, 5, {0, 1}), field(1, 6, {0, 1}), field(2, 13, {0, 1})});
    ir::build_functions(module, packing, plain_gbuffer(1));
    for (const auto& parameter : packing.parameters) {
        const ir::Field& one = packing.fields[parameter.parameter];
        const auto decoded = values<Acceptance>(module, one.decode, {all_codes<Acceptance>(one)});
        for (int at = 0; at < 256; ++at) {
            // Nothing is promised of the last bit of what a channel reads.
            const double read = at / 255.0;
            const Acceptance input{std::max(0.0, read - 0x1p-20), std::min(1.0, read + 0x1p-20),
                                   false};
            const std::vector<std::vector<Acceptance>> inputs(parameter.channels.size(), {input});
            const Acceptance value = values<Acceptance>(module, parameter.unpack, inputs)[0];
            int code = 0;
            for (const ir::Slot& slot : one.slots)
                code = code << slot.bits | ((at >> slot.low) & ((1 << slot.bits) - 1));
            CAPTURE(at, code);
            REQUIRE(value == decoded[static_cast<std::size_t>(code)]);
        }
    }
    for (const auto& channel : packing.channels) {
        const auto count = module[channel.pack].inputs.size();
        for (int at = 0; at <= 1000; ++at) {
            const double x = at / 1000.0;
            const std::vector<std::vector<Acceptance>> inputs(count, {{x, x, false}});
            const Acceptance stored = values<Acceptance>(module, channel.pack, inputs)[0];
            CAPTURE(x, text(stored));
            // Halfway between two codes a device may take either; nowhere else.
            const double low = stored.low * 255;
            const double high = stored.high * 255;
            REQUIRE(stored.high <= 1);
            REQUIRE(std::abs(low - std::round(low)) < 1e-4);
            REQUIRE(std::abs(high - std::round(high)) < 1e-4);
        }
    }
}

}  // namespace lobe::tests
