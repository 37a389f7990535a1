#include "ir/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lobe::ir {
namespace {

struct OpEntry {
    std::string_view name;
    int arity;
    Shape shape;
};

constexpr std::array op_entries{
#define LOBE_OP(name, arity, shape) OpEntry{#name, arity, Shape::shape},
#include "ir/ops.def"
#undef LOBE_OP
};

constexpr std::size_t most_operands = 3;  // of an operation whose type follows from them
static_assert(std::ranges::all_of(op_entries, [](const OpEntry& op) {
    return op.arity <= static_cast<int>(most_operands);
}));

const OpEntry& entry(Op op) { return op_entries[static_cast<std::size_t>(op)]; }

std::size_t hash_node(Op op, Type type, std::uint32_t aux, std::span<const ExprId> operands)
{
    std::size_t hash =
        mix_hash(aux, static_cast<std::size_t>(op) * 31 + static_cast<std::size_t>(type));
    for (const ExprId operand : operands) hash = mix_hash(hash, operand.index);
    return hash;
}

}  // namespace

int arity(Op op) { return entry(op).arity; }
Shape shape(Op op) { return entry(op).shape; }
std::string_view name(Op op) { return entry(op).name; }

int components(Type type)
{
    switch (type) {
    case Type::boolean:
    case Type::scalar: return 1;
    case Type::vec2: return 2;
    case Type::vec3: return 3;
    case Type::vec4: return 4;
    }
    return 0;
}

Type vector_type(int components)
{
    assert(components >= 1 && components <= 4);
    constexpr std::array types{Type::scalar, Type::vec2, Type::vec3, Type::vec4};
    return types[static_cast<std::size_t>(components - 1)];
}

std::string_view name(Type type)
{
    constexpr std::array<std::string_view, 5> names{"boolean", "scalar", "vec2", "vec3", "vec4"};
    return names[static_cast<std::size_t>(type)];
}

std::string canonical_number(std::string_view text)
{
    if (text == "pi") return "pi";

    // Split into digits and a decimal exponent, then write them back the one short way.
    std::string digits;
    long exponent = 0;
    bool negative = false;
    bool fraction = false;
    std::size_t i = 0;
    if (i < text.size() && text[i] == '-') {
        negative = true;
        ++i;
    }
    for (; i < text.size() && text[i] != 'e' && text[i] != 'E'; ++i) {
        if (text[i] == '.') {
            fraction = true;
        } else {
            digits += text[i];
            if (fraction) --exponent;
        }
    }
    if (i < text.size()) {
        ++i;
        if (i < text.size() && text[i] == '+') ++i;
        long written = 0;
        const auto read = std::from_chars(text.data() + i, text.data() + text.size(), written);
        if (read.ec == std::errc::result_out_of_range)
            written = text[i] == '-' ? -1'000'000 : 1'000'000;
        exponent += std::clamp(written, -1'000'000L, 1'000'000L);
    }
    digits.erase(0, digits.find_first_not_of('0'));
    if (digits.empty()) return "0";
    while (digits.back() == '0') {
        digits.pop_back();
        ++exponent;
    }

    const std::string sign = negative ? "-" : "";
    const long size = static_cast<long>(digits.size());
    const long point = size + exponent;  // digits before the decimal point
    constexpr long widest = 21;
    if (exponent >= 0 && point <= widest)
        return sign + digits + std::string(static_cast<std::size_t>(exponent), '0');
    if (exponent < 0 && point > 0 && point <= widest)
        return sign + digits.substr(0, static_cast<std::size_t>(point)) + "." +
               digits.substr(static_cast<std::size_t>(point));
    if (point <= 0 && point > -6)
        return sign + "0." + std::string(static_cast<std::size_t>(-point), '0') + digits;
    const std::string rest = size > 1 ? "." + digits.substr(1) : "";
    return fmt::format("{}{}{}e{}", sign, digits.substr(0, 1), rest, point - 1);
}

