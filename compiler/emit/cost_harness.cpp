#include "emit/cost_harness.h"

#include "emit/listing.h"
#include "emit/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace lobe::emit {
namespace {

const std::vector<std::string> taken_names{"harness_points", "harness_results",  "harness_count",
                                           "harness_thread", "harness_index",    "harness_link",
                                           "harness_zero",   "harness_evaluate", "HarnessPoints",
                                           "HarnessResults", "HarnessPush"};

std::string input_bits(int index) { return fmt::format("harness_x{}", index); }

/// The bits of a number, as many as it has.
std::string bits_of(const std::string& number, NumberFormat format)
{
    switch (format) {
    case NumberFormat::float32: return fmt::format("floatBitsToUint({})", number);
    case NumberFormat::float16: return fmt::format("packFloat2x16(f16vec2({}))", number);
    case NumberFormat::packed16: return fmt::format("packFloat2x16({})", number);
    }
    return {};
}

/// The statements before the functions, and the functions' calls.
class Writer {
public:
    Writer(const ir::Module& module, const Sources& sources,
           const std::vector<ir::FunctionId>& functions, NumberFormat format, bool from_vectors)
        : module_(module), functions_(functions), format_(format), from_vectors_(from_vectors),
          dialect_(dialect(*find_target("glsl450"), format == NumberFormat::float32
                                                        ? Precision::float32
                                                        : Precision::float16)),
          listing_(module, sources, dialect_, module.reachable(functions), {}, taken_names),
          scope_(listing_.scope())
    {
        if (!from_vectors_) return;
        frame_.bare = module.bare_geometry;
        for (const ir::FunctionId id : functions_)
            for (const ir::Input& input : module_[id].inputs) {
                if (input.origin != ir::Origin::geometry) continue;
                const auto field = static_cast<ir::GeometryField>(input.which);
                tangents_ |= ir::needs_tangents(field);
                frame_.expect(field);
            }
    }

    Evaluation write()
    {
        std::vector<ir::ExprId> roots;
        for (const ir::FunctionId id : functions_)
            roots.push_back(
                text_.call(module_, id, [&](const ir::Input& input) { return operand(input); }));
        scope_.inputs = text_.texts;
        evaluation_.functions = listing_.functions();
        const Body body = listing_.write(scope_, text_.graph, roots);
        for (const Statement& statement : body.locals)
            evaluation_.statements.push_back(statement.text);
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const std::string name = scope_.namer.unique("result");
            const ir::Type type = text_.graph[roots[i]].type;
            evaluation_.statements.push_back(
                fmt::format("{} {} = {};", dialect_.type(type), name, body.results[i].text));
            add_results(name, type);
        }
        evaluation_.helpers = listing_.helpers();
        return std::move(evaluation_);
    }

private:
    /// What is passed for an input: the same for all functions.
    ir::ExprId operand(const ir::Input& input)
    {
        const bool expanded = from_vectors_ && input.origin == ir::Origin::geometry;
        if (!expanded) return text_.input(declare(key_of(input), input), input.type);
        const auto field = static_cast<ir::GeometryField>(input.which);
        const auto vector = [&](ir::GeometryField which) {
            ir::Input declared;
            declared.name = ir::facts(which).name;
            declared.type = ir::facts(which).type;
            declared.origin = ir::Origin::geometry;
            declared.which = static_cast<std::uint32_t>(which);
            return text_.input(declare(key_of(declared), declared), declared.type);
        };
        frame_.l = vector(ir::GeometryField::l);
        frame_.v = vector(ir::GeometryField::v);
        frame_.n = vector(ir::GeometryField::n);
        if (tangents_) {
            frame_.x = vector(ir::GeometryField::x);
            frame_.y = vector(ir::GeometryField::y);
        }
        return ir::expand(text_.graph, field, frame_);
    }

    static std::string key_of(const ir::Input& input)
    {
        if (input.origin == ir::Origin::argument) return input.name;
        return fmt::format("{} {}", static_cast<int>(input.origin), input.which);
    }

    /// The local that holds an input; declared where it is first asked for.
    std::string declare(const std::string& key, const ir::Input& input)
    {
        if (const auto known = names_.find(key); known != names_.end()) return known->second;
        const std::string name = scope_.namer.unique(input_name(dialect_, input));
        std::vector<std::string> numbers;
        for (int i = 0; i < ir::components(input.type); ++i) {
            const int index = evaluation_.inputs++;
            numbers.push_back(input.type == ir::Type::boolean ? read_condition(index)
                                                              : read_number(index, format_));
        }
        const std::string_view type = dialect_.type(input.type);
        std::string value = fmt::format("{}", fmt::join(numbers, ", "));
        if (numbers.size() > 1) value = fmt::format("{}({})", type, value);
        evaluation_.statements.push_back(fmt::format("{} {} = {};", type, name, value));
        names_.emplace(key, name);
        return name;
    }

