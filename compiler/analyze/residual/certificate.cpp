#include "analyze/residual/certificate.h"

#include "analyze/heads.h"
#include "analyze/kept_lines.h"
#include "analyze/physics/emitted_function.h"
#include "analyze/points.h"
#include "analyze/tasks.h"
#include "evaluate/bounds.h"
#include "evaluate/run.h"
#include "optimize/inline.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lobe::analyze {
namespace {

using evaluate::Acceptance;
using evaluate::Real;

/// Bits of the exact values: twice those of a double, and some.
constexpr int exact_bits = 113;

/// Points that one thread takes at a time.
constexpr std::size_t chunk = 512;

/// The inputs of both functions, over the scene's box.
class SceneBox {
public:
    /// What was dropped is compared where it is off; an effect that is off has its own constants,
    /// or what the residual set in place of a range.
    SceneBox(const ir::Module& general, const optimize::Called& called,
             const optimize::Settings& settings, const std::vector<Dropped>& dropped)
        : called_(called), constants_(settings)
    {
        optimize::Settings own = called.constants;
        for (const ir::Effect& effect : general.effects)
            if (std::ranges::count(dropped, effect.name, &Dropped::effect) > 0)
                for (const ir::Input& input : general[effect.off_when].inputs)
                    own.erase(input.name);
        for (const auto& [name, value] : own) constants_[name] = value;
    }

    const optimize::Settings& constants() const { return constants_; }
    /// The value of an input that does not vary.
    const std::vector<double>* constant(const ir::Input& input) const
    {
        if (input.origin != ir::Origin::parameter && input.origin != ir::Origin::surface)
            return nullptr;
        const auto found = constants_.find(input.name);
        const auto size = static_cast<std::size_t>(ir::components(input.type));
        return found != constants_.end() && found->second.size() == size ? &found->second : nullptr;
    }

    bool is_binary(const ir::Input& input) const { return called_.binary.contains(input.name); }

    ir::Range range(const ir::Input& input) const
    {
        const auto found = called_.ranges.find(input.name);
        if (found == called_.ranges.end() || input.origin == ir::Origin::argument ||
            input.origin == ir::Origin::geometry)
            return input.range;
        const ir::Range both{std::max(input.range.low, found->second.low),
                             std::min(input.range.high, found->second.high)};
        return both.low <= both.high ? both : input.range;
    }

private:
    const optimize::Called& called_;
    optimize::Settings constants_;
};

/// One scalar of the points.
struct Column {
    std::string name;
    std::optional<double> constant;
};

/// Points of the scene's box, for the inputs of both functions.
struct Sample {
    std::vector<Column> columns;
    std::vector<std::vector<float>> values;

    /// Which column a tape reads for each of its inputs.
    std::vector<std::size_t> columns_of(const evaluate::Tape& tape) const
    {
        std::vector<std::size_t> result;
        for (const evaluate::TapeInput& input : tape.inputs)
            result.push_back(static_cast<std::size_t>(
                std::ranges::find(columns, input.name, &Column::name) - columns.begin()));
        return result;
    }
};

Sample sample(const ir::Module& module, const ir::Function& general, const ir::Function& residual,
              const SceneBox& box, std::size_t count)
{
    ir::Function probe = general;
    for (const ir::Input& input : residual.inputs)
        if (std::ranges::count(probe.inputs, input.name, &ir::Input::name) == 0)
            probe.inputs.push_back(input);
    for (ir::Input& input : probe.inputs) input.range = box.range(input);
    Points points = analyze::points(module, probe, count);

    Sample result;
    std::size_t column = 0;
    for (const ir::Input& input : probe.inputs) {
        const std::vector<double>* constant = box.constant(input);
        for (int k = 0; k < ir::components(input.type); ++k, ++column) {
            std::vector<float>& values = points.columns[column];
            result.columns.push_back({points.names[column], {}});
            if (constant != nullptr) {
                const double value = (*constant)[static_cast<std::size_t>(k)];
                result.columns.back().constant = value;
                std::ranges::fill(values, static_cast<float>(value));
            } else if (box.is_binary(input)) {
                for (float& value : values) value = value > 0.5F ? 1.0F : 0.0F;
            }
        }
    }
    result.values = std::move(points.columns);
    return result;
}

/// A material's number reaches a shader as the float next to it: the general function may be given
/// that one, and is meant for the number itself.
Acceptance admitted(const Column& column, float value)
{
    if (!column.constant || *column.constant == double{value}) return {value, value, false};
    return {std::min(evaluate::next_down(*column.constant), double{value}),
            std::max(evaluate::next_up(*column.constant), double{value}), false};
}

/// A function at some of the points.
class Evaluation {
public:
    Evaluation(const ir::Module& module, const ir::Function& entry, const Sample& sample)
        : tape_(evaluate::compile(module, entry)), sample_(sample),
          columns_(sample.columns_of(tape_))
    {
    }

