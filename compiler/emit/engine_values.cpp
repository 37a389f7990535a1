#include "emit/engine_values.h"

#include "emit/packing.h"
#include "emit/unreal.h"
#include "emit/wrap.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::emit {
namespace {

bool is_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// What is left of a text when only an identifier's characters stay.
std::string identifier(std::string_view text)
{
    std::string result;
    for (const char c : text)
        if (is_word(c)) result += c;
    return result;
}

std::string upper(std::string text)
{
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

/// As a string literal of C++. Line breaks become blanks.
std::string quoted(std::string_view text)
{
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result + "\"";
}

/// A float of C++.
std::string constant(const Dialect& language, double value)
{
    return language.literal(value) + "f";
}

class Values {
public:
    Values(const ir::Module& module, const ir::Engine& engine, const ir::Gbuffer& gbuffer,
           const ir::Packing& packing, const GbufferAccess& access)
        : module_(module), engine_(engine), gbuffer_(gbuffer), packing_(packing), access_(access),
          language_(dialect(*find_target("ue4"))), model_(identifier(engine.shading_model))
    {
    }

    EngineValues all()
    {
        names();
        pins();
        node();
        unfed();
        channels();
        return {model_, std::move(values_), std::move(words_)};
    }

private:
    std::string& text(std::string_view name) { return values_.texts[name]; }
    std::vector<Record>& list(std::string_view name) { return values_.lists[name]; }

    void names()
    {
        const std::string& module = packing_.model.module;
        text("Model") = model_;
        text("MODEL") = upper(model_);
        text("display") = quoted(engine_.shading_model);
        text("display_text") = engine_.shading_model;
        text("banner") = banner(module_);
        text("bxdf") =
            language_.styled(model_stem(module, packing_.model.name, language_)) + "BxDF";
        text("shader_file") = file(module);
        text("pack") = access_.function;
        text("packing_file") = file(module_.name + "_packing");
        std::vector<std::string> given;
        std::vector<std::string> defaults;
        for (const Member& member : access_.members) {
            given.push_back(local(member.input.which));
            defaults.push_back(value(member.input.which));
        }
        text("pack_arguments") = fmt::format("{}", fmt::join(given, ", "));
        text("default_arguments") = fmt::format("{}", fmt::join(defaults, ", "));
        if (!engine_.color) return;
        std::vector<std::string> parts;
        for (const double part : *engine_.color) parts.push_back(constant(language_, part));
        text("color") = fmt::format("{}", fmt::join(parts, ", "));
        words_.emplace_back("has_color");
    }

    void pins()
    {
        for (std::size_t i = 0; i < gbuffer_.pins.size(); ++i) {
            const std::string name = "pin_" + gbuffer_.pins[i].name;
            list(name);
            for (const ir::Engine::PinUse& use : engine_.pins) {
                if (use.pin != i) continue;
                Record record = parameter(use.parameter);
                const ir::Parameter& fed = module_.parameters[use.parameter];
                record.texts["label"] = quoted(use.label.empty() ? label(fed) : use.label);
                record.texts["constant"] = constant(language_, fed.default_value.front());
                record.texts["pin"] = gbuffer_.pins[i].label;
                list("pins").push_back(record);
                list(name).push_back(std::move(record));
                words_.push_back(name);
            }
        }
        if (!list("pins").empty()) words_.emplace_back("any_pin");
    }

    void node()
    {
        list("nodes");
        if (!engine_.node) return;
        const std::string& name = engine_.node->name;
        words_.emplace_back("has_node");
        text("Node") = name;
        text("NODE") = upper(name);
        text("caption") = quoted(caption(name));
        text("input_count") = std::to_string(engine_.node->parameters.size());
        Namer taken{language_};
        Record node{{{"upper", upper(name)}, {"function", name}}, {}};
        for (const std::uint32_t which : engine_.node->parameters) {
            Record fed = parameter(which);
            fed.texts["index"] = std::to_string(list("inputs").size());
            node.lists["inputs"].push_back(std::move(fed));
            list("inputs").push_back(input(which, taken));
        }
        list("nodes").push_back(std::move(node));

        Record source;
        for (const std::string_view used : {"Node", "display", "caption", "input_count"})
            source.texts[used] = text(used);
        source.lists["inputs"] = list("inputs");
        for (Record& each : source.lists["inputs"]) {
            each.texts = {{"name", each.texts.at("name")}, {"index", each.texts.at("index")}};
            each.lists = {{"number", each.lists.at("number")}, {"color", each.lists.at("color")}};
        }
        text("node_source") = render_embedded("ue4/engine/node.cpp", source).text;
        while (text("node_source").ends_with('\n')) text("node_source").pop_back();
    }

    void unfed()
    {
        list("unfed");
        for (const Member& member : access_.members) {
            const std::uint32_t which = member.input.which;
            const bool in_node =
                engine_.node && std::ranges::find(engine_.node->parameters, which) !=
                                    engine_.node->parameters.end();
            const bool has_pin = std::ranges::any_of(
                engine_.pins, [&](const auto& use) { return use.parameter == which; });
            if (!in_node && !has_pin) list("unfed").push_back(parameter(which));
        }
    }

    void channels()
    {
        std::vector<std::string> taken;  // what the engine has in the packed channels
        for (std::size_t i = 0; i < gbuffer_.channels.size(); ++i) {
            const ir::Channel& channel = gbuffer_.channels[i];
            const std::string name = gbuffer_.targets[channel.target].name + "_" + channel.name;
            list("carrier_" + name);
            const bool packed = std::ranges::any_of(
                packing_.channels, [&](const auto& each) { return each.channel == i; });
            if (!packed) continue;
            list("carrier_" + name).emplace_back();
            words_.push_back("carrier_" + name);
            for (const ir::Channel::Holder& holder : channel.holders) taken.push_back(holder.name);
            if (!channel.holders.empty() && is_stray(i)) words_.push_back("stray_" + name);
        }
        for (std::size_t i = 0; i < gbuffer_.pins.size(); ++i) {
            const std::string& pin = gbuffer_.pins[i].name;
            list("lent_" + pin);
            const bool lent = std::ranges::find(taken, pin) != taken.end() || uses(i) != nullptr;
            if (!lent) continue;
            list("lent_" + pin).emplace_back();
            words_.push_back("lent_" + pin);
        }
    }

    const ir::Engine::PinUse* uses(std::size_t pin) const
    {
        for (const ir::Engine::PinUse& use : engine_.pins)
            if (use.pin == pin) return &use;
        return nullptr;
    }

    /// A parameter in it is not fed by the pin that is named after what the channel holds.
    bool is_stray(std::size_t channel) const
    {
        std::vector<std::uint32_t> expected;
        for (const ir::Channel::Holder& holder : gbuffer_.channels[channel].holders)
            if (const auto pin = gbuffer_.find_pin(holder.name))
                if (const ir::Engine::PinUse* use = uses(*pin)) expected.push_back(use->parameter);
        return std::ranges::any_of(packing_.fields, [&](const ir::Field& field) {
            const bool here = std::ranges::any_of(
                field.slots, [&](const ir::Slot& slot) { return slot.channel == channel; });
            return here && std::ranges::find(expected, field.parameter) == expected.end();
        });
    }

    std::string file(std::string_view name) const
    {
        return language_.styled(name) + find_target("ue4")->extension;
    }

    /// What holds a parameter in the base pass: not the name of anything there.
    std::string local(std::uint32_t which) const
    {
        return model_ + language_.styled(module_.parameters[which].name);
    }

    std::string value(std::uint32_t which) const
    {
        const ir::Parameter& parameter = module_.parameters[which];
        std::vector<std::string> parts;
        for (const double part : parameter.default_value) parts.push_back(language_.literal(part));
        if (parts.size() == 1) return parts.front();
        return fmt::format("{}( {} )", language_.type(parameter.type), fmt::join(parts, ", "));
    }

    Record parameter(std::uint32_t which) const
    {
        return {{{"local", local(which)},
                 {"type", std::string{language_.type(module_.parameters[which].type)}},
                 {"value", value(which)}},
                {}};
    }

    std::string label(const ir::Parameter& parameter) const
    {
        return parameter.label.empty() ? caption(language_.styled(parameter.name))
                                       : parameter.label;
    }

    /// `CallistoAdvancedParams` as people read it.
    static std::string caption(std::string_view name)
    {
        std::string result;
        for (const char c : name) {
            const bool capital = c >= 'A' && c <= 'Z';
            const bool after_small =
                !result.empty() && !(result.back() >= 'A' && result.back() <= 'Z');
            if (capital && after_small) result += ' ';
            result += c;
        }
        return result;
    }

    Record input(std::uint32_t which, Namer& taken) const
    {
        const ir::Parameter& parameter = module_.parameters[which];
        Record record;
        record.texts = {{"index", std::to_string(engine_index(which))},
                        {"name", taken.unique(identifier(label(parameter)))},
                        {"tip", quoted(parameter.doc.empty() ? label(parameter) : parameter.doc)}};
        record.lists["comment"] = lines(paragraphs(parameter.doc, 92));
        record.lists["number"];
        record.lists["color"];
        const std::vector<double>& values = parameter.default_value;
        if (values.size() == 3) {
            record.lists["color"] = {{{{"r", constant(language_, values[0])},
                                       {"g", constant(language_, values[1])},
                                       {"b", constant(language_, values[2])}},
                                      {}}};
        } else {
            record.lists["number"] = {{{{"value", constant(language_, values.front())}}, {}}};
        }
        return record;
    }

    std::size_t engine_index(std::uint32_t which) const
    {
        const auto& all = engine_.node->parameters;
        return static_cast<std::size_t>(std::ranges::find(all, which) - all.begin());
    }

    const ir::Module& module_;
    const ir::Engine& engine_;
    const ir::Gbuffer& gbuffer_;
    const ir::Packing& packing_;
    const GbufferAccess& access_;
    const Dialect& language_;
    std::string model_;
    Record values_;
    std::vector<std::string> words_;
};

}  // namespace

std::optional<std::size_t> packing_of(const ir::Module& module, const ir::Engine& engine)
{
    for (std::size_t i = 0; i < module.packings.size(); ++i)
        if (module.packings[i].model.name == engine.model &&
            module.packings[i].gbuffer == engine.gbuffer)
            return i;
    return std::nullopt;
}

std::optional<EngineValues> engine_values(const ir::Module& module, const ir::Engine& engine,
                                          std::size_t packing)
{
    const std::optional<GbufferAccess> access = gbuffer_access(module, packing);
    const ir::Gbuffer* gbuffer = module.find_gbuffer(engine.gbuffer);
    if (!access || gbuffer == nullptr) return std::nullopt;
    return Values{module, engine, *gbuffer, module.packings[packing], *access}.all();
}

}  // namespace lobe::emit
