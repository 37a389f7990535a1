// What was checked of stored values is what is emitted: the passes leave the codes alone.
#include "ir/packings.h"
#include "optimize/optimize.h"

#include <catch2/catch.hpp>

namespace lobe::tests {
namespace {

using evaluate::Acceptance;
using ir::Code;

ir::Code code(Code::Kind kind, int pivot = 0)
{
    ir::Code result;
    result.kind = kind;
    result.pivot = pivot;
    return result;
}

}  // namespace

TEST_CASE("optimized codes are the codes that were checked, on any device")
{
    for (const ir::Range range : {ir::Range{0, 1}, ir::Range{0, 256}, ir::Range{-0.3, 2.7}}) {
        for (const double part : {0.0, 0.2, 1.0}) {
            const double value = range.low + part * (range.high - range.low);
            // Wider than what is carried: there is an end to halve the distance to.
            const ir::Parameter parameter = scalar("p", {range.low, range.high * 1.125}, value);
            std::vector<Code> codes_of_all_kinds{Code{},
                                                 code(Code::Kind::linear, 250),
                                                 code(Code::Kind::square_root),
                                                 power(1, 127),
                                                 power(3, 127),
                                                 power(8, 127),
                                                 code(Code::Kind::log2),
                                                 code(Code::Kind::log2, 31)};
            // With the default at the pivot.
            for (const int exponent : {2, 3, 8}) {
                codes_of_all_kinds.push_back(power(exponent, 100));
                codes_of_all_kinds.back().unit = ir::power_unit(parameter, 0, range);
            }
            if (const auto halved = ir::halving(parameter, 0, range, 31))
                codes_of_all_kinds.push_back(*halved);
            CHECK(codes_of_all_kinds.size() == (part == 0 ? 11 : 12));
            for (const Code& one : codes_of_all_kinds) {
                ir::Module module;
                module.name = "m";
                module.parameters = {parameter};
                module.packings = {laid_out(module, {field(0, 8, range, one)})};
                ir::Packing& packing = module.packings[0];
                packing.exact = {{0, range.low + 1, {}}};
                ir::build_functions(module, packing, plain_gbuffer(1));
                const ir::Module after = optimize::optimize(module);
                CAPTURE(range.low, range.high, value, ir::describe(one, 8));
                const ir::Field& before_field = module.packings[0].fields[0];
                const ir::Field& after_field = after.packings[0].fields[0];
                const auto codes = all_codes<Acceptance>(before_field);
                const auto decoded = values<Acceptance>(module, before_field.decode, {codes});
                CHECK(values<Acceptance>(after, after_field.decode, {codes}) == decoded);
                CHECK(values<Acceptance>(after, after_field.encode, {decoded}) ==
                      values<Acceptance>(module, before_field.encode, {decoded}));

                // Stored and read as a whole; a channel reads code / 255.
                std::vector<Acceptance> stored;
                for (const Acceptance& x : codes)
                    stored.push_back({x.low / 255, x.low / 255, false});
                const ir::FunctionId unpack = module.packings[0].parameters[0].unpack;
                const ir::FunctionId unpack_after = after.packings[0].parameters[0].unpack;
                CHECK(values<Acceptance>(after, unpack_after, {stored}) ==
                      values<Acceptance>(module, unpack, {stored}));
                const ir::FunctionId pack = module.packings[0].channels[0].pack;
                const ir::FunctionId pack_after = after.packings[0].channels[0].pack;
                CHECK(values<Acceptance>(after, pack_after, {decoded}) ==
                      values<Acceptance>(module, pack, {decoded}));
            }
        }
    }
}

}  // namespace lobe::tests
