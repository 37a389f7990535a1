// The whole compiler on one page. Read this first.
//
//   text ──front──▶ module ──middle──▶ module ──back──▶ files
//
// `front` is the only part that can reject a program, and reports everything that is wrong with
// it. What comes after is total. Beside this line stand the witnesses: `evaluate` says what a
// module means, `verify` and `device` say what real compilers and devices make of its text, and
// `analyze` holds the two together.
#include "compile.h"

#include "lobe/lobe.h"
#include "optimize/optimize.h"

namespace lobe {

std::optional<ir::Module> front(Sources& sources, std::uint32_t root, const check::Loader& loader,
                                Diagnostics& diagnostics)
{
    return check::check(sources, root, loader, diagnostics);
}

ir::Module middle(const ir::Module& module) { return optimize::optimize(module); }

std::vector<emit::Artifact> back(const ir::Module& module, const Sources& sources,
                                 const std::vector<const emit::Target*>& targets)
{
    return emit::emit(module, sources, targets);
}

// ---- the public interface: the same line, without the compiler's own types

namespace {

Message message_of(const Diagnostic& diagnostic, const Sources& sources)
{
    const Position at = sources.position(diagnostic.primary.span);
    return {std::string{id(diagnostic.code)},
            severity(diagnostic.code) == Severity::error,
            sources[diagnostic.primary.span.source].path(),
            at.line,
            at.column,
            diagnostic.message};
}

}  // namespace

bool Result::ok() const
{
    for (const Message& message : messages)
        if (message.is_error) return false;
    return true;
}

std::vector<std::string> target_names()
{
    std::vector<std::string> names;
    for (const emit::Target& target : emit::targets()) names.push_back(target.name);
    return names;
}

Result compile(const File& file, const Importer& importer, const Options& options)
{
    Result result;
    std::vector<const emit::Target*> targets;
    for (const std::string& name : options.targets.empty() ? target_names() : options.targets) {
        const emit::Target* target = emit::find_target(name);
        if (target == nullptr) {
            result.messages.push_back({std::string{id(Code::unknown_target)}, true, file.path, 1, 1,
                                       "unknown target `" + name + "`"});
            return result;
        }
        targets.push_back(target);
    }

    Sources sources;
    Diagnostics diagnostics;
    const std::uint32_t root = sources.add(file.path, file.text);
    const check::Loader loader =
        [&importer](Sources& all, std::string_view name,
                    std::string_view importing) -> std::optional<std::uint32_t> {
        if (!importer) return std::nullopt;
        auto found = importer(std::string{name}, std::string{importing});
        if (!found) return std::nullopt;
        return all.add(std::move(found->path), std::move(found->text));
    };

    const auto module = front(sources, root, loader, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.sorted())
        result.messages.push_back(message_of(diagnostic, sources));
    if (!module) return result;

    for (emit::Artifact& artifact : back(middle(*module), sources, targets))
        result.files.push_back({std::move(artifact.path), std::move(artifact.text)});
    return result;
}

}  // namespace lobe
