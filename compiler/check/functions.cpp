#include "check/functions.h"

#include "check/declarations.h"
#include "check/docs.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lobe::check {

namespace {

/// Gives a value the declared result type. Reports what does not fit.
Value convert_result(Lowering& lowering, const Value& value, const Callable& callable,
                     const Span& span)
{
    const std::optional<DeclaredType>& declared = callable.signature.result;
    if (!value.good) return {};
    if (value.type.structure != Structure::none)
        return lowering.convert(value, declared ? declared->type : number_type, span,
                                fmt::format("the result of `{}`", callable.name), std::nullopt);
    if (!declared) return value;
    return lowering.convert(value, declared->type, span,
                            fmt::format("the result of `{}`", callable.name),
                            Label{declared->span, "declared here"});
}

/// A form gives what its term gives; only how differs.
Value convert_form(Lowering& lowering, const Value& value, const Callable& callable,
                   const ir::Function& term, const Span& span, Diagnostics& diagnostics)
{
    if (!value.good) return {};
    const ValueType wanted{term.quantity, term.type(), Structure::none};
    if (fit(value.type, wanted) != Fit::none) return lowering.convert(value, wanted, span, "", {});
    diagnostics.report(
        {.code = Code::form_signature,
         .message = fmt::format("the form `{}` gives {}, and its term `{}` gives {}",
                                callable.form->name.text, describe(value.type), term.name,
                                describe(wanted)),
         .primary = {span, ""},
         .secondary = {{term.span, "the term"}},
         .notes = {"a form is another way to compute the same term, so a caller may swap them"}});
    return {};
}

void describe_function(ir::Function& function, const File& file,
                       const std::vector<syntax::Comment>& comments, Diagnostics& diagnostics)
{
    Documentation documentation = read_documentation(file, comments, diagnostics);
    function.doc = std::move(documentation.text);
    function.citations = std::move(documentation.citations);
    function.module = file.name;
}

/// A model makes nothing of a light but its direction, and a light makes that direction.
void refuse_structures(const syntax::ModelItem& model, Signature& signature,
                       Diagnostics& diagnostics)
{
    for (const Argument& argument : signature.arguments) {
        const Structure structure = argument.type.type.structure;
        const bool is_emitter = structure == Structure::emitter;
        const bool fits =
            model.is_light ? is_emitter || structure == Structure::surface : !is_emitter;
        if (argument.broken || fits) continue;
        Diagnostic diagnostic{
            .code = Code::misplaced_type,
            .message = model.is_light
                           ? fmt::format("a light takes an emitter and a surface, and this is {}",
                                         describe(argument.type.type))
                           : "a model takes no emitter",
            .primary = {argument.type.span, ""}};
        if (is_emitter)
            diagnostic.notes = {"a model is what light from one direction becomes; where the light "
                                "is, and how much of it arrives, is a `light`'s affair"};
        else if (structure == Structure::geometry)
            diagnostic.notes = {"a geometry has the direction that a light is there to find; an "
                                "emitter has `v` and `n`"};
        diagnostics.report(std::move(diagnostic));
        signature.broken = true;
    }
}

struct LightOutput {
    std::string_view name;
    ValueType type;
    bool required = false;
};

// What a light is made of; see ir::Model.
constexpr std::array light_outputs{
    LightOutput{"direction", direction_type, true},
    LightOutput{"irradiance", number_type, true},
    LightOutput{"specular_direction", direction_type},
    LightOutput{"specular_gain", number_type},
};

const LightOutput* find_light_output(std::string_view name)
{
    const auto* found = std::ranges::find(light_outputs, name, &LightOutput::name);
    return found == light_outputs.end() ? nullptr : found;
}

/// A light has the outputs that make one, and no others.
void check_outputs(const File& file, const syntax::ModelItem& light, Diagnostics& diagnostics)
{
    for (const syntax::Output& output : light.outputs) {
        if (find_light_output(output.name.text) != nullptr) continue;
        std::vector<std::string> known;
        for (const LightOutput& each : light_outputs) known.emplace_back(each.name);
        diagnostics.report({.code = Code::light_outputs,
                            .message = fmt::format("a light has no `{}`{}", output.name.text,
                                                   did_you_mean(output.name.text, known)),
                            .primary = {output.name.span, ""},
                            .notes = {fmt::format("its outputs are {}", fmt::join(known, ", "))},
                            .fix = rename_fix(output.name.text, output.name.span, known)});
    }
    if (file.broken) return;
    for (const LightOutput& wanted : light_outputs) {
        const bool has = std::ranges::any_of(light.outputs, [&](const syntax::Output& output) {
            return output.name.text == wanted.name;
        });
        if (wanted.required && !has)
            diagnostics.report(
                {.code = Code::light_outputs,
                 .message = fmt::format("the light `{}` has no `{}`", light.name.text, wanted.name),
                 .primary = {light.name.span, ""},
                 .helps = {wanted.name == "direction"
                               ? "say where the point is lit from: `direction = e.l`"
                               : "say what arrives of the light's intensity, without the cosine of "
                                 "its angle: `irradiance = 1 / e.distance_squared else 0`"}});
    }
}

/// The value of an output as what it is to be. Reports what does not fit.
Value convert_output(Lowering& lowering, const Value& value, const syntax::ModelItem& model,
                     const syntax::Output& output, const Span& span, Diagnostics& diagnostics)
{
    if (!value.good) return {};
    if (model.is_light) {
        const LightOutput* wanted = find_light_output(output.name.text);
        if (wanted == nullptr) return {};
        return lowering.convert(value, wanted->type, span,
                                fmt::format("the `{}` of a light", wanted->name), std::nullopt);
    }
    if (is_number(value.type) || value.type == color_type) return value;
    diagnostics.report({.code = Code::type_mismatch,
                        .message = fmt::format("an output is a number or a color, and this is {}",
                                               describe(value.type)),
                        .primary = {span, ""}});
    return {};
}

void set_result(Lowered& lowered, const Value& value)
{
    lowered.good = value.good;
    if (!value.good) return;
    lowered.draft.function.result = value.expr;
    lowered.draft.function.quantity = value.type.quantity;
}

}  // namespace

