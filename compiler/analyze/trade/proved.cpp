#include "analyze/trade/proved.h"

#include "analyze/proof/bounds.h"
#include "analyze/proof/finite.h"
#include "analyze/proof/proof.h"
#include "evaluate/bounds.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::analyze {
namespace {

using evaluate::Machine;
using evaluate::Precision;

/// Bounds sharper than these times the worst that was found are not worth more time: a device
/// may round to either side, and approximates more than what the search runs on.
constexpr double sharp = 4;
constexpr double sharp_anywhere = 16;

/// The sides on which a box is less than the declared one.
std::string describe_part(const Subject& subject, const Box& part)
{
    NamedBox named;
    for (std::size_t i = 0; i < part.size(); ++i)
        if (part[i] != subject.box[i]) named.sides.emplace_back(subject.names[i], part[i]);
    return describe(named);
}

void bound(const Subject& subject, std::size_t boxes, ProvedRounding& out)
{
    Worst worst{subject, Measure::relative};
    explore(subject, {&worst}, 0);
    Bound here{subject, Machine::kernels, Measure::relative, worst};
    here.refine(boxes, sharp);
    Bound anywhere{subject, Machine::vulkan, Measure::relative, worst};
    anywhere.refine(boxes, sharp_anywhere);
    out.bound = std::max(out.bound, here.value());
    out.any_device = std::max(out.any_device, anywhere.value());
    if (const Point* const point = worst.point())
        out.observed = std::max(
            out.observed, error_of(subject, confirm_point(subject, *point), Measure::relative));
}

}  // namespace

ProvedRounding proved_rounding(const Spelled& spelled, Precision precision, double floor,
                               std::size_t boxes)
{
    ProvedRounding out;
    for (const ir::FunctionId id : spelled.outputs)
        for (Subject& subject : subjects(spelled.module, spelled.module[id], precision)) {
            subject.floor = floor;
            if (precision == Precision::float16) {
                const auto part = finite_part(subject, boxes);
                if (!part) return {evaluate::infinity, 0, evaluate::infinity, {}};
                const std::string words = describe_part(subject, *part);
                if (out.over.find(words) == std::string::npos)
                    out.over += (out.over.empty() ? "" : "; ") + words;
                subject.box = *part;
            }
            bound(subject, boxes, out);
        }
    return out;
}

}  // namespace lobe::analyze
