#include "analyze/packing/curves.h"

#include "analyze/tasks.h"
#include "optimize/optimize.h"
#include "optimize/specialize.h"

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

constexpr Effort first_look{512, 4, 20};
constexpr Effort second_look{1024, 8, 64};
constexpr std::size_t compared = 2;  ///< candidates that get a second look
constexpr int most_linear = 3;       ///< pivots of linear: the finest steps
constexpr int most_exponent = 12;

// ---- candidates

using Kind = ir::Code::Kind;

ir::Code code_like(Kind kind, const char* name)
{
    ir::Code code;
    code.kind = kind;
    code.name = name;
    return code;
}

/// Every value that has to survive lies on a code.
bool keeps_values(const CodeSearch& subject, const Placed& placed, const CurvePoint& point)
{
    for (int k = 0; k < placed.components; ++k) {
        const ir::Field field = field_of(placed, k, point);
        for (const double value : ir::kept_values(subject.bare, subject.packing, field))
            if (!ir::code_of(field, value)) return false;
    }
    return true;
}

std::vector<CurvePoint> candidates(const CodeSearch& subject, const Placed& placed, int bits)
{
    std::vector<CurvePoint> found;
    const auto consider = [&](bool is_signed, const ir::Code& code) {
        const CurvePoint point{bits, is_signed, code, 0};
        const bool kept = keeps_values(subject, placed, point);
        if (kept) found.push_back(point);
        return kept;
    };
    const int last = (1 << bits) - 1;
    const ir::Range range = placed.range;
    const double size = range.high - range.low;

    int linear = 0;
    for (int pivot = last; pivot >= 1 && linear < most_linear; --pivot) {
        ir::Code code;
        code.pivot = pivot == last ? 0 : pivot;
        if (consider(false, code)) ++linear;
    }
    if (range.low == -range.high && bits >= 2) consider(true, {});
    consider(false, code_like(Kind::square_root, "sqrt"));
    const ir::Parameter& parameter = subject.bare.parameters[placed.parameter];
    const double unit = ir::power_unit(parameter, 0, range);
    // Components with defaults of their own have pivots that mean something else for each.
    const bool alike = std::ranges::all_of(parameter.default_value, [&](double value) {
        return value == parameter.default_value.front();
    });
    for (int exponent = 2; alike && exponent <= most_exponent; ++exponent) {
        // The largest pivot that lets the last code reach the high end. In doubles: where rounding
        // decides, the next smaller one is as good.
        const int pivot = static_cast<int>(std::floor(
            last / std::pow(std::max(size / unit, 1.0), 1.0 / exponent) * (1 + 0x1p-40)));
        if (pivot < 1 || (size == unit && exponent == 2)) continue;  // which is sqrt
        ir::Code code = code_like(Kind::power, "power");
        code.exponent = exponent;
        code.unit = unit;
        code.pivot = pivot;
        consider(false, code);
    }
    // Whole multiples are what keeps low + 1; the largest that reaches the high end.
    if (size > 1) {
        ir::Code code = code_like(Kind::log2, "log2");
        code.pivot = static_cast<int>(std::floor(last / std::log2(1 + size)));
        if (code.pivot >= 1) consider(false, code);
    }
    // The largest pivot that reaches the high end.
    const auto one = alike ? ir::halving(parameter, 0, range, 1) : std::nullopt;
    if (one) {
        ir::Field field;
        field.bits = bits;
        field.range = range;
        field.code = *one;
        ir::Code code = *one;
        code.pivot =
            static_cast<int>(std::floor(last / ir::position(field, range.high) * (1 + 0x1p-40)));
        if (code.pivot >= 1) consider(false, code);
    }
    for (const ir::Field& field : placed.declared)
        if (field.bits == bits && field.component == 0) consider(false, field.code);
    return found;
}

Fitted with_steps(const CodeSearch& subject, const Placed& placed, const CurvePoint& point)
{
    Fitted fitted{point, {}, {}};
    for (int k = 0; k < placed.components; ++k) {
        ir::Module module = subject.bare;
        ir::Packing packing = subject.packing;
        packing.fields = {field_of(placed, k, point)};
        packing.fields[0].slots = {{0, 0, point.bits}};
        packing.supported = {true};
        ir::Gbuffer gbuffer;
        gbuffer.targets.push_back({"t", "", "", {}});
        ir::Channel channel;
        channel.name = "r";
        channel.formats = {{ir::Storage::unorm, point.bits}};
        channel.exists = {true};
        gbuffer.channels.push_back(channel);
        ir::build_functions(module, packing, gbuffer);
        fitted.steps.push_back(steps_of(module, packing.fields[0]));
    }
    return fitted;
}

StoredAs stored_alone(const CodeSearch& subject, const Placed& placed, const Fitted& fitted)
{
    StoredAs stored(subject.box.width(), nullptr);
    for (std::size_t k = 0; k < placed.coordinates.size(); ++k)
        stored[placed.coordinates[k]] = &fitted.steps[k];
    return stored;
}

}  // namespace

