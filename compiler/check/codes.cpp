#include "check/codes.h"

#include "check/analysis.h"
#include "check/constants.h"
#include "check/declarations.h"
#include "check/docs.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe::check {
namespace {

using syntax::ExpressionId;

constexpr int most_exponent = 32;

struct BuiltinCode {
    std::string_view name;
    ir::Code::Kind kind;
    std::string_view form;  ///< how it is written
};
constexpr std::array<BuiltinCode, 4> builtin_codes{{
    {"linear", ir::Code::Kind::linear, "`linear` or `linear(252/255)`"},
    {"sqrt", ir::Code::Kind::square_root, "`sqrt`"},
    {"power", ir::Code::Kind::power, "`power(8, 127/255)`"},
    {"log2", ir::Code::Kind::log2, "`log2` or `log2(31/255)`"},
}};

// ---- declarations

/// One half of a code: a function of one number.
class Half {
public:
    Half(Program& program, const CodeDeclaration& code, const Sources& sources,
         Diagnostics& diagnostics)
        : program_(program), code_(code), file_(*program.files[code.file]), sources_(sources),
          diagnostics_(diagnostics)
    {
    }

    Lowered lower(std::string_view word, ExpressionId body, const Signature& signature,
                  const std::vector<syntax::Comment>& comments, Obligation obligation)
    {
        Lowered lowered;
        lowered.file = code_.file;
        ir::Function& function = lowered.draft.function;
        function.name = fmt::format("{}_{}", code_.node->name.text, word);
        function.kind = ir::Function::Kind::storage;
        function.span = code_.node->name.span;
        const bool own = std::ranges::any_of(comments, &syntax::Comment::doc);
        Diagnostics said;  // of comments that both halves have
        Documentation documentation =
            read_documentation(file_, own ? comments : code_.item->comments,
                               own || word == "encode" ? diagnostics_ : said);
        function.doc = std::move(documentation.text);
        function.citations = std::move(documentation.citations);
        function.module = file_.name;
        if (!body.valid()) return lowered;
        const Span span = file_.tree[body].span;
        function.formula = one_line(sources_.text(span));

        Lowering lowering{program_, code_.file, sources_, lowered.draft, diagnostics_};
        lowering.add_arguments(signature);
        Value value = lowering.lower(body);
        if (value.good)
            value = lowering.convert(value, number_type, span,
                                     fmt::format("the result of `{}`", word), std::nullopt);
        if (!value.good || signature.broken || reads_more(function, word, span)) return lowered;
        function.result = value.expr;
        function.quantity = ir::Quantity::number;
        const Requirement& wanted = obligation.any_of[0].requirement;
        function.declared_range = ir::Range{wanted.low, wanted.high};
        obligation.any_of[0].subject = value.expr;
        obligation.whole = obligation.subject = span;
        obligation.function = function.name;
        lowered.draft.obligations.push_back(std::move(obligation));
        lowered.good = true;
        return lowered;
    }

private:
    bool reads_more(const ir::Function& function, std::string_view word, const Span& span)
    {
        const auto other = std::ranges::find_if(function.inputs, [](const ir::Input& input) {
            return input.origin != ir::Origin::argument;
        });
        if (other == function.inputs.end()) return false;
        diagnostics_.report(
            {.code = Code::code_misuse,
             .message = fmt::format("`{}` of the code `{}` depends on the parameter `{}`", word,
                                    code_.node->name.text, other->name),
             .primary = {span, ""},
             .notes = {"what is stored is read back where parameters are not known: a code is a "
                       "function of one number"}});
        return true;
    }

