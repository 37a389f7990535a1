#include "analyze/packing/suggest.h"

#include "analyze/packing/give_ups.h"
#include "analyze/packing/layout.h"
#include "analyze/packing/packing_text.h"
#include "analyze/packing/sharing.h"
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
            if (field.code.kind == ir::Code::Kind::declared) one.declared.push_back(field);
        }
    }
    return placed;
}

/// Fields in their slots, for options of the curves. All of it fits, by the sum of the bits.
ir::Packing laid_out(const CodeSearch& subject, const std::vector<FittedCurve>& curves,
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
PackingErrors linear_errors(const ir::Module& module, const CodeSearch& subject,
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

/// Module, errors and text for one choice of options.
void take(Suggestion& out, const ir::Module& module, const CodeSearch& subject,
          const std::vector<FittedCurve>& curves, const Shared& shared,
          const SuggestOptions& options)
{
    ir::Packing packing = laid_out(subject, curves, shared, options.room);
    out.module = module;
    ir::build_functions(out.module, packing, *out.module.find_gbuffer(packing.gbuffer));
    out.module.packings.push_back(packing);
    const ir::Module legal = optimize::optimize(out.module);
    out.errors = packing_errors(legal, legal.packings.back(), options.radiance);
    ir::Packing& placed = out.module.packings.back();
    if (placed.radiance_limit && out.errors.whole.worst >= *placed.radiance_limit)
        placed.radiance_limit.reset();

    std::vector<std::string> remarks;
    for (const ir::Field& field : placed.fields)
        for (const PackingErrors::OfParameter& one : out.errors.parameters)
            if (one.parameter == field.parameter)
                remarks.push_back(field.component == 0 ? percent(one.error.worst) : "");
    out.text = packing_text(out.module, placed, remarks);
}

/// Takes the smallest layout that stays below the error, or else the best. Returns the one taken;
/// its measured error is then that of the whole measurement.
const Shared* take_best(Suggestion& out, const ir::Module& module, const CodeSearch& subject,
                        const std::vector<FittedCurve>& curves, std::vector<Shared>& trade,
                        const SuggestOptions& options)
{
    const auto taken = [&](Shared& shared) {
        take(out, module, subject, curves, shared, options);
        shared.measured = out.errors.whole.worst;
        return options.error && shared.measured < *options.error;
    };
    for (Shared& shared : trade)
        if (options.error && shared.measured < *options.error && taken(shared)) return &shared;
    if (trade.empty()) return nullptr;
    std::vector<std::vector<float>> known;
    for (const Shared& shared : trade) known.push_back(shared.worst);
    Shared best = improved(subject, curves, trade.back(), bits_in(options.room), known,
                           options.radiance.jobs);
    while (!trade.empty() && trade.back().bits >= best.bits) trade.pop_back();
    trade.push_back(std::move(best));
    taken(trade.back());
    return &trade.back();
}

std::string needs_too_much(const ir::Module& module, const CodeSearch& subject,
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
    const CodeSearch subject = subject_of(module, from, to_place(module, from, options.parameters));
    const int bits = bits_in(options.room);

    std::vector<std::size_t> everything(subject.placed.size());
    for (std::size_t i = 0; i < everything.size(); ++i) everything[i] = i;
    const auto curves = fit_curves(subject, everything, {1, most_field_bits}, jobs);
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
        // With more bits nothing has to become worse: what is not better is the same again.
        if (answer && (trade.empty() || answer->measured < trade.back().measured))
            trade.push_back(*answer);
    }
    progress(2);

    const Shared* chosen = take_best(out, module, subject, curves, trade, options);
    if (chosen != nullptr) {
        out.linear = linear_errors(module, subject, options.radiance);
        out.found = !options.error || chosen->measured < *options.error;
        if (!out.found)
            out.why_not = fmt::format("no layout in {} bits stays below {}; the best reaches {}",
                                      bits, percent(*options.error), percent(chosen->measured));
    } else {
        out.why_not = needs_too_much(module, subject, curves, bits);
    }
    for (const Shared& shared : trade) {
        TradePoint& point = out.trade.emplace_back();
        point = {shared.bits, {}, shared.predicted, shared.measured};
        for (std::size_t i = 0; i < curves.size(); ++i)
            point.shares.push_back(bits_of(subject, i, curves[i][shared.options[i]]));
    }
    progress(3);
    out.give_ups = give_ups(module, subject, curves, options, {chosen, most_field_bits});
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
