#include "analyze/columns.h"

#include "base/diagnostic.h"
#include "ir/geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace lobe::analyze {
namespace {

using ir::GeometryField;
using ir::Origin;

bool contains(std::span<const std::string> names, std::string_view name)
{
    return std::ranges::find(names, name) != names.end();
}

/// The cosine that a stable field is another way to write.
std::optional<GeometryField> cosine_of(GeometryField field)
{
    if (field == GeometryField::sin2_h || field == GeometryField::one_minus_cos_h)
        return GeometryField::cos_h;
    if (field == GeometryField::one_minus_cos_d) return GeometryField::cos_d;
    return std::nullopt;
}

/// Builds a function that takes what a person can write down and calls the given one: the geometry
/// as vectors, or as fields without the stable ones; no argument's complement. Both are computed,
/// unless the table has them.
class Adapter {
public:
    Adapter(const ir::Module& module, ir::FunctionId id, std::span<const std::string> header)
        : callee_(module[id]), id_(id), header_(header), entry_(callee_)
    {
        entry_.graph = {};
        entry_.inputs.clear();
    }

    ir::Function by_vectors()
    {
        bool geometry = false;
        bool tangents = false;
        for (const ir::Input& input : callee_.inputs)
            if (input.origin == Origin::geometry) {
                geometry = true;
                tangents |= ir::needs_tangents(static_cast<GeometryField>(input.which));
            }
        ir::Frame frame;
        if (geometry) {
            frame.l = field(GeometryField::l);
            frame.v = field(GeometryField::v);
            frame.n = field(GeometryField::n);
        }
        if (tangents) {
            frame.x = field(GeometryField::x);
            frame.y = field(GeometryField::y);
        }
        return build([&](GeometryField wanted) { return ir::expand(entry_.graph, wanted, frame); });
    }

    ir::Function by_fields()
    {
        return build([&](GeometryField wanted) {
            const auto cosine = cosine_of(wanted);
            if (!cosine || contains(header_, ir::facts(wanted).name)) return field(wanted);
            return complement(field(*cosine), wanted == GeometryField::sin2_h);
        });
    }

private:
    template <class Geometry>
    ir::Function build(const Geometry& geometry)
    {
        std::vector<ir::ExprId> operands;
        for (const ir::Input& wanted : callee_.inputs) {
            if (wanted.origin == Origin::geometry)
                operands.push_back(geometry(static_cast<GeometryField>(wanted.which)));
            else if (const auto whole = declared(wanted))
                operands.push_back(complement(input(*whole), false));
            else
                operands.push_back(input(wanted));
        }
        entry_.result = entry_.graph.call(id_, callee_.type(), operands, callee_.span);
        return std::move(entry_);
    }

    /// The argument as it was declared, if this one is the complement that a pass put in its place
    /// or beside it.
    std::optional<ir::Input> declared(const ir::Input& wanted) const
    {
        constexpr std::string_view prefix = "one_minus_";
        if (!wanted.complement || contains(header_, wanted.name)) return std::nullopt;
        ir::Input whole = wanted;
        whole.complement = false;
        whole.name = wanted.name.substr(prefix.size());
        whole.range = {1 - wanted.range.high, 1 - wanted.range.low};
        return whole;
    }

    /// 1 - c, or 1 - c^2.
    ir::ExprId complement(ir::ExprId c, bool squared)
    {
        const ir::ExprId one = entry_.graph.literal("1");
        const ir::ExprId difference = entry_.graph.apply(ir::Op::subtract, {one, c});
        if (!squared) return difference;
        const ir::ExprId sum = entry_.graph.apply(ir::Op::add, {one, c});
        return entry_.graph.apply(ir::Op::multiply, {difference, sum});
    }

    ir::ExprId field(GeometryField wanted)
    {
        const ir::FieldFacts& known = ir::facts(wanted);
        const auto quantity =
            known.type == ir::Type::vec3 ? ir::Quantity::direction : ir::Quantity::number;
        return input({std::string{known.name},
                      known.type,
                      quantity,
                      {known.low, known.high},
                      Origin::geometry,
                      static_cast<std::uint32_t>(wanted),
                      {}});
    }

    ir::ExprId input(const ir::Input& wanted)
    {
        for (std::size_t i = 0; i < entry_.inputs.size(); ++i)
            if (entry_.inputs[i].name == wanted.name)
                return entry_.graph.input(static_cast<std::uint32_t>(i), wanted.type);
        entry_.inputs.push_back(wanted);
        return entry_.graph.input(static_cast<std::uint32_t>(entry_.inputs.size() - 1),
                                  wanted.type);
    }