std::optional<int> rounding_of(const Literal& literal)
{
    // m / 10^k with both whole numbers exact as doubles: value * 10^k - m has the sign.
    constexpr int most_digits = 15;
    constexpr std::array powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const std::string_view text = literal.text;
    double number = 0;
    int digits = 0;
    long scale = 0;
    bool fraction = false;
    const bool negative = text.starts_with('-');
    for (std::size_t i = negative ? 1 : 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c >= '0' && c <= '9') {
            number = 10 * number + (c - '0');
            scale += fraction ? 1 : 0;
            if (++digits > most_digits) return std::nullopt;
        } else if (c == '.') {
            fraction = true;
        } else {
            long exponent = 0;
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data() + i + 1, end, exponent);
            if (c != 'e' || read.ec != std::errc{} || read.ptr != end) return std::nullopt;
            scale -= exponent;
            break;
        }
    }
    if (scale < 0 || scale >= static_cast<long>(powers.size())) return std::nullopt;
    const double difference = std::fma(literal.value, powers[static_cast<std::size_t>(scale)],
                                       negative ? number : -number);
    return difference > 0 ? 1 : difference < 0 ? -1 : 0;
}

std::optional<std::uint32_t> Graph::find_literal(std::string_view text) const
{
    return literal_index_.find(std::hash<std::string_view>{}(text),
                               [&](std::uint32_t i) { return literals_[i].text == text; });
}

std::uint32_t Graph::intern_literal(std::string_view text, double value)
{
    if (const auto known = find_literal(text)) return *known;
    literal_index_.add(std::hash<std::string_view>{}(text), literals_.size());
    literals_.push_back({std::string{text}, value});
    return static_cast<std::uint32_t>(literals_.size() - 1);
}

ExprId Graph::literal(std::string_view text, Span span)
{
    // What is known here is canonical, and so is a text that equals it.
    if (const auto known = find_literal(text))
        return intern(Op::literal, Type::scalar, *known, {}, span);
    const std::string canonical = canonical_number(text);
    double value = 3.141592653589793;
    if (canonical != "pi") {
        const auto read =
            std::from_chars(canonical.data(), canonical.data() + canonical.size(), value);
        // from_chars leaves the value alone when it is out of range.
        if (read.ec == std::errc::result_out_of_range)
            value = canonical.find("e-") != std::string::npos ? 0.0 : HUGE_VAL;
    }
    const std::uint32_t aux = intern_literal(canonical, value);
    return intern(Op::literal, Type::scalar, aux, {}, span);
}

ExprId Graph::literal(double value, Span span)
{
    assert(std::isfinite(value));
    // The shortest text that reads back may be another real number than the double it stands
    // for; a folded literal must be exactly the double, so write every digit it has.
    const std::string shortest = canonical_number(fmt::format("{}", value));
    if (rounding_of({shortest, value}) == 0) return literal(shortest, span);
    std::string exact = fmt::format("{:.1074f}", value);
    exact.erase(exact.find_last_not_of('0') + 1);
    return literal(exact, span);
}

ExprId Graph::intern(Op op, Type type, std::uint32_t aux, std::span<const ExprId> operands,
                     Span span)
{
    const std::size_t hash = hash_node(op, type, aux, operands);
    const auto known = shared_.find(hash, [&](std::uint32_t i) {
        const Expr& expr = exprs_[i];
        return expr.op == op && expr.type == type && expr.aux == aux &&
               std::ranges::equal(this->operands(ExprId{i}), operands);
    });
    if (known) return ExprId{*known};

    const ExprId id{exprs_.size()};
    for ([[maybe_unused]] const ExprId operand : operands) assert(operand.index < id.index);
    const std::size_t first = operands_.size();
    exprs_.push_back({op, type, aux, static_cast<std::uint32_t>(first),
                      static_cast<std::uint32_t>(operands.size())});
    // `operands` may be a slice of `operands_`, which moves when it grows.
    const bool own = !operands_.empty() && !std::less<>{}(operands.data(), operands_.data()) &&
                     std::less<>{}(operands.data(), operands_.data() + first);
    const auto offset = own ? operands.data() - operands_.data() : 0;
    operands_.resize(first + operands.size());
    const ExprId* const from = own ? operands_.data() + offset : operands.data();
    std::copy_n(from, operands.size(), operands_.begin() + static_cast<std::ptrdiff_t>(first));
    spans_.push_back(span);
    names_.emplace_back();
    shared_.add(hash, id.index);
    return id;
}