Lowered lower_callable(Program& program, std::size_t index, const Sources& sources,
                       Diagnostics& diagnostics)
{
    const Callable& callable = program.callables[index];
    const File& file = *program.files[callable.file];
    const bool is_form = callable.form != nullptr;
    const syntax::Body& body = is_form ? callable.form->body : callable.term->body;

    Lowered lowered;
    lowered.file = callable.file;
    ir::Function& function = lowered.draft.function;
    function.name = callable.name;
    function.kind = is_form ? ir::Function::Kind::form : ir::Function::Kind::term;
    function.span = callable.span;
    describe_function(function, file, is_form ? callable.form->comments : callable.item->comments,
                      diagnostics);
    function.formula = formula(sources, file.tree, body);

    Lowering lowering{program, callable.file, sources, lowered.draft, diagnostics};
    // What is wrong with the names of arguments is said at the term, not at each form.
    Diagnostics said;
    if (is_form) lowering.report_to(said);
    lowering.add_arguments(callable.signature);
    lowering.report_to(diagnostics);
    lowering.add_lets(body.lets);
    const Value value = lowering.lower(body.value);
    if (!callable.signature.broken && body.value.valid()) {
        const Span span = file.tree[body.value].span;
        if (!is_form) {
            set_result(lowered, convert_result(lowering, value, callable, span));
        } else if (const auto& term = program.callables[callable.term_index].function) {
            const ir::Function& of = program.functions[term->index];
            set_result(lowered, convert_form(lowering, value, callable, of, span, diagnostics));
            function.form_of = *term;
            function.form_name = callable.form->name.text;
        }
    }
    if (value.good) lowering.report_unused_lets();

    const std::optional<DeclaredType>& result = callable.signature.result;
    if (lowered.good && !is_form && result && result->bounded) {
        function.declared_range = result->range;
        lowered.draft.obligations.push_back(
            {.kind = Obligation::Kind::result,
             .any_of = {{function.result, {.low = result->range.low, .high = result->range.high}}},
             .whole = file.tree[body.value].span,
             .subject = file.tree[body.value].span,
             .declared = result->span,
             .function = callable.name});
    }
    return lowered;
}

