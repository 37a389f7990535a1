#include "ir/packings.h"

#include <algorithm>

namespace lobe::tests {

ir::Gbuffer plain_gbuffer(int targets)
{
    ir::Gbuffer gbuffer;
    gbuffer.name = "g";
    gbuffer.module = "m";
    for (int target = 0; target < targets; ++target) {
        gbuffer.targets.push_back({std::string(1, static_cast<char>('a' + target)), "", "", {}});
        for (const char name : {'r', 'g', 'b', 'a'}) {
            ir::Channel channel;
            channel.target = static_cast<std::size_t>(target);
            channel.name = std::string(1, name);
            channel.formats = {{ir::Storage::unorm, 8}};
            channel.exists = {true};
            gbuffer.channels.push_back(channel);
        }
    }
    return gbuffer;
}

ir::Parameter scalar(std::string name, ir::Range range, double default_value)
{
    ir::Parameter parameter;
    parameter.name = std::move(name);
    parameter.type = ir::Type::scalar;
    parameter.quantity = ir::Quantity::number;
    parameter.range = range;
    parameter.default_value = {default_value};
    parameter.module = "m";
    return parameter;
}

ir::Packing laid_out(const ir::Module& module, std::vector<ir::Field> fields)
{
    ir::Packing packing;
    packing.gbuffer = "g";
    packing.module = module.name;
    packing.supported = {true};
    std::size_t channel = 0;
    int free = 8;
    for (ir::Field& field : fields) {
        int left = field.bits;
        while (left > 0) {
            const int bits = std::min(left, free);
            free -= bits;
            left -= bits;
            field.slots.push_back({channel, free, bits});
            if (free > 0) continue;
            free = 8;
            ++channel;
        }
        packing.fields.push_back(std::move(field));
    }
    return packing;
}

ir::Field field(std::uint32_t parameter, int bits, ir::Range range, ir::Code code)
{
    ir::Field field;
    field.parameter = parameter;
    field.bits = bits;
    field.range = range;
    field.code = std::move(code);
    return field;
}

ir::Code power(int exponent, int pivot)
{
    ir::Code code;
    code.kind = ir::Code::Kind::power;
    code.exponent = exponent;
    code.pivot = pivot;
    return code;
}

}  // namespace lobe::tests
