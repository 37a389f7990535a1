// What is stored comes back: every code, under every rounding, in every layout.
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
    for (int i = 0; i <= stored.field().last_code(); ++i) {
        const auto at = static_cast<std::size_t>(i);
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
            check_round_trip({parameter, field(0, bits, range, code(Code::Kind::square_root))});
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

TEST_CASE("a signed field has an exact 0 and exact ends")
{
    for (int bits = 2; bits <= 12; ++bits) {
        for (const double high : {1.0, 0.3, 5.0}) {
            CAPTURE(bits, high);
            ir::Field signed_field = field(0, bits, {-high, high});
            signed_field.is_signed = true;
            const Stored stored{scalar("p", {-high, high}, 0), signed_field};
            check_round_trip(stored);
            const double end = static_cast<float>(high);
            CHECK(stored.decoded(stored.field().last_code() / 2) == Acceptance{0, 0, false});
            CHECK(stored.decoded(0) == Acceptance{-end, -end, false});
            CHECK(stored.decoded(stored.field().last_code()) == Acceptance{end, end, false});
        }
    }
}

}  // namespace lobe::tests