std::vector<Lowered> lower_model(Program& program, const ModelDeclaration& declared,
                                 const Sources& sources, Diagnostics& diagnostics)
{
    const syntax::ModelItem& model = *declared.node;
    const File& file = *program.files[declared.file];
    Signature signature = resolve_signature(file.tree, model.parameters, std::nullopt, diagnostics);
    refuse_structures(model, signature, diagnostics);
    if (model.is_light) check_outputs(file, model, diagnostics);

    std::vector<Lowered> result;
    std::map<std::string, Lowering::Local> unused;
    Diagnostics repeated;
    for (const syntax::Output& output : model.outputs) {
        const bool first = result.empty();
        Lowered lowered;
        lowered.file = declared.file;
        ir::Function& function = lowered.draft.function;
        function.name = fmt::format("{}_{}", model.name.text, output.name.text);
        function.kind = ir::Function::Kind::output;
        function.span = output.name.span;
        const bool own_doc = std::ranges::any_of(output.comments, &syntax::Comment::doc);
        describe_function(function, file, own_doc ? output.comments : declared.item->comments,
                          first || own_doc ? diagnostics : repeated);
        if (output.value.valid())
            function.formula = one_line(sources.text(file.tree[output.value].span));

        // The lets are lowered again for every output, for each keeps only what it uses.
        Lowering lets{program, declared.file, sources, lowered.draft,
                      first ? diagnostics : repeated};
        lets.add_arguments(signature);
        lets.add_lets(model.lets);
        if (!first) {
            lowered.draft.obligations.clear();
            lowered.draft.limits.clear();
        }
        lets.report_to(diagnostics);
        const Value value = lets.lower(output.value);
        if (output.value.valid() && !signature.broken)
            set_result(lowered, convert_output(lets, value, model, output,
                                               file.tree[output.value].span, diagnostics));

        for (const auto& [name, local] : lets.locals()) {
            if (!local.is_let) continue;
            const auto [found, added] = unused.try_emplace(name, local);
            found->second.used = found->second.used || local.used;
        }
        result.push_back(std::move(lowered));
    }
    for (const auto& [name, local] : unused)
        if (!local.used)
            diagnostics.report({.code = Code::unused_name,
                                .message = fmt::format("`{}` is not used", name),
                                .primary = {local.span, ""},
                                .helps = {"remove it, or use it in an output"}});
    return result;
}

Lowered lower_effect(Program& program, const syntax::EffectItem& effect, std::size_t number,
                     const Sources& sources, Diagnostics& diagnostics)
{
    const std::size_t root = program.files.size() - 1;
    const File& file = *program.files[root];
    Lowered lowered;
    lowered.file = root;
    ir::Function& function = lowered.draft.function;
    function.name = fmt::format("effect_{}", number);
    function.module = file.name;
    function.span = effect.name_span;
    if (!effect.off_when.valid()) return lowered;
    const Span span = file.tree[effect.off_when].span;
    function.formula = one_line(sources.text(span));

    Lowering lowering{program, root, sources, lowered.draft, diagnostics};
    const Value value = lowering.lower(effect.off_when);
    if (!value.good) return lowered;
    const auto refuse = [&](std::string message) {
        diagnostics.report({.code = Code::effect_condition,
                            .message = std::move(message),
                            .primary = {span, ""},
                            .helps = {"compare a parameter with the value that switches the effect "
                                      "off: `off when gain == 0`"}});
    };
    if (value.type != boolean_type) {
        refuse(fmt::format("an effect is off when a condition holds, and this is {}",
                           describe(value.type)));
        return lowered;
    }
    if (function.inputs.empty()) {
        refuse("this condition depends on no parameter");
        return lowered;
    }
    set_result(lowered, value);
    return lowered;
}

}  // namespace lobe::check
