#include "check/range_report.h"

#include "check/docs.h"
#include "check/types.h"

#include <fmt/format.h>

#include <cmath>

namespace lobe::check {
namespace {

using Kind = Obligation::Kind;

std::string text(const Interval& range) { return describe(ir::Range{range.low, range.high}); }

std::string text(const Requirement& wanted)
{
    const bool below = std::isinf(wanted.low);
    const bool above = std::isinf(wanted.high);
    if (above && !below)
        return fmt::format("{} {}", wanted.low_open ? "above" : "at least",
                           describe(wanted.low, true));
    if (below && !above) return fmt::format("at most {}", describe(wanted.high, true));
    return fmt::format("{} {}", wanted.low_open ? "strictly inside" : "in",
                       describe(ir::Range{wanted.low, wanted.high}));
}

/// `g.cos_i`: a field of a structure by itself.
bool is_cosine(std::string_view subject, std::string_view field)
{
    const std::size_t dot = subject.rfind('.');
    return dot != std::string_view::npos && subject.substr(dot + 1) == field;
}

/// Names, members, numbers and calls need no parentheses when something is put around them.
bool is_plain(std::string_view subject)
{
    return subject.find_first_of(" +-*/^") == std::string_view::npos;
}

class Report {
public:
    Report(const Finding& finding, const Sources& sources)
        : finding_(finding), obligation_(finding.obligation), sources_(sources),
          subject_(one_line(sources.text(finding.obligation.subject))),
          certain_(finding.witness.has_value())
    {
    }

    Diagnostic run()
    {
        diagnostic_.primary.span = obligation_.subject;
        switch (obligation_.kind) {
        case Kind::divisor: divisor(); break;
        case Kind::domain: domain(); break;
        case Kind::power_base: power_base(); break;
        case Kind::power_zero: power_zero(); break;
        case Kind::argument: argument(); break;
        case Kind::result: result(); break;
        case Kind::stored: stored(); break;
        }
        evidence();
        return std::move(diagnostic_);
    }

private:
    std::string_view can() const { return certain_ ? "can" : "is not proved not to"; }
    std::string subject_range() const
    {
        return fmt::format("`{}` is in {}", subject_, text(finding_.ranges[0]));
    }
    void fix(std::string replacement, std::string what)
    {
        diagnostic_.fix = Fix{obligation_.subject, std::move(replacement), std::move(what)};
    }

    void divisor()
    {
        diagnostic_.code = Code::divisor_reaches_zero;
        diagnostic_.message = certain_ ? "this division can reach 0"
                                       : "this divisor is not proved to stay away from 0";
        diagnostic_.primary.span = obligation_.whole;
        diagnostic_.primary.text = subject_range();
        if (certain_) diagnostic_.primary.text += ", and it can be 0";
        if (is_cosine(subject_, "cos_i"))
            diagnostic_.helps.push_back(
                fmt::format("multiply the term by `{}` first: a model's output is f times n.l, so "
                            "the division cancels",
                            subject_));
        const Span after{obligation_.whole.source, obligation_.whole.end, obligation_.whole.end};
        // In the arm of a conditional `else` would end the arm.
        diagnostic_.fix = obligation_.in_choice
                              ? Fix{obligation_.whole,
                                    fmt::format("({} else 0)", sources_.text(obligation_.whole)),
                                    "name the limit, what the quotient is where the divisor is 0"}
                              : Fix{after, " else 0",
                                    "name the limit, what the quotient is where the divisor is 0"};
    }

    void domain()
    {
        const Requirement& wanted = obligation_.any_of[0].requirement;
        const std::string& name = obligation_.function;
        diagnostic_.code = Code::domain_violation;
        diagnostic_.message = certain_
                                  ? fmt::format("`{}` can leave its domain", name)
                                  : fmt::format("`{}` is not proved to stay in its domain", name);
        diagnostic_.primary.text =
            fmt::format("{}; `{}` needs it {}", subject_range(), name, text(wanted));
        if (name == "sqrt")
            fix(fmt::format("max({}, 0)", subject_), "cut off what is below 0");
        else if (name == "asin" || name == "acos")
            fix(fmt::format("clamp({}, -1, 1)", subject_), "keep it in the domain");
        else
            diagnostic_.helps.push_back("bound the argument away from the end of the domain, or "
                                        "narrow the ranges it is made of");
    }

    void power_base()
    {
        diagnostic_.code = Code::power_of_negative;
        diagnostic_.message = certain_ ? "this power can have a negative base"
                                       : "the base of this power is not proved to be 0 or more";
        diagnostic_.primary.text =
            fmt::format("{}; below 0 only a whole literal exponent has a value", subject_range());
        fix(fmt::format("max({}, 0)", subject_), "cut off what is below 0");
        if (!is_plain(subject_)) return;
        diagnostic_.helps.push_back(
            fmt::format("write `abs({})` if its sign means nothing here", subject_));
    }