    Program& program_;
    const CodeDeclaration& code_;
    const File& file_;
    const Sources& sources_;
    Diagnostics& diagnostics_;
};

/// The argument of encode; broken (reported) unless it is a number with both ends.
Signature value_signature(const File& file, const syntax::CodeItem& code, Diagnostics& diagnostics)
{
    Signature signature = resolve_signature(file.tree, {code.value}, std::nullopt, diagnostics);
    if (signature.broken || signature.arguments.empty()) {
        signature.broken = true;
        return signature;
    }
    const DeclaredType& type = signature.arguments[0].type;
    if (signature.arguments[0].broken) {
        signature.broken = true;
    } else if (type.type != number_type || !std::isfinite(type.range.low) ||
               !std::isfinite(type.range.high)) {
        signature.broken = true;
        diagnostics.report(
            {.code = Code::code_misuse,
             .message = fmt::format(
                 "a code is about a number with a range, and `{}` is {}", code.value.name.text,
                 type.type == number_type ? "a number without one" : describe(type.type)),
             .primary = {type.span, ""},
             .helps = {fmt::format("write the range that has codes: `{}: float in [0, 256]`",
                                   code.value.name.text)}});
    }
    return signature;
}

// ---- the code of a field

class Reading {
public:
    Reading(Program& program, std::size_t file, const syntax::FieldClause& clause,
            const ir::Field& field, const ir::Parameter& parameter, Diagnostics& diagnostics)
        : program_(program), file_(*program.files[file]), clause_(clause), field_(field),
          parameter_(parameter), diagnostics_(diagnostics)
    {
    }

    std::optional<ir::Code> run()
    {
        if (field_.is_signed && !fits_sign()) return std::nullopt;
        if (!clause_.code) return plain();
        const std::string& name = clause_.code->name.text;
        if (name.empty()) return std::nullopt;  // a syntax error was reported
        const auto* builtin = std::ranges::find(builtin_codes, name, &BuiltinCode::name);
        if (builtin == builtin_codes.end()) return declared();
        if (!fits_kind(builtin->kind)) return std::nullopt;
        return standard(*builtin);
    }

private:
    int last() const { return field_.last_code(); }
    const std::vector<ExpressionId>& arguments() const { return clause_.code->arguments; }
    Span span_of(ExpressionId id) const { return file_.tree[id].span; }

    std::nullopt_t refuse(std::string message, Label at, std::vector<std::string> notes = {},
                          std::vector<std::string> helps = {},
                          std::optional<Fix> fix = std::nullopt)
    {
        diagnostics_.report({.code = Code::code_misuse,
                             .message = std::move(message),
                             .primary = std::move(at),
                             .notes = std::move(notes),
                             .helps = std::move(helps),
                             .fix = std::move(fix)});
        return std::nullopt;
    }

    /// Whole numbers are stored as they are where there are codes enough.
    ir::Code plain() const
    {
        ir::Code code;
        const double size = field_.range.high - field_.range.low;
        const bool whole = parameter_.quantity == ir::Quantity::integer ||
                           parameter_.quantity == ir::Quantity::boolean;
        if (whole && size == std::floor(size) && size < last() && !field_.is_signed)
            code.pivot = static_cast<int>(size);
        return code;
    }

    bool fits_sign()
    {
        if (field_.range.low == -field_.range.high) return true;
        refuse(
            fmt::format("a snorm field is as wide below 0 as above, and {} is not",
                        describe(field_.range)),
            {clause_.range ? clause_.range->span : clause_.storage.span, ""}, {},
            {fmt::format("store it as `unorm {}`, which has codes from end to end", field_.bits)});
        return false;
    }

    bool fits_kind(ir::Code::Kind kind)
    {
        const Span& span = clause_.code->span;
        if (field_.is_signed && (kind != ir::Code::Kind::linear || !arguments().empty())) {
            refuse("a snorm field has linear codes on both sides of 0, and no other", {span, ""},
                   {}, {"leave the code out, or store it as unorm"});
            return false;
        }
        if (kind != ir::Code::Kind::linear && parameter_.quantity != ir::Quantity::number &&
            parameter_.quantity != ir::Quantity::color) {
            refuse(fmt::format("`{}` is {}, and its codes are linear", parameter_.name,
                               parameter_.quantity == ir::Quantity::boolean ? "a condition"
                                                                            : "a whole number"),
                   {span, ""});
            return false;
        }
        return true;
    }

