#include "check/subjects.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

/// What a name stands for, if it is of this kind; else it is reported, unless that was done before.
const Declared* find(Program& program, std::size_t file, const syntax::Identifier& name,
                     NameKind kind, Diagnostics& diagnostics)
{
    if (name.text.empty()) return nullptr;  // a syntax error was reported
    Scope& names = program.files[file]->names;
    const auto found = names.find(name.text);
    if (found != names.end()) {
        found->second.used = true;
        if (found->second.kind == kind) return &found->second;
        if (found->second.kind == NameKind::lost) return nullptr;
        diagnostics.report({.code = Code::unknown_name,
                            .message = fmt::format("`{}` is {}, not {}", name.text,
                                                   describe(found->second.kind), describe(kind)),
                            .primary = {name.span, ""},
                            .secondary = {{found->second.span, "declared here"}}});
        return nullptr;
    }
    const std::vector<std::string> known = names_of(names, kind);
    Diagnostic diagnostic{.code = Code::unknown_name,
                          .message = fmt::format("no {} is called `{}`{}",
                                                 kind == NameKind::model ? "model" : "gbuffer",
                                                 name.text, did_you_mean(name.text, known)),
                          .primary = {name.span, ""},
                          .fix = rename_fix(name.text, name.span, known)};
    if (!diagnostic.fix)
        diagnostic.helps = {kind == NameKind::model
                                ? "declare it here, or import it from the module that does"
                                : "import it from the module that declares it: `import ue4_gbuffer "
                                  "{ ue4 }`"};
    diagnostics.report(std::move(diagnostic));
    return nullptr;
}

std::vector<std::uint32_t> read_parameters(const Program& program, const ir::Model& model)
{
    std::vector<std::uint32_t> read;
    for (const ir::ModelOutput& output : model.outputs)
        for (const ir::Input& input : program.functions[output.function.index].inputs)
            if (input.origin == ir::Origin::parameter) read.push_back(input.which);
    std::ranges::sort(read);
    read.erase(std::unique(read.begin(), read.end()), read.end());
    return read;
}

/// A parameter that the author may have meant: visible in the file, or of the model's module.
std::optional<std::uint32_t> find_unread(const Program& program, const Subject& subject,
                                         const std::string& name)
{
    const Scope& names = program.files[subject.file]->names;
    const auto found = names.find(name);
    if (found != names.end() && found->second.kind == NameKind::parameter)
        return static_cast<std::uint32_t>(found->second.index);
    const std::string& module = program.files[subject.model->file]->name;
    for (std::uint32_t i = 0; i < program.parameters.size(); ++i)
        if (program.parameters[i].name == name && program.parameters[i].module == module) return i;
    return std::nullopt;
}

}  // namespace

std::optional<Subject> find_subject(Program& program, std::size_t file,
                                    const syntax::Identifier& model,
                                    const syntax::Identifier& gbuffer, Diagnostics& diagnostics)
{
    const Declared* of = find(program, file, model, NameKind::model, diagnostics);
    const Declared* on = find(program, file, gbuffer, NameKind::gbuffer, diagnostics);
    if (!of || !on) return std::nullopt;
    Subject subject;
    subject.file = file;
    subject.model = &program.models[of->index];
    const auto& resolved = program.gbuffers[on->index].gbuffer;
    // What the model of a file with syntax errors reads cannot be told.
    if (!subject.model->model || !resolved || program.files[subject.model->file]->broken)
        return std::nullopt;
    subject.gbuffer = &*resolved;
    subject.parameters = read_parameters(program, *subject.model->model);
    return subject;
}

std::optional<std::uint32_t> find_parameter(Program& program, const Subject& subject,
                                            const syntax::Identifier& name, Code unread,
                                            Diagnostics& diagnostics)
{
    if (name.text.empty()) return std::nullopt;  // a syntax error was reported
    Scope& names = program.files[subject.file]->names;
    const auto visible = names.find(name.text);
    if (visible != names.end()) visible->second.used = true;

    for (const std::uint32_t index : subject.parameters)
        if (program.parameters[index].name == name.text) return index;
    if (visible != names.end() && visible->second.kind == NameKind::lost) return std::nullopt;

    // A model with errors may have read it there.
    const bool known_elsewhere =
        std::ranges::find(program.parameters, name.text, &ir::Parameter::name) !=
        program.parameters.end();
    if (subject.model->broken && known_elsewhere) return std::nullopt;
    const auto meant = find_unread(program, subject, name.text);
    if (meant && program.parameter_broken[*meant]) return std::nullopt;
    if (meant) {
        diagnostics.report({.code = unread,
                            .message = fmt::format("the model `{}` does not read `{}`",
                                                   subject.model_name(), name.text),
                            .primary = {name.span, ""},
                            .secondary = {{program.parameters[*meant].span, "declared here"},
                                          {subject.model->node->name.span, "the model"}}});
        return std::nullopt;
    }
    std::vector<std::string> known;
    for (const std::uint32_t index : subject.parameters)
        known.push_back(program.parameters[index].name);
    Diagnostic diagnostic{.code = Code::unknown_name,
                          .message =
                              fmt::format("`{}` has no parameter `{}`{}", subject.model_name(),
                                          name.text, did_you_mean(name.text, known)),
                          .primary = {name.span, ""},
                          .fix = rename_fix(name.text, name.span, known)};
    if (!diagnostic.fix)
        diagnostic.notes = {known.empty() ? "it reads no parameter"
                                          : fmt::format("it reads {}", fmt::join(known, ", "))};
    diagnostics.report(std::move(diagnostic));
    return std::nullopt;
}

}  // namespace lobe::check
