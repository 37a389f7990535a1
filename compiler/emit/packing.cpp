#include "emit/packing.h"

#include "emit/layout.h"
#include "emit/unreal.h"
#include "emit/wrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lobe::emit {
namespace {

constexpr std::string_view gbuffer_prefix = "GBuffer.";

/// The packing's title, its own documentation and its layout.
Record layout_record(const ir::Module& module, const ir::Packing& packing)
{
    std::vector<std::string> text{fmt::format("{} on {}", packing.model.name, packing.gbuffer)};
    if (!packing.doc.empty()) text.emplace_back();
    for (std::string& line : paragraphs(packing.doc, 96)) text.push_back(std::move(line));
    text.emplace_back();
    for (std::string& line : draw_layout(module, packing)) text.push_back(std::move(line));
    return {{}, {{"lines", lines(text)}}};
}

/// Lines of a macro's body.
std::vector<Record> macro_lines(const std::vector<std::string>& statements)
{
    std::vector<Record> records;
    for (const std::string& statement : statements) {
        std::string text = wrap(statement, 6, "\t");
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3)
            text.replace(at, 1, " \\\n");
        if (&statement != &statements.back()) text += " \\";
        records.push_back({{{"text", std::move(text)}}, {}});
    }
    return records;
}

}  // namespace

std::optional<GbufferAccess> gbuffer_access(const ir::Module& module, std::size_t index)
{
    const ir::Packing& packing = module.packings[index];
    const ir::Gbuffer* gbuffer = module.find_gbuffer(packing.gbuffer);
    if (gbuffer == nullptr) return std::nullopt;
    const Dialect& language = dialect(*find_target("ue4"));

    GbufferAccess access;
    std::set<std::size_t> targets;
    std::set<std::size_t> packed;
    for (const auto& channel : packing.channels) {
        const ir::Channel& known = gbuffer->channels[channel.channel];
        if (!known.field.starts_with(gbuffer_prefix)) return std::nullopt;
        access.fields.push_back(known.field);
        targets.insert(known.target);
        packed.insert(channel.channel);
    }
    for (std::size_t i = 0; i < gbuffer->channels.size(); ++i) {
        const ir::Channel& channel = gbuffer->channels[i];
        if (targets.contains(channel.target) && !packed.contains(i) && channel.holders.empty() &&
            channel.field.starts_with(gbuffer_prefix))
            access.unused.push_back(channel.field);
    }
    const ModelInputs inputs = inputs_of(module, packing.model, language);
    for (const auto& parameter : packing.parameters) {
        const auto member = std::ranges::find(inputs.parameters, parameter.parameter,
                                              [](const Member& m) { return m.input.which; });
        if (member == inputs.parameters.end()) return std::nullopt;
        access.members.push_back(*member);
    }

    const std::string stem = model_stem(packing.model.module, packing.model.name, language);
    const bool again = std::ranges::any_of(
        module.packings.begin(), module.packings.begin() + static_cast<std::ptrdiff_t>(index),
        [&](const ir::Packing& earlier) {
            return earlier.model.name == packing.model.name &&
                   earlier.model.module == packing.model.module;
        });
    access.macro = parameters_macro(again ? stem + "_on_" + packing.gbuffer : stem);
    access.function = language.styled(stem) + "_PackGBuffer" +
                      (again ? language.styled("on_" + packing.gbuffer) : "");
    return access;
}

PackingFiles::PackingFiles(const ir::Module& module, const Sources& sources, const Target& target)
    : module_(module), dialect_(&dialect(target)),
      listing_(module, sources, *dialect_, module.reachable(module.packing_roots()),
               function_prefix(module, target),
               names_of_shared(module, sources, target, module.packing_roots()))
{
    calls_ = root_calls(module, module.packing_roots(), listing_, *dialect_);
    values_.texts = {{"banner", banner(module)}};
    values_.lists["remarks"] = remarks(module);
    if (target.name != "ue4") values_.texts["guard"] = include_guard(module, target, "packing");
    std::vector<Record>& layouts = values_.lists["layouts"];
    for (const ir::Packing& packing : module.packings)
        layouts.push_back(layout_record(module, packing));
    if (target.name == "ue4") {
        values_.lists["accesses"];
        for (std::size_t i = 0; i < module.packings.size(); ++i)
            if (const auto access = gbuffer_access(module, i))
                add_access(module.packings[i], *access);
    }
    values_.lists["functions"] = listing_.functions();
    values_.lists["helpers"] = listing_.helpers();
}

