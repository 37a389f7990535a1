#include "check/exactness.h"

#include "check/field_run.h"
#include "check/neutral.h"
#include "check/proposals.h"
#include "check/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace lobe::check {
namespace {

/// A number among others that may look alike: seven digits, or all that a float has.
std::string number(double value) { return fmt::format("{:.7g}", value); }
std::string number_beside(double value, double other)
{
    const std::string text = number(value);
    return text == number(other) && value != other ? fmt::format("{}", static_cast<float>(value))
                                                   : text;
}

/// A value that has to come back.
struct Kept {
    enum class Why {
        standard,  ///< the default
        required,
        neutral
    };
    double value = 0;
    Why why{};
    Span span;           ///< required: of the requirement
    std::string effect;  ///< neutral: that is off there
};

class FieldCheck {
public:
    FieldCheck(const ir::Module& module, const ir::Gbuffer& gbuffer, const ir::Field& field,
               const FieldRun& run, Diagnostics& diagnostics)
        : module_(module), gbuffer_(gbuffer), field_(field), run_(run), diagnostics_(diagnostics),
          parameter_(module.parameters[field.parameter]), name_(parameter_.name)
    {
        if (ir::components(parameter_.type) > 1)
            name_ += fmt::format(".{}", "rgba"[static_cast<std::size_t>(field.component)]);
    }

    double default_value() const
    {
        return parameter_.default_value[static_cast<std::size_t>(field_.component)];
    }

    /// E0606, once per value.
    void check_kept(const std::vector<Kept>& values)
    {
        std::vector<double> all;
        for (const Kept& kept : values) all.push_back(kept.value);
        std::set<double> reported;
        for (const Kept& kept : values)
            if (!run_.keeps(kept.value) && reported.insert(kept.value).second)
                report_inexact(kept, all);
    }

    /// E0607
    void check_ends()
    {
        if (field_.code.kind == ir::Code::Kind::declared) return;
        const double last = field_.last_code();
        if (ir::position(field_, field_.range.high) <= last + 0.5) return;
        const double reached = run_.reals.back();
        Diagnostic diagnostic{
            .code = Code::range_clamped,
            .message = fmt::format("the codes of `{}` end before its range", name_),
            .primary = {field_.span,
                        fmt::format("`{}` reaches {} of {}", describe(field_.code, field_.bits),
                                    number(reached), number(field_.range.high))},
            .notes = {fmt::format("what is above is stored as the last code, {}, and read as {}",
                                  field_.last_code(), number(reached))}};
        if (const auto pivot = reaching_pivot(field_)) {
            ir::Code code = field_.code;
            code.pivot = *pivot;
            diagnostic.helps.push_back(
                fmt::format("`{}` reaches the end", describe(code, field_.bits)));
        }
        // The nearest number below with three digits.
        const double unit = std::pow(10.0, std::floor(std::log10(std::abs(reached))) - 2);
        double end = std::floor(reached / unit) * unit;
        if (end < default_value()) end = default_value();
        if (end > field_.range.low && end <= reached)
            diagnostic.helps.push_back(fmt::format("or let the field carry less: `in {}`",
                                                   range_text(field_.range.low, end)));
        diagnostics_.report(std::move(diagnostic));
    }

    /// E0609; true if the values rise.
    bool check_rising()
    {
        for (std::size_t i = run_.bottom + 1; i <= run_.top; ++i) {
            if (run_.floats[i] > run_.floats[i - 1] && run_.reals[i] > run_.reals[i - 1]) continue;
            const bool same = run_.floats[i] == run_.floats[i - 1];
            const double below = run_.reals[i - 1];
            const double here = run_.reals[i];
            diagnostics_.report(
                {.code = Code::code_not_monotone,
                 .message = fmt::format("the values of the codes of `{}` do not rise", name_),
                 .primary = {field_.span,
                             same ? fmt::format("codes {} and {} are both {}", i - 1, i,
                                                number(static_cast<double>(run_.floats[i])))
                                  : fmt::format("code {} is {}, and code {} is {}", i - 1,
                                                number_beside(below, here), i,
                                                number_beside(here, below))},
                 .secondary = declared_labels(),
                 .notes = same && field_.code.kind != ir::Code::Kind::declared
                              ? std::vector<std::string>{"they differ by less than float can say "
                                                         "there"}
                              : std::vector<std::string>{},
                 .helps = {"take fewer bits, or a code with larger steps there"}});
            return false;
        }
        return true;
    }

