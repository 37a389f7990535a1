#include "analyze/packing/borders.h"

#include "evaluate/run.h"

#include <algorithm>

namespace lobe::analyze {

Borders::Borders(const ir::Module& module, const ir::Function& entry)
{
    const auto id = module.find(entry.name);
    if (!id || module[*id].kind != ir::Function::Kind::storage) return;
    std::vector<std::size_t> first;  // scalar of each input
    std::size_t scalars = 0;
    for (const ir::Input& input : entry.inputs) {
        first.push_back(scalars);
        scalars += static_cast<std::size_t>(ir::components(input.type));
    }
    columns_.resize(scalars);

    for (const ir::Packing& packing : module.packings) {
        const auto packs =
            std::ranges::find(packing.channels, *id, &ir::Packing::PackedChannel::pack);
        for (const ir::Field& field : packing.fields) {
            if (field.encode == *id) add_field(module, field, 0);
            if (packs == packing.channels.end()) continue;
            for (std::size_t i = 0; i < entry.inputs.size(); ++i)
                if (entry.inputs[i].which == field.parameter)
                    add_field(module, field, first[i] + static_cast<std::size_t>(field.component));
        }
        const ir::Gbuffer* gbuffer = module.find_gbuffer(packing.gbuffer);
        for (const auto& parameter : packing.parameters)
            for (std::size_t i = 0; i < parameter.channels.size() && gbuffer != nullptr; ++i) {
                const std::size_t channel = packing.channels[parameter.channels[i]].channel;
                if (parameter.unpack == *id)
                    add_channel(ir::channel_bits(packing, gbuffer->channels[channel]), first[i]);
            }
    }
    if (std::ranges::all_of(columns_, &std::vector<double>::empty)) columns_.clear();
}

/// A value half way between two codes, as decode goes on between them.
void Borders::add_field(const ir::Module& module, const ir::Field& field, std::size_t column)
{
    if (module.parameters[field.parameter].type == ir::Type::boolean) return;
    const evaluate::Tape tape = evaluate::compile(module, module[field.decode]);
    std::vector<double> codes;
    for (int code = 0; code < field.last_code(); ++code) codes.push_back(code + 0.5);
    std::vector<double>& values = columns_[column];
    values.resize(codes.size());
    const double* in[] = {codes.data()};
    double* out[] = {values.data()};
    evaluate::run(tape, evaluate::Columns<double>{in}, evaluate::Results<double>{out},
                  codes.size());
    // Where codes are past the range there is no border.
    std::erase_if(values, [&](double value) {
        return value <= field.range.low || field.range.high <= value;
    });
}

/// Half way between two codes, and on the codes themselves.
void Borders::add_channel(int bits, std::size_t column)
{
    const int last = (1 << bits) - 1;
    for (int half = 0; half <= 2 * last; ++half) columns_[column].push_back(half / (2.0 * last));
}

void Borders::place(Random& random, std::span<double> values) const
{
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const std::vector<double>& borders = columns_[i];
        if (borders.empty()) continue;
        const double border = borders[random.below(static_cast<std::uint32_t>(borders.size()))];
        // From a few floats on up to where codes of 16 bits are further apart than that.
        const double distance = random.magnitude(-22, -8);
        values[i] = border * (random.coin() ? 1 + distance : 1 - distance);
    }
}

}  // namespace lobe::analyze
