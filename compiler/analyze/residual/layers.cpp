#include "analyze/residual/layers.h"

#include "analyze/packing/radiance_search.h"
#include "analyze/residual/parameters.h"
#include "analyze/residual/reach.h"
#include "analyze/residual/surface.h"
#include "analyze/tasks.h"
#include "evaluate/run.h"
#include "scene/color.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace lobe::analyze {
namespace {

using ir::Range;

/// What is blended of a material: the surface that others follow from, then the parameters.
enum Place : std::size_t {
    base_color = 0,
    metallic = 3,
    roughness = 4,
    dielectric_f0 = 5,
    parameters = 8
};

/// One component of one material: a constant, or a coordinate of the box.
struct Ingredient {
    double constant = 0;
    std::optional<std::size_t> coordinate;
};

struct Layer {
    std::size_t material = 0;  ///< index into Stack::materials
    Ingredient weight;
};

struct Stacked {
    std::vector<Ingredient> values;
    std::vector<Layer> layers;
};

/// Columns of numbers, row by row of a meter.
using Rows = std::vector<std::vector<double>>;

double lerp(double a, double b, double t) { return t == 1 ? b : a + (b - a) * t; }

class Stack {
public:
    Stack(const scene::Scene& scene, const ir::Module& module, const std::string& model,
          std::size_t material)
        : scene_{scene}, module_{module}
    {
        for (const char* const name : {"l.x", "l.y", "l.z", "v.x", "v.y", "v.z"})
            box_.coordinates.push_back({name, -1, 1});
        box_.light = 0;
        box_.view = 3;
        const VertexColors colors = vertex_colors(scene)[material];
        for (std::size_t c = 0; c < colors_.size(); ++c)
            colors_[c] = ingredient(fmt::format("vertex color[{}]", c), colors.rgb[c]);
        add(material);
        std::vector<ir::FunctionId> outputs;
        for (const ir::Model& one : module.models)
            if (one.name == model)
                for (const ir::ModelOutput& output : one.outputs)
                    outputs.push_back(output.function);
        const ir::Function radiance = radiance_of(module, outputs);
        tape_ = evaluate::compile(module, radiance);
        std::map<std::string, std::size_t, std::less<>> places;
        std::size_t place = parameters;
        for (const ir::Parameter& parameter : module.parameters)
            for (int c = 0; c < ir::components(parameter.type); ++c)
                places[parameter.name +
                       evaluate::component_suffix(parameter.type, parameter.quantity, c)] = place++;
        for (const evaluate::TapeInput& input : tape_.inputs) {
            const auto found = places.find(input.name);
            sources_.push_back({input.name, found == places.end() ? 0 : found->second});
        }
    }

    const RadianceBox& box() const { return box_; }
    std::size_t layers() const { return materials_.front().layers.size(); }

    /// The errors of the points in a meter; `blend` and `exact` are of the channel with the error.
    struct Difference {
        double error = 0;
        double exact = 0;
        double blend = 0;
    };
    std::vector<Difference> differences(RadianceMeter& meter) const
    {
        const std::size_t rows = meter.rows();
        const Rows blended = blended_values(0, meter);
        const Rows of_blend = shade(blended, meter);
        const Rows of_layers = blended_results(0, meter);
        std::vector<Difference> out(rows);
        for (std::size_t row = 0; row < rows; ++row) {
            const double floor = grey_card * meter.column(2)[row];
            Difference& worst = out[row];
            worst.error = -1;
            for (std::size_t c = 0; c < of_blend.size(); ++c) {
                const double exact = of_layers[c][row];
                const double blend = of_blend[c][row];
                if (!std::isfinite(exact)) continue;
                const double error = std::isfinite(blend) ? std::abs(blend - exact) /
                                                                std::max(std::abs(exact), floor)
                                                          : std::numeric_limits<double>::infinity();
                if (error > worst.error) worst = {error, exact, blend};
            }
            worst.error = std::max(worst.error, 0.0);
        }
        return out;
    }

private:
    struct Source {
        std::string name;
        std::size_t place = 0;  ///< of a parameter
    };

    Ingredient ingredient(const std::string& name, const Range& range)
    {
        if (range.low == range.high) return {range.low, std::nullopt};
        box_.coordinates.push_back(
            {name, static_cast<float>(range.low), static_cast<float>(range.high)});
        box_.values.push_back(box_.coordinates.size() - 1);
        return {0, box_.coordinates.size() - 1};
    }