    void power_zero()
    {
        diagnostic_.code = Code::power_of_zero;
        diagnostic_.message = certain_ ? "this power can raise 0 to a negative exponent"
                                       : "this power is not proved never to raise 0 to a negative "
                                         "exponent";
        diagnostic_.primary.span = obligation_.whole;
        diagnostic_.primary.text = fmt::format("the base is in {}", text(finding_.ranges[0]));
        if (finding_.ranges.size() > 1)
            diagnostic_.primary.text +=
                fmt::format(", the exponent in {}", text(finding_.ranges[1]));
        diagnostic_.helps.push_back(
            "write it as a division that names its limit: `1 / x^n else c`");
    }

    /// `saturate(x)`, `max(x, 0)`, `clamp(x, a, b)`: whichever ends are left.
    std::string kept_inside() const
    {
        const Requirement& wanted = obligation_.any_of[0].requirement;
        const Interval& range = finding_.ranges[0];
        const std::string low = describe(wanted.low);
        const std::string high = describe(wanted.high);
        if (wanted.low == 0 && wanted.high == 1) return fmt::format("saturate({})", subject_);
        if (range.high <= wanted.high) return fmt::format("max({}, {})", subject_, low);
        if (range.low >= wanted.low) return fmt::format("min({}, {})", subject_, high);
        return fmt::format("clamp({}, {}, {})", subject_, low, high);
    }

    void argument()
    {
        const Requirement& wanted = obligation_.any_of[0].requirement;
        diagnostic_.code = Code::argument_out_of_range;
        diagnostic_.message = fmt::format("`{}` of `{}` {}", obligation_.name, obligation_.function,
                                          certain_ ? "can be out of its range"
                                                   : "is not proved to stay in its range");
        diagnostic_.primary.text =
            fmt::format("this is in {}; `{}` takes {}", text(finding_.ranges[0]), obligation_.name,
                        text(Interval{wanted.low, wanted.high}));
        diagnostic_.secondary.push_back({obligation_.declared, "the range is asked for here"});
        fix(kept_inside(), "keep it in range, if that is what you mean");
    }

    void result()
    {
        diagnostic_.code = Code::result_out_of_range;
        diagnostic_.message = fmt::format("the result of `{}` {}", obligation_.function,
                                          certain_ ? "can leave its declared range"
                                                   : "is not proved to stay in its declared range");
        diagnostic_.primary.text = fmt::format("this is in {}", text(finding_.ranges[0]));
        diagnostic_.secondary.push_back({obligation_.declared, "the range is declared here"});
        diagnostic_.helps.push_back(
            "declare the range that it has, or no range, which has it inferred");
        diagnostic_.helps.push_back("or keep it inside: `saturate`, `min`, `max` and `clamp` do");
    }

    void stored()
    {
        diagnostic_.code = Code::range_clamped;
        diagnostic_.message =
            fmt::format("what `{}` stores {}", obligation_.function,
                        certain_ ? "can leave [0, 1]" : "is not proved to stay in [0, 1]");
        diagnostic_.primary.text = fmt::format("this is in {}", text(finding_.ranges[0]));
        diagnostic_.notes.push_back("0 is the first code and 1 the last one; what is outside is "
                                    "clamped and lost");
        diagnostic_.helps.push_back("divide by what the ends of the range give");
    }

    /// The input that breaks it, or why none is shown.
    void evidence()
    {
        if (!obligation_.term.empty())
            diagnostic_.notes.push_back(
                fmt::format("in the term of the sum with {}", obligation_.term));
        if (!certain_ && !finding_.unbounded.empty()) {
            diagnostic_.code = Code::unbounded_argument;
            for (const ir::Input* input : finding_.unbounded)
                diagnostic_.secondary.push_back(
                    {input->span, fmt::format("`{}` has no range", input->name)});
            diagnostic_.notes.push_back("no input was found that breaks it, but nothing bounds "
                                        "what it is made of");
            diagnostic_.helps.insert(diagnostic_.helps.begin(),
                                     fmt::format("give `{}` a range: `{}: float in [0, 1]`",
                                                 finding_.unbounded[0]->name,
                                                 finding_.unbounded[0]->name));
            return;
        }
        if (!certain_) {
            diagnostic_.notes.push_back("no input was found that breaks it; the ranges shown are "
                                        "as tight as the analysis could make them");
            return;
        }
        const Witness& witness = *finding_.witness;
        std::string value;
        if (obligation_.kind != Kind::divisor && obligation_.kind != Kind::power_zero) {
            for (const double component : witness.values)
                value += (value.empty() ? "" : ", ") + describe(component, true);
            if (witness.values.size() > 1) value = fmt::format("({})", value);
            value = fmt::format(", where it is {}", value);
        }
        if (witness.on_vectors) {
            diagnostic_.notes.push_back(fmt::format(
                "reached at: {}{}", witness.point.empty() ? "every input" : witness.point, value));
        } else {
            diagnostic_.notes.push_back(fmt::format("reached at: {}{}", witness.point, value));
            diagnostic_.notes.push_back("the analysis takes the cosines of a geometry as "
                                        "independent: no l and v were found that give these");
        }
    }

    const Finding& finding_;
    const Obligation& obligation_;
    const Sources& sources_;
    std::string subject_;
    bool certain_;
    Diagnostic diagnostic_;
};

}  // namespace

Diagnostic describe(const Finding& finding, const Sources& sources)
{
    return Report{finding, sources}.run();
}

}  // namespace lobe::check