    /// E0608
    void check_codes()
    {
        for (std::size_t i = 0; i <= run_.top; ++i) {
            const Acceptance& back = run_.encoded[i];
            if (back == point(static_cast<double>(i))) continue;
            const double value = run_.reals[i];
            Diagnostic diagnostic{
                .code = Code::decode_not_inverse,
                .message = fmt::format("code {} of `{}` does not come back", i, name_),
                .primary = {field_.span,
                            back.low == back.high
                                ? fmt::format("it is read as {}, which is stored as code {}",
                                              number(value), number(back.low))
                                : fmt::format("it is read as {}, which a device may store as any "
                                              "code from {} to {}",
                                              number(value), number(back.low), number(back.high))},
                .secondary = declared_labels()};
            if (i < run_.bottom)
                diagnostic.notes.push_back(
                    fmt::format("the low end, {}, is stored as code {}: the codes below are never "
                                "written",
                                number(field_.range.low), run_.bottom));
            else if (back.low != back.high)
                diagnostic.helps.push_back("take fewer bits, or a code with larger steps there");
            diagnostics_.report(std::move(diagnostic));
            return;
        }
    }

private:
    static std::string range_text(double low, double high)
    {
        return fmt::format("[{}, {}]", number(low), number(high));
    }

    /// `d.r and d.g`
    std::string place() const
    {
        std::string result;
        for (const ir::Slot& slot : field_.slots)
            result +=
                (result.empty() ? "" : " and ") + gbuffer_.name_of(gbuffer_.channels[slot.channel]);
        return result;
    }

    /// Where a declared code says what it does.
    std::vector<Label> declared_labels() const
    {
        if (field_.code.kind != ir::Code::Kind::declared) return {};
        return {{module_[field_.code.decode].span, "the code is declared here"}};
    }

    void report_inexact(const Kept& kept, const std::vector<double>& all)
    {
        const std::size_t code = run_.code_of(kept.value);
        const Acceptance read = run_.stored_and_read(kept.value);
        const double nearest = run_.reals[code];
        Diagnostic diagnostic{.code = Code::value_inexact, .message = {}, .primary = {}};
        // What a device may make of the code holds the value, but not alone.
        const auto wanted = static_cast<double>(static_cast<float>(kept.value));
        const Acceptance& alone = run_.accepted[code];
        const bool vague = read.undefined || (alone.low <= wanted && wanted <= alone.high);
        std::string what = fmt::format("{} is stored as code {} and comes back as {}",
                                       number_beside(kept.value, nearest), code,
                                       number_beside(nearest, kept.value));
        if (kept.value < field_.range.low || kept.value > field_.range.high)
            what = fmt::format("{} is not in {}, and comes back as {}", number(kept.value),
                               describe(field_.range), number(nearest));
        else if (vague)
            what =
                fmt::format("{} is stored as code {} and may come back as anything from {} to {}",
                            number(kept.value), code, number_beside(read.low, read.high),
                            number_beside(read.high, read.low));
        switch (kept.why) {
        case Kept::Why::standard:
            diagnostic.message =
                fmt::format("the default of `{}` does not survive in {}", name_, place());
            diagnostic.primary = {field_.span, what};
            diagnostic.secondary = {
                {parameter_.span, fmt::format("the default is {}", number(kept.value))}};
            break;
        case Kept::Why::required:
            diagnostic.message =
                fmt::format("`{} == {}` is required to be exact", name_, number(kept.value));
            diagnostic.primary = {kept.span, what};
            diagnostic.secondary = {{field_.span, "it is stored here"}};
            break;
        case Kept::Why::neutral:
            diagnostic.message = fmt::format("the effect `{}` is off at `{} == {}`, and no longer "
                                             "once that is stored",
                                             kept.effect, name_, number(kept.value));
            diagnostic.primary = {field_.span, what};
            diagnostic.secondary = {{kept.span, "the effect"}};
            break;
        }
        if (!vague) explain(diagnostic, kept.value);
        propose(diagnostic, kept.value, all);
        diagnostics_.report(std::move(diagnostic));
    }

    /// What the codes around a value mean.
    void explain(Diagnostic& diagnostic, double value) const
    {
        if (field_.code.kind == ir::Code::Kind::log2 && field_.code.pivot == 0)
            diagnostic.notes.push_back("the codes of `log2` are at no simple values, but for 0: a "
                                       "pivot puts one at the low end plus 1");
        const auto above = std::ranges::lower_bound(run_.reals, value);
        if (above == run_.reals.begin() || above == run_.reals.end()) return;
        const auto index = above - run_.reals.begin();
        diagnostic.notes.push_back(fmt::format("the codes around it are {}, which is {}, and {}, "
                                               "which is {}",
                                               index - 1, number_beside(*(above - 1), value), index,
                                               number_beside(*above, value)));
    }

    void propose(Diagnostic& diagnostic, double value, const std::vector<double>& all) const
    {
        const auto outside = std::ranges::find_if(
            all, [this](double one) { return one < field_.range.low || one > field_.range.high; });
        if (outside != all.end()) {
            const ir::Range wider{std::min(*outside, field_.range.low),
                                  std::max(*outside, field_.range.high)};
            const bool halving = field_.code.kind == ir::Code::Kind::halving;
            diagnostic.helps.push_back(fmt::format(
                "let the field carry it{}: `in {}`",
                halving && wider.high >= field_.code.top ? ", with a code that reaches it" : "",
                range_text(wider.low, wider.high)));
            return;
        }
        std::string values;
        for (const double one : std::set<double>(all.begin(), all.end()))
            values += (values.empty() ? "" : ", ") + number(one);
        if (const auto code = code_for(field_, parameter_, all)) {
            diagnostic.helps.push_back(
                fmt::format("`code {}` keeps {}", describe(*code, field_.bits), values));
            return;
        }
        const auto code = code_for(field_, parameter_, {value});
        if (code && all.size() > 1)
            diagnostic.helps.push_back(
                fmt::format("`code {}` keeps {}, but no linear code or power with these bits keeps "
                            "all of {}",
                            describe(*code, field_.bits), number(value), values));
        else
            diagnostic.helps.push_back(
                field_.is_signed
                    ? "a snorm field keeps 0, its ends and what lies on its codes: take another "
                      "range or other bits, or store it as unorm"
                    : "no linear code or power with these bits keeps it: take another range or "
                      "other bits, or a value that lies on a code");
    }

