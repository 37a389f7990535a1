// `lobec render`: a scene under a model, to be looked at.
#include "render/render.h"

#include "analyze/environment/consistency.h"
#include "analyze/packing/radiance_box.h"
#include "analyze/residual/facts.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/scene_file.h"
#include "lights.h"
#include "optimize/residual.h"
#include "render/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <memory>

namespace lobe::cli {
namespace {

/// Shaders with the modules that they point into.
struct Looks {
    std::deque<ir::Module> modules;
    render::Look look;
};

struct Render {
    std::string scene;
    std::string model = "models/callisto.lobe";
    std::string out;
    std::string size = "512x512";
    std::string compare;
    render::RenderOptions options;
    double exposure = 0;
    int gain = 16;
    Sources sources_;  ///< of the lights

    int run(const Terminal& terminal)
    {
        if (!parse_size())
            return fail(terminal,
                        fmt::format("--size takes WIDTHxHEIGHT, each 1 to 16384; got `{}`", size));
        const ModelFile file = load_model(terminal, model);
        if (file.status != success) return file.status;
        const auto read = read_scene(terminal, scene, {});
        if (!read) return broken;
        auto found = analyze::find_facts(*read, file.module(), file.model);
        print(terminal, scene, found.complaints);
        if (!found.facts) return broken;

        const auto start = std::chrono::steady_clock::now();
        const Looks general = general_look(file, *read, *found.facts);
        const render::Picture picture = draw(terminal, *read, general.look, "general");
        const float factor =
            exposure > 0 ? static_cast<float>(exposure) : render::exposure(picture);
        const auto shown = render::displayed(picture, factor);
        render::Panel panel{options.width, shown};
        std::string told;
        if (!compare.empty()) {
            const Looks residual = residual_look(file, *read, *found.facts);
            const auto other =
                render::displayed(draw(terminal, *read, residual.look, "residual"), factor);
            panel = render::beside({{options.width, other},
                                    panel,
                                    {options.width, render::difference(other, shown, gain)}},
                                   options.height);
            told = differences(other, shown, residual.look.shaders.size());
        }
        told += environment_line(*read);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        const std::vector<Output> outputs{{"-o", out, render::png(panel, options.height)}};
        const int status = write(terminal, outputs, success);
        if (status == success && !terminal.quiet && !is_piped(outputs))
            fmt::print("{}: {} x {}, exposure {:.4g}, {:.1f} s\n{}", out, panel.width,
                       options.height, factor, taken.count(), told);
        return status;
    }

private:
    bool parse_size()
    {
        constexpr int most = 16384;
        const std::size_t cross = size.find('x');
        const auto number = [](const std::string& text) {
            const bool digits =
                !text.empty() && text.size() < 6 &&
                std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
            return digits ? std::stoi(text) : 0;
        };
        if (cross == std::string::npos) return false;
        options.width = number(size.substr(0, cross));
        options.height = number(size.substr(cross + 1));
        return options.width >= 1 && options.height >= 1 && options.width <= most &&
               options.height <= most;
    }

    /// Adds the shader of a checked module's model. Returns its index.
    std::size_t add(Looks& looks, const ir::Module& checked, const std::string& model_name,
                    const std::vector<std::string>& lights)
    {
        looks.modules.push_back(middle(with_lights(checked, lights, sources_, model_name)));
        const ir::Module& module = looks.modules.back();
        render::Shader shader;
        shader.module = &module;
        std::vector<ir::FunctionId> outputs;
        for (const ir::Model& one : module.models)
            if (one.name == model_name)
                for (const ir::ModelOutput& output : one.outputs)
                    outputs.push_back(output.function);
        shader.radiance = analyze::radiance_of(module, outputs);
        for (const std::string& light : lights)
            shader.lit[light] = ir::entry_point(
                module, *module.find(fmt::format("shade_{}_{}", model_name, light)));
        looks.look.shaders.push_back(std::move(shader));
        return looks.look.shaders.size() - 1;
    }

    Looks general_look(const ModelFile& file, const scene::Scene& shown,
                       const analyze::SceneFacts& facts)
    {
        Looks looks;
        looks.look.shader_of.assign(shown.materials.size(),
                                    add(looks, file.module(), file.model, facts.light_names));
        return looks;
    }