    void add_results(const std::string& name, ir::Type type)
    {
        const int count = ir::components(type);
        for (int i = 0; i < count; ++i) {
            std::string value = count > 1 ? fmt::format("{}.{}", name, "xyzw"[i]) : name;
            if (type == ir::Type::boolean)
                value = fmt::format("({} ? {} : {})", value, dialect_.literal(1.0),
                                    dialect_.literal(0.0));
            evaluation_.results.push_back(std::move(value));
        }
    }

    const ir::Module& module_;
    const std::vector<ir::FunctionId>& functions_;
    NumberFormat format_;
    bool from_vectors_;
    bool tangents_ = false;
    ir::Frame frame_;
    const Dialect& dialect_;
    Listing listing_;
    Scope scope_;
    TextGraph text_;
    std::map<std::string, std::string> names_;
    Evaluation evaluation_;
};

}  // namespace

std::string read_number(int index, NumberFormat format)
{
    const std::string bits = fmt::format("{} ^ harness_link", input_bits(index));
    switch (format) {
    case NumberFormat::float32: return fmt::format("uintBitsToFloat({})", bits);
    case NumberFormat::float16: return fmt::format("unpackFloat2x16({}).x", bits);
    case NumberFormat::packed16: return fmt::format("unpackFloat2x16({})", bits);
    }
    return {};
}

std::string read_condition(int index)
{
    return fmt::format("({} ^ harness_link) != 0u", input_bits(index));
}

Evaluation evaluation(const ir::Module& module, const Sources& sources,
                      const std::vector<ir::FunctionId>& functions, NumberFormat format,
                      bool from_vectors)
{
    return Writer{module, sources, functions, format, from_vectors}.write();
}

Evaluation powers(int numbers, int exponent, NumberFormat format)
{
    Evaluation evaluation;
    evaluation.inputs = numbers;
    for (int i = 0; i < numbers; ++i) {
        std::string result = read_number(i, format);
        for (int factor = 1; factor < exponent; ++factor) result += " * " + read_number(i, format);
        evaluation.results.push_back(std::move(result));
    }
    return evaluation;
}

Evaluation product(NumberFormat format)
{
    Evaluation evaluation;
    evaluation.inputs = 2;
    evaluation.results.push_back(
        fmt::format("{} * {}", read_number(0, format), read_number(1, format)));
    return evaluation;
}

std::string cost_harness(const Evaluation& evaluation, NumberFormat format, int copies, int chains)
{
    const bool half = format != NumberFormat::float32;
    Record values;
    std::vector<std::string> extensions;
    if (half)
        extensions.emplace_back(
            "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require");
    values.lists["extensions"] = lines(extensions);

    std::vector<Record> inputs;
    for (int i = 0; i < evaluation.inputs; ++i) {
        const std::string point =
            fmt::format("harness_points[harness_index * {}u + {}u]", evaluation.inputs, i);
        inputs.push_back({{{"name", input_bits(i)},
                           {"value", half ? fmt::format("packFloat2x16(f16vec2({}))", point)
                                          : fmt::format("floatBitsToUint({})", point)}},
                          {}});
    }
    values.lists["inputs"] = std::move(inputs);
    values.lists["helpers"] = evaluation.helpers;
    values.lists["functions"] = evaluation.functions;
    values.lists["statements"] = lines(evaluation.statements);

    std::string result;
    for (const std::string& each : evaluation.results) {
        const std::string bits = bits_of(each, format);
        result = result.empty() ? bits : fmt::format("max({}, {})", result, bits);
    }
    values.texts["result"] = result;

    std::vector<Record> starts;
    std::vector<Record> steps;
    std::string sum;
    for (int chain = 0; chain < chains; ++chain) {
        const std::string link = fmt::format("harness_link_{}", chain);
        starts.push_back(
            {{{"link", link}, {"start", fmt::format("harness_index + {}u", chain)}}, {}});
        sum = sum.empty() ? link : fmt::format("max({}, {})", sum, link);
    }
    for (int copy = 0; copy < copies; ++copy)
        for (const Record& start : starts)
            steps.push_back({{{"link", start.texts.at("link")}}, {}});
    values.lists["chains"] = std::move(starts);
    values.lists["steps"] = std::move(steps);
    values.texts["sum"] = sum;
    return render_embedded("harness/cost.comp", values).text;
}

}  // namespace lobe::emit
