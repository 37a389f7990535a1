#include "analyze/packing/round_trip.h"

#include "analyze/random.h"
#include "evaluate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using Codes = std::vector<std::uint32_t>;  ///< one per packed channel

template <class Number>
using Table = std::vector<std::vector<Number>>;  ///< columns

void run_tape(const evaluate::Tape& tape, const Table<double>& in, Table<double>& out)
{
    std::vector<const double*> inputs;
    for (const auto& column : in) inputs.push_back(column.data());
    std::vector<double*> outputs;
    for (auto& column : out) outputs.push_back(column.data());
    evaluate::run(tape, evaluate::Columns<double>{inputs}, evaluate::Results<double>{outputs}, 1);
}

/// Which codes a field has: those of its range. Others decode to an end of it.
struct Reach {
    std::uint32_t least = 0;
    std::uint32_t most = 0;
};

Reach reach_of(const ir::Module& module, const ir::Field& field)
{
    const evaluate::Tape tape = evaluate::compile(module, module[field.encode]);
    const auto code_of = [&](double value) {
        Table<double> out(1, std::vector<double>(1));
        run_tape(tape, {{value}}, out);
        return static_cast<std::uint32_t>(std::lround(out[0][0]));
    };
    const std::uint32_t a = code_of(field.range.low);
    const std::uint32_t b = code_of(field.range.high);
    return {std::min(a, b), std::max(a, b)};
}

/// A packing in whole numbers.
class Bits {
public:
    Bits(const ir::Module& module, const ir::Packing& packing)
        : packing_(packing), gbuffer_(*module.find_gbuffer(packing.gbuffer))
    {
        for (const auto& channel : packing.channels)
            last_.push_back((1u << ir::channel_bits(packing, gbuffer_.channels[channel.channel])) -
                            1);
        for (const ir::Field& field : packing.fields) reaches_.push_back(reach_of(module, field));
    }

    std::size_t channels() const { return last_.size(); }
    const Codes& last() const { return last_; }
    std::string name(std::size_t channel) const
    {
        return gbuffer_.name_of(gbuffer_.channels[packing_.channels[channel].channel]);
    }

    /// What has to be in the channels after these codes were unpacked and packed again.
    Codes expected(const Codes& codes) const
    {
        Codes out(codes.size());
        for (std::size_t i = 0; i < packing_.fields.size(); ++i) {
            const ir::Field& field = packing_.fields[i];
            put(field, std::clamp(get(field, codes), reaches_[i].least, reaches_[i].most), out);
        }
        return out;
    }

    std::uint32_t get(const ir::Field& field, const Codes& codes) const
    {
        std::uint32_t code = 0;
        for (const ir::Slot& slot : field.slots)
            code = code << slot.bits | (codes[index_of(slot)] >> slot.low & mask(slot));
        return code;
    }

    void put(const ir::Field& field, std::uint32_t code, Codes& codes) const
    {
        for (std::size_t i = field.slots.size(); i-- > 0;) {
            const ir::Slot& slot = field.slots[i];
            std::uint32_t& channel = codes[index_of(slot)];
            channel = (channel & ~(mask(slot) << slot.low)) | (code & mask(slot)) << slot.low;
            code >>= slot.bits;
        }
    }

private:
    static std::uint32_t mask(const ir::Slot& slot) { return (1u << slot.bits) - 1; }

    std::size_t index_of(const ir::Slot& slot) const
    {
        const auto found = std::ranges::find(packing_.channels, slot.channel,
                                             &ir::Packing::PackedChannel::channel);
        return static_cast<std::size_t>(found - packing_.channels.begin());
    }

    const ir::Packing& packing_;
    const ir::Gbuffer& gbuffer_;
    Codes last_;
    std::vector<Reach> reaches_;
};

/// What a channel with this code reads: the nearest float, or the float beside it, which is what
/// the conversion of a device may make of it.
float reading(std::uint32_t code, std::uint32_t last, int neighbor)
{
    const auto nearest = static_cast<float>(static_cast<double>(code) / static_cast<double>(last));
    if (neighbor == 0) return nearest;
    return std::clamp(std::nextafter(nearest, neighbor < 0 ? -1.0f : 2.0f), 0.0f, 1.0f);
}