ir::Field field_of(const Placed& placed, int component, const CurvePoint& point)
{
    ir::Field field;
    field.parameter = placed.parameter;
    field.component = component;
    field.bits = point.bits;
    field.is_signed = point.is_signed;
    field.range = placed.range;
    field.code = point.code;
    for (const ir::Field& written : placed.declared)
        if (written.bits == point.bits && written.component == component &&
            written.code == point.code)
            field.anchors = written.anchors;
    return field;
}

CodeSearch subject_of(const ir::Module& module, const ir::Packing& from, std::vector<Placed> placed)
{
    CodeSearch subject;
    subject.packing = from;
    subject.packing.fields.clear();
    subject.packing.channels.clear();
    subject.packing.parameters.clear();
    subject.placed = std::move(placed);
    subject.bare.name = module.name;
    subject.bare.parameters = module.parameters;
    const bool declared = std::ranges::any_of(
        subject.placed, [](const Placed& one) { return !one.declared.empty(); });
    if (declared) subject.bare.functions = module.functions;

    optimize::Settings settings = optimize::defaults(module);
    for (const Placed& one : subject.placed) settings.erase(module.parameters[one.parameter].name);
    for (const ir::MeasuredRange& over : from.measured) settings.erase(over.name);
    ir::Module lit = module;
    lit.gbuffers.clear();
    lit.packings.clear();
    lit.engines.clear();
    lit = optimize::optimize(optimize::specialize(lit, settings));

    ir::Packing packing = subject.packing;
    for (const Placed& one : subject.placed)
        for (int k = 0; k < one.components; ++k) packing.fields.push_back(field_of(one, k, {}));
    // A channel sees of colors only its own, so that one tells as much as three.
    const bool colored =
        std::ranges::any_of(subject.placed, [](const Placed& one) { return one.components > 1; });
    subject.box = radiance_box(lit, packing, colored ? Channels::all : Channels::first);
    for (Placed& one : subject.placed) {
        one.coordinates.clear();
        for (int k = 0; k < one.components; ++k)
            for (std::size_t i = 0; i < subject.box.width(); ++i) {
                const auto field = subject.box.coordinates[i].field;
                if (field && packing.fields[*field].parameter == one.parameter &&
                    packing.fields[*field].component == k)
                    one.coordinates.push_back(i);
            }
    }
    return subject;
}

std::vector<FittedCurve> fit_curves(const CodeSearch& subject,
                                    const std::vector<std::size_t>& which, BitRange range,
                                    unsigned jobs)
{
    struct Look {
        std::size_t curve = 0;  ///< index into `which`
        Fitted fitted;
    };
    std::vector<Look> looks;
    for (std::size_t curve = 0; curve < which.size(); ++curve)
        for (int bits = range.least; bits <= range.most; ++bits)
            for (const CurvePoint& point : candidates(subject, subject.placed[which[curve]], bits))
                looks.push_back({curve, {point, {}, {}}});

    const auto look = [&](Look& one, const Effort& effort,
                          std::span<const std::vector<float>> seeds) {
        const Placed& placed = subject.placed[which[one.curve]];
        if (one.fitted.steps.empty()) one.fitted = with_steps(subject, placed, one.fitted.point);
        const Peak found =
            search(subject.box, stored_alone(subject, placed, one.fitted), effort, seeds);
        one.fitted.peak = found;
        one.fitted.point.error = found.error;
    };
    for_each_task(looks.size(), jobs, [&](std::size_t i) { look(looks[i], first_look, {}); });

    // Every bad point of a parameter is one to try on the better candidates.
    std::vector<std::vector<std::vector<float>>> seeds(which.size());
    for (const Look& one : looks) seeds[one.curve].push_back(one.fitted.peak.point);
    std::vector<Look> best;
    for (std::size_t begin = 0; begin < looks.size();) {
        std::size_t end = begin;
        while (end < looks.size() && looks[end].curve == looks[begin].curve &&
               looks[end].fitted.point.bits == looks[begin].fitted.point.bits)
            ++end;
        std::stable_sort(looks.begin() + static_cast<std::ptrdiff_t>(begin),
                         looks.begin() + static_cast<std::ptrdiff_t>(end),
                         [](const Look& a, const Look& b) {
                             return a.fitted.point.error < b.fitted.point.error;
                         });
        for (std::size_t i = begin; i < std::min(end, begin + compared); ++i)
            best.push_back(looks[i]);
        begin = end;
    }
    for_each_task(best.size(), jobs,
                  [&](std::size_t i) { look(best[i], second_look, seeds[best[i].curve]); });

    std::vector<FittedCurve> curves(which.size());
    for (Look& one : best) {
        FittedCurve& curve = curves[one.curve];
        if (curve.empty() || curve.back().point.bits != one.fitted.point.bits)
            curve.push_back(std::move(one.fitted));
        else if (one.fitted.point.error < curve.back().point.error)
            curve.back() = std::move(one.fitted);
    }
    return curves;
}

}  // namespace lobe::analyze
