// `lobec patch`: a model into an engine's source tree, as a diff or in place; and out again.
#include "report/patch.h"

#include "cli/commands.h"
#include "cli/engine_tree.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "emit/engine_values.h"
#include "emit/template.h"
#include "engine/diff.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace lobe::cli {
namespace {

/// The edit list that the compiler ships; one that does not parse is a bug of ours.
engine::ParsedEdits shipped_edits()
{
    return engine::parse_edits(*emit::embedded_template("ue4/engine.edits"));
}

/// What one engine block asks of a tree.
struct Wanted {
    engine::Request request;
    std::string node;              ///< the custom output's function; empty without one
    std::vector<int> node_inputs;  ///< components of each of its inputs
    /// Of the engine, that the packing supports; empty if the gbuffer does not tell them apart.
    std::vector<std::string> versions;
};

/// `v4_27` of a gbuffer's setting `version` is 4.27.
std::vector<std::string> supported_versions(const ir::Gbuffer& gbuffer, const ir::Packing& packing)
{
    std::vector<std::string> versions;
    const auto setting = std::ranges::find(gbuffer.settings, "version", &ir::Setting::name);
    if (setting == gbuffer.settings.end()) return versions;
    const auto which = static_cast<std::size_t>(setting - gbuffer.settings.begin());
    for (std::size_t value = 0; value < setting->values.size(); ++value) {
        bool supported = false;
        for (std::size_t i = 0; i < packing.supported.size(); ++i)
            supported |= packing.supported[i] && gbuffer.values(i)[which] == value;
        if (!supported) continue;
        std::string name = setting->values[value];
        if (name.starts_with('v')) name.erase(0, 1);
        std::ranges::replace(name, '_', '.');
        versions.push_back(std::move(name));
    }
    return versions;
}

void check_version(const std::vector<std::string>& supported, engine::Plan& plan)
{
    if (supported.empty() || plan.version.empty()) return;
    if (std::ranges::find(supported, plan.version) != supported.end()) return;
    plan.changes.clear();
    plan.obstacles.push_back({{},
                              0,
                              {},
                              {},
                              fmt::format("this is engine {}, and the packing supports {}",
                                          plan.version, fmt::join(supported, ", ")),
                              "widen `supports version` in the packing; it is checked again then"});
}

std::string file_name(const std::string& path)
{
    return std::filesystem::path{path}.filename().string();
}

/// A tree in which some files are as a plan would have them.
analyze::EngineShaders::Read overlaid(const engine::Tree& tree,
                                      const std::vector<engine::Change>& changes)
{
    return [&tree, &changes](const std::string& path) -> std::optional<std::string> {
        const auto found = std::ranges::find(changes, path, &engine::Change::path);
        return found == changes.end() ? tree.read(path) : found->after;
    };
}

struct Patch {
    std::string input;
    std::string tree;
    std::string shading_model;
    std::string output;
    std::string json;
    bool apply = false;
    bool revert = false;
    bool check = false;
    bool skip_shaders = false;

    int run(const Terminal& terminal) const
    {
        if (apply + revert + check + !output.empty() > 1)
            return fail(terminal, "--apply, --revert, --check and -o exclude each other");
        if (const std::string why = conflict({{"-o", output}, {"--json", json}}); !why.empty())
            return fail(terminal, why);
        if (!std::filesystem::is_directory(tree))
            return fail(terminal, fmt::format("{} is no folder", tree));
        if (is_interrupted(tree)) {
            if (!apply && !revert)
                return fail(terminal, fmt::format("a change of {} was interrupted; run `lobec "
                                                  "patch` with --apply or --revert, which "
                                                  "finishes it first",
                                                  tree));
            if (std::string why = finish_interrupted(tree); !why.empty())
                return fail(terminal, why);
        }

        const engine::ParsedEdits edits = shipped_edits();
        if (!edits.error.empty()) return fail(terminal, "engine.edits:" + edits.error);
        const Program program = load(terminal, {input});
        print(terminal, program.diagnostics, program.sources);
        if (program.status != success) return program.status;
        const auto wanted = choose(terminal, program);
        return wanted ? patch(terminal, edits.list, *wanted) : broken;
    }

    /// The engine block that the command is about, with everything that it needs.
    std::optional<Wanted> choose(const Terminal& terminal, const Program& program) const
    {
        std::string names;
        for (const ir::Module& checked : program.modules) {
            for (std::size_t i = 0; i < checked.engines.size(); ++i) {
                const std::string& name = checked.engines[i].shading_model;
                names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
                if (!shading_model.empty() && name != shading_model) continue;
                if (shading_model.empty() && checked.engines.size() > 1) continue;
                return want(terminal, program, checked, i);
            }
        }
        if (names.empty())
            fail(terminal,
                 fmt::format("{} has no `engine` block, so there is nothing to patch", input));
        else if (shading_model.empty())
            fail(terminal, fmt::format("{} has several shading models, choose one with --model: {}",
                                       input, names));
        else
            fail(terminal, fmt::format("{} has no shading model `{}`; it has {}", input,
                                       shading_model, names));
        return std::nullopt;
    }

