#include "check/gbuffers.h"

#include "check/conditions.h"
#include "check/constants.h"
#include "check/declarations.h"
#include "check/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lobe::check {
namespace {

using ir::Configurations;
using syntax::FactClause;
using Kind = syntax::FactClause::Kind;

struct StorageName {
    std::string_view name;
    ir::Storage storage{};
};
constexpr std::array<StorageName, 4> storages{
    StorageName{"unorm", ir::Storage::unorm}, StorageName{"snorm", ir::Storage::snorm},
    StorageName{"float", ir::Storage::floating}, StorageName{"srgb", ir::Storage::srgb}};

bool has_width(ir::Storage storage, int bits)
{
    switch (storage) {
    case ir::Storage::unorm:
    case ir::Storage::snorm: return bits >= 1 && bits <= 16;
    case ir::Storage::floating: return bits == 16 || bits == 32;
    case ir::Storage::srgb: return bits == 8;
    }
    return false;
}

class Resolving {
public:
    Resolving(const File& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics)
    {
    }

    std::optional<ir::Gbuffer> resolve(const syntax::Item& item, const syntax::GbufferItem& node)
    {
        const int before = diagnostics_.error_count();
        result_.name = node.name.text;
        result_.module = file_.name;
        result_.doc = syntax::doc_text(item.comments);
        result_.span = node.name.span;
        for (const syntax::SettingItem& setting : node.settings) add_setting(setting);
        // Without settings there is nothing that a condition could be about.
        if (diagnostics_.error_count() > before || !is_countable(node)) return std::nullopt;
        for (const syntax::TargetClause& target : node.targets) add_target(target);
        for (const syntax::PinClause& pin : node.pins) add_pin(pin);
        if (diagnostics_.error_count() > before) return std::nullopt;
        return std::move(result_);
    }

private:
    void refuse(std::string message, const Span& span, std::string label = {},
                std::vector<std::string> notes = {}, std::vector<std::string> helps = {})
    {
        diagnostics_.report({.code = Code::gbuffer_declaration,
                             .message = std::move(message),
                             .primary = {span, std::move(label)},
                             .notes = std::move(notes),
                             .helps = std::move(helps)});
    }

    /// False (reported) when a name is taken.
    bool enter(std::map<std::string, Span>& names, const syntax::Identifier& name,
               std::string_view what)
    {
        const auto [found, added] = names.try_emplace(name.text, name.span);
        if (added) return true;
        diagnostics_.report(
            {.code = Code::duplicate_name,
             .message = fmt::format("the {} `{}` is declared twice", what, name.text),
             .primary = {name.span, "declared again"},
             .secondary = {{found->second, "first declared here"}}});
        return false;
    }

    // ---- settings

    void add_setting(const syntax::SettingItem& node)
    {
        enter(settings_, node.name, "setting");
        ir::Setting setting;
        setting.name = node.name.text;
        setting.label = node.label;
        setting.doc = syntax::doc_text(node.comments);
        setting.span = node.name.span;
        std::map<std::string, Span> values;
        for (const syntax::Identifier& value : node.values)
            if (enter(values, value, "value")) setting.values.push_back(value.text);
        const auto found = std::ranges::find(setting.values, node.default_value.text);
        if (found == setting.values.end())
            diagnostics_.report(
                {.code = Code::gbuffer_declaration,
                 .message = fmt::format("the setting `{}` has no value `{}`{}", setting.name,
                                        node.default_value.text,
                                        did_you_mean(node.default_value.text, setting.values)),
                 .primary = {node.default_value.span, "the engine's own has to be one of them"},
                 .notes = {fmt::format("its values are {}", fmt::join(setting.values, ", "))},
                 .fix =
                     rename_fix(node.default_value.text, node.default_value.span, setting.values)});
        else
            setting.default_value = static_cast<std::size_t>(found - setting.values.begin());
        result_.settings.push_back(std::move(setting));
    }

    bool is_countable(const syntax::GbufferItem& node)
    {
        std::size_t count = 1;
        for (const ir::Setting& setting : result_.settings) {
            count *= setting.values.size();
            if (count <= most_configurations) continue;
            refuse(fmt::format("`{}` has more than {} configurations", result_.name,
                               most_configurations),
                   setting.span, "with this setting",
                   {fmt::format("each of {} settings multiplies them by its number of values",
                                node.settings.size())},
                   {"leave out settings that no condition names, or values that act alike"});
            return false;
        }
        return true;
    }