    const evaluate::Tape& tape() const { return tape_; }
    std::size_t components() const { return tape_.outputs.size(); }
    const std::vector<std::size_t>& columns() const { return columns_; }

    std::vector<std::vector<Acceptance>> accepted(std::size_t first, std::size_t size) const
    {
        const auto in = slice<Acceptance>(first, size, admitted);
        std::vector<std::vector<Acceptance>> out(components(), std::vector<Acceptance>(size));
        evaluate::run_acceptance(tape_, evaluate::Precision::float32, heads(in), heads(out), size);
        return out;
    }

    std::vector<std::vector<double>> exact(std::size_t first, std::size_t size) const
    {
        const auto in = slice<Real>(first, size, [](const Column& column, float value) {
            return column.constant ? Real{fmt::format("{}", *column.constant), exact_bits}
                                   : Real{value, exact_bits};
        });
        std::vector<std::vector<Real>> out(components(), std::vector<Real>(size, Real{exact_bits}));
        evaluate::run_real(tape_, exact_bits, heads(in), heads(out), size);
        std::vector<std::vector<double>> result;
        for (const auto& column : out) {
            auto& values = result.emplace_back();
            for (const Real& value : column) values.push_back(value.to_double());
        }
        return result;
    }

private:
    template <class Number, class Make>
    std::vector<std::vector<Number>> slice(std::size_t first, std::size_t size,
                                           const Make& make) const
    {
        std::vector<std::vector<Number>> result;
        for (const std::size_t column : columns_) {
            auto& values = result.emplace_back();
            for (std::size_t i = 0; i < size; ++i)
                values.push_back(make(sample_.columns[column], sample_.values[column][first + i]));
        }
        return result;
    }

    evaluate::Tape tape_;
    const Sample& sample_;
    std::vector<std::size_t> columns_;
};

bool allows(const Acceptance& allowed, double value)
{
    return allowed.undefined || (allowed.low <= value && value <= allowed.high);
}

/// In shares of the half width; 0 where both are one number, whatever the width.
double share(const Acceptance& allowed, double residual, double general)
{
    if (allowed.undefined || residual == general) return 0;
    return std::abs(residual - general) / ((allowed.high - allowed.low) / 2);
}

/// What some of the points say.
struct Count {
    std::size_t outside = 0;
    std::size_t device_outside = 0;
    double worst = 0;
};

class Comparison {
public:
    Comparison(const Evaluation& general, const Evaluation& residual)
        : general_(general), residual_(residual)
    {
    }

    /// `device` has what a device computed of all points, or nothing.
    Count count(std::size_t first, std::size_t size, const ResultColumns& device) const
    {
        const auto allowed = general_.accepted(first, size);
        const auto meant = general_.exact(first, size);
        const auto values = residual_.exact(first, size);
        Count result;
        for (std::size_t i = 0; i < size; ++i) {
            bool outside = false;
            bool device_outside = false;
            for (std::size_t k = 0; k < allowed.size(); ++k) {
                outside |= !allows(allowed[k][i], values[k][i]);
                result.worst =
                    std::max(result.worst, share(allowed[k][i], values[k][i], meant[k][i]));
                if (!device.empty()) device_outside |= !allows(allowed[k][i], device[k][first + i]);
            }
            result.outside += outside;
            result.device_outside += device_outside;
        }
        return result;
    }

private:
    const Evaluation& general_;
    const Evaluation& residual_;
};

/// All of one output.
class Output {
public:
    Output(const ir::Module& general, ir::FunctionId meant, const ir::Module& residual,
           ir::FunctionId emitted, const Sources& sources, const SceneBox& box,
           const CertificateOptions& options, device::Device* device)
        : options_(options), device_(device), emitted_(residual, sources, emitted, device),
          sample_(sample(general, ir::entry_point(general, meant), emitted_.inputs().entry(), box,
                         options.points)),
          general_(general, ir::entry_point(general, meant), sample_),
          residual_(residual, emitted_.inputs().entry(), sample_)
    {
    }