    std::optional<Wanted> want(const Terminal& terminal, const Program& program,
                               const ir::Module& checked, std::size_t index) const
    {
        const ir::Module module = middle(checked);
        const ir::Engine& block = module.engines[index];
        const auto packing = emit::packing_of(module, block);
        const auto values = packing ? emit::engine_values(module, block, *packing) : std::nullopt;
        if (!values) {
            fail(terminal, fmt::format("`{}` needs a packing on {} in channels that shaders of the "
                                       "engine can name",
                                       block.shading_model, block.gbuffer));
            return std::nullopt;
        }
        Wanted wanted;
        wanted.request = {values->model, values->values, values->words, {}};
        const auto take_shaders = [&wanted](const ir::Module& from, const Sources& sources) {
            for (emit::Artifact& artifact : back(from, sources, {emit::find_target("ue4")}))
                wanted.request.files.emplace_back(file_name(artifact.path),
                                                  std::move(artifact.text));
        };
        take_shaders(module, program.sources);
        // A model of another module is in that module's own files.
        const std::string& owner = module.packings[*packing].model.module;
        if (owner != module.name) {
            const auto beside = std::filesystem::path{input}.parent_path() / (owner + ".lobe");
            const Program imported = read_and_check(terminal, {beside.generic_string()});
            for (const ir::Module& one : imported.modules)
                take_shaders(middle(one), imported.sources);
        }
        if (const ir::Gbuffer* gbuffer = module.find_gbuffer(block.gbuffer))
            wanted.versions = supported_versions(*gbuffer, module.packings[*packing]);
        if (!block.node) return wanted;
        wanted.node = block.node->name;
        for (const std::uint32_t parameter : block.node->parameters)
            wanted.node_inputs.push_back(ir::components(module.parameters[parameter].type));
        return wanted;
    }

    int patch(const Terminal& terminal, const engine::EditList& list, const Wanted& wanted) const
    {
        const engine::Tree files = disk_tree(tree);
        report::PatchReport result;
        result.model = wanted.request.model;
        result.reverts = revert;
        result.plan = revert ? engine::plan_revert(files, list, wanted.request)
                             : engine::plan_patch(files, list, wanted.request);
        if (!revert) check_version(wanted.versions, result.plan);
        if (!revert && !skip_shaders && result.plan.obstacles.empty())
            result.shaders = check_shaders(files, list, wanted, result.plan.changes);

        std::vector<Output> outputs{{"--json", json}};
        const int status = carry_out(terminal, result, outputs);
        if (status == broken) return broken;
        outputs.front().text = report::patch_json(result);
        const int end = write(terminal, outputs, status);
        if (end != broken && result.ok() && !terminal.quiet)
            fmt::print(stderr, "{}",
                       report::patch_summary(result, {terminal.color_on_stderr(), 0}));
        return end;
    }

    static std::vector<analyze::EngineShaderVerdict>
    check_shaders(const engine::Tree& files, const engine::EditList& list, const Wanted& wanted,
                  const std::vector<engine::Change>& changes)
    {
        // The tree may hold an earlier patch; without it, it is the engine's own.
        const engine::Plan clean = engine::plan_revert(files, list, wanted.request);
        return analyze::check_engine_shaders(
            {.original = overlaid(files, clean.changes),
             .patched = overlaid(files, changes),
             .folder = list.folders.at("SH"),  // engine.edits calls it so
             .shading_model = wanted.request.values.texts.at("MODEL"),
             .node_function = wanted.node,
             .node_inputs = wanted.node_inputs});
    }

    /// Changes the tree, or adds the diff to what is written.
    int carry_out(const Terminal& terminal, report::PatchReport& result,
                  std::vector<Output>& outputs) const
    {
        const report::Look look{terminal.color_on_stderr(), 0};
        fmt::print(stderr, "{}{}", report::patch_obstacles(result, look),
                   report::patch_shaders(result, look));
        if (!result.ok()) return findings;
        const auto& changes = result.plan.changes;
        if (apply || revert) {
            if (std::string why = apply_changes(tree, changes); !why.empty())
                return fail(terminal, is_interrupted(tree) ? why : why + "; the tree is as it was");
            result.applied = true;
        } else if (!check) {
            // Standard output is the diff's, but for a JSON that was sent there.
            const bool to_stdout = output.empty() && json != "-";
            outputs.push_back({"-o", to_stdout ? "-" : output, engine::unified_diff(changes)});
        }
        return check && !changes.empty() ? findings : success;
    }
};

}  // namespace

void add_patch(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "patch", "Make, apply, check or take back the patch of an Unreal Engine 4 source tree");
    auto patch = std::make_shared<Patch>();
    command->add_option("FILE", patch->input, "A .lobe file with an engine block")->required();
    command->add_option("--engine", patch->tree, "The engine's source tree: the folder of Engine/")
        ->required();
    command->add_option("--model", patch->shading_model,
                        "The shading model, where the file has several");
    command->add_option("-o,--output", patch->output, "Write the diff here (default: to stdout)");
    command->add_flag("--apply", patch->apply, "Change the tree: all files or none");
    command->add_flag("--revert", patch->revert,
                      "Take the model out of the tree again, to the byte");
    command->add_flag("--check", patch->check,
                      "Write nothing; exit 1 when the tree is not what the model makes of it");
    command->add_flag("--skip-shaders", patch->skip_shaders,
                      "Do not compile the patched tree's shaders");
    command->add_option("--json", patch->json, "Write what was found and done as JSON");
    command->footer("Reads Unreal Engine 4.25 to 4.27, with local changes. Every edit is a region "
                    "between marked\n"
                    "lines; running it again replaces the regions, and nothing outside of them is "
                    "touched. The\n"
                    "shading model's number is computed from the tree. Obstacles are reported all "
                    "at once, and\n"
                    "then nothing is written.\n"
                    "Examples:\n"
                    "  lobec patch models/callisto.lobe --engine ~/UnrealEngine -o callisto.patch\n"
                    "  lobec patch models/callisto.lobe --engine ~/UnrealEngine --apply");
    command->callback([patch, &terminal, &status] { status = patch->run(terminal); });
}

}  // namespace lobe::cli
