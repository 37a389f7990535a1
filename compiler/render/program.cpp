#include "render/program.h"

#include "evaluate/run.h"

#include <algorithm>
#include <cassert>

namespace lobe::render {
namespace {

constexpr std::array<std::string_view, 12> frame_columns{"n.x", "n.y", "n.z", "x.x", "x.y", "x.z",
                                                         "y.x", "y.y", "y.z", "v.x", "v.y", "v.z"};
constexpr std::array<std::string_view, 3> light_columns{"l.x", "l.y", "l.z"};

template <std::size_t Size>
std::optional<std::size_t> place(const std::array<std::string_view, Size>& names,
                                 std::string_view name)
{
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

Program::Program(const ir::Module& module, const ir::Function& function,
                 const MaterialValues& values)
    : tape_{evaluate::compile(module, function)}
{
    for (const evaluate::TapeInput& input : tape_.inputs) {
        if (const auto at = place(frame_columns, input.name))
            columns_.push_back({Source::frame, *at});
        else if (const auto light = place(light_columns, input.name))
            columns_.push_back({Source::light, *light});
        else if (const auto emitter = place(emitter_columns, input.name))
            columns_.push_back({Source::emitter, *emitter});
        else {
            const auto value = values.find(input.name);
            assert(value && "a model asks for what materials, lights and geometry give");
            columns_.push_back({Source::value, value.value_or(0)});
        }
    }
}

void Program::run(Batch& batch) const
{
    std::vector<const float*> inputs;
    for (const Column& column : columns_) switch (column.source) {
        case Source::value: inputs.push_back(batch.values[column.index].data()); break;
        case Source::frame: inputs.push_back(batch.frame[column.index].data()); break;
        case Source::light: inputs.push_back(batch.l[column.index].data()); break;
        case Source::emitter: inputs.push_back(batch.emitter[column.index].data()); break;
        }
    std::vector<float*> outputs;
    for (std::size_t c = 0; c < tape_.outputs.size(); ++c)
        outputs.push_back(batch.result[c].data());
    evaluate::run(tape_, inputs, outputs, batch.size);
    for (std::size_t c = tape_.outputs.size(); c < 3; ++c) batch.result[c] = batch.result[0];
}

}  // namespace lobe::render