void PackingFiles::add_access(const ir::Packing& packing, const GbufferAccess& access)
{
    std::vector<std::string> fills;
    for (std::size_t i = 0; i < packing.parameters.size(); ++i) {
        std::vector<std::string> operands;
        for (const std::size_t channel : packing.parameters[i].channels)
            operands.push_back(access.fields[channel]);
        fills.push_back(fmt::format("Parameters.{} = {}( {} );", access.members[i].name,
                                    name_of(packing.parameters[i].unpack),
                                    fmt::join(operands, ", ")));
    }
    std::vector<std::string> arguments{"inout FGBufferData GBuffer"};
    for (const Member& member : access.members)
        arguments.push_back(fmt::format("{} {}", dialect_->type(member.input.type), member.name));
    std::vector<std::string> stores;
    for (std::size_t i = 0; i < packing.channels.size(); ++i) {
        std::vector<std::string> operands;
        for (const ir::Input& input : module_[packing.channels[i].pack].inputs)
            for (const Member& member : access.members)
                if (member.input.which == input.which) operands.push_back(member.name);
        stores.push_back(
            wrap(fmt::format("{} = {}( {} );", access.fields[i], name_of(packing.channels[i].pack),
                             fmt::join(operands, ", ")),
                 4, dialect_->indent));
    }
    for (const std::string& field : access.unused) stores.push_back(field + " = 0.0;");

    Record record;
    record.texts = {{"model", packing.model.name},
                    {"gbuffer", packing.gbuffer},
                    {"macro", access.macro},
                    {"signature",
                     wrap(fmt::format("void {}( {} )", access.function, fmt::join(arguments, ", ")),
                          0, dialect_->indent)}};
    record.lists["fills"] = macro_lines(fills);
    record.lists["stores"] = lines(stores);
    record.tag = listing_.tag(packing.span);
    std::vector<Record>& accesses = values_.lists["accesses"];
    accesses.push_back(std::move(record));

    // What a judge's main does with it.
    const std::string gbuffer = fmt::format("FramePacked_{}", accesses.size());
    std::vector<std::string> operands{gbuffer};
    for (const Member& member : access.members)
        operands.push_back(sample(*dialect_, member.input.type));
    calls_.push_back(fmt::format("FGBufferData {} = FrameGBuffer( frame_x );", gbuffer));
    calls_.push_back(fmt::format("{}( {} );", access.function, fmt::join(operands, ", ")));
    for (const std::string& field : access.fields)
        calls_.push_back(
            fmt::format("frame_sum += {}.{};", gbuffer, field.substr(gbuffer_prefix.size())));
}

Artifact PackingFiles::artifact(const Target& target)
{
    const bool precise = target.language == Language::essl;
    std::optional<Rendered>& rendered = rendered_[precise ? 1 : 0];
    if (!rendered && target.name == "ue4") {
        rendered = render_embedded("ue4/packing.ush", values_);
    } else if (!rendered && target.language == Language::hlsl) {
        rendered = render_embedded("hlsl/packing.hlsl", values_);
    } else if (!rendered) {
        values_.lists["precisions"] = std::vector<Record>(precise ? 1 : 0);
        rendered = render_embedded("glsl/packing.glsl", values_);
    }
    std::string text = rendered->text;
    if (text.ends_with("\n\n")) text.pop_back();
    return {fmt::format("{}/{}/{}{}", module_.name, target.name,
                        dialect_->styled(module_.name + "_packing"), target.extension),
            std::move(text), listing_.origins(rendered->marks), calls_};
}

}  // namespace lobe::emit