    /// A shader for every combination of effects that materials call for.
    Looks residual_look(const ModelFile& file, const scene::Scene& shown,
                        const analyze::SceneFacts& facts)
    {
        Looks looks;
        looks.look.shader_of.assign(shown.materials.size(), 0);
        std::map<std::vector<bool>, std::vector<std::size_t>> groups;
        for (std::size_t i = 0; i < facts.materials.size(); ++i)
            groups[facts.materials[i].calls].push_back(i);
        for (const auto& [calls, members] : groups) {
            const optimize::Residual residual =
                optimize::residual(file.module(), facts.called(members), file.model);
            const std::size_t shader = add(looks, residual.module, file.model, facts.light_names);
            for (const std::size_t member : members)
                looks.look.shader_of[facts.materials[member].material] = shader;
        }
        return looks;
    }

    render::Picture draw(const Terminal& terminal, const scene::Scene& shown,
                         const render::Look& look, std::string_view what) const
    {
        Progress progress{terminal};
        render::RenderOptions with = options;
        with.progress = [&](std::size_t done, std::size_t total) {
            progress.show(fmt::format("drawing, {}: {} %", what, 100 * done / total));
        };
        return render::render(shown, look, with);
    }

    /// What shaders take from the environment, against the level that the picture is made from.
    std::string environment_line(const scene::Scene& shown) const
    {
        const analyze::CubeMap map = render::environment_map(shown);
        if (map.levels.empty() || render::Sky{shown}.is_dark()) return {};
        analyze::HarmonicSeries irradiance;
        std::ranges::transform(shown.environment->irradiance, irradiance.begin(),
                               [&](scene::Color color) {
                                   for (double& channel : color)
                                       channel *= shown.environment->intensity;
                                   return color;
                               });
        const auto errors = analyze::environment_errors(map, irradiance, options.jobs);
        std::string mips;
        for (const double error : errors.levels) mips += fmt::format(" {:.1f} %", 100 * error);
        return fmt::format("environment: against the sharpest mip, irradiance is off by {:.1f} %{}"
                           "{}\n",
                           100 * errors.irradiance, mips.empty() ? "" : ", coarser mips by", mips);
    }

    std::string differences(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                            std::size_t shaders) const
    {
        int most = 0;
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < a.size(); i += 3) {
            int here = 0;
            for (std::size_t c = i; c < i + 3; ++c) here = std::max(here, std::abs(a[c] - b[c]));
            most = std::max(most, here);
            pixels += here > 0 ? 1 : 0;
        }
        return fmt::format("left: residual, {} shader{}; middle: general; right: their difference, "
                           "x {}\n{} of {} pixels differ, by at most {} of 255\n",
                           shaders, shaders == 1 ? "" : "s", gain, pixels, a.size() / 3, most);
    }
};

}  // namespace

void add_render(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("render", "Draw a glTF scene under a model, as a PNG");
    auto render = std::make_shared<Render>();
    command->add_option("SCENE", render->scene, "A .gltf or .glb file")->required();
    command
        ->add_option("--model", render->model,
                     "A .lobe file, or FILE:MODEL where it has more than one")
        ->capture_default_str();
    command->add_option("-o,--output", render->out, "The picture; `-` is standard output")
        ->required();
    command->add_option("--size", render->size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    command->add_option("--rays", render->options.rays, "Rays per pixel, squared")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    command
        ->add_option("--directions", render->options.directions,
                     "Directions of the environment, per ray")
        ->check(CLI::Range(2, 65536))
        ->capture_default_str();
    command
        ->add_option("--exposure", render->exposure,
                     "What radiance is multiplied by (default: the log average becomes 0.18)")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--compare", render->compare,
                     "`general`: show what specialize leaves, the whole model and their difference")
        ->check(CLI::IsMember({"general"}));
    command->add_option("--gain", render->gain, "How much larger --compare shows differences")
        ->check(CLI::Range(1, 255))
        ->capture_default_str();
    command->add_option("-j,--jobs", render->options.jobs, "Threads (default: one per core)");
    command->footer("One bounce: the scene's lights with shadows, and its environment; by the "
                    "evaluator, in float.\n"
                    "Example: lobec render head.gltf --model models/callisto.lobe -o head.png\n"
                    "         lobec render head.gltf --compare general -o compare.png");
    command->callback([render, &terminal, &status] { status = render->run(terminal); });
}

}  // namespace lobe::cli
