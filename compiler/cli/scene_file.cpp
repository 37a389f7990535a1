#include "cli/scene_file.h"

#include "cli/files.h"
#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace lobe::cli {
namespace fs = std::filesystem;

ModelFile load_model(const Terminal& terminal, const std::string& text)
{
    const auto colon = text.rfind(':');
    const bool names_one = colon != std::string::npos &&
                           text.find_first_of("/\\.", colon) == std::string::npos &&
                           colon + 1 < text.size();
    return names_one ? load_model(terminal, text.substr(0, colon), text.substr(colon + 1))
                     : load_model(terminal, text, "");
}

ModelFile load_model(const Terminal& terminal, const std::string& file, const std::string& name)
{
    ModelFile out;
    out.program = read_and_check(terminal, {file});
    print(terminal, out.program.diagnostics, out.program.sources);
    out.status = out.program.status;
    if (out.status != success) return out;
    const auto refuse = [&](const std::string& why) {
        out.status = fail(terminal, why);
        return out;
    };
    if (out.program.modules.size() != 1)
        return refuse(fmt::format("{} is a folder; name one .lobe file", file));
    std::vector<std::string> names;
    for (const ir::Model& model : out.module().models) names.push_back(model.name);
    if (names.empty()) return refuse(fmt::format("{} has no model", file));
    out.model = name.empty() ? names.front() : name;
    if (std::ranges::count(names, out.model) == 0) {
        const auto near = nearest(name, names);
        return refuse(fmt::format("{} has no model `{}`; {}", file, name,
                                  near ? fmt::format("did you mean `{}`?", *near)
                                       : fmt::format("there are {}", fmt::join(names, ", "))));
    }
    return out;
}

std::optional<scene::Scene> read_scene(const Terminal& terminal, const std::string& path,
                                       const scene::ReadOptions& options)
{
    const Read read = read_file(path, options.limits.file_bytes);
    if (!read.text) {
        fail(terminal, fmt::format("cannot read {}: {}", path, read.why));
        return std::nullopt;
    }
    const fs::path folder = fs::path{path}.parent_path();
    const scene::Fetch fetch = [&](const std::string& uri) {
        Read file = read_file((folder / uri).string(), options.limits.file_bytes);
        return scene::Fetched{std::move(file.text), std::move(file.why)};
    };
    scene::ReadScene result = scene::read_gltf(*read.text, path, fetch, options);
    print(terminal, path, result.complaints);
    return std::move(result.scene);
}

std::optional<SceneUnderModel> read_facts(const Terminal& terminal, const std::string& path,
                                          const ModelFile& model)
{
    scene::ReadOptions options;
    options.geometry = false;
    options.keep_pixels = false;
    auto scene = read_scene(terminal, path, options);
    if (!scene) return std::nullopt;
    analyze::FoundFacts found = analyze::find_facts(*scene, model.module(), model.model);
    print(terminal, path, found.complaints);
    if (!found.facts) return std::nullopt;
    return SceneUnderModel{*std::move(scene), *std::move(found.facts)};
}

void print(const Terminal& terminal, const std::string& path,
           const std::vector<scene::Complaint>& complaints)
{
    const bool color = terminal.color_on_stderr();
    for (const scene::Complaint& complaint : complaints) {
        if (terminal.quiet && !complaint.is_error) continue;
        const std::string place =
            complaint.pointer.empty() ? path : fmt::format("{}#{}", path, complaint.pointer);
        fmt::print(stderr, "{}: {}: {}\n", place,
                   complaint.is_error ? report::styled("error", report::Style::bad, color)
                                      : report::styled("note", report::Style::faint, color),
                   complaint.message);
        if (!complaint.help.empty()) fmt::print(stderr, "  help: {}\n", complaint.help);
    }
}

}  // namespace lobe::cli
