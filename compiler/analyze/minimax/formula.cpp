#include "analyze/minimax/formula.h"

#include "evaluate/tape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace lobe::analyze {
namespace {

using ir::ExprId;
using ir::Op;

/// How tightly a text binds, loosest first; docs/language.md, "Expressions".
enum class Binding : std::uint8_t {
    choice,
    disjunction,
    conjunction,
    negation,
    comparison,
    sum,
    product,
    minus,
    power,
    operand
};

struct Text {
    std::string text;
    Binding binding = Binding::operand;
};

std::string in(const Text& text, Binding least)
{
    return text.binding >= least ? text.text : "(" + text.text + ")";
}

/// An operation with a sign between two operands; the right one binds tighter, for signs group to
/// the left.
struct Sign {
    Op op;
    std::string_view sign;
    Binding binding;
    Binding right;
};
constexpr std::array signs{
    Sign{Op::add, " + ", Binding::sum, Binding::product},
    Sign{Op::subtract, " - ", Binding::sum, Binding::product},
    Sign{Op::multiply, " * ", Binding::product, Binding::minus},
    Sign{Op::divide, " / ", Binding::product, Binding::minus},
    Sign{Op::less, " < ", Binding::comparison, Binding::sum},
    Sign{Op::less_equal, " <= ", Binding::comparison, Binding::sum},
    Sign{Op::equal, " == ", Binding::comparison, Binding::sum},
    Sign{Op::not_equal, " != ", Binding::comparison, Binding::sum},
    Sign{Op::logical_and, " and ", Binding::conjunction, Binding::negation},
    Sign{Op::logical_or, " or ", Binding::disjunction, Binding::conjunction},
};

struct Name {
    Op op;
    std::string_view name;
};
constexpr std::array names{
    Name{Op::absolute, "abs"},
    Name{Op::sign, "sign"},
    Name{Op::floor, "floor"},
    Name{Op::square_root, "sqrt"},
    Name{Op::inverse_square_root, "inversesqrt"},
    Name{Op::exp2, "exp2"},
    Name{Op::log2, "log2"},
    Name{Op::exp, "exp"},
    Name{Op::log, "log"},
    Name{Op::sine, "sin"},
    Name{Op::cosine, "cos"},
    Name{Op::tangent, "tan"},
    Name{Op::arc_sine, "asin"},
    Name{Op::arc_cosine, "acos"},
    Name{Op::arc_tangent, "atan"},
    Name{Op::saturate, "saturate"},
    Name{Op::minimum, "min"},
    Name{Op::maximum, "max"},
    Name{Op::step, "step"},
    Name{Op::lerp, "lerp"},
    Name{Op::clamp, "clamp"},
    Name{Op::smoothstep, "smoothstep"},
    Name{Op::guarded_smoothstep, "smoothstep"},
};

class Writing {
public:
    Writing(const ir::Module& module, const ir::Function& function)
        : module_{module}, function_{function}, graph_{function.graph}
    {
    }

    std::optional<std::string> run()
    {
        constexpr std::size_t longest = 4096;
        const auto uses = ir::use_counts(graph_, function_.result);
        bool chooses = false;
        bool divides = false;
        texts_.resize(graph_.size());
        for (const ExprId id : graph_.ids()) {
            if (uses[id] == 0) continue;
            const auto operands = graph_.operands(id);
            chooses = chooses || graph_[id].op == Op::select;
            divides =
                divides || (graph_[id].op == Op::divide && graph_[operands[1]].op != Op::literal);
            auto text = write(id);
            if (!text || text->text.size() > longest) return std::nullopt;
            texts_[id.index] = std::move(*text);
        }
        if (chooses && divides) return std::nullopt;
        return texts_[function_.result.index].text;
    }

private:
    const Text& at(ExprId id) const { return texts_[id.index]; }

    static Text call(std::string_view name, const std::vector<std::string>& operands)
    {
        return {fmt::format("{}({})", name, fmt::join(operands, ", "))};
    }

