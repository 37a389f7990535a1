#include "analyze/suggest.h"

#include "analyze/give_ups.h"
#include "analyze/layout.h"
#include "analyze/packing_text.h"
#include "analyze/sharing.h"
#include "optimize/optimize.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {
namespace {

constexpr int most_field_bits = 12;  ///< of one component; more than any error here can use

int bits_in(const std::vector<ir::Slot>& slots)
{
    int bits = 0;
    for (const ir::Slot& slot : slots) bits += slot.bits;
    return bits;
}

std::string percent(double error) { return fmt::format("{:.3g} %", error * 100); }

/// Ranges and declared codes of the fields that `from` has; a parameter without one is carried
/// whole.
std::vector<Placed> to_place(const ir::Module& module, const ir::Packing& from,
                             const std::vector<std::uint32_t>& parameters)
{
    std::vector<Placed> placed;
    for (const std::uint32_t parameter : parameters) {
        const ir::Parameter& declared = module.parameters[parameter];
        Placed& one = placed.emplace_back();
        one.parameter = parameter;
        one.components = ir::components(declared.type);
        one.range = declared.quantity == ir::Quantity::boolean ? ir::Range{0, 1} : declared.range;
        for (const ir::Field& field : from.fields) {
            if (field.parameter != parameter) continue;
            one.range = field.range;
            const bool known = std::ranges::find(one.declared, field.code) != one.declared.end();
            if (field.code.kind == ir::Code::Kind::declared && !known)
                one.declared.push_back(field.code);
        }
    }
    return placed;
}

/// Fields in their slots, for options of the curves. All of it fits, by the sum of the bits.
ir::Packing laid_out(const Subject& subject, const std::vector<FittedCurve>& curves,
                     const Shared& shared, const std::vector<ir::Slot>& slots)
{
    ir::Packing packing = subject.packing;
    std::vector<int> bits;
    for (std::size_t i = 0; i < curves.size(); ++i)
        for (int k = 0; k < subject.placed[i].components; ++k) {
            const CurvePoint& point = curves[i][shared.options[i]].point;
            packing.fields.push_back(field_of(subject.placed[i], k, point));
            bits.push_back(point.bits);
        }
    const auto places = lay_out(bits, slots);
    for (std::size_t i = 0; i < packing.fields.size(); ++i) packing.fields[i].slots = (*places)[i];
    std::ranges::stable_sort(packing.fields, [](const ir::Field& a, const ir::Field& b) {
        if (a.slots[0].channel != b.slots[0].channel)
            return a.slots[0].channel < b.slots[0].channel;
        return a.slots[0].low > b.slots[0].low;
    });
    return packing;
}

/// Every parameter in 8 linear bits per component, each in a channel of its own that no engine has.
PackingErrors linear_errors(const ir::Module& module, const Subject& subject,
                            const RadianceOptions& options)
{
    ir::Module copy = module;
    copy.packings.clear();
    ir::Packing packing = subject.packing;
    packing.supported = {true};
    ir::Gbuffer gbuffer;
    gbuffer.targets.push_back({"linear", "", "", {}});
    for (const Placed& placed : subject.placed)
        for (int k = 0; k < placed.components; ++k) {
            ir::Channel channel;
            channel.name = fmt::format("c{}", gbuffer.channels.size());
            channel.formats = {{ir::Storage::unorm, 8}};
            channel.exists = {true};
            packing.fields.push_back(field_of(placed, k, {8, false, {}, 0}));
            packing.fields.back().slots = {{gbuffer.channels.size(), 0, 8}};
            gbuffer.channels.push_back(std::move(channel));
        }
    ir::build_functions(copy, packing, gbuffer);
    copy.packings.push_back(packing);
    const ir::Module legal = optimize::optimize(copy);
    return packing_errors(legal, legal.packings.back(), options);
}

void add_packing(Suggestion& out, ir::Packing packing, const RadianceOptions& options)
{
    ir::build_functions(out.module, packing, *out.module.find_gbuffer(packing.gbuffer));
    out.module.packings.push_back(packing);
    const ir::Module legal = optimize::optimize(out.module);
    out.errors = packing_errors(legal, legal.packings.back(), options);

    std::vector<std::string> remarks;
    for (const ir::Field& field : packing.fields)
        for (const PackingErrors::OfParameter& one : out.errors.parameters)
            if (one.parameter == field.parameter)
                remarks.push_back(field.component == 0 ? percent(one.error.worst) : "");
    out.text = packing_text(out.module, packing, remarks);
}

/// The layout to suggest: the smallest that is good enough, or else the best.
const Shared* choose(const std::vector<Shared>& trade, std::optional<double> error)
{
    const Shared* best = nullptr;
    for (const Shared& shared : trade) {
        if (error && shared.measured < *error) return &shared;
        if (best == nullptr || shared.measured < best->measured) best = &shared;
    }
    return best;
}

std::string needs_too_much(const ir::Module& module, const Subject& subject,
                           const std::vector<FittedCurve>& curves, int bits)
{
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (!curves[i].empty()) continue;
        const Placed& placed = subject.placed[i];
        return fmt::format(
            "no code of up to {} bits keeps what has to stay exact of `{}` over [{}, {}]",
            most_field_bits, module.parameters[placed.parameter].name, placed.range.low,
            placed.range.high);
    }
    return fmt::format("{} parameters need at least {} bits for what has to stay exact; {} are "
                       "there",
                       curves.size(), *least_bits(subject, curves), bits);
}

}  // namespace

