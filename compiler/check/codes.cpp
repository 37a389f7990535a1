#include "check/codes.h"

#include "check/analysis.h"
#include "check/declarations.h"
#include "check/docs.h"
#include "check/lowering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::check {
namespace {

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

    Lowered lower(std::string_view word, syntax::ExpressionId body, const Signature& signature,
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
    if (is_builtin_code(code.node->name.text))
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

}  // namespace lobe::check