    // ---- targets and channels

    void add_target(const syntax::TargetClause& node)
    {
        enter(targets_, node.name, "target");
        const std::size_t index = result_.targets.size();
        result_.targets.push_back(
            {node.name.text, node.label, syntax::doc_text(node.comments), node.name.span});
        for (const FactClause& fact : node.facts)
            if (fact.kind == Kind::field)
                refuse("a target has no field, its channels have", fact.span, "",
                       {"each channel is another field of the engine's shaders"});
        const Facts common = read(node.facts);
        std::map<std::string, Span> names;
        for (const syntax::ChannelClause& channel : node.channels) {
            enter(names, channel.name, "channel");
            add_channel(channel, index, common);
        }
    }

    /// Facts as read, in the order written.
    struct Facts {
        struct Stored {
            ir::Format format;
            Configurations when;
        };
        std::vector<Stored> formats;
        std::optional<Configurations> exists;
        double absent_value = 0;
        std::string field;
        std::vector<ir::Channel::Holder> holders;
        std::vector<ir::Channel::Remark> consumers;
        std::vector<ir::Channel::Remark> changes;
        bool good = true;
    };

    Facts read(const std::vector<FactClause>& clauses)
    {
        Facts facts;
        const FactClause* exists = nullptr;
        const FactClause* field = nullptr;
        for (const FactClause& clause : clauses) {
            const auto when = condition(clause.condition);
            if (!when) {
                facts.good = false;
                continue;
            }
            switch (clause.kind) {
            case Kind::format:
                if (const auto format =
                        clause.storage ? read_format(*clause.storage) : std::nullopt)
                    facts.formats.push_back({*format, *when});
                else
                    facts.good = false;
                break;
            case Kind::exists:
                if (twice(clause, exists, "exists")) break;
                facts.exists = *when;
                if (clause.otherwise.valid())
                    facts.absent_value =
                        constant_value(file_.tree, clause.otherwise, diagnostics_).value_or(0);
                break;
            case Kind::field:
                if (!twice(clause, field, "field")) facts.field = clause.text;
                break;
            case Kind::holds: add_holder(facts, clause, *when); break;
            case Kind::also: facts.consumers.push_back({clause.text, *when, clause.span}); break;
            case Kind::changes: facts.changes.push_back({clause.text, *when, clause.span}); break;
            }
        }
        return facts;
    }

    std::optional<Configurations> condition(syntax::ExpressionId id)
    {
        if (!id.valid()) return everywhere(result_);
        return decide(file_.tree, id, result_, diagnostics_);
    }

    bool twice(const FactClause& clause, const FactClause*& first, std::string_view word)
    {
        if (first != nullptr) {
            diagnostics_.report({.code = Code::gbuffer_declaration,
                                 .message = fmt::format("`{}` is said twice", word),
                                 .primary = {clause.span, "said again"},
                                 .secondary = {{first->span, "first said here"}}});
            return true;
        }
        first = &clause;
        return false;
    }

    void add_holder(Facts& facts, const FactClause& clause, const Configurations& when)
    {
        const auto same =
            std::ranges::find(facts.holders, clause.name.text, &ir::Channel::Holder::name);
        if (same != facts.holders.end())
            diagnostics_.report(
                {.code = Code::duplicate_name,
                 .message = fmt::format("the content `{}` is declared twice", clause.name.text),
                 .primary = {clause.name.span, "declared again"},
                 .secondary = {{same->span, "first declared here"}},
                 .helps = {"join the conditions by `or`"}});
        facts.holders.push_back({clause.name.text, clause.text, clause.lent, when, clause.span});
    }