    std::string key() const
    {
        std::string key = "certificate\n" + emitted_.key() + evaluate::dump(general_.tape());
        for (std::size_t i = 0; i < sample_.columns.size(); ++i) {
            const auto [low, high] = std::ranges::minmax(sample_.values[i]);
            write_line(key, sample_.columns[i].name, low, high,
                       sample_.columns[i].constant.value_or(low));
        }
        write_line(key, options_.points, device_ != nullptr);
        return key;
    }

    void compare(Equality& out)
    {
        ResultColumns on_device;
        if (device_ != nullptr) {
            EmittedFunction::Batch batch{emitted_.inputs().columns()};
            EntryInputs::Values values(emitted_.inputs().columns());
            for (std::size_t point = 0; point < options_.points; ++point) {
                for (std::size_t i = 0; i < values.size(); ++i)
                    values[i] = sample_.values[residual_.columns()[i]][point];
                batch.add(values);
            }
            if (emitted_.emitted(batch, on_device).empty())
                out.device = device_->facts().name;
            else
                on_device.clear();
        }
        const std::size_t tasks = (options_.points + chunk - 1) / chunk;
        std::vector<Count> counts(tasks);
        const Comparison comparison{general_, residual_};
        for_each_task(tasks, options_.jobs, [&](std::size_t task) {
            const std::size_t first = task * chunk;
            counts[task] =
                comparison.count(first, std::min(chunk, options_.points - first), on_device);
        });
        out.points = options_.points;
        for (const Count& count : counts) {
            out.outside += count.outside;
            out.device_outside += count.device_outside;
            out.worst = std::max(out.worst, count.worst);
        }
    }

private:
    const CertificateOptions& options_;
    device::Device* device_;
    EmittedFunction emitted_;
    Sample sample_;
    Evaluation general_;
    Evaluation residual_;
};

/// The general function with nothing done to it but constants put in, against the residual one.
bool same_graph(const ir::Module& bound, ir::FunctionId meant, const ir::Module& residual,
                ir::FunctionId emitted)
{
    ir::Function f = optimize::inline_calls(bound, meant);
    const ir::Function g = optimize::inline_calls(residual, emitted);
    if (f.inputs.size() != g.inputs.size()) return false;
    // What is known of the inputs is no part of what is computed of them.
    for (std::size_t i = 0; i < f.inputs.size(); ++i) f.inputs[i].range = g.inputs[i].range;
    return optimize::same_function(f, g);
}

const ir::Model* find_model(const ir::Module& module, std::string_view name)
{
    const auto found = std::ranges::find(module.models, name, &ir::Model::name);
    return found == module.models.end() ? nullptr : &*found;
}

}  // namespace

bool Certificate::ok() const { return std::ranges::all_of(outputs, &Equality::ok); }

Certificate certify(const ir::Module& general, const Sources& sources, const std::string& model,
                    const optimize::Called& called, const optimize::Residual& residual,
                    const std::vector<Dropped>& dropped, const CertificateOptions& options,
                    const Store& store)
{
    const auto start = std::chrono::steady_clock::now();
    Certificate result;
    result.model = model;
    result.dropped = dropped;
    const ir::Model* const meant = find_model(general, model);
    const ir::Model* const left = find_model(residual.module, model);
    if (meant == nullptr || left == nullptr) return result;

    std::string why;
    std::optional<device::Device> device;
    if (options.execute) device = device::Device::open(options.device, why);

    const ir::Module whole = optimize::optimize(general);
    const SceneBox box{general, called, residual.settings, dropped};
    const ir::Module bound = optimize::optimize(optimize::specialize(general, box.constants()));
    const ir::Module emitted = optimize::optimize(residual.module);
    for (std::size_t i = 0; i < meant->outputs.size(); ++i) {
        Equality& equality = result.outputs.emplace_back();
        equality.output = meant->outputs[i].name;
        const ir::FunctionId of_general = meant->outputs[i].function;
        const ir::FunctionId of_residual = left->outputs[i].function;
        equality.same_graph = same_graph(bound, of_general, emitted, of_residual);
        Output output{whole,   of_general, emitted, of_residual,
                      sources, box,        options, device ? &*device : nullptr};
        const std::string text = kept(store, output.key(), [&] {
            Equality measured;
            output.compare(measured);
            std::string line;
            write_line(line, measured.points, measured.outside, measured.worst,
                       measured.device_outside, measured.device);
            return line;
        });
        LineReader read{text};
        read(equality.points);
        read(equality.outside);
        read(equality.worst);
        read(equality.device_outside);
        read(equality.device);
    }
    optimize::Called left_out = called;
    for (const Dropped& each : dropped) left_out.off.insert(each.effect);
    result.kept = not_droppable(general, model, left_out, options);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace lobe::analyze
