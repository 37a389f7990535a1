// `lobec scene`: what a scene calls for, under a model.
#include "report/scene.h"

#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/scene_file.h"
#include "compile.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace lobe::cli {
namespace {

struct SceneCommand {
    std::vector<std::string> scenes;
    std::string model = "models/callisto.lobe";
    std::string json;

    int run(const Terminal& terminal) const
    {
        std::vector<Output> outputs{{"--json", json}};
        const ModelFile file = load_model(terminal, model);
        if (file.status != success) return file.status;
        const ir::Module optimized = middle(file.module());
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        int status = success;
        for (const std::string& path : scenes) {
            const auto read = read_facts(terminal, path, file);
            if (!read) {
                status = broken;
                continue;
            }
            const auto layered = analyze::layered_materials(read->scene, optimized, file.model);
            if (!is_piped(outputs) && !terminal.quiet)
                show(terminal, path, file, read->facts, layered);
            nlohmann::ordered_json each{{"scene", path}, {"module", file.module().name}};
            each.update(report::to_json(read->facts));
            each["layered"] = report::to_json(layered);
            all.push_back(std::move(each));
        }
        if (status != success) return status;
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        outputs[0].text = all.dump(2, ' ', false, replace) + "\n";
        return write(terminal, outputs, success);
    }

    void show(const Terminal& terminal, const std::string& path, const ModelFile& file,
              const analyze::SceneFacts& facts, const analyze::LayeredMaterials& layered) const
    {
        const report::Look look{terminal.color_on_stdout(), terminal.width()};
        const std::string of_layers = report::to_text(layered, look);
        fmt::print("{}{}: {} material{} under model {} of {}\n\n{}{}{}",
                   path == scenes.front() ? "" : "\n", path, facts.materials.size(),
                   facts.materials.size() == 1 ? "" : "s", file.model, file.module().name,
                   report::to_text(facts, look), of_layers.empty() ? "" : "\n", of_layers);
    }
};

}  // namespace

void add_scene(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand("scene", "Show what a glTF scene calls for, and why");
    auto scene = std::make_shared<SceneCommand>();
    command->add_option("SCENE", scene->scenes, "A .gltf or .glb file")->required();
    command
        ->add_option("--model", scene->model,
                     "A .lobe file, or FILE:MODEL where it has more than one")
        ->capture_default_str();
    command->add_option("--json", scene->json, "Write the facts as JSON; `-` is standard output");
    command->footer(
        "A model's own parameters stand in `extras.lobe.parameters` of a material:\n"
        "  \"extras\": {\"lobe\": {\"parameters\": {\"retroreflection\": 4}}}\n"
        "Exits with 2 when a scene cannot be read or gives a value that the model does not take.\n"
        "Example: lobec scene head.gltf --model models/callisto.lobe\n"
        "         lobec scene *.glb --model models/callisto.lobe:callisto_lambert --json -");
    command->callback([scene, &terminal, &status] { status = scene->run(terminal); });
}

}  // namespace lobe::cli
