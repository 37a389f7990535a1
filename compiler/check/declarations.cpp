#include "check/declarations.h"

#include "check/builtins.h"
#include "check/constants.h"
#include "check/docs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe::check {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr ir::Range everything{-infinity, infinity};

struct NamedType {
    std::string_view name;
    ValueType type;
    ir::Range range;
    bool bounded = false;  ///< the name itself promises the range
};

const std::array<NamedType, 12>& named_types()
{
    constexpr ir::Range unit{0, 1};
    static const std::array<NamedType, 12> types{
        NamedType{"float", number_type, everything},
        NamedType{"int", integer_type, everything},
        NamedType{"bool", boolean_type, unit},
        NamedType{"float2", vector_type(2), everything},
        NamedType{"float3", vector_type(3), everything},
        NamedType{"float4", vector_type(4), everything},
        NamedType{"unit", number_type, unit, true},
        // What goes in as a color is a reflectance; a result may be brighter.
        NamedType{"color", color_type, unit},
        NamedType{"direction", direction_type, {-1, 1}},
        NamedType{"geometry", {{}, {}, Structure::geometry}, everything},
        NamedType{"surface", {{}, {}, Structure::surface}, everything},
        NamedType{"emitter", {{}, {}, Structure::emitter}, everything},
    };
    return types;
}

void report_unknown_type(const syntax::Identifier& name, Diagnostics& diagnostics)
{
    std::vector<std::string> candidates = type_names();
    std::optional<std::string> other;
    if (const auto ours = translated(name.text); ours && is_type_name(*ours)) other = *ours;
    Diagnostic diagnostic{
        .code = Code::unknown_type,
        .message = fmt::format("no type is called `{}`{}", name.text,
                               other ? fmt::format("; here it is `{}`", *other)
                                     : did_you_mean(name.text, candidates)),
        .primary = {name.span, ""},
        .notes = {"the types are float, int, bool, float2, float3, float4, unit, color, "
                  "direction, geometry, surface and emitter"}};
    diagnostic.fix = other ? Fix{name.span, *other, fmt::format("write `{}`", *other)}
                           : rename_fix(name.text, name.span, candidates);
    diagnostics.report(std::move(diagnostic));
}

/// A number as such, so that writing its value is writing it again.
bool is_written(const syntax::Tree& tree, syntax::ExpressionId id)
{
    if (const auto* unary = std::get_if<syntax::Unary>(&tree[id].node)) id = unary->operand;
    return std::holds_alternative<syntax::Number>(tree[id].node);
}

}  // namespace

bool resolve_range(const syntax::Tree& tree, const syntax::RangeClause& clause, ir::Range& range,
                   Diagnostics& diagnostics)
{
    const auto low = constant_value(tree, clause.low, diagnostics);
    const auto high = constant_value(tree, clause.high, diagnostics);
    if (!low || !high) return false;
    range = {*low, *high};
    if (*low < *high) return true;
    const std::string low_text = describe(*low);
    const std::string high_text = describe(*high);
    Diagnostic diagnostic{
        .code = Code::empty_range,
        .message = *low == *high ? fmt::format("this range holds one value, {}", low_text)
                                 : "the ends of this range are reversed",
        .primary = {clause.span,
                    *low == *high ? "" : fmt::format("{} is above {}", low_text, high_text)}};
    if (*low == *high)
        diagnostic.helps = {"a value that never changes is a constant: write it where it is used"};
    else if (is_written(tree, clause.low) && is_written(tree, clause.high))
        diagnostic.fix = Fix{clause.span, fmt::format("[{}, {}]", high_text, low_text),
                             "put the smaller end first"};
    else
        diagnostic.helps = {"put the smaller end first"};
    diagnostics.report(std::move(diagnostic));
    return false;
}

std::optional<DeclaredType> resolve_type(const syntax::Tree& tree, const syntax::TypeClause& clause,
                                         Place place, Diagnostics& diagnostics)
{
    if (clause.name.text.empty()) return std::nullopt;  // a syntax error was reported
    const auto& types = named_types();
    const auto* found = std::ranges::find(types, clause.name.text, &NamedType::name);
    if (found == types.end()) {
        report_unknown_type(clause.name, diagnostics);
        return std::nullopt;
    }
    const auto misplaced = [&](std::string message, const Span& span) {
        diagnostics.report({.code = Code::misplaced_type,
                            .message = std::move(message),
                            .primary = {span, ""},
                            .notes = {}});
        return std::nullopt;
    };
    if (found->type.structure != Structure::none && place != Place::argument)
        return misplaced(fmt::format("{} cannot be {}", describe(found->type),
                                     place == Place::result ? "a result" : "a parameter"),
                         clause.name.span);

    DeclaredType result{found->type, found->range, found->bounded, clause.span};
    // A result says only what its clause says; the rest is inferred from the body.
    if (place == Place::result && !found->bounded) result.range = everything;
    if (!clause.range) return result;
    if (!is_number(found->type) && (!is_vector(found->type) || found->type == direction_type))
        return misplaced(fmt::format("a {} has no range of its own", clause.name.text),
                         clause.range->span);
    if (!resolve_range(tree, *clause.range, result.range, diagnostics)) return std::nullopt;
    result.bounded = true;
    return result;
}

