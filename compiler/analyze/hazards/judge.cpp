#include "analyze/hazards/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lobe::analyze {
namespace {

using evaluate::Instruction;
using evaluate::Slot;
using evaluate::TapeOp;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool has_domain(TapeOp op)
{
    switch (op) {
    case TapeOp::divide:
    case TapeOp::square_root:
    case TapeOp::inverse_square_root:
    case TapeOp::log2:
    case TapeOp::log:
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine:
    case TapeOp::power:
    case TapeOp::smoothstep:
    case TapeOp::normalized: return true;
    default: return false;
    }
}

bool is_sum(TapeOp op)
{
    return op == TapeOp::add || op == TapeOp::subtract || op == TapeOp::sum3 || op == TapeOp::sum4;
}

/// Sums, and what subtracts 1 from its operand on the way: a logarithm near 1, and so a power.
bool may_cancel(TapeOp op)
{
    switch (op) {
    case TapeOp::add:
    case TapeOp::subtract:
    case TapeOp::sum3:
    case TapeOp::sum4:
    case TapeOp::lerp:
    case TapeOp::log2:
    case TapeOp::log:
    case TapeOp::power: return true;
    default: return false;
    }
}

std::span<const Slot> operands(const Instruction& step, std::array<Slot, 4>& storage)
{
    storage = {step.a, step.b, step.c, step.d};
    return std::span{storage}.first(static_cast<std::size_t>(arity(step.op)));
}

/// Marks what is divided by or taken the logarithm of, and the factors of it.
std::vector<char> divisor_slots(const evaluate::Tape& tape)
{
    std::vector<char> divides(tape.slots);
    for (std::size_t i = tape.code.size(); i-- > 0;) {
        const Instruction& step = tape.code[i];
        switch (step.op) {
        case TapeOp::divide:
        case TapeOp::normalized: divides[step.b] = 1; break;
        case TapeOp::inverse_square_root:
        case TapeOp::log2:
        case TapeOp::log: divides[step.a] = 1; break;
        case TapeOp::multiply:
            if (divides[step.result] != 0) divides[step.b] = 1;
            [[fallthrough]];
        case TapeOp::square:
        case TapeOp::square_root:
        case TapeOp::power:
            if (divides[step.result] != 0) divides[step.a] = 1;
            break;
        default: break;
        }
    }
    return divides;
}

}  // namespace

double domain_distance(const Instruction& step, const Trace& trace)
{
    const double a = trace.device(step.a);
    const double b = trace.device(step.b);
    switch (step.op) {
    case TapeOp::divide: return std::fabs(b);
    case TapeOp::square_root: return a < 0 ? 0 : a + trace.grid().least;
    case TapeOp::inverse_square_root:
    case TapeOp::log2:
    case TapeOp::log: return std::fmax(a, 0);
    case TapeOp::arc_sine:
    case TapeOp::arc_cosine: return std::fabs(a) > 1 ? 0 : 1 - std::fabs(a) + trace.grid().least;
    case TapeOp::power: return a < 0 ? 0 : a + std::fmax(b, 0);
    case TapeOp::smoothstep: return std::fmax(b - a, 0);
    case TapeOp::normalized: return std::fmax(b, 0);
    default: return infinity;
    }
}

double scaled_error(double result, double exact)
{
    constexpr double floor = 0.18;
    if (!std::isfinite(exact)) return std::isfinite(result) ? infinity : 0;
    if (!std::isfinite(result)) return infinity;
    return std::fabs(result - exact) / std::max(std::fabs(exact), floor);
}

double tolerance(const Grid& grid) { return std::ldexp(1, -(grid.digits / 2)); }

HazardJudge::HazardJudge(const WatchedLine& line) : line_{&line}
{
    const std::vector<char> divides = divisor_slots(line.tape);
    for (std::size_t i = 0; i < line.tape.code.size(); ++i) {
        const Instruction& step = line.tape.code[i];
        if (has_domain(step.op)) with_domain_.push_back(i);
        if (may_cancel(step.op)) sums_.push_back(i);
        // A sum of floats below the normal ones is exact: what is small there has cancelled.
        if (divides[step.result] != 0 && !is_sum(step.op)) divisors_.push_back(i);
    }
}

bool HazardJudge::cancels(const Trace& trace, std::size_t instruction) const
{
    const Instruction& step = line_->tape.code[instruction];
    const double needed = static_cast<double>(trace.grid().digits) / 2;
    if (trace.kept_bits(step.result) >= needed) return false;
    // Operands that are wrong already make a wrong sum, and are not its fault. Nor is it known what
    // is left of a sum of which double loses too much itself.
    double largest = 0;
    std::array<Slot, 4> storage;
    for (const Slot slot : operands(step, storage)) {
        if (!std::isfinite(trace.exact(slot)) || trace.kept_bits(slot) < needed) return false;
        largest = std::max(largest, std::fabs(trace.exact(slot)));
    }
    constexpr double trusted = 0x1p-40;
    return std::fabs(trace.exact(step.result)) > trusted * largest;
}

bool HazardJudge::underflows(const Trace& trace, std::size_t instruction) const
{
    const Instruction& step = line_->tape.code[instruction];
    const double least = trace.grid().least_normal;
    if (!(std::fabs(trace.device(step.result)) < least) || trace.exact(step.result) == 0)
        return false;
    std::array<Slot, 4> storage;
    return std::ranges::all_of(operands(step, storage), [&](Slot slot) {
        return std::fabs(trace.device(slot)) >= least || trace.exact(slot) == 0;
    });
}

bool HazardJudge::may_find(const Trace& trace, bool wrong) const
{
    return wrong || trace.any_infinite() || std::ranges::any_of(with_domain_, [&](std::size_t i) {
               return domain_distance(line_->tape.code[i], trace) == 0;
           });
}

void HazardJudge::find(const Trace& trace, bool wrong, std::vector<HazardEvent>& events) const
{
    events.clear();
    const std::vector<Instruction>& code = line_->tape.code;
    const auto counts = [&](std::size_t i) { return trace.demanded(code[i].result); };
    std::array<Slot, 4> storage;
    const auto finite_operands = [&](std::size_t i) {
        return std::ranges::all_of(operands(code[i], storage),
                                   [&](Slot slot) { return std::isfinite(trace.device(slot)); });
    };
    for (const std::size_t i : with_domain_)
        if (counts(i) && finite_operands(i) && domain_distance(code[i], trace) == 0)
            events.push_back({HazardKind::domain, i});
    if (!wrong) return;
    for (const std::size_t i : sums_)
        if (counts(i) && finite_operands(i) && std::isfinite(trace.device(code[i].result)) &&
            cancels(trace, i))
            events.push_back({HazardKind::cancellation, i});
    for (const std::size_t i : divisors_)
        if (counts(i) && underflows(trace, i)) events.push_back({HazardKind::underflow, i});
    if (!trace.any_infinite()) return;
    for (std::size_t i = 0; i < code.size(); ++i)
        if (counts(i) && std::isinf(trace.device(code[i].result)) && finite_operands(i) &&
            !(domain_distance(code[i], trace) == 0))
            events.push_back({HazardKind::overflow, i});
}

}  // namespace lobe::analyze
