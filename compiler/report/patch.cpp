#include "report/patch.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>

namespace lobe::report {
namespace {

using nlohmann::ordered_json;
using Verdict = analyze::EngineShaderVerdict;

std::string_view what_happens(const engine::Change& change)
{
    if (!change.before) return "new";
    return change.after ? "changed" : "removed";
}

std::string_view name(Verdict::Result result)
{
    switch (result) {
    case Verdict::Result::compiles: return "compiles";
    case Verdict::Result::broken: return "broken";
    case Verdict::Result::unknown: return "unknown";
    }
    return {};
}

std::string counted(std::size_t number, std::string_view singular)
{
    return fmt::format("{} {}{}", number, singular, number == 1 ? "" : "s");
}

/// `as shading model 12`, when the tree was asked for a number.
std::string id_text(const engine::Plan& plan)
{
    for (const auto& [name, value] : plan.read)
        if (name == "next_id") return fmt::format(" as shading model {}", value);
    return {};
}

/// True when what to do is a change of the edit list.
bool names_list(const engine::Obstacle& obstacle)
{
    return obstacle.help.find(" the list") != std::string::npos;
}

}  // namespace

bool PatchReport::ok() const
{
    return plan.obstacles.empty() && std::ranges::none_of(shaders, [](const Verdict& verdict) {
               return verdict.result == Verdict::Result::broken;
           });
}

std::string patch_summary(const PatchReport& report, const Look& look)
{
    std::string text;
    std::size_t added = 0;
    std::size_t removed = 0;
    for (const engine::Change& change : report.plan.changes) {
        added += change.before ? 0 : 1;
        removed += change.after ? 0 : 1;
        const Style style = !change.before ? Style::good : change.after ? Style::plain : Style::bad;
        text += fmt::format("{} {}\n",
                            styled(fmt::format("{:8}", what_happens(change)), style, look.color),
                            change.path);
    }
    if (report.plan.changes.empty()) {
        text += report.reverts ? fmt::format("nothing of {} is in the tree\n", report.model)
                               : fmt::format("{} is up to date in the tree\n", report.model);
        return text;
    }
    const std::size_t changed = report.plan.changes.size() - added - removed;
    text += report.reverts ? fmt::format("{} out of", report.model)
                           : fmt::format("{}{} into", report.model, id_text(report.plan));
    text += fmt::format(" an engine {}: {}, {} new, {} removed",
                        report.plan.version.empty() ? "tree" : report.plan.version,
                        counted(changed, "changed file"), added, removed);
    if (!report.reverts)
        text += fmt::format(
            ", {}", counted(static_cast<std::size_t>(report.plan.regions), "marked region"));
    return text + (report.applied ? "; applied\n" : "\n");
}

std::string patch_obstacles(const PatchReport& report, const Look& look)
{
    const auto& obstacles = report.plan.obstacles;
    std::string text;
    for (const engine::Obstacle& obstacle : obstacles) {
        text += fmt::format("{}: {}\n", styled("error", Style::bad, look.color), obstacle.what);
        if (!obstacle.file.empty())
            text += fmt::format("  --> {}{}\n", obstacle.file,
                                obstacle.line > 0 ? fmt::format(":{}", obstacle.line) : "");
        if (!obstacle.edit.empty()) text += fmt::format("  = edit: {}\n", obstacle.edit);
        if (!obstacle.anchor.empty()) text += fmt::format("  = anchor: {}\n", obstacle.anchor);
        if (!obstacle.help.empty()) text += fmt::format("  = help: {}\n", obstacle.help);
        text += '\n';
    }
    if (obstacles.empty()) return text;
    if (std::ranges::any_of(obstacles, names_list))
        text += "the list of edits is templates/ue4/engine.edits\n";
    return text + fmt::format("{}; nothing was written\n", counted(obstacles.size(), "obstacle"));
}

std::string patch_shaders(const PatchReport& report, const Look& look)
{
    std::string text;
    bool any_broken = false;
    for (const Verdict& verdict : report.shaders) {
        if (verdict.result == Verdict::Result::compiles) continue;
        const bool broken = verdict.result == Verdict::Result::broken;
        any_broken |= broken;
        text += fmt::format(
            "{}: {}\n",
            styled(broken ? "error" : "warning", broken ? Style::bad : Style::faint, look.color),
            broken ? fmt::format("the patched {} shader does not compile, and the "
                                 "tree's own does",
                                 verdict.shader)
                   : fmt::format("the {} shader was not checked: our stand-ins do "
                                 "not fit this tree, whose own does not compile "
                                 "with them either",
                                 verdict.shader));
        text += fmt::format("  = glslang: {}\n", verdict.message);
        if (broken) text += "  = help: --skip-shaders makes the patch all the same\n";
    }
    return any_broken ? text + "\nnothing was written\n" : text;
}

std::string patch_json(const PatchReport& report)
{
    ordered_json out{{"model", report.model},
                     {"engine", report.plan.version},
                     {"reverts", report.reverts},
                     {"applied", report.applied},
                     {"regions", report.plan.regions}};
    ordered_json& values = out["values"] = ordered_json::object();
    for (const auto& [name, value] : report.plan.read) values[name] = value;
    ordered_json& files = out["files"] = ordered_json::array();
    for (const engine::Change& change : report.plan.changes)
        files.push_back({{"path", change.path}, {"change", what_happens(change)}});
    ordered_json& obstacles = out["obstacles"] = ordered_json::array();
    for (const engine::Obstacle& obstacle : report.plan.obstacles)
        obstacles.push_back({{"file", obstacle.file},
                             {"line", obstacle.line},
                             {"edit", obstacle.edit},
                             {"anchor", obstacle.anchor},
                             {"what", obstacle.what},
                             {"help", obstacle.help}});
    ordered_json& shaders = out["shaders"] = ordered_json::array();
    for (const Verdict& verdict : report.shaders)
        shaders.push_back({{"shader", verdict.shader},
                           {"result", name(verdict.result)},
                           {"message", verdict.message}});
    // Texts come from the user's tree and need not be UTF-8.
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobe::report
