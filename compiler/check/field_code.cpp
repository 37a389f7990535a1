// What the `code` of a field says, and whether the field can have it.
#include "check/codes.h"
#include "check/constants.h"

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
constexpr std::array<BuiltinCode, 5> builtin_codes{{
    {"linear", ir::Code::Kind::linear, "`linear` or `linear(252/255)`"},
    {"sqrt", ir::Code::Kind::square_root, "`sqrt`"},
    {"power", ir::Code::Kind::power, "`power(8, 127/255)`"},
    {"log2", ir::Code::Kind::log2, "`log2` or `log2(31/255)`"},
    {"halving", ir::Code::Kind::halving, "`halving(120/255)`"},
}};

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
        const bool is_halving = builtin.kind == ir::Code::Kind::halving;
        const std::size_t least = is_power ? 2 : is_halving ? 1 : 0;
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
            code.unit = ir::power_unit(parameter_, field_.component, field_.range);
        }
        if (given > least || is_power || is_halving) {
            const auto pivot = read_pivot(arguments().back());
            if (!pivot) return std::nullopt;
            // A linear code without a pivot has it at the last code.
            const bool implied = builtin.kind == ir::Code::Kind::linear && *pivot == last();
            code.pivot = implied ? 0 : *pivot;
        }
        return is_halving ? halving(code.pivot) : code;
    }

    std::optional<ir::Code> halving(int pivot)
    {
        if (auto code = ir::halving(parameter_, field_.component, field_.range, pivot)) return code;
        const ir::Range& carried = field_.range;
        const double top = parameter_.range.high;
        const double value = parameter_.default_value[static_cast<std::size_t>(field_.component)];
        const Span& span = clause_.code->span;
        if (!std::isfinite(top))
            return refuse(fmt::format("`{}` has no high end that `halving` could go towards",
                                      parameter_.name),
                          {span, fmt::format("it is in {}", describe(parameter_.range))}, {},
                          {"give the parameter a range, or take another code"});
        if (carried.high >= top)
            return refuse(
                fmt::format("`halving` never reaches the high end of `{}`", parameter_.name),
                {span, fmt::format("the field carries {}", describe(carried))},
                {fmt::format("equal steps halve what is missing to {}", describe(top))},
                {value < top ? fmt::format("let the field carry less: `in {}`",
                                           describe(ir::Range{carried.low, below_top(value)}))
                             : "take another code: the default is that end"});
        return refuse(fmt::format("the pivot of `halving` is the code of the default, and the "
                                  "default of `{}` {}",
                                  parameter_.name,
                                  value == carried.low ? "is the low end" : "is not carried"),
                      {span, fmt::format("the field carries {}, and the default is {}",
                                         describe(carried), describe(value))},
                      {},
                      {value > carried.high && value < top
                           ? fmt::format("let the field carry it: `in {}`",
                                         describe(ir::Range{carried.low, value}))
                           : "take another code"});
    }

    /// An end that leaves out a small part of the range, but not the default.
    double below_top(double value) const
    {
        const double top = parameter_.range.high;
        double end = top - (top - field_.range.low) / 16;
        for (int i = 0; i < 32 && end < value; ++i) end = (end + top) / 2;
        return std::max(end, value);
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
            return refuse(
                found == file_.names.end() ? fmt::format("no code is called `{}`{}", name.text,
                                                         did_you_mean(name.text, known))
                                           : fmt::format("`{}` is no code", name.text),
                {name.span, ""}, {},
                {"the codes are linear, sqrt, power, log2, halving, and those that a `code` item "
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

}  // namespace

bool is_builtin_code(std::string_view name)
{
    return std::ranges::find(builtin_codes, name, &BuiltinCode::name) != builtin_codes.end();
}

std::optional<ir::Code> read_code(Program& program, std::size_t file,
                                  const syntax::FieldClause& clause, const ir::Field& field,
                                  const ir::Parameter& parameter, Diagnostics& diagnostics)
{
    return Reading{program, file, clause, field, parameter, diagnostics}.run();
}

}  // namespace lobe::check
