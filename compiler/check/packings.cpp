#include "check/packings.h"

#include "check/conditions.h"
#include "check/constants.h"
#include "check/declarations.h"
#include "check/types.h"
#include "ir/geometry.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

using ir::any;
using ir::both;
using syntax::PackingClause;
using Kind = syntax::PackingClause::Kind;

class Reading {
public:
    Reading(Program& program, Subject subject, Diagnostics& diagnostics)
        : program_(program), subject_(std::move(subject)), gbuffer_(*subject_.gbuffer),
          tree_(program.files[subject_.file]->tree), diagnostics_(diagnostics)
    {
    }

    ReadPacking read(const syntax::Item& item, const syntax::PackingItem& node)
    {
        packing_.model = *subject_.model->model;
        packing_.gbuffer = gbuffer_.name;
        packing_.module = program_.files[subject_.file]->name;
        packing_.doc = syntax::doc_text(item.comments);
        packing_.span = node.model.span;
        packing_.supported = everywhere(gbuffer_);

        // What has to work decides what a field may use; what is packed, what can be required.
        each_clause(node, [this](const PackingClause& clause) {
            if (clause.kind == Kind::supports) add_supported(clause);
            if (clause.kind == Kind::without) add_without(clause);
        });
        for (const auto& line : node.lines)
            if (const auto* field = std::get_if<syntax::FieldClause>(&line)) add_field(*field);
        each_clause(node, [this](const PackingClause& clause) {
            if (clause.kind == Kind::exact) add_exact(clause);
            if (clause.kind == Kind::radiance) add_radiance(clause);
            if (clause.kind == Kind::over) add_measured(clause);
        });
        report_missing_components();
        check_channels(gbuffer_, packing_, fields_, diagnostics_);
        for (const PlacedField& placed : fields_) packing_.fields.push_back(placed.field);
        return {std::move(packing_), std::move(failed_)};
    }

private:
    template <typename Take>
    static void each_clause(const syntax::PackingItem& node, const Take& take)
    {
        for (const auto& line : node.lines)
            if (const auto* clause = std::get_if<PackingClause>(&line)) take(*clause);
    }

    void refuse(std::string message, const Span& span, std::string label = {},
                std::vector<std::string> notes = {}, std::vector<std::string> helps = {})
    {
        diagnostics_.report({.code = Code::packing_clause,
                             .message = std::move(message),
                             .primary = {span, std::move(label)},
                             .notes = std::move(notes),
                             .helps = std::move(helps)});
    }

    void report_unknown(const syntax::Identifier& name, std::string_view what,
                        const std::vector<std::string>& known, std::string_view kind)
    {
        if (name.text.empty()) return;  // a syntax error was reported
        Diagnostic diagnostic{
            .code = Code::packing_clause,
            .message = fmt::format("{} `{}`{}", what, name.text, did_you_mean(name.text, known)),
            .primary = {name.span, ""},
            .fix = rename_fix(name.text, name.span, known)};
        if (!diagnostic.fix)
            diagnostic.notes = {known.empty()
                                    ? fmt::format("it has no {}", kind)
                                    : fmt::format("its {} are {}", kind, fmt::join(known, ", "))};
        diagnostics_.report(std::move(diagnostic));
    }

    // ---- what has to work

    void add_supported(const PackingClause& clause)
    {
        const auto& settings = gbuffer_.settings;
        const auto setting = std::ranges::find(settings, clause.name.text, &ir::Setting::name);
        if (setting == settings.end()) {
            std::vector<std::string> known;
            for (const ir::Setting& other : settings) known.push_back(other.name);
            report_unknown(clause.name, fmt::format("`{}` has no setting", gbuffer_.name), known,
                           "settings");
            return;
        }
        std::vector<std::size_t> values;
        for (const syntax::Identifier& name : clause.names) {
            const auto value = std::ranges::find(setting->values, name.text);
            if (value != setting->values.end())
                values.push_back(static_cast<std::size_t>(value - setting->values.begin()));
            else
                report_unknown(name, fmt::format("the setting `{}` has no value", setting->name),
                               setting->values, "values");
        }
        if (values.empty()) return;
        const auto index = static_cast<std::size_t>(setting - settings.begin());
        const ir::Configurations narrowed = both(packing_.supported, gbuffer_.where(index, values));
        if (any(narrowed)) {
            packing_.supported = narrowed;
            return;
        }
        refuse("nothing is left that this packing supports", clause.span,
               fmt::format("the lines before leave no such `{}`", setting->name),
               {"each `supports` narrows what the others leave; values are listed in one line"});
    }

