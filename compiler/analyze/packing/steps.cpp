#include "analyze/packing/steps.h"

#include "evaluate/run.h"
#include "evaluate/tape.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lobe::analyze {
namespace {

/// A function of one number in float. A pass may have given it one minus that number as well.
class Curve {
public:
    Curve(const ir::Module& module, ir::FunctionId function)
        : tape_{evaluate::compile(module, module[function])}
    {
        for (const evaluate::TapeInput& input : tape_.inputs)
            complement_.push_back(module[function].inputs[input.input].complement);
    }

    std::vector<float> operator()(const std::vector<float>& arguments) const
    {
        std::vector<float> rest;
        for (const float argument : arguments) rest.push_back(1 - argument);
        std::vector<const float*> in;
        for (const bool complement : complement_)
            in.push_back(complement ? rest.data() : arguments.data());
        std::vector<float> results(arguments.size());
        float* const out[] = {results.data()};
        evaluate::run(tape_, in, out, arguments.size());
        return results;
    }

private:
    evaluate::Tape tape_;
    std::vector<bool> complement_;
};

// Floats in their order as whole numbers, so that halving a distance is halving a count.
std::int64_t rank(float value)
{
    const auto bits = std::bit_cast<std::int32_t>(value + 0.0F);
    return bits < 0 ? std::int64_t{std::numeric_limits<std::int32_t>::min()} - bits : bits;
}

float of_rank(std::int64_t rank)
{
    const std::int64_t bits =
        rank < 0 ? std::int64_t{std::numeric_limits<std::int32_t>::min()} - rank : rank;
    return std::bit_cast<float>(static_cast<std::int32_t>(bits));
}

std::size_t whole(float code) { return static_cast<std::size_t>(std::max(0.0F, code) + 0.5F); }

}  // namespace

std::size_t Steps::step_of(float value) const
{
    return static_cast<std::size_t>(std::ranges::upper_bound(borders, value) - borders.begin());
}

Steps steps_of(const ir::Module& module, const ir::Field& field)
{
    const Curve encode{module, field.encode};
    const Curve decode{module, field.decode};

    Steps steps;
    steps.low = static_cast<float>(field.range.low);
    steps.high = static_cast<float>(field.range.high);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    if (steps.low < field.range.low) steps.low = std::nextafter(steps.low, infinity);
    if (steps.high > field.range.high) steps.high = std::nextafter(steps.high, -infinity);

    const std::vector<float> ends = encode({steps.low, steps.high});
    steps.first = whole(ends[0]);
    const std::size_t count = std::max(whole(ends[1]), steps.first) - steps.first;

    // below: a value with a smaller code; above: one with this code or more.
    std::vector<std::int64_t> below(count, rank(steps.low));
    std::vector<std::int64_t> above(count, rank(steps.high));
    std::vector<float> middle(count);
    for (bool open = count > 0; open;) {
        for (std::size_t i = 0; i < count; ++i)
            middle[i] = of_rank(below[i] + (above[i] - below[i]) / 2);
        const std::vector<float> codes = encode(middle);
        open = false;
        for (std::size_t i = 0; i < count; ++i) {
            if (above[i] - below[i] <= 1) continue;
            (whole(codes[i]) > steps.first + i ? above : below)[i] = rank(middle[i]);
            open |= above[i] - below[i] > 1;
        }
    }
    std::vector<float> codes;
    for (std::size_t i = 0; i < count; ++i) steps.borders.push_back(of_rank(above[i]));
    for (std::size_t i = 0; i <= count; ++i) codes.push_back(static_cast<float>(steps.first + i));
    steps.values = decode(codes);
    return steps;
}

}  // namespace lobe::analyze