/// The points, in order; returns how many codes they are about.
template <class Add>
std::size_t for_each_code(const Bits& bits, const ir::Packing& packing, const Add& add)
{
    std::size_t codes = 0;
    // The other channels hold anything: no field may hear another.
    const auto anything = [&] {
        Random random{codes};
        Codes all;
        for (const std::uint32_t last : bits.last()) all.push_back(random.below(last + 1));
        return all;
    };
    for (std::size_t channel = 0; channel < bits.channels(); ++channel)
        for (std::uint32_t code = 0; code <= bits.last()[channel]; ++code) {
            Codes all = anything();
            all[channel] = code;
            add(all);
            ++codes;
        }
    for (const ir::Field& field : packing.fields) {
        if (field.slots.size() < 2) continue;
        for (std::uint32_t code = 0; code < 1u << field.bits; ++code) {
            Codes all = anything();
            bits.put(field, code, all);
            add(all);
            ++codes;
        }
    }
    return codes;
}

void run_numbers(const evaluate::Tape& tape, evaluate::Columns<float> in,
                 evaluate::Results<float> out, std::size_t count)
{
    evaluate::run(tape, in, out, count);
}

void run_numbers(const evaluate::Tape& tape, evaluate::Columns<evaluate::Acceptance> in,
                 evaluate::Results<evaluate::Acceptance> out, std::size_t count)
{
    evaluate::run_acceptance(tape, evaluate::Precision::float32, in, out, count);
}

/// Every parameter unpacked from the readings, every channel packed from the parameters: the
/// columns that a device has as outputs.
template <class Number>
Table<Number> run_all(const ir::Module& module, const ir::Packing& packing,
                      const Table<Number>& readings, std::size_t count)
{
    Table<Number> stored;
    Table<Number> values;
    std::vector<std::size_t> first_value;  // per Packing::parameters
    const auto run = [&](ir::FunctionId id, const std::vector<const Number*>& in,
                         Table<Number>& results) {
        const evaluate::Tape tape = evaluate::compile(module, module[id]);
        std::vector<Number*> out;
        const std::size_t before = results.size();
        results.resize(before + tape.outputs.size(), std::vector<Number>(count));
        for (std::size_t i = before; i < results.size(); ++i) out.push_back(results[i].data());
        run_numbers(tape, evaluate::Columns<Number>{in}, evaluate::Results<Number>{out}, count);
    };
    for (const auto& parameter : packing.parameters) {
        std::vector<const Number*> in;
        for (const std::size_t channel : parameter.channels) in.push_back(readings[channel].data());
        first_value.push_back(values.size());
        run(parameter.unpack, in, values);
    }
    for (const auto& channel : packing.channels) {
        std::vector<const Number*> in;
        for (const ir::Input& input : module[channel.pack].inputs) {
            const auto found = std::ranges::find(packing.parameters, input.which,
                                                 &ir::Packing::UnpackedParameter::parameter);
            const std::size_t first =
                first_value[static_cast<std::size_t>(found - packing.parameters.begin())];
            for (int k = 0; k < ir::components(input.type); ++k)
                in.push_back(values[first + static_cast<std::size_t>(k)].data());
        }
        run(channel.pack, in, stored);
    }
    std::ranges::move(values, std::back_inserter(stored));
    return stored;
}

/// The code that a channel would store.
std::uint32_t code_of(double stored, std::uint32_t last)
{
    const double code = std::floor(stored * last + 0.5);
    // What is no number, or out of reach, is no code.
    return code >= 0 && code <= last ? static_cast<std::uint32_t>(code)
                                     : std::numeric_limits<std::uint32_t>::max();
}

LostCode lost_code(const TripReference& reference, std::size_t point, std::size_t channel,
                   double stored)
{
    LostCode out;
    out.channel = reference.names[channel];
    for (std::size_t i = 0; i < reference.names.size(); ++i) {
        const double reading = reference.input[point * reference.names.size() + i];
        out.stored += fmt::format("{}{} = {}/{}", i == 0 ? "" : ", ", reference.names[i],
                                  std::lround(reading * reference.last[i]), reference.last[i]);
    }
    out.expected = reference.expected[point * reference.names.size() + channel];
    out.returned = stored * reference.last[channel];
    return out;
}

}  // namespace

bool RoundTrip::ok() const
{
    return failure.empty() && processor.ok() && direct.ok() && optimized.ok() &&
           std::ranges::all_of(judgements, &Judgement::accepted);
}