    void add_without(const PackingClause& clause)
    {
        for (const syntax::Identifier& name : clause.names) {
            std::vector<std::string> lent;
            const ir::Channel::Holder* held = nullptr;
            for (const ir::Channel& channel : gbuffer_.channels)
                for (const ir::Channel::Holder& holder : channel.holders) {
                    if (holder.lent && std::ranges::find(lent, holder.name) == lent.end())
                        lent.push_back(holder.name);
                    if (holder.name == name.text && (held == nullptr || holder.lent))
                        held = &holder;
                }
            if (held == nullptr) {
                report_unknown(name, fmt::format("`{}` lends no", gbuffer_.name), lent,
                               "contents to lend");
            } else if (!held->lent) {
                diagnostics_.report(
                    {.code = Code::packing_clause,
                     .message = fmt::format("no model can do without `{}`", name.text),
                     .primary = {name.span, ""},
                     .secondary = {{held->span, "the engine does not lend it"}},
                     .notes = {lent.empty() ? "it lends nothing"
                                            : fmt::format("it lends {}", fmt::join(lent, ", "))}});
            } else {
                packing_.without.push_back(name.text);
            }
        }
    }

    // ---- fields

    void add_field(const syntax::FieldClause& clause)
    {
        auto read = read_field(program_, subject_, packing_.supported, clause, diagnostics_);
        if (read.empty()) failed_.insert(clause.parameter.text);
        for (PlacedField& placed : read) {
            const auto same = std::ranges::find_if(fields_, [&](const PlacedField& other) {
                return other.field.parameter == placed.field.parameter &&
                       other.field.component == placed.field.component;
            });
            if (same == fields_.end()) {
                fields_.push_back(std::move(placed));
                continue;
            }
            diagnostics_.report(
                {.code = Code::duplicate_name,
                 .message = fmt::format("`{}` is packed twice", placed.name),
                 .primary = {clause.span, "packed again"},
                 .secondary = {{same->field.span, "first packed here"}},
                 .helps = {"one field may lie in several slots: `d.r, d.g[0..3] = …`"}});
        }
    }

    void report_missing_components()
    {
        for (const PlacedField& placed : fields_) {
            const ir::Parameter& parameter = program_.parameters[placed.field.parameter];
            std::vector<int> there;
            std::string missing;
            for (int i = 0; i < ir::components(parameter.type); ++i) {
                const bool packed = std::ranges::any_of(fields_, [&](const PlacedField& other) {
                    return other.field.parameter == placed.field.parameter &&
                           other.field.component == i;
                });
                if (packed)
                    there.push_back(i);
                else
                    missing += fmt::format("{}`{}`", missing.empty() ? "" : ", ",
                                           component_name(parameter, i));
            }
            if (missing.empty() || placed.field.component != there.front() ||
                failed_.contains(parameter.name))
                continue;
            diagnostics_.report(
                {.code = Code::field_width,
                 .message = fmt::format("`{}` is packed in part", parameter.name),
                 .primary = {placed.field.span, fmt::format("nothing stores {}", missing)},
                 .secondary = {{parameter.span, "declared here"}},
                 .helps = {"pack all of its components, or make them parameters of their own"}});
        }
    }

    bool is_packed(std::uint32_t parameter) const
    {
        return std::ranges::any_of(fields_, [&](const PlacedField& placed) {
            return placed.field.parameter == parameter;
        });
    }

    // ---- what is asked of it