    std::optional<ir::Code> standard(const BuiltinCode& builtin)
    {
        ir::Code code;
        code.kind = builtin.kind;
        code.name = builtin.name;
        const std::size_t given = arguments().size();
        const bool is_power = builtin.kind == ir::Code::Kind::power;
        const std::size_t least = is_power ? 2 : 0;
        const std::size_t most = is_power ? 2 : builtin.kind == ir::Code::Kind::square_root ? 0 : 1;
        if (given < least || given > most)
            return refuse(fmt::format("`{}` takes {} argument{}, and {} {} given", builtin.name,
                                      most == 0       ? "no"
                                      : least == most ? fmt::format("{}", most)
                                                      : fmt::format("at most {}", most),
                                      most == 1 ? "" : "s", given, given == 1 ? "is" : "are"),
                          {clause_.code->span, ""}, {},
                          {fmt::format("it is written {}", builtin.form)});
        if (is_power) {
            const auto exponent = constant_value(file_.tree, arguments()[0], diagnostics_);
            if (!exponent) return std::nullopt;
            if (*exponent != std::floor(*exponent) || *exponent < 1 || *exponent > most_exponent)
                return refuse(fmt::format("the exponent of a power is a whole number from 1 to {}",
                                          most_exponent),
                              {span_of(arguments()[0]), fmt::format("is {}", describe(*exponent))});
            code.exponent = static_cast<int>(*exponent);
        }
        if (given > least || is_power) {
            const auto pivot = read_pivot(arguments().back());
            if (!pivot) return std::nullopt;
            // A linear code without a pivot has it at the last code.
            const bool implied = builtin.kind == ir::Code::Kind::linear && *pivot == last();
            code.pivot = implied ? 0 : *pivot;
        }
        return code;
    }

    /// `127/255`: a code over the last code; `1` is the last one.
    std::optional<int> read_pivot(ExpressionId id)
    {
        const auto value = constant_value(file_.tree, id, diagnostics_);
        if (!value) return std::nullopt;
        if (*value == 1) return last();
        const Span span = span_of(id);
        const double nearest = std::clamp(std::round(*value * last()), 1.0, double{1.0 * last()});
        const std::string written = fmt::format("{}/{}", nearest, last());
        const std::vector<std::string> notes{fmt::format(
            "{} {}have the codes 0 to {}; a pivot is one of them over the last one",
            field_.bits == 1 ? "a field of one bit" : fmt::format("{} bits", field_.bits),
            field_.bits == 1 ? "would " : "", last())};
        const std::optional<Fix> fix =
            Fix{span, written, "write the nearest code over the last code"};
        const auto* ratio = std::get_if<syntax::Binary>(&file_.tree[id].node);
        if (ratio == nullptr || ratio->op != syntax::BinaryOperator::divide)
            return refuse("this pivot is not written as a code over the last code",
                          {span, fmt::format("is {}", describe(*value, true))}, notes, {}, fix);
        const auto code = constant_value(file_.tree, ratio->left, diagnostics_);
        const auto over = constant_value(file_.tree, ratio->right, diagnostics_);
        if (!code || !over) return std::nullopt;
        if (*over != last())
            return refuse(
                fmt::format("this pivot is not on a code of {} bit{}", field_.bits,
                            field_.bits == 1 ? "" : "s"),
                {span, fmt::format("is over {}, and the last code is {}", describe(*over), last())},
                notes, {}, fix);
        if (*code != std::floor(*code) || *code < 1 || *code > last())
            return refuse(fmt::format("this pivot is no code from 1 to {}", last()),
                          {span_of(ratio->left), fmt::format("is {}", describe(*code))}, notes, {},
                          fix);
        return static_cast<int>(*code);
    }

