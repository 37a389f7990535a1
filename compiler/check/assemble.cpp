#include "check/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lobe::check {
namespace {

std::vector<bool> read_parameters(const Program& program)
{
    std::vector<bool> read(program.parameters.size());
    for (const ir::Function& function : program.functions)
        for (const ir::Input& input : function.inputs)
            if (input.origin == ir::Origin::parameter) read[input.which] = true;
    return read;
}

std::string comments_text(const std::vector<syntax::Comment>& comments)
{
    std::string text;
    for (const syntax::Comment& comment : comments)
        text += (text.empty() ? "" : "\n") + comment.text;
    return text;
}

/// What packings and engines name is read by their model, so it is kept.
void renumber(ir::Packing& packing, const std::vector<std::uint32_t>& moved)
{
    for (ir::Field& field : packing.fields) field.parameter = moved[field.parameter];
    for (ir::ExactRequirement& exact : packing.exact) exact.parameter = moved[exact.parameter];
}

void renumber(ir::Engine& engine, const std::vector<std::uint32_t>& moved)
{
    for (ir::Engine::PinUse& pin : engine.pins) pin.parameter = moved[pin.parameter];
    if (!engine.node) return;
    for (std::uint32_t& parameter : engine.node->parameters) parameter = moved[parameter];
}

/// Sources keep their name, unless another file gave it to another source.
class SourceList {
public:
    explicit SourceList(std::vector<ir::Source>& list) : list_(list) {}

    std::string add(const File& file, const syntax::SourceItem& item)
    {
        std::string name = item.name.text;
        auto same = find(name);
        if (same != list_.end() && same->text != item.text) {
            name = fmt::format("{}_{}", file.name, name);
            same = find(name);
        }
        if (same == list_.end()) list_.push_back({name, item.text, item.name.span});
        return name;
    }

private:
    std::vector<ir::Source>::iterator find(const std::string& name)
    {
        return std::ranges::find(list_, name, &ir::Source::name);
    }

    std::vector<ir::Source>& list_;
};

}  // namespace

void report_collisions(const Program& program, Diagnostics& diagnostics)
{
    // The root comes first: what it declares is what the author can see.
    std::map<std::string, Span> taken;
    const File& root = *program.files.back();
    for (const auto& [name, declared] : root.names)
        if (!declared.imported) taken.try_emplace(name, declared.span);
    for (const ir::Function& function : program.functions)
        if (function.module == root.name && function.kind == ir::Function::Kind::storage)
            taken.try_emplace(function.name, function.span);

    const auto enter = [&](const std::string& name, const Span& span, std::string_view what,
                           const std::string& module) {
        const auto [found, added] = taken.try_emplace(name, span);
        if (added || found->second == span) return;
        diagnostics.report(
            {.code = Code::duplicate_name,
             .message = fmt::format("the {} `{}` of module `{}` comes along with an import, and "
                                    "its name is taken",
                                    what, name, module),
             .primary = {found->second, "declared here"},
             .secondary = {{span, "the one that comes along"}},
             .helps = {"rename one of them"}});
    };
    const std::vector<bool> read = read_parameters(program);
    for (std::size_t i = 0; i < program.parameters.size(); ++i)
        if (read[i])
            enter(program.parameters[i].name, program.parameters[i].span, "parameter",
                  program.parameters[i].module);
    for (const ir::Function& function : program.functions)
        if (function.module != root.name)
            enter(function.name, function.span, "term", function.module);
}

ir::Module assemble(Program& program, Declarations declarations, const Sources& sources)
{
    const File& root = program.root();
    ir::Module module;
    module.name = root.name;
    module.path = sources[root.source].path();
    module.doc = comments_text(root.tree.header);
    module.effects = std::move(declarations.effects);
    module.models = std::move(declarations.models);
    module.lights = std::move(declarations.lights);
    module.shadings = std::move(declarations.shadings);
    module.gbuffers = std::move(declarations.gbuffers);
    module.packings = std::move(declarations.packings);
    module.engines = std::move(declarations.engines);

    SourceList list{module.sources};
    for (const syntax::Item& item : root.tree.items) {
        if (const auto* source = std::get_if<syntax::SourceItem>(&item.node))
            list.add(root, *source);
        if (const auto* tier = std::get_if<syntax::TierItem>(&item.node))
            for (const syntax::Identifier& name : tier->names) module.tiers.push_back(name.text);
    }

    std::vector<bool> kept = read_parameters(program);
    std::vector<std::uint32_t> moved(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        ir::Parameter& parameter = program.parameters[i];
        if (!kept[i] && parameter.module != root.name) continue;
        moved[i] = static_cast<std::uint32_t>(module.parameters.size());
        if (!parameter.tier.empty() &&
            std::ranges::find(module.tiers, parameter.tier) == module.tiers.end())
            module.tiers.push_back(parameter.tier);
        module.parameters.push_back(std::move(parameter));
    }

    for (ir::Packing& packing : module.packings) renumber(packing, moved);
    for (ir::Engine& engine : module.engines) renumber(engine, moved);

    module.functions = std::move(program.functions);
    for (ir::Function& function : module.functions) {
        for (ir::Input& input : function.inputs)
            if (input.origin == ir::Origin::parameter) input.which = moved[input.which];
        if (function.module == root.name) continue;
        for (ir::Citation& citation : function.citations)
            for (const auto& file : program.files)
                if (file->name == function.module)
                    if (const auto found = file->sources.find(citation.source);
                        found != file->sources.end())
                        citation.source = list.add(*file, *found->second);
    }
    return module;
}

}  // namespace lobe::check