    const ir::Function& callee_;
    ir::FunctionId id_;
    std::span<const std::string> header_;
    ir::Function entry_;
};

bool is_vector_column(std::string_view name)
{
    constexpr std::array<std::string_view, 5> vectors{"l", "v", "n", "x", "y"};
    const std::string_view base = name.substr(0, name.find('.'));
    return base.size() < name.size() && std::ranges::find(vectors, base) != vectors.end();
}

bool has_vectors(std::span<const std::string> header)
{
    return std::ranges::any_of(header, is_vector_column);
}

/// The fields of the geometry that a table could give a function, besides the vectors.
std::vector<std::string> field_names(const ir::Function& function)
{
    std::vector<std::string> names;
    for (const ir::Input& input : function.inputs) {
        if (input.origin != Origin::geometry) continue;
        const auto cosine = cosine_of(static_cast<GeometryField>(input.which));
        std::string name{cosine ? ir::facts(*cosine).name : input.name};
        if (!contains(names, name)) names.push_back(std::move(name));
    }
    return names;
}

/// The value of an input that the table has no column for, if it has one.
std::optional<std::string> default_text(const ir::Module& module, const ir::Input& input,
                                        int component)
{
    if (input.origin == Origin::parameter) {
        // Shortest digits: the decimal that the declaration wrote, not the double it became.
        const auto& values = module.parameters[input.which].default_value;
        const auto index = std::min(static_cast<std::size_t>(component), values.size() - 1);
        return fmt::format("{}", values[index]);
    }
    if (input.origin == Origin::geometry) {
        const auto field = static_cast<GeometryField>(input.which);
        if (field == GeometryField::n) return component == 2 ? "1" : "0";
        if (field == GeometryField::x) return component == 0 ? "1" : "0";
        if (field == GeometryField::y) return component == 1 ? "1" : "0";
    }
    return std::nullopt;
}

/// Two names that differ in case, points and underscores only.
std::string plain(std::string_view name)
{
    std::string letters;
    for (const char c : name)
        if (c != '.' && c != '_' && c != ' ')
            letters += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return letters;
}

std::optional<std::string> meant(const std::string& column, const std::vector<std::string>& open)
{
    for (const std::string& name : open)
        if (plain(name) == plain(column)) return name;
    return nearest(column, open);
}

}  // namespace

Binding bind_columns(const ir::Module& module, ir::FunctionId id,
                     std::span<const std::string> header)
{
    Binding binding;
    for (std::size_t i = 0; i < header.size(); ++i)
        if (contains(header.first(i), header[i])) {
            binding.error = TableError{"two columns have one name", 1, header[i], {}};
            return binding;
        }

    const ir::Function& callee = module[id];
    const auto fields = field_names(callee);
    const bool vectors = has_vectors(header);
    const bool as_fields =
        !vectors && std::ranges::any_of(fields, [&](const auto& f) { return contains(header, f); });
    Adapter adapter{module, id, header};
    const ir::Function entry = as_fields ? adapter.by_fields() : adapter.by_vectors();
    binding.tape = evaluate::compile(module, entry);

    std::vector<bool> used(header.size(), false);
    std::vector<std::string> missing;
    std::vector<std::string> open;  // inputs that no column feeds: what a misspelt one may mean
    for (const evaluate::TapeInput& scalar : binding.tape.inputs) {
        const ir::Input& input = entry.inputs[scalar.input];
        auto column = std::ranges::find(header, scalar.name);
        if (column == header.end()) column = std::ranges::find(header, input.name);
        Feed feed;
        if (column != header.end()) {
            feed.column = static_cast<std::size_t>(column - header.begin());
            used[feed.column] = true;
        } else {
            open.push_back(scalar.name);
            if (const auto text = default_text(module, input, scalar.component))
                feed.text = *text;
            else
                missing.push_back(fmt::format("`{}`", scalar.name));
        }
        binding.feeds.push_back(feed);
    }

    std::vector<std::string> hints;
    for (std::size_t i = 0; i < header.size(); ++i) {
        if (used[i]) continue;
        if (vectors && contains(fields, header[i])) {
            binding.warnings.push_back(fmt::format(
                "column `{}` is passed through: the vectors give the geometry", header[i]));
        } else if (const auto name = meant(header[i], open)) {
            const auto text = fmt::format("column `{}` is not an input of `{}`; did you mean `{}`?",
                                          header[i], callee.name, *name);
            binding.warnings.push_back(text);
            hints.push_back(text);
        }
    }
    if (!missing.empty()) {
        if (!fields.empty() && !as_fields && !vectors)
            hints.push_back(fmt::format("the geometry may also be given by its fields: {}",
                                        fmt::join(fields, ", ")));
        binding.error =
            TableError{fmt::format("`{}` needs {} more column{}: {}", callee.name, missing.size(),
                                   missing.size() == 1 ? "" : "s", fmt::join(missing, ", ")),
                       1, "", std::move(hints)};
    }
    return binding;
}

}  // namespace lobe::analyze