    void add_exact(const PackingClause& clause)
    {
        for (const PackingClause::Exact& exact : clause.exact) {
            const auto value = constant_value(tree_, exact.value, diagnostics_);
            const auto index = find_parameter(program_, subject_, exact.parameter,
                                              Code::packing_clause, diagnostics_);
            if (!value || !index) continue;
            const ir::Parameter& parameter = program_.parameters[*index];
            const Span span = join(exact.parameter.span, tree_[exact.value].span);
            if (*value < parameter.range.low || *value > parameter.range.high) {
                diagnostics_.report(
                    {.code = Code::packing_clause,
                     .message = fmt::format("`{}` is never {}", parameter.name, describe(*value)),
                     .primary = {span, ""},
                     .secondary = {
                         {parameter.span, fmt::format("it is in {}", describe(parameter.range))}}});
                continue;
            }
            // A field that did not make sense is not held against what is required of it.
            if (!is_packed(*index)) {
                if (!failed_.contains(parameter.name))
                    refuse(fmt::format("`{}` is not packed", parameter.name), span,
                           "nothing can be required of it");
                continue;
            }
            packing_.exact.push_back({*index, *value, span});
        }
    }

    void add_radiance(const PackingClause& clause)
    {
        if (packing_.radiance_limit) {
            diagnostics_.report({.code = Code::packing_clause,
                                 .message = "two limits for the error of radiance",
                                 .primary = {clause.span, "said again"},
                                 .secondary = {{packing_.radiance_span, "first said here"}}});
            return;
        }
        const auto percent = constant_value(tree_, clause.limit, diagnostics_);
        if (!percent) return;
        if (*percent <= 0) {
            refuse(fmt::format("no packing has an error below {}%", describe(*percent)),
                   tree_[clause.limit].span, "", {}, {"ask for more than 0"});
            return;
        }
        packing_.radiance_limit = *percent / 100;
        packing_.radiance_span = clause.span;
    }

    void add_measured(const PackingClause& clause)
    {
        if (clause.name.text.empty() || !clause.range) return;  // a syntax error was reported
        ir::Range range{};
        if (!resolve_range(tree_, *clause.range, range, diagnostics_)) return;
        const auto same =
            std::ranges::find(packing_.measured, clause.name.text, &ir::MeasuredRange::name);
        if (same != packing_.measured.end()) {
            diagnostics_.report({.code = Code::packing_clause,
                                 .message = fmt::format("two ranges for `{}`", clause.name.text),
                                 .primary = {clause.span, "said again"},
                                 .secondary = {{same->span, "first said here"}}});
            return;
        }
        const auto whole = measurable_range(clause.name);
        if (!whole) return;
        if (range.low < whole->low || range.high > whole->high) {
            refuse(fmt::format("`{}` is in {}", clause.name.text, describe(*whole)),
                   clause.range->span, "and this is outside");
            return;
        }
        packing_.measured.push_back({clause.name.text, range, clause.span});
    }

    /// Of a parameter of the model, or of a field of the surface.
    std::optional<ir::Range> measurable_range(const syntax::Identifier& name)
    {
        const auto is_parameter =
            std::ranges::any_of(subject_.parameters, [&](std::uint32_t index) {
                return program_.parameters[index].name == name.text;
            });
        const auto field = ir::find_surface_field(name.text);
        if (is_parameter || !field) {
            const auto index =
                find_parameter(program_, subject_, name, Code::packing_clause, diagnostics_);
            if (!index) return std::nullopt;
            return program_.parameters[*index].range;
        }
        if (*field == ir::SurfaceField::alpha) {
            refuse("alpha is the square of roughness", name.span, "", {},
                   {"limit the roughness: `over roughness in [0.1, 1]`"});
            return std::nullopt;
        }
        const ir::FieldFacts& known = ir::facts(*field);
        return ir::Range{known.low, known.high};
    }

    Program& program_;
    Subject subject_;
    const ir::Gbuffer& gbuffer_;
    const syntax::Tree& tree_;
    Diagnostics& diagnostics_;
    ir::Packing packing_;
    std::vector<PlacedField> fields_;
    std::set<std::string> failed_;
};

}  // namespace

std::optional<ReadPacking> read_packing(Program& program, const syntax::Item& item,
                                        const syntax::PackingItem& node, Diagnostics& diagnostics)
{
    auto subject =
        find_subject(program, program.files.size() - 1, node.model, node.gbuffer, diagnostics);
    if (!subject) return std::nullopt;
    return Reading{program, std::move(*subject), diagnostics}.read(item, node);
}

}  // namespace lobe::check