    std::optional<ir::Code> declared()
    {
        const syntax::Identifier& name = clause_.code->name;
        const auto found = file_.names.find(name.text);
        if (found == file_.names.end() || found->second.kind != NameKind::code) {
            if (found != file_.names.end() && found->second.kind == NameKind::lost)
                return std::nullopt;
            std::vector<std::string> known = names_of(file_.names, NameKind::code);
            for (const BuiltinCode& builtin : builtin_codes) known.emplace_back(builtin.name);
            return refuse(found == file_.names.end()
                              ? fmt::format("no code is called `{}`{}", name.text,
                                            did_you_mean(name.text, known))
                              : fmt::format("`{}` is no code", name.text),
                          {name.span, ""}, {},
                          {"the codes are linear, sqrt, power, log2, and those that a `code` item "
                           "declares"},
                          rename_fix(name.text, name.span, known));
        }
        found->second.used = true;
        const CodeDeclaration& code = program_.codes[found->second.index];
        if (!fits_kind(ir::Code::Kind::declared)) return std::nullopt;
        if (!arguments().empty())
            return refuse(fmt::format("the code `{}` takes no arguments", name.text),
                          {clause_.code->span, ""}, {},
                          {fmt::format("write `code {}`", name.text)});
        if (!code.encode || !code.decode) return std::nullopt;
        const ir::Range& carried = program_.functions[code.encode->index].inputs[0].range;
        if (field_.range.low < carried.low || field_.range.high > carried.high) {
            diagnostics_.report(
                {.code = Code::range_clamped,
                 .message =
                     fmt::format("the code `{}` does not carry the range of this field", name.text),
                 .primary = {clause_.range ? clause_.range->span : clause_.code->span,
                             fmt::format("the field carries {}", describe(field_.range))},
                 .secondary = {{code.node->value.type.span,
                                fmt::format("the code carries {}", describe(carried))}},
                 .helps = {fmt::format("let the field carry less: `in {}`", describe(carried)),
                           "or declare the code over more"}});
            return std::nullopt;
        }
        ir::Code result;
        result.kind = ir::Code::Kind::declared;
        result.name = name.text;
        result.encode = *code.encode;
        result.decode = *code.decode;
        return result;
    }

    Program& program_;
    File& file_;
    const syntax::FieldClause& clause_;
    const ir::Field& field_;
    const ir::Parameter& parameter_;
    Diagnostics& diagnostics_;
};

// ---- inverse

/// Values of a range to try: simple ones first, then evenly and towards both ends.
std::vector<double> points_of(const ir::Range& range)
{
    std::vector<double> points;
    const auto add = [&](double x) {
        if (x >= range.low && x <= range.high) points.push_back(x);
    };
    for (const double simple : {1.0, 0.5, 2.0, -1.0, 0.25, 0.75, 10.0, 100.0, 0.0}) add(simple);
    const double size = range.high - range.low;
    add(range.low);
    add(range.high);
    constexpr int steps = 4096;
    for (int i = 1; i < steps; ++i) add(range.low + size * i / steps);
    for (int i = 13; i < 40; ++i) {
        add(range.low + std::ldexp(size, -i));
        add(range.high - std::ldexp(size, -i));
    }
    return points;
}

Analysis analysis_of(const Program& program, ir::FunctionId id)
{
    const ir::Function& function = program.functions[id.index];
    return Analysis{
        flatten(program.functions, function, {&function.result, 1}, {}, Calls::taken_in)};
}

/// Two values of which the greater one is certain to have less.
std::optional<std::pair<double, double>> falling_pair(Analysis& encode, std::vector<double> points)
{
    std::ranges::sort(points);
    double greatest = points.front();
    Interval most = encode.ranges({{greatest, greatest}})[0][0];
    for (const double x : points) {
        const Interval stored = encode.ranges({{x, x}})[0][0];
        if (stored.high < most.low) return std::pair{greatest, x};
        if (stored.low > most.low) {
            most = stored;
            greatest = x;
        }
    }
    return std::nullopt;
}

}  // namespace