    /// A material and those above it, once each. Returns its index.
    std::size_t add(std::size_t index)
    {
        if (const auto known = index_of_.find(index); known != index_of_.end())
            return known->second;
        const std::size_t here = materials_.size();
        index_of_.emplace(index, here);
        materials_.emplace_back();
        const scene::Material& material = scene_.materials[index];
        const std::string name =
            material.name.empty() ? fmt::format("material {}", index) : material.name;
        std::vector<Ingredient> values;
        const auto take = [&](const std::string& what, const InputFact& fact) {
            for (std::size_t c = 0; c < fact.components.size(); ++c)
                values.push_back(ingredient(
                    fmt::format("{} {}{}", name, what,
                                fact.components.size() == 1 ? "" : fmt::format("[{}]", c)),
                    fact.components[c]));
        };
        const RawSurface raw = raw_surface(scene_, material);
        take("base_color", raw.base_color);
        take("metallic", raw.metallic);
        take("roughness", raw.roughness);
        take("dielectric_f0", raw.dielectric_f0);
        std::vector<scene::Complaint> complaints;
        const auto given = given_parameters(scene_, material, module_, complaints);
        const auto defaults = default_facts(module_);
        for (const ir::Parameter& parameter : module_.parameters) {
            const auto found = given.find(parameter.name);
            take(parameter.name,
                 found == given.end() ? defaults.at(parameter.name) : found->second);
        }
        std::vector<Layer> layers;
        for (std::size_t k = 0; k < material.layers.size(); ++k) {
            const scene::Layer& layer = material.layers[k];
            const Range weight = reach(scene_, layer.weight).components.at(0);
            layers.push_back({add(layer.material),
                              ingredient(fmt::format("{} layer {} weight", name, k + 1), weight)});
        }
        materials_[here] = {std::move(values), std::move(layers)};
        return here;
    }

    std::vector<double> column(const Ingredient& of, RadianceMeter& meter) const
    {
        if (!of.coordinate) return std::vector<double>(meter.rows(), of.constant);
        const double* const from = meter.column(*of.coordinate);
        return {from, from + meter.rows()};
    }

    Rows own_values(std::size_t material, RadianceMeter& meter) const
    {
        Rows out;
        for (const Ingredient& value : materials_[material].values)
            out.push_back(column(value, meter));
        for (std::size_t c = 0; c < colors_.size(); ++c) {
            const std::vector<double> color = column(colors_[c], meter);
            for (std::size_t row = 0; row < color.size(); ++row)
                out[base_color + c][row] =
                    std::clamp(out[base_color + c][row] * color[row], 0.0, 1.0);
        }
        return out;
    }

    static void blend_over(Rows& below, const Rows& above, const std::vector<double>& weight)
    {
        for (std::size_t k = 0; k < below.size(); ++k)
            for (std::size_t row = 0; row < weight.size(); ++row)
                below[k][row] = lerp(below[k][row], above[k][row], weight[row]);
    }

    Rows blended_values(std::size_t material, RadianceMeter& meter) const
    {
        Rows out = own_values(material, meter);
        for (const Layer& layer : materials_[material].layers)
            blend_over(out, blended_values(layer.material, meter), column(layer.weight, meter));
        return out;
    }

    Rows blended_results(std::size_t material, RadianceMeter& meter) const
    {
        Rows out = shade(own_values(material, meter), meter);
        for (const Layer& layer : materials_[material].layers)
            blend_over(out, blended_results(layer.material, meter), column(layer.weight, meter));
        return out;
    }

    /// The radiance of materials, one per row, under the meter's directions.
    Rows shade(const Rows& values, RadianceMeter& meter) const
    {
        const std::size_t rows = meter.rows();
        Rows columns(tape_.inputs.size(), std::vector<double>(rows));
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (std::size_t row = 0; row < rows; ++row)
                columns[i][row] = input(i, values, meter, row);
        Rows out(tape_.outputs.size(), std::vector<double>(rows));
        std::vector<const double*> in;
        std::vector<double*> to;
        for (const auto& one : columns) in.push_back(one.data());
        for (auto& one : out) to.push_back(one.data());
        evaluate::run(tape_, evaluate::Columns<double>{in}, evaluate::Results<double>{to}, rows);
        return out;
    }