Signature resolve_signature(const syntax::Tree& tree,
                            const std::vector<syntax::ParameterClause>& parameters,
                            const std::optional<syntax::TypeClause>& result,
                            Diagnostics& diagnostics)
{
    Signature signature;
    for (const syntax::ParameterClause& clause : parameters) {
        const auto type = resolve_type(tree, clause.type, Place::argument, diagnostics);
        if (!type) signature.broken = true;
        const auto same = std::ranges::find(signature.arguments, clause.name.text, &Argument::name);
        if (same != signature.arguments.end() && !clause.name.text.empty()) {
            diagnostics.report(
                {.code = Code::duplicate_name,
                 .message = fmt::format("two arguments are called `{}`", clause.name.text),
                 .primary = {clause.name.span, ""},
                 .secondary = {{same->span, "the other one"}}});
            signature.broken = true;
        }
        if (type && type->type.structure != Structure::none)
            for (const Argument& other : signature.arguments)
                if (other.type.type == type->type) {
                    diagnostics.report(
                        {.code = Code::misplaced_type,
                         .message = fmt::format("a term takes at most one {}", spell(type->type)),
                         .primary = {clause.type.span, "the second"},
                         .secondary = {{other.type.span, "the first"}}});
                    signature.broken = true;
                }
        signature.arguments.push_back(
            {clause.name.text, clause.name.span, type.value_or(DeclaredType{}), !type});
    }
    if (result) {
        signature.result = resolve_type(tree, *result, Place::result, diagnostics);
        if (!signature.result) signature.broken = true;
    }
    return signature;
}

namespace {

/// The default, one value per component, each inside the range.
bool resolve_default(const syntax::Tree& tree, const syntax::ParamItem& param,
                     const DeclaredType& type, std::vector<double>& values,
                     Diagnostics& diagnostics)
{
    const auto count = static_cast<std::size_t>(ir::components(type.type.type));
    if (param.default_value.size() != 1 && param.default_value.size() != count) {
        diagnostics.report(
            {.code = Code::type_mismatch,
             .message = fmt::format("{} takes {} as its default, not {}", describe(type.type),
                                    count == 1 ? "one number" : fmt::format("{} numbers", count),
                                    param.default_value.size()),
             .primary = {param.default_span, ""},
             .secondary = {{type.span, "the type"}}});
        return false;
    }
    bool good = true;
    for (const syntax::ExpressionId id : param.default_value) {
        const auto value = constant_value(tree, id, diagnostics);
        good = good && value;
        if (!value) continue;
        values.push_back(*value);
        const Span span = tree[id].span;
        if (type.type == integer_type && *value != std::floor(*value)) {
            diagnostics.report({.code = Code::type_mismatch,
                                .message = "the default of an int is a whole number",
                                .primary = {span, fmt::format("this is {}", describe(*value))},
                                .secondary = {{type.span, "the type"}}});
            good = false;
        } else if (*value < type.range.low || *value > type.range.high) {
            const double nearest_end = *value < type.range.low ? type.range.low : type.range.high;
            diagnostics.report(
                {.code = Code::default_out_of_range,
                 .message =
                     fmt::format("the default of `{}` is outside its range", param.name.text),
                 .primary = {span, fmt::format("{} is {} {}", describe(*value),
                                               *value < type.range.low ? "below" : "above",
                                               describe(nearest_end))},
                 .secondary = {{type.span, fmt::format("the range is {}", describe(type.range))}},
                 .fix = Fix{span, describe(nearest_end), "start at the end of the range"}});
            good = false;
        }
    }
    if (good && values.size() == 1) values.resize(count, values[0]);
    return good;
}

}  // namespace

ir::Parameter resolve_parameter(const File& file, const syntax::Item& item,
                                const syntax::ParamItem& param, bool& broken,
                                Diagnostics& diagnostics)
{
    ir::Parameter result;
    result.name = param.name.text;
    result.span = param.name.span;
    result.module = file.name;
    result.label = param.label.value_or("");
    result.doc = read_documentation(file, item.comments, diagnostics).text;

    const auto type = resolve_type(file.tree, param.type, Place::parameter, diagnostics);
    broken = !type;
    if (type) {
        result.type = type->type.type;
        result.quantity = type->type.quantity;
        result.range = type->range;
        if (!resolve_default(file.tree, param, *type, result.default_value, diagnostics))
            result.default_value.assign(static_cast<std::size_t>(ir::components(result.type)), 0);
    }
    if (param.tier) {
        result.tier = param.tier->text;
        if (!file.tiers.contains(param.tier->text) && !file.broken) {
            std::vector<std::string> known;
            for (const auto& [name, span] : file.tiers) known.push_back(name);
            Diagnostic diagnostic{.code = Code::unknown_tier,
                                  .message =
                                      fmt::format("no tier is called `{}`{}", param.tier->text,
                                                  did_you_mean(param.tier->text, known)),
                                  .primary = {param.tier->span, ""},
                                  .fix = rename_fix(param.tier->text, param.tier->span, known)};
            if (known.empty())
                diagnostic.helps = {fmt::format("declare it first: `tier {}`", param.tier->text)};
            else if (!diagnostic.fix)
                diagnostic.notes = {fmt::format("the tiers are {}", fmt::join(known, ", "))};
            diagnostics.report(std::move(diagnostic));
        }
    }
    return result;
}

}  // namespace lobe::check