LoweredCode lower_code(Program& program, std::size_t index, const Sources& sources,
                       Diagnostics& diagnostics)
{
    const CodeDeclaration& code = program.codes[index];
    const File& file = *program.files[code.file];
    if (std::ranges::find(builtin_codes, code.node->name.text, &BuiltinCode::name) !=
        builtin_codes.end())
        diagnostics.report({.code = Code::shadowed_builtin,
                            .message = fmt::format("the code `{}` would hide the standard code",
                                                   code.node->name.text),
                            .primary = {code.node->name.span, ""},
                            .helps = {"give it another name"}});
    for (const std::string_view half : {"encode", "decode"}) {
        const auto taken = file.names.find(fmt::format("{}_{}", code.node->name.text, half));
        if (taken == file.names.end() || taken->second.kind == NameKind::lost) continue;
        diagnostics.report({.code = Code::duplicate_name,
                            .message = fmt::format("`{}` is what the code `{}` calls its own",
                                                   taken->first, code.node->name.text),
                            .primary = {taken->second.span, ""},
                            .secondary = {{code.node->name.span, "the code"}},
                            .helps = {"give it another name"}});
    }
    const Signature value = value_signature(file, *code.node, diagnostics);
    Signature stored;
    stored.broken = value.broken;
    stored.arguments.push_back({code.node->stored.text,
                                code.node->stored.span,
                                {number_type, {0, 1}, true, code.node->stored.span},
                                false});

    Half half{program, code, sources, diagnostics};
    LoweredCode result;
    Obligation into_codes{.kind = Obligation::Kind::stored,
                          .any_of = {{{}, {.low = 0, .high = 1}}},
                          .whole = {},
                          .subject = {}};
    result.encode =
        half.lower("encode", code.node->encode, value, code.node->encode_comments, into_codes);
    const ir::Range range = value.broken ? ir::Range{0, 1} : value.arguments[0].type.range;
    Obligation into_range{.kind = Obligation::Kind::result,
                          .any_of = {{{}, {.low = range.low, .high = range.high}}},
                          .whole = {},
                          .subject = {},
                          .declared = code.node->value.type.span};
    result.decode =
        half.lower("decode", code.node->decode, stored, code.node->decode_comments, into_range);
    return result;
}

bool check_inverse(const Program& program, const CodeDeclaration& code, const Sources& sources,
                   Diagnostics& diagnostics)
{
    if (!code.encode || !code.decode) return true;
    Analysis encode = analysis_of(program, *code.encode);
    Analysis decode = analysis_of(program, *code.decode);
    const ir::Function& function = program.functions[code.encode->index];
    const std::string& name = code.node->name.text;
    const syntax::Tree& tree = program.files[code.file]->tree;
    const Span encode_span = tree[code.node->encode].span;
    const Span decode_span = tree[code.node->decode].span;

    std::vector<double> points = points_of(function.inputs[0].range);
    for (const double x : points) {
        const Interval stored = encode.ranges({{x, x}})[0][0];
        const Interval read = decode.ranges({stored})[0][0];
        if (read.low <= x && x <= read.high) continue;
        const double u = encode.values({x})[0][0];
        diagnostics.report(
            {.code = Code::decode_not_inverse,
             .message = fmt::format("`decode` of the code `{}` does not undo its `encode`", name),
             .primary = {decode_span,
                         fmt::format("{} is stored as {} and read as {}", describe(x, true),
                                     describe(u, true), describe(decode.values({u})[0][0], true))},
             .secondary = {{encode_span, fmt::format("the code stores `{}`",
                                                     one_line(sources.text(encode_span)))}},
             .notes = {"a value must come back as it was, but for the rounding to a code"}});
        return false;
    }

    // Over values far apart first, which are easier to picture.
    const ir::Range& range = function.inputs[0].range;
    std::vector<double> few;
    for (int i = 0; i <= 4; ++i) few.push_back(range.low + (range.high - range.low) * i / 4);
    for (std::vector<double>* const some : {&few, &points}) {
        const auto falls = falling_pair(encode, *some);
        if (!falls) continue;
        const auto stored = [&](double x) { return describe(encode.values({x})[0][0], true); };
        diagnostics.report(
            {.code = Code::code_not_monotone,
             .message = fmt::format("`encode` of the code `{}` falls", name),
             .primary = {encode_span,
                         fmt::format("{} at {}, and {} at {}", stored(falls->first),
                                     describe(falls->first, true), stored(falls->second),
                                     describe(falls->second, true))},
             .notes = {"a greater value has a greater code, so that neighboring codes are "
                       "neighboring values"}});
        return false;
    }
    return true;
}

std::optional<ir::Code> read_code(Program& program, std::size_t file,
                                  const syntax::FieldClause& clause, const ir::Field& field,
                                  const ir::Parameter& parameter, Diagnostics& diagnostics)
{
    return Reading{program, file, clause, field, parameter, diagnostics}.run();
}

}  // namespace lobe::check
