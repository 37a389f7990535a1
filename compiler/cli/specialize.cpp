// `lobec specialize`: the shaders that a scene calls for, and nothing else, with a certificate.
#include "analyze/residual/certificate.h"
#include "analyze/residual/drop.h"
#include "analyze/residual/variants.h"
#include "analyze/tasks.h"
#include "cli/cache.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/scene_file.h"
#include "cli/settings.h"
#include "emit/listing.h"
#include "lights.h"
#include "lobe/lobe.h"
#include "report/residual.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>

namespace lobe::cli {
namespace {

/// Of --per-material. Every one is compiled to find its cost.
constexpr std::size_t most_shaders = 1000;

/// What each part of a run took.
class Phases {
public:
    void done(const std::string& what)
    {
        const auto now = std::chrono::steady_clock::now();
        told_ += fmt::format("{}{} {:.2f}", told_.empty() ? "" : ", ", what,
                             std::chrono::duration<double>(now - last_).count());
        last_ = now;
    }
    std::string text() const
    {
        const double all = std::chrono::duration<double>(last_ - start_).count();
        return fmt::format("time {:.2f} s: {}", all, told_);
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point last_ = start_;
    std::string told_;
};

struct Specialize {
    std::string input;
    std::string scene;
    std::string model;
    std::vector<std::string> target_names;
    std::string output = "specialized";
    std::string epsilon_text;
    std::string family;
    std::string device;
    std::string json;
    std::string certificate;
    std::string html;
    CacheOptions cache;
    std::size_t variants = 0;
    std::size_t points = analyze::CertificateOptions{}.points;
    unsigned jobs = 0;
    bool per_material = false;
    bool no_certificate = false;
    bool no_execution = false;
    bool no_lights = false;

    int run(const Terminal& terminal) const
    {
        Phases phases;
        std::optional<double> epsilon = 0.0;
        if (!epsilon_text.empty()) epsilon = fraction_of(epsilon_text);
        if (!epsilon)
            return fail(terminal, fmt::format("--epsilon takes a share above 0, such as 0.1% or "
                                              "0.001; got `{}`",
                                              epsilon_text));
        std::vector<Output> outputs{
            {"--json", json}, {"--certificate", certificate}, {"--html", html}};
        if (const std::string why = conflict(outputs); !why.empty()) return fail(terminal, why);

        const ModelFile file = load_model(terminal, input, model);
        if (file.status != success) return file.status;
        phases.done("model");
        auto read = read_facts(terminal, scene, file);
        if (!read) return broken;
        phases.done("scene");
        if (per_material)
            if (const std::size_t kinds = analyze::by_facts(read->facts).size();
                kinds > most_shaders)
                return fail(terminal, fmt::format("--per-material would make {} shaders; it makes "
                                                  "at most {}. `--variants` takes any number of "
                                                  "materials",
                                                  kinds, most_shaders));

        const analyze::Store store = open_cache(cache);
        report::Specialization result;
        {
            Progress progress{terminal};
            result = specialized(file, std::move(read->facts), *epsilon, store, progress, phases);
        }
        std::vector<OutputFile> files = emitted(file, result);
        phases.done("files");
        if (!terminal.quiet && !is_piped(outputs)) {
            const report::Look look{terminal.color_on_stdout(), terminal.width()};
            fmt::print("{}", report::to_text(result, look));
        }
        return finish(terminal, result, std::move(files), outputs, phases);
    }

    /// As it may be typed again, but for where results go.
    std::string command() const
    {
        std::string text = fmt::format("lobec specialize {} --scene {}", emit::shown_path(input),
                                       emit::shown_path(scene));
        if (!model.empty()) text += " --model " + model;
        if (variants > 0) text += fmt::format(" --variants {}", variants);
        if (per_material) text += " --per-material";
        if (!epsilon_text.empty()) text += " --epsilon " + epsilon_text;
        if (!family.empty()) text += " --on " + family;
        return text;
    }