ExprId Graph::input(std::uint32_t index, Type type, Span span)
{
    return intern(Op::input, type, index, {}, span);
}

ExprId Graph::apply(Op op, std::span<const ExprId> operands, Span span)
{
    std::array<Type, most_operands> types{};
    assert(operands.size() <= types.size());
    std::ranges::transform(operands, types.begin(),
                           [this](ExprId operand) { return (*this)[operand].type; });
    return intern(op, result_type(op, std::span{types}.first(operands.size())), 0, operands, span);
}

ExprId Graph::component(ExprId vector, int index, Span span)
{
    assert(index >= 0 && index < components((*this)[vector].type));
    return intern(Op::component, Type::scalar, static_cast<std::uint32_t>(index), {&vector, 1},
                  span);
}

ExprId Graph::construct(Type type, std::span<const ExprId> scalars, Span span)
{
    assert(static_cast<int>(scalars.size()) == components(type) || scalars.size() == 1);
    return intern(Op::construct, type, 0, scalars, span);
}

ExprId Graph::call(FunctionId callee, Type type, std::span<const ExprId> arguments, Span span)
{
    return intern(Op::call, type, callee.index, arguments, span);
}

void Graph::set_name(ExprId id, std::string_view name)
{
    if (names_[id.index].empty()) names_[id.index] = name;
}

ExprId Graph::copy(const Graph& from, ExprId id, std::span<const ExprId> operands)
{
    const Expr expr = from[id];
    const Span span = from.span(id);
    if (expr.op == Op::literal) {
        const Literal& literal = from.literal_of(id);
        return intern(Op::literal, Type::scalar, intern_literal(literal.text, literal.value), {},
                      span);
    }
    const ExprId copied = intern(expr.op, expr.type, expr.aux, operands, span);
    set_name(copied, from.names_[id.index]);
    return copied;
}

bool Graph::is_literal(ExprId id, double value) const
{
    return (*this)[id].op == Op::literal && literal_of(id).text != "pi" &&
           literal_of(id).value == value;
}

Type result_type(Op op, std::span<const Type> operands)
{
    switch (shape(op)) {
    case Shape::compare:
    case Shape::logic: return Type::boolean;
    case Shape::reduce: return Type::scalar;
    case Shape::vector: return Type::vec3;
    case Shape::each: {
        Type widest = Type::scalar;
        // A select's first operand is its condition; it has no say in the type.
        const auto values = op == Op::select ? operands.subspan(1) : operands;
        bool boolean = !values.empty();
        for (const Type type : values) {
            if (type != Type::boolean) boolean = false;
            if (components(type) > components(widest)) widest = type;
        }
        return boolean ? Type::boolean : widest;
    }
    case Shape::leaf:
    case Shape::list: break;
    }
    assert(false && "the type of this operation is given at creation");
    return Type::scalar;
}

Facts<Expr, int> use_counts(const Graph& graph, ExprId root)
{
    Facts<Expr, int> uses(graph.size());
    uses[root] = 1;
    for (std::size_t i = root.index + 1; i-- > 0;) {
        if (uses[ExprId{i}] == 0) continue;
        for (const ExprId operand : graph.operands(ExprId{i})) ++uses[operand];
    }
    return uses;
}

std::string dump(const Graph& graph)
{
    std::string text;
    for (const ExprId id : graph.ids()) {
        const Expr& expr = graph[id];
        text += fmt::format("%{} : {} = {}", id.index, name(expr.type), name(expr.op));
        if (expr.op == Op::literal)
            text += " " + graph.literal_of(id).text;
        else if (expr.op == Op::input || expr.op == Op::component || expr.op == Op::call)
            text += fmt::format(" #{}", expr.aux);
        for (const ExprId operand : graph.operands(id)) text += fmt::format(" %{}", operand.index);
        text += "\n";
    }
    return text;
}

}  // namespace lobe::ir