    const ir::Module& module_;
    const ir::Gbuffer& gbuffer_;
    const ir::Field& field_;
    const FieldRun& run_;
    Diagnostics& diagnostics_;
    const ir::Parameter& parameter_;
    std::string name_;
};

/// Fields of a color that differ in nothing but the component have one finding.
bool is_repeated(const ir::Module& module, const ir::Packing& packing, const ir::Field& field)
{
    const auto& defaults = module.parameters[field.parameter].default_value;
    const auto default_of = [&](const ir::Field& of) {
        return defaults[static_cast<std::size_t>(of.component)];
    };
    return std::any_of(packing.fields.data(), &field, [&](const ir::Field& other) {
        return other.parameter == field.parameter && other.bits == field.bits &&
               other.is_signed == field.is_signed && other.range == field.range &&
               other.code == field.code && default_of(other) == default_of(field);
    });
}

/// Functions of the packing get out of the way of others, but who calls them knows them by name.
void check_names(const ir::Module& module, const ir::Packing& packing, Diagnostics& diagnostics)
{
    const auto check = [&](const std::string& wanted, const ir::FunctionId made) {
        if (module[made].name == wanted) return;
        const auto other = module.find(wanted);
        if (!other || module[*other].kind == ir::Function::Kind::storage) return;
        diagnostics.report(
            {.code = Code::duplicate_name,
             .message = fmt::format("`{}` is what the packing calls a function of its own", wanted),
             .primary = {module[*other].span, ""},
             .secondary = {{module[made].span, "for what is stored here"}},
             .helps = {"give it another name"}});
    };
    for (const ir::Field& field : packing.fields) {
        check("encode_" + ir::field_name(module, field), field.encode);
        check("decode_" + ir::field_name(module, field), field.decode);
    }
    for (const auto& parameter : packing.parameters)
        check("unpack_" + module.parameters[parameter.parameter].name, parameter.unpack);
}

}  // namespace

void place_anchors(const ir::Module& module, ir::Packing& packing)
{
    const std::vector<Condition> conditions = conditions_of(module);
    for (ir::Field& field : packing.fields) {
        field.anchors.clear();
        const bool declared = field.code.kind == ir::Code::Kind::declared;
        std::vector<double> values;
        if (declared) values = ir::kept_values(module, packing, field);
        for (const Condition& condition : conditions)
            for (const double value : condition.neutral_values(field)) values.push_back(value);
        std::vector<ir::Anchor> anchors;
        for (const double value : values) {
            if (value < field.range.low || value > field.range.high) continue;
            std::optional<int> code;
            if (declared) {
                // The double arithmetic of a code loses far less than this.
                const double place = value_of(module, field.code.encode, value) * field.last_code();
                if (std::abs(place - std::round(place)) < 0x1p-24)
                    code = static_cast<int>(std::round(place));
            } else {
                code = ir::code_of(field, value);
            }
            if (code && std::ranges::find(anchors, value, &ir::Anchor::value) == anchors.end())
                anchors.push_back({*code, value});
        }
        field.anchors = std::move(anchors);
    }
}

bool check_values(const ir::Module& module, const ir::Packing& packing, const ir::Gbuffer& gbuffer,
                  Diagnostics& diagnostics)
{
    const int errors = diagnostics.error_count();
    check_names(module, packing, diagnostics);
    const std::vector<Condition> conditions = conditions_of(module);
    for (const ir::Field& field : packing.fields) {
        if (is_repeated(module, packing, field)) continue;
        const FieldRun run{module, field};
        FieldCheck check{module, gbuffer, field, run, diagnostics};
        std::vector<Kept> kept{{check.default_value(), Kept::Why::standard, {}, {}}};
        for (const ir::ExactRequirement& required : packing.exact)
            if (required.parameter == field.parameter)
                kept.push_back({required.value, Kept::Why::required, required.span, {}});
        for (std::size_t i = 0; i < conditions.size(); ++i)
            for (const double value : conditions[i].neutral_values(field))
                if (!conditions[i].stays_off(field, run.stored_and_read(value)))
                    kept.push_back({value, Kept::Why::neutral, module.effects[i].span,
                                    module.effects[i].name});
        check.check_kept(kept);
        check.check_ends();
        if (check.check_rising()) check.check_codes();
    }
    return diagnostics.error_count() == errors;
}

}  // namespace lobe::check