TripReference trip_reference(const ir::Module& module, std::size_t index)
{
    const ir::Packing& packing = module.packings[index];
    const Bits bits{module, packing};
    TripReference out;
    out.last = bits.last();
    for (std::size_t i = 0; i < bits.channels(); ++i) out.names.push_back(bits.name(i));

    RoundTrip& outcome = out.outcome;
    outcome.packing = fmt::format("{} on {}", packing.model.name, packing.gbuffer);
    outcome.channels = bits.channels();
    outcome.codes = for_each_code(bits, packing, [&](const Codes& codes) {
        const Codes expected = bits.expected(codes);
        for (const int neighbor : {0, -1, 1}) {
            for (std::size_t i = 0; i < codes.size(); ++i)
                out.input.push_back(reading(codes[i], bits.last()[i], neighbor));
            out.expected.insert(out.expected.end(), expected.begin(), expected.end());
            ++outcome.points;
        }
    });

    const std::size_t count = outcome.points;
    Table<float> readings(bits.channels(), std::vector<float>(count));
    Table<evaluate::Acceptance> exact(bits.channels(), std::vector<evaluate::Acceptance>(count));
    for (std::size_t point = 0; point < count; ++point)
        for (std::size_t i = 0; i < bits.channels(); ++i) {
            const float reading = out.input[point * bits.channels() + i];
            readings[i][point] = reading;
            exact[i][point] = {reading, reading, false};
        }
    const Table<float> results = run_all(module, packing, readings, count);
    const Table<evaluate::Acceptance> allowed = run_all(module, packing, exact, count);
    out.outputs = results.size();
    out.results.resize(count * out.outputs);
    out.allowed.resize(count * out.outputs);
    for (std::size_t point = 0; point < count; ++point)
        for (std::size_t i = 0; i < out.outputs; ++i) {
            out.results[point * out.outputs + i] = results[i][point];
            out.allowed[point * out.outputs + i] = allowed[i][point];
        }

    outcome.processor = compare(out, out.results);
    for (std::size_t point = 0; point < count; ++point) {
        bool promised = true;
        for (std::size_t i = 0; i < bits.channels(); ++i) {
            const evaluate::Acceptance& interval = out.allowed[point * out.outputs + i];
            const std::uint32_t expected = out.expected[point * bits.channels() + i];
            promised &= !interval.undefined && code_of(interval.low, out.last[i]) == expected &&
                        code_of(interval.high, out.last[i]) == expected;
        }
        outcome.promised += promised;
    }
    return out;
}

Trip compare(const TripReference& reference, std::span<const float> results)
{
    const std::size_t channels = reference.names.size();
    Trip out;
    for (std::size_t point = 0; point < reference.points(); ++point) {
        bool lost = false;
        bool outside = false;
        bool other = false;
        for (std::size_t i = 0; i < reference.outputs; ++i) {
            const float result = results[point * reference.outputs + i];
            const evaluate::Acceptance& allowed = reference.allowed[point * reference.outputs + i];
            outside |= !allowed.undefined && !(allowed.low <= result && result <= allowed.high);
            if (i >= channels) continue;
            const float on_cpu = reference.results[point * reference.outputs + i];
            other |= std::bit_cast<std::uint32_t>(result) != std::bit_cast<std::uint32_t>(on_cpu);
            if (code_of(result, reference.last[i]) == reference.expected[point * channels + i])
                continue;
            lost = true;
            if (!out.example) out.example = lost_code(reference, point, i, result);
        }
        out.lost += lost;
        out.outside += outside;
        out.other_bits += other;
    }
    return out;
}

RoundTrip round_trip(const ir::Module& module, const Sources& sources, std::size_t packing,
                     const emit::Target& target, const TripReference& reference,
                     device::Device* device)
{
    RoundTrip out = reference.outcome;
    out.target = target.name;
    const emit::Harness harness = emit::packing_harness(module, sources, packing, target);
    Judged judged = judge_harness(harness, target, emit::Precision::float32);
    out.judgements = std::move(judged.judgements);
    if (device == nullptr || judged.direct.empty()) return out;

    std::vector<float> results;
    const auto run = [&](const std::vector<std::uint32_t>& spirv, Trip& trip) {
        // NaN where nothing is written: a shader that skips points is caught.
        results.assign(reference.outputs * reference.points(),
                       std::numeric_limits<float>::quiet_NaN());
        if (const auto why = device->run(spirv, harness.entry, reference.input, results,
                                         static_cast<std::uint32_t>(reference.points())))
            out.failure = *why;
        else
            trip = compare(reference, results);
    };
    run(judged.direct, out.direct);
    if (out.failure.empty()) run(judged.optimized, out.optimized);
    out.executed = out.failure.empty();
    return out;
}

}  // namespace lobe::analyze