Suggestion suggest(const ir::Module& module, std::size_t packing, const SuggestOptions& options)
{
    const unsigned jobs = options.radiance.jobs;
    constexpr std::size_t stages = 5;
    const auto progress = [&](std::size_t done) {
        if (options.progress) options.progress(done, stages);
    };
    progress(0);
    const ir::Packing& from = module.packings[packing];
    Suggestion out;
    out.module = module;
    const Subject subject = subject_of(module, from, to_place(module, from, options.parameters));
    const int bits = bits_in(options.room);

    std::vector<std::size_t> everything(subject.placed.size());
    for (std::size_t i = 0; i < everything.size(); ++i) everything[i] = i;
    const auto curves = fit_curves(subject, everything, most_field_bits, jobs);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        Curve& curve = out.curves.emplace_back();
        curve.parameter = subject.placed[i].parameter;
        for (const Fitted& fitted : curves[i]) curve.points.push_back(fitted.point);
    }
    progress(1);

    std::vector<ShareQuestion> questions;
    if (const auto least = least_bits(subject, curves))
        for (int some = *least; some <= bits; ++some)
            questions.push_back({&subject, &curves, some});
    std::vector<Shared> trade;
    for (const auto& answer : best_shares(questions, jobs)) {
        // With more bits than are of use, the same again.
        if (!answer || (!trade.empty() && answer->bits <= trade.back().bits)) continue;
        trade.push_back(*answer);
        TradePoint& point = out.trade.emplace_back();
        point.bits = answer->bits;
        point.predicted = answer->predicted;
        point.measured = answer->measured;
        for (std::size_t i = 0; i < curves.size(); ++i)
            point.shares.push_back(bits_of(subject, i, curves[i][answer->options[i]]));
    }
    progress(2);

    const Shared* chosen = choose(trade, options.error);
    if (chosen != nullptr) {
        ir::Packing found = laid_out(subject, curves, *chosen, options.room);
        if (found.radiance_limit && chosen->measured >= *found.radiance_limit)
            found.radiance_limit.reset();
        add_packing(out, std::move(found), options.radiance);
        out.linear = linear_errors(module, subject, options.radiance);
        out.found = !options.error || out.errors.whole.worst < *options.error;
        if (!out.found)
            out.why_not =
                fmt::format("no layout in {} bits stays below {}; the best reaches {}", bits,
                            percent(*options.error), percent(out.errors.whole.worst));
    } else {
        out.why_not = needs_too_much(module, subject, curves, bits);
    }
    progress(3);
    const auto error =
        chosen != nullptr ? std::optional{out.errors.whole.worst} : std::optional<double>{};
    out.give_ups = give_ups(module, subject, curves, options, most_field_bits, error);
    progress(stages);
    return out;
}

std::vector<ir::Slot> room(const ir::Gbuffer& gbuffer, const ir::Packing& packing)
{
    std::vector<ir::Slot> slots;
    for (const ir::Room& free : ir::free_channels(gbuffer, packing.supported, packing.without))
        slots.push_back({free.channel, 0, free.bits});
    return slots;
}

}  // namespace lobe::analyze
