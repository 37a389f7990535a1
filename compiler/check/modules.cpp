#include "check/modules.h"

#include "syntax/parse.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

/// `models/callisto.lobe` is `callisto` unless it says otherwise.
std::string stem(std::string_view path)
{
    const std::size_t slash = path.find_last_of("/\\");
    if (slash != std::string_view::npos) path.remove_prefix(slash + 1);
    return std::string{path.substr(0, path.find('.'))};
}

class Loading {
public:
    Loading(Program& program, Sources& sources, const Loader& loader, Diagnostics& diagnostics)
        : program_(program), sources_(sources), loader_(loader), diagnostics_(diagnostics)
    {
    }

    /// Parses one source and, before it is added, everything it imports.
    std::size_t load(std::uint32_t source, const std::string& expected_name)
    {
        auto file = std::make_unique<File>();
        const int errors = diagnostics_.error_count();
        file->source = source;
        file->tree = syntax::parse(sources_, source, diagnostics_);
        file->broken = diagnostics_.error_count() > errors;
        file->name = file->tree.module ? file->tree.module->text : stem(sources_[source].path());

        const std::string key = expected_name.empty() ? file->name : expected_name;
        path_.push_back({key, {}});
        for (const syntax::Item& item : file->tree.items)
            if (const auto* import = std::get_if<syntax::Import>(&item.node)) {
                path_.back().import = import->module.span;
                file->imports.push_back(follow(*import, sources_[source].path()));
            }
        path_.pop_back();

        program_.files.push_back(std::move(file));
        const std::size_t index = program_.files.size() - 1;
        loaded_[key] = index;
        return index;
    }

private:
    struct Step {
        std::string module;
        Span import;  ///< the import being followed
    };

    std::optional<std::size_t> follow(const syntax::Import& import, const std::string& from)
    {
        const std::string& name = import.module.text;
        const auto entered = std::ranges::find(path_, name, &Step::module);
        if (entered != path_.end()) {
            report_cycle(import, entered);
            return std::nullopt;
        }
        if (const auto found = loaded_.find(name); found != loaded_.end()) return found->second;
        if (std::ranges::find(missing_, name) != missing_.end()) return std::nullopt;

        const auto source = loader_ ? loader_(sources_, name, from) : std::nullopt;
        if (!source) {
            missing_.push_back(name);
            std::vector<std::string> known;
            for (const auto& [module, index] : loaded_) known.push_back(module);
            diagnostics_.report(
                {.code = Code::unknown_module,
                 .message = fmt::format("the module `{}` cannot be found{}", name,
                                        did_you_mean(name, known)),
                 .primary = {import.module.span, "no such file"},
                 .notes = {fmt::format("a module `m` is the file `m.lobe` beside the one that "
                                       "imports it; this one is `{}`",
                                       from)},
                 .fix = rename_fix(name, import.module.span, known)});
            return std::nullopt;
        }
        const std::size_t index = load(*source, name);
        const File& file = *program_.files[index];
        if (file.name != name && !file.broken)
            diagnostics_.report(
                {.code = Code::unknown_module,
                 .message =
                     fmt::format("the file of module `{}` declares module `{}`", name, file.name),
                 .primary = {import.module.span, "imported by this name"},
                 .secondary = {{file.tree.module->span, "declared by this name"}},
                 .helps = {"give the module the name of its file"}});
        return index;
    }

    void report_cycle(const syntax::Import& import, std::vector<Step>::const_iterator entered)
    {
        std::string chain;
        std::vector<Label> others;
        for (auto step = entered; step != path_.end(); ++step) {
            chain += fmt::format("`{}` imports ", step->module);
            if (step + 1 != path_.end())
                others.push_back(
                    {step->import, fmt::format("`{}` is imported here", (step + 1)->module)});
        }
        chain += fmt::format("`{}`", import.module.text);
        const bool itself = entered + 1 == path_.end();
        diagnostics_.report(
            {.code = Code::import_cycle,
             .message = itself ? fmt::format("module `{}` imports itself", import.module.text)
                               : fmt::format("modules import each other: {}", chain),
             .primary = {import.module.span, itself ? "" : "this closes the cycle"},
             .secondary = std::move(others),
             .helps = {"move what both need into a third module"}});
    }

    Program& program_;
    Sources& sources_;
    const Loader& loader_;
    Diagnostics& diagnostics_;
    std::vector<Step> path_;
    std::map<std::string, std::size_t> loaded_;
    std::vector<std::string> missing_;
};

}  // namespace

void load_files(Program& program, Sources& sources, std::uint32_t root, const Loader& loader,
                Diagnostics& diagnostics)
{
    Loading{program, sources, loader, diagnostics}.load(root, {});
}

std::string_view describe(NameKind kind)
{
    switch (kind) {
    case NameKind::callable: return "a term";
    case NameKind::parameter: return "a parameter";
    case NameKind::model: return "a model";
    case NameKind::light: return "a light";
    case NameKind::output: return "an output";
    case NameKind::gbuffer: return "a gbuffer";
    case NameKind::code: return "a code";
    case NameKind::lost: return "";
    }
    return "";
}

std::vector<std::string> names_of(const Scope& scope, NameKind kind)
{
    std::vector<std::string> names;
    for (const auto& [name, declared] : scope)
        if (declared.kind == kind) names.push_back(name);
    return names;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates)
{
    const auto near = nearest(name, candidates);
    return near ? fmt::format("; did you mean `{}`?", *near) : std::string{};
}

std::optional<Fix> rename_fix(std::string_view name, const Span& span,
                              const std::vector<std::string>& candidates)
{
    const auto near = nearest(name, candidates);
    if (!near) return std::nullopt;
    return Fix{span, *near, fmt::format("write `{}`", *near)};
}

}  // namespace lobe::check