    report::Specialization specialized(const ModelFile& file, analyze::SceneFacts facts,
                                       double epsilon, const analyze::Store& store,
                                       Progress& progress, Phases& phases) const
    {
        analyze::CertificateOptions checks;
        checks.points = points;
        checks.epsilon = epsilon;
        checks.execute = !no_execution;
        checks.device = device;
        checks.jobs = jobs;

        report::Specialization out;
        out.scene = emit::shown_path(scene);
        out.module = file.module().name;
        out.command = command();
        out.epsilon = epsilon;
        out.has_lights = !no_lights;
        out.family = family.empty() ? default_family : *analyze::find_family(family);
        out.facts = std::move(facts);
        std::vector<analyze::DroppedEffects> dropped;
        if (epsilon > 0) {
            progress.show("what is within epsilon");
            dropped = analyze::drop_effects(out.facts, file.module(), epsilon, checks);
            phases.done("epsilon");
        }
        progress.show("shaders and what they cost");
        analyze::VariantOptions options;
        options.most = variants;
        options.per_material = per_material;
        options.family = out.family;
        options.jobs = jobs;
        out.variants = analyze::choose_variants(file.module(), file.program.sources, out.facts,
                                                options, store);
        phases.done("shaders and costs");
        if (no_certificate) return out;
        progress.show("certificates");
        out.certificates = certified(file, out, dropped, checks, store);
        phases.done("certificates");
        return out;
    }

    /// Of the shaders, and of what they are under the lights of the scene.
    std::vector<analyze::Certificate> certified(const ModelFile& file,
                                                const report::Specialization& of,
                                                const std::vector<analyze::DroppedEffects>& dropped,
                                                const analyze::CertificateOptions& checks,
                                                const analyze::Store& store) const
    {
        Sources sources = file.program.sources;
        ir::Module general = file.module();
        std::vector<optimize::Residual> residuals;
        for (const analyze::Variant& variant : of.variants.chosen)
            residuals.push_back(variant.residual);
        if (!no_lights) {
            general = with_lights(general, of.facts.light_names, sources, file.model);
            for (optimize::Residual& residual : residuals)
                residual.module =
                    with_lights(residual.module, of.facts.emitters, sources, file.model);
        }
        std::vector<analyze::CertificateSubject> subjects;
        for (std::size_t i = 0; i < residuals.size(); ++i) {
            const analyze::Variant& variant = of.variants.chosen[i];
            subjects.push_back({&variant.called, &residuals[i],
                                analyze::dropped_in(variant, dropped), &of.facts.emitters});
        }
        return analyze::certify(general, sources, file.model, subjects, checks, store);
    }

    /// The files of every shader, and of what it makes of the lights that the scene has.
    std::vector<OutputFile> emitted(const ModelFile& file,
                                    const report::Specialization& result) const
    {
        const auto targets = choose_targets(target_names);
        std::vector<std::vector<OutputFile>> of_shader(result.variants.chosen.size());
        analyze::for_each_task(of_shader.size(), jobs, [&](std::size_t i) {
            const analyze::Variant& variant = result.variants.chosen[i];
            Sources sources = file.program.sources;
            ir::Module module = analyze::renamed(variant.residual.module, variant.name);
            module.remarks = report::remarks(result, i);
            if (!no_lights) module = with_lights(module, result.facts.emitters, sources);
            for (emit::Artifact& artifact : back(middle(module), sources, targets))
                of_shader[i].push_back(
                    {(std::filesystem::path{output} / artifact.path).generic_string(),
                     std::move(artifact.text)});
        });
        std::vector<OutputFile> files;
        for (auto& some : of_shader) std::ranges::move(some, std::back_inserter(files));
        return files;
    }