    double input(std::size_t which, const Rows& values, RadianceMeter& meter, std::size_t row) const
    {
        const Source& source = sources_[which];
        if (source.place != 0) return values[source.place][row];
        const std::string& name = source.name;
        const double metal = values[metallic][row];
        const double rough = values[roughness][row];
        const std::size_t channel = name.ends_with(".g") ? 1 : name.ends_with(".b") ? 2 : 0;
        const double color = values[base_color + channel][row];
        const double f0 = values[dielectric_f0 + channel][row];
        for (std::size_t i = 0; i < 6; ++i)
            if (name == box_.coordinates[i].name) return meter.column(i)[row];
        if (name == "metallic") return metal;
        if (name == "roughness") return rough;
        if (name == "alpha") return rough * rough;
        if (name == "specular") {
            const double most =
                std::max({f0, values[dielectric_f0 + 1][row], values[dielectric_f0 + 2][row]});
            return std::min(most / 0.08, 1.0);
        }
        if (name.starts_with("base_color")) return color;
        if (name.starts_with("diffuse_color")) return color * (1 - metal);
        if (name.starts_with("f0")) return lerp(f0, color, metal);
        // The normal is the z axis, the frame the other two.
        return name == "n.z" || name == "x.x" || name == "y.y" ? 1 : 0;
    }

    const scene::Scene& scene_;
    const ir::Module& module_;
    RadianceBox box_;
    evaluate::Tape tape_;
    std::vector<Source> sources_;
    std::array<Ingredient, 3> colors_;  ///< of vertices
    std::vector<Stacked> materials_;
    std::map<std::size_t, std::size_t> index_of_;  ///< from the scene's materials
};

RadianceError worst_of(const Stack& stack, const LayerOptions& options)
{
    constexpr std::size_t rows = 1024;
    constexpr std::size_t climbs = 8;
    constexpr int rounds = 96;
    const RadianceBox& box = stack.box();
    const StoredAs nothing(box.width(), nullptr);
    const std::size_t chunks = std::max<std::size_t>(climbs, (options.points + rows - 1) / rows);
    std::vector<double> anywhere(chunks * rows / 2);
    std::vector<Peak> peaks(chunks);
    for_each_task(chunks, options.jobs, [&](std::size_t task) {
        RadianceMeter meter{box, rows};
        for (std::size_t row = 0; row < rows; ++row)
            place_point(box, nothing, task * rows + row, meter, row);
        const auto found = stack.differences(meter);
        for (std::size_t row = 0; row < rows; ++row) {
            if (row % 2 == 0) anywhere[(task * rows + row) / 2] = found[row].error;
            if (found[row].error > peaks[task].error)
                peaks[task] = {found[row].error, meter.point(row)};
        }
    });
    std::ranges::stable_sort(peaks, [](const Peak& a, const Peak& b) { return a.error > b.error; });
    peaks.resize(climbs);
    for_each_task(climbs, options.jobs, [&](std::size_t task) {
        std::vector<double> errors;
        const Measure measure = [&](RadianceMeter& meter) -> const std::vector<double>& {
            errors.clear();
            for (const auto& one : stack.differences(meter)) errors.push_back(one.error);
            return errors;
        };
        const Peak found = climb(box, nothing, peaks[task].point, rounds, task, measure);
        if (found.error > peaks[task].error) peaks[task] = found;
    });
    const Peak& worst = *std::ranges::max_element(peaks, {}, &Peak::error);

    RadianceError out;
    std::ranges::sort(anywhere);
    out.typical = anywhere[anywhere.size() / 2];
    out.often = anywhere[anywhere.size() * 95 / 100];
    RadianceMeter meter{box, 1};
    meter.set(0, worst.point);
    const auto at = stack.differences(meter).front();
    out.worst = at.error;
    out.witness.exact = at.exact;
    out.witness.packed = at.blend;
    for (std::size_t i = 0; i < box.width(); ++i)
        out.witness.inputs.emplace_back(box.coordinates[i].name, worst.point[i]);
    return out;
}

}  // namespace

bool LayeredMaterial::one_shading_is_enough() const
{
    constexpr float half_a_step_below_white = 1 - 0.5F / 255;
    return error.worst < 1 - static_cast<double>(scene::linear_of_srgb(half_a_step_below_white));
}

LayeredMaterials layered_materials(const scene::Scene& scene, const ir::Module& module,
                                   const std::string& model, const LayerOptions& options)
{
    LayeredMaterials out;
    for (const std::size_t index : scene.shown_materials()) {
        const scene::Material& material = scene.materials[index];
        if (material.layers.empty() || material.is_unlit) continue;
        if (out.measured.size() == options.most) {
            ++out.not_measured;
            continue;
        }
        const Stack stack{scene, module, model, index};
        out.measured.push_back(
            {index, material.name.empty() ? fmt::format("material {}", index) : material.name,
             stack.layers(), worst_of(stack, options)});
    }
    return out;
}

}  // namespace lobe::analyze
