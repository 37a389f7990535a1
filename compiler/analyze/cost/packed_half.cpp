#include "analyze/cost/packed_half.h"

#include "emit/dialect.h"
#include "evaluate/tape.h"

#include <fmt/format.h>

#include <map>

namespace lobe::analyze {
namespace {

using evaluate::Instruction;
using evaluate::Slot;
using evaluate::Tape;
using evaluate::TapeOp;

/// What a slot holds while the text is written.
struct Held {
    std::string text;
    bool is_condition = false;
};

class Writer {
public:
    explicit Writer(emit::Evaluation& out)
        : out_(out),
          dialect_(emit::dialect(*emit::find_target("glsl450"), emit::Precision::float16))
    {
    }

    void write(const ir::Function& function, const Tape& tape)
    {
        slots_.assign(tape.slots, {});
        for (std::size_t i = 0; i < tape.inputs.size(); ++i)
            slots_[i] = input(function.inputs[tape.inputs[i].input], tape.inputs[i].component);
        for (const evaluate::Constant& constant : tape.constants)
            slots_[constant.slot] = {fmt::format("f16vec2({})", dialect_.literal(constant.literal)),
                                     false};
        for (const Instruction& instruction : tape.code) {
            const bool is_condition = makes_condition(instruction.op);
            const std::string name = fmt::format("{}{}", is_condition ? "c" : "t", names_++);
            out_.statements.push_back(fmt::format("{} {} = {};", is_condition ? "bvec2" : "f16vec2",
                                                  name, value(instruction)));
            slots_[instruction.result] = {name, is_condition};
        }
        for (const Slot slot : tape.outputs) out_.results.push_back(number(slot));
    }

private:
    /// The text of an input's component: the same for all functions.
    Held input(const ir::Input& input, int component)
    {
        const bool is_condition = input.type == ir::Type::boolean;
        const std::string key =
            input.origin == ir::Origin::argument
                ? fmt::format("{} {}", input.name, component)
                : fmt::format("{} {} {}", static_cast<int>(input.origin), input.which, component);
        const auto [known, is_new] = inputs_.try_emplace(key);
        if (is_new) {
            const std::string name = fmt::format("x{}", out_.inputs);
            out_.statements.push_back(
                is_condition
                    ? fmt::format("bvec2 {} = bvec2({});", name, emit::read_condition(out_.inputs))
                    : fmt::format("f16vec2 {} = {};", name,
                                  emit::read_number(out_.inputs, emit::NumberFormat::packed16)));
            ++out_.inputs;
            known->second = {name, is_condition};
        }
        return known->second;
    }

    std::string number(Slot slot) const
    {
        const Held& held = slots_[slot];
        if (!held.is_condition) return held.text;
        return fmt::format("mix(f16vec2(0.0hf), f16vec2(1.0hf), {})", held.text);
    }

    std::string condition(Slot slot) const
    {
        const Held& held = slots_[slot];
        if (held.is_condition) return held.text;
        return fmt::format("notEqual({}, f16vec2(0.0hf))", held.text);
    }

    std::string value(const Instruction& instruction) const
    {
        const auto call = [&](std::string_view function) {
            std::string text{function};
            const Slot operands[] = {instruction.a, instruction.b, instruction.c, instruction.d};
            for (int i = 0; i < evaluate::arity(instruction.op); ++i)
                text += (i == 0 ? "(" : ", ") + number(operands[i]);
            return text + ")";
        };
        const auto infix = [&](std::string_view word) {
            return fmt::format("{} {} {}", number(instruction.a), word, number(instruction.b));
        };
        const auto each = [&](std::string_view word) {
            const std::string a = condition(instruction.a);
            const std::string b = condition(instruction.b);
            return fmt::format("bvec2({0}.x {2} {1}.x, {0}.y {2} {1}.y)", a, b, word);
        };
        constexpr std::string_view zero = "f16vec2(0.0hf)";
        constexpr std::string_view one = "f16vec2(1.0hf)";
        switch (instruction.op) {
        case TapeOp::negate: return "-" + number(instruction.a);
        case TapeOp::absolute: return call("abs");
        case TapeOp::sign: return call("sign");
        case TapeOp::floor: return call("floor");
        case TapeOp::square: return fmt::format("{0} * {0}", number(instruction.a));
        case TapeOp::square_root: return call("sqrt");
        case TapeOp::inverse_square_root: return call("inversesqrt");
        case TapeOp::exp2: return call("exp2");
        case TapeOp::log2: return call("log2");
        case TapeOp::exp: return call("exp");
        case TapeOp::log: return call("log");
        case TapeOp::sine: return call("sin");
        case TapeOp::cosine: return call("cos");
        case TapeOp::tangent: return call("tan");
        case TapeOp::arc_sine: return call("asin");
        case TapeOp::arc_cosine: return call("acos");
        case TapeOp::arc_tangent: return call("atan");
        case TapeOp::saturate:
            return fmt::format("clamp({}, {}, {})", number(instruction.a), zero, one);
        case TapeOp::add: return infix("+");
        case TapeOp::subtract: return infix("-");
        case TapeOp::multiply: return infix("*");
        case TapeOp::divide: return infix("/");
        case TapeOp::power: return call("pow");
        case TapeOp::minimum: return call("min");
        case TapeOp::maximum: return call("max");
        case TapeOp::step: return call("step");
        case TapeOp::normalized: return infix("* inversesqrt(") + ")";
        case TapeOp::lerp: return call("mix");
        case TapeOp::clamp: return call("clamp");
        case TapeOp::smoothstep: return call("smoothstep");
        case TapeOp::less: return call("lessThan");
        case TapeOp::less_equal: return call("lessThanEqual");
        case TapeOp::equal: return call("equal");
        case TapeOp::not_equal: return call("notEqual");
        case TapeOp::logical_and: return each("&&");
        case TapeOp::logical_or: return each("||");
        case TapeOp::logical_not: return fmt::format("not({})", condition(instruction.a));
        case TapeOp::select:
            return fmt::format("mix({}, {}, {})", number(instruction.c), number(instruction.b),
                               condition(instruction.a));
        case TapeOp::sum3:
            return fmt::format("{} + {} + {}", number(instruction.a), number(instruction.b),
                               number(instruction.c));
        case TapeOp::sum4:
            return fmt::format("{} + {} + {} + {}", number(instruction.a), number(instruction.b),
                               number(instruction.c), number(instruction.d));
        }
        return {};
    }

    emit::Evaluation& out_;
    const emit::Dialect& dialect_;
    std::vector<Held> slots_;
    std::map<std::string, Held> inputs_;
    int names_ = 0;
};

}  // namespace

emit::Evaluation packed_evaluation(const ir::Module& module,
                                   const std::vector<ir::FunctionId>& functions, bool from_vectors)
{
    emit::Evaluation out;
    Writer writer{out};
    for (const ir::FunctionId id : functions) {
        const ir::Function function = from_vectors ? ir::entry_point(module, id) : module[id];
        writer.write(function, evaluate::compile(module, function));
    }
    return out;
}

}  // namespace lobe::analyze