    /// Everything is written, or nothing: shaders only under a certificate that holds.
    int finish(const Terminal& terminal, const report::Specialization& result,
               std::vector<OutputFile> files, std::vector<Output>& outputs,
               const Phases& phases) const
    {
        const auto dump = [](const nlohmann::ordered_json& value) {
            return value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                   "\n";
        };
        outputs[0].text = dump(report::to_json(result));
        outputs[1].text = dump(report::certificates_to_json(result));
        outputs[2].text = report::to_page(report::to_document(result));
        if (!result.ok()) {
            fmt::print(stderr, "error: the certificate does not hold; no shader was written\n");
            return cli::write(terminal, outputs, findings);
        }
        const std::size_t shaders = files.size();
        for (const Output& each : outputs) {
            if (each.path == "-")
                fmt::print("{}", each.text);
            else if (!each.path.empty())
                files.push_back({each.path, each.text});
        }
        const Written written = write_files(files);
        if (!written.why.empty()) return fail(terminal, written.why + "; nothing was written");
        if (!terminal.quiet && !is_piped(outputs))
            fmt::print("{} files of {} shader{} in {}: {} written, {} unchanged\n{}\n", shaders,
                       result.variants.chosen.size(), result.variants.chosen.size() == 1 ? "" : "s",
                       output, written.written, written.unchanged, phases.text());
        return success;
    }
};

}  // namespace

void add_specialize(CLI::App& app, const Terminal& terminal, int& status)
{
    auto* command = app.add_subcommand(
        "specialize", "Compile only what a scene calls for, and certify what was left out");
    auto specialize = std::make_shared<Specialize>();
    command->add_option("FILE", specialize->input, "A .lobe file")->required();
    command->add_option("--scene", specialize->scene, "A .gltf or .glb file")->required();
    command->add_option("--model", specialize->model,
                        "Which model of the file (default: the first)");
    command->add_option("-t,--target", specialize->target_names, "Targets (default: all)")
        ->check(CLI::IsMember(lobe::target_names()))
        ->delimiter(',');
    command->add_option("-o,--output", specialize->output, "The folder to write into")
        ->capture_default_str();
    const std::string which = "Which shaders";
    command
        ->add_option("--variants", specialize->variants,
                     "At most so many shaders, the cheapest choice of them (default: as many as "
                     "make every material cheapest)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{4096}))
        ->group(which);
    command
        ->add_flag("--per-material", specialize->per_material,
                   "A shader for every material, its surface's constants in it")
        ->excludes("--variants")
        ->group(which);
    command
        ->add_option("--epsilon", specialize->epsilon_text,
                     "Also leave out effects that are proved to change radiance by less, such as "
                     "0.1%")
        ->group(which);
    command
        ->add_option("--on", specialize->family,
                     "The GPU family to count cycles on (default: rdna2)")
        ->check(CLI::IsMember(family_names()))
        ->group(which);
    command
        ->add_flag("--no-lights", specialize->no_lights,
                   "Leave out the functions that shade under the kinds of light the scene has")
        ->group(which);
    const std::string what = "The certificate";
    command
        ->add_option("--points", specialize->points,
                     "Points per output; a quarter of them where both are proved one graph")
        ->check(CLI::Range(std::size_t{64}, std::size_t{1} << 24))
        ->capture_default_str()
        ->group(what);
    command
        ->add_option("-d,--device", specialize->device,
                     "Vulkan device: a number or a part of its name (default: software)")
        ->group(what);
    command
        ->add_flag("--no-execution", specialize->no_execution,
                   "Use no device: the certificate is the evaluator's")
        ->group(what);
    command->add_flag("--no-certificate", specialize->no_certificate, "Check nothing")->group(what);
    command->add_option("--certificate", specialize->certificate,
                        "Write what was proved and checked as JSON; `-` is standard output");
    command->add_option("--json", specialize->json,
                        "Write everything as JSON; `-` is standard output");
    command->add_option("--html", specialize->html, "Write a self-contained page; `-` likewise");
    command->add_option("-j,--jobs", specialize->jobs, "Threads (default: one per core)");
    add_cache_options(*command, specialize->cache);
    command->footer(
        "Effects that no material calls for are absent, with their parameters. The banner of\n"
        "every file says which materials it is for, what is on and why, and what is off.\n"
        "Exits with 1, and writes no shader, when the certificate does not hold; with 2 when the\n"
        "scene cannot be read or asks for what the model does not take.\n"
        "`lobec build --set` is for values that no scene gives.\n"
        "Example: lobec specialize models/callisto.lobe --scene head.gltf -o out -t ue4\n"
        "         lobec specialize models/callisto.lobe --scene level.glb --variants 3 "
        "--epsilon 0.1%");
    command->callback([specialize, &terminal, &status] { status = specialize->run(terminal); });
}

}  // namespace lobe::cli