    std::optional<ir::Format> read_format(const syntax::StorageClause& clause)
    {
        const auto* found = std::ranges::find(storages, clause.kind.text, &StorageName::name);
        if (found == storages.end()) {
            if (clause.kind.text.empty()) return std::nullopt;  // a syntax error was reported
            std::vector<std::string> known;
            for (const StorageName& storage : storages) known.emplace_back(storage.name);
            diagnostics_.report(
                {.code = Code::gbuffer_declaration,
                 .message = fmt::format("no format is called `{}`{}", clause.kind.text,
                                        did_you_mean(clause.kind.text, known)),
                 .primary = {clause.kind.span, ""},
                 .notes = {"the formats are unorm, snorm, float and srgb"},
                 .fix = rename_fix(clause.kind.text, clause.kind.span, known)});
            return std::nullopt;
        }
        const ir::Format format{found->storage, clause.bits};
        if (has_width(format.storage, format.bits)) return format;
        refuse(fmt::format("there is no format {}", describe(format)), clause.span, "",
               {"unorm and snorm have 1 to 16 bits, float has 16 or 32, srgb has 8"});
        return std::nullopt;
    }

    void add_channel(const syntax::ChannelClause& node, std::size_t target, const Facts& common)
    {
        Facts facts = read(node.facts);
        const auto& formats = facts.formats.empty() ? common.formats : facts.formats;
        if (!facts.exists) {
            facts.exists = common.exists;
            facts.absent_value = common.absent_value;
        }
        const auto prepend = [](auto& own, const auto& shared) {
            own.insert(own.begin(), shared.begin(), shared.end());
        };
        prepend(facts.holders, common.holders);
        prepend(facts.consumers, common.consumers);
        prepend(facts.changes, common.changes);

        ir::Channel channel;
        channel.target = target;
        channel.name = node.name.text;
        channel.label = node.label;
        channel.field = std::move(facts.field);
        channel.exists = facts.exists.value_or(everywhere(result_));
        channel.absent_value = facts.absent_value;
        channel.holders = std::move(facts.holders);
        channel.consumers = std::move(facts.consumers);
        channel.changes = std::move(facts.changes);
        channel.doc = syntax::doc_text(node.comments);
        channel.span = node.name.span;

        channel.formats.resize(result_.configurations());
        Configurations open = channel.exists;
        for (std::size_t i = 0; i < channel.formats.size(); ++i) {
            const auto first = std::ranges::find_if(
                formats, [i](const Facts::Stored& stored) { return stored.when[i]; });
            if (first == formats.end()) continue;
            channel.formats[i] = first->format;
            open[i] = false;
        }
        if (facts.good && common.good) report_open(node, channel, open, formats.empty());
        result_.channels.push_back(std::move(channel));
    }

    void report_open(const syntax::ChannelClause& node, const ir::Channel& channel,
                     const Configurations& open, bool none)
    {
        const auto witness = nearest_to_default(result_, open);
        if (!witness) return;
        refuse(fmt::format("the channel `{}` has no format{}", result_.name_of(channel),
                           none ? std::string{} : " " + describe_where(result_, *witness, open)),
               node.name.span, "", {},
               {"the last `format` of a target or channel has no condition: `format unorm 8`"});
    }

    // ---- pins

    void add_pin(const syntax::PinClause& node)
    {
        enter(pins_, node.name, "pin");
        ir::Pin pin;
        pin.name = node.name.text;
        pin.label = node.label;
        pin.doc = syntax::doc_text(node.comments);
        pin.span = node.name.span;
        if (node.range) {
            ir::Range range{};
            if (resolve_range(file_.tree, *node.range, range, diagnostics_)) pin.range = range;
        }
        const auto value = constant_value(file_.tree, node.default_value, diagnostics_);
        pin.default_value = value.value_or(0);
        if (value && pin.range && (*value < pin.range->low || *value > pin.range->high))
            diagnostics_.report(
                {.code = Code::default_out_of_range,
                 .message = fmt::format("the default of `{}` is outside its range", pin.name),
                 .primary = {file_.tree[node.default_value].span, ""},
                 .secondary = {
                     {node.range->span, fmt::format("the range is {}", describe(*pin.range))}}});
        result_.pins.push_back(std::move(pin));
    }

    const File& file_;
    Diagnostics& diagnostics_;
    ir::Gbuffer result_;
    std::map<std::string, Span> settings_;
    std::map<std::string, Span> targets_;
    std::map<std::string, Span> pins_;
};

}  // namespace

std::optional<ir::Gbuffer> resolve_gbuffer(const Program& program,
                                           const GbufferDeclaration& declared,
                                           Diagnostics& diagnostics)
{
    const File& file = *program.files[declared.file];
    return Resolving{file, diagnostics}.resolve(*declared.item, *declared.node);
}

}  // namespace lobe::check