    std::vector<std::string> operand_texts(ExprId id) const
    {
        std::vector<std::string> result;
        for (const ExprId operand : graph_.operands(id)) result.push_back(at(operand).text);
        return result;
    }

    static bool is_color_or_scalar(ir::Type type)
    {
        return ir::components(type) == 1 || type == ir::Type::vec3;
    }

    std::optional<Text> write(ExprId id) const
    {
        const ir::Expr& expr = graph_[id];
        const auto operands = graph_.operands(id);
        if (!is_color_or_scalar(expr.type)) return std::nullopt;
        if (const auto sign = std::ranges::find(signs, expr.op, &Sign::op); sign != signs.end())
            return Text{in(at(operands[0]),
                           sign->binding == Binding::comparison ? Binding::sum : sign->binding) +
                            std::string{sign->sign} + in(at(operands[1]), sign->right),
                        sign->binding};
        if (const auto name = std::ranges::find(names, expr.op, &Name::op); name != names.end())
            return call(name->name, operand_texts(id));
        switch (expr.op) {
        case Op::literal: {
            const std::string& text = graph_.literal_of(id).text;
            return Text{text, text.starts_with('-') ? Binding::minus : Binding::operand};
        }
        case Op::input: return input(function_.inputs[expr.aux]);
        case Op::negate: return Text{"-" + in(at(operands[0]), Binding::minus), Binding::minus};
        case Op::logical_not:
            return Text{"not " + in(at(operands[0]), Binding::negation), Binding::negation};
        case Op::power:
        case Op::guarded_power:
            return Text{in(at(operands[0]), Binding::operand) + "^" +
                            in(at(operands[1]), Binding::operand),
                        Binding::power};
        case Op::select:
            return Text{fmt::format("if {} then {} else {}", at(operands[0]).text,
                                    in(at(operands[1]), Binding::disjunction),
                                    at(operands[2]).text),
                        Binding::choice};
        case Op::component:
            return Text{in(at(operands[0]), Binding::operand) +
                        evaluate::component_suffix(ir::Type::vec3, ir::Quantity::color,
                                                   static_cast<int>(expr.aux))};
        case Op::construct: return call("color", operand_texts(id));
        case Op::call: return call_of(id);
        default: return std::nullopt;  // vectors that are no colors
        }
    }

    static std::optional<Text> input(const ir::Input& input)
    {
        if (input.type != ir::Type::scalar && input.quantity != ir::Quantity::color)
            return std::nullopt;
        const std::string_view of = input.origin == ir::Origin::geometry  ? "g."
                                    : input.origin == ir::Origin::surface ? "s."
                                    : input.origin == ir::Origin::emitter ? "e."
                                                                          : "";
        return Text{fmt::format("{}{}", of, input.name)};
    }

    /// Fields come from structures, which are passed whole, and parameters are not passed.
    Text call_of(ExprId id) const
    {
        const ir::Function& callee = module_.functions[graph_[id].aux];
        std::vector<std::string> operands;
        bool geometry = false;
        bool surface = false;
        bool emitter = false;
        for (std::size_t i = 0; i < callee.inputs.size(); ++i) {
            switch (callee.inputs[i].origin) {
            case ir::Origin::argument: operands.push_back(at(graph_.operands(id)[i]).text); break;
            case ir::Origin::geometry:
                if (!std::exchange(geometry, true)) operands.emplace_back("g");
                break;
            case ir::Origin::surface:
                if (!std::exchange(surface, true)) operands.emplace_back("s");
                break;
            case ir::Origin::emitter:
                if (!std::exchange(emitter, true)) operands.emplace_back("e");
                break;
            case ir::Origin::parameter: break;
            }
        }
        return call(callee.name, operands);
    }

    const ir::Module& module_;
    const ir::Function& function_;
    const ir::Graph& graph_;
    std::vector<Text> texts_;
};

}  // namespace

std::optional<std::string> formula_of(const ir::Module& module, const ir::Function& function)
{
    return Writing{module, function}.run();
}

}  // namespace lobe::analyze
