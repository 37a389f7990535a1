#include "check/engines.h"

#include "check/constants.h"
#include "check/types.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

using syntax::EngineClause;
using Kind = syntax::EngineClause::Kind;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Reading {
public:
    Reading(Program& program, Subject subject, const std::vector<ReadPacking>& packings,
            Diagnostics& diagnostics)
        : program_(program), subject_(std::move(subject)), gbuffer_(*subject_.gbuffer),
          diagnostics_(diagnostics)
    {
        for (const ReadPacking& read : packings) {
            if (read.packing.model.name != subject_.model_name() ||
                read.packing.gbuffer != gbuffer_.name)
                continue;
            packing_ = &read.packing;
            failed_ = &read.failed;
        }
    }

    ir::Engine read(const syntax::EngineItem& node, bool packing_expected)
    {
        result_.gbuffer = gbuffer_.name;
        result_.model = subject_.model_name();
        result_.module = program_.files[subject_.file]->name;
        result_.span = node.model.span;
        if (packing_ == nullptr && !packing_expected)
            refuse(fmt::format("no packing stores `{}` on `{}`", result_.model, result_.gbuffer),
                   node.model.span, "what the editor feeds has no place",
                   {fmt::format("declare one: `packing {} on {} {{ … }}`", result_.model,
                                result_.gbuffer)});
        for (const EngineClause& line : node.lines) {
            switch (line.kind) {
            case Kind::shading_model: add_shading_model(line); break;
            case Kind::pin: add_pin(line); break;
            case Kind::node: add_node(line); break;
            case Kind::color: add_color(line); break;
            }
        }
        if (result_.shading_model.empty() && !has_shading_model_)
            refuse("this engine block names no shading model", node.model.span, "",
                   {"say what the editor calls it: `shading_model \"…\"`; files and identifiers "
                    "are named after it"});
        warn_unfed();
        return std::move(result_);
    }

private:
    void refuse(std::string message, const Span& span, std::string label = {},
                std::vector<std::string> helps = {})
    {
        diagnostics_.report({.code = Code::engine_block,
                             .message = std::move(message),
                             .primary = {span, std::move(label)},
                             .helps = std::move(helps)});
    }

    void refuse_twice(std::string message, const Span& span, const Span& first)
    {
        diagnostics_.report({.code = Code::engine_block,
                             .message = std::move(message),
                             .primary = {span, "said again"},
                             .secondary = {{first, "first said here"}}});
    }

    // ---- names that the engine will know

    void add_shading_model(const EngineClause& line)
    {
        if (!line.text) return;  // a syntax error was reported
        if (has_shading_model_) {
            refuse_twice("two names for the shading model", line.span, result_.shading_model_span);
            return;
        }
        has_shading_model_ = true;
        result_.shading_model = *line.text;
        result_.shading_model_span = line.span;
        const bool named = !line.text->empty() && is_letter(line.text->front()) &&
                           line.text->back() != ' ' && std::ranges::all_of(*line.text, [](char c) {
                               return is_letter(c) || is_digit(c) || c == ' ';
                           });
        if (!named)
            refuse("a shading model is named by letters, digits and spaces between them", line.span,
                   "", {"identifiers of shaders and C++ are made of it: start with a letter"});
    }

    void add_node(const EngineClause& line)
    {
        if (!line.text) return;  // a syntax error was reported
        if (result_.node) {
            refuse_twice("two nodes for one model", line.span, result_.node->span);
            return;
        }
        ir::Engine::Node node{*line.text, {}, line.span};
        const bool named =
            !node.name.empty() && is_letter(node.name.front()) &&
            std::ranges::all_of(node.name, [](char c) { return is_letter(c) || is_digit(c); });
        if (!named)
            refuse("a node is named by letters and digits", line.span, "",
                   {"classes and files of C++ are named after it: `CallistoAdvancedParams`"});
        for (const syntax::Identifier& name : line.names)
            if (const auto parameter = feed(name)) node.parameters.push_back(*parameter);
        result_.node = std::move(node);
    }

    void add_color(const EngineClause& line)
    {
        if (result_.color) {
            refuse("two colors for one model", line.span, "said again");
            return;
        }
        const syntax::Tree& tree = program_.files[subject_.file]->tree;
        std::vector<double> color;
        for (const syntax::ExpressionId id : line.color) {
            const auto value = constant_value(tree, id, diagnostics_);
            if (value && (*value < 0 || *value > 1))
                refuse("a color of the editor is in [0, 1]", tree[id].span,
                       fmt::format("this is {}", describe(*value)));
            color.push_back(value.value_or(0));
        }
        if (color.size() == 3) result_.color = std::move(color);
    }

    // ---- what is fed

    void add_pin(const EngineClause& line)
    {
        const auto pin = find_pin(line);
        if (!pin) {
            meant_.insert(line.parameter.text);
            return;
        }
        const auto parameter = feed(line.parameter);
        if (!parameter) return;
        const ir::Parameter& fed = program_.parameters[*parameter];
        if (ir::components(fed.type) > 1) {
            diagnostics_.report(
                {.code = Code::engine_block,
                 .message = fmt::format(
                     "the pin `{}` is one number, and `{}` is {}", line.name.text, fed.name,
                     describe(ValueType{fed.quantity, fed.type, Structure::none})),
                 .primary = {line.parameter.span, ""},
                 .secondary = {{fed.span, "declared here"}},
                 .helps = {"feed it by the node, whose inputs have any size"}});
            return;
        }
        check_clamp(line, gbuffer_.pins[*pin], *parameter);
        result_.pins.push_back({*pin, *parameter, line.text.value_or(fed.label), line.span});
    }

    std::optional<std::size_t> find_pin(const EngineClause& line)
    {
        const syntax::Identifier& name = line.name;
        if (name.text.empty()) return std::nullopt;  // a syntax error was reported
        const auto pin = gbuffer_.find_pin(name.text);
        if (!pin) {
            std::vector<std::string> known;
            for (const ir::Pin& other : gbuffer_.pins) known.push_back(other.name);
            Diagnostic diagnostic{.code = Code::engine_block,
                                  .message = fmt::format("`{}` has no pin `{}`{}", gbuffer_.name,
                                                         name.text, did_you_mean(name.text, known)),
                                  .primary = {name.span, ""},
                                  .fix = rename_fix(name.text, name.span, known)};
            if (!diagnostic.fix)
                diagnostic.notes = {known.empty()
                                        ? "it has no pins"
                                        : fmt::format("its pins are {}", fmt::join(known, ", "))};
            diagnostics_.report(std::move(diagnostic));
            return std::nullopt;
        }
        const auto [found, added] = pins_.try_emplace(name.text, name.span);
        if (added) return pin;
        refuse_twice(fmt::format("the pin `{}` feeds two parameters", name.text), name.span,
                     found->second);
        return std::nullopt;
    }

    /// The parameter that a pin or an input of the node feeds.
    std::optional<std::uint32_t> feed(const syntax::Identifier& name)
    {
        const auto parameter =
            find_parameter(program_, subject_, name, Code::engine_block, diagnostics_);
        if (!parameter) return std::nullopt;
        const auto [found, added] = fed_.try_emplace(*parameter, name.span);
        if (!added) {
            refuse_twice(fmt::format("`{}` is fed twice", name.text), name.span, found->second);
            return std::nullopt;
        }
        if (packing_ != nullptr && field_of(*parameter) == nullptr && !failed_->contains(name.text))
            diagnostics_.report(
                {.code = Code::engine_block,
                 .message = fmt::format("`{}` is fed, and no field stores it", name.text),
                 .primary = {name.span, "it is lost before any light is computed"},
                 .secondary = {{packing_->span, "the packing"}},
                 .helps = {
                     "give it a field, or do not feed it: then it is its default, everywhere"}});
        return parameter;
    }

    const ir::Field* field_of(std::uint32_t parameter) const
    {
        const auto found = std::ranges::find(packing_->fields, parameter, &ir::Field::parameter);
        return found == packing_->fields.end() ? nullptr : &*found;
    }

    /// A pin that clamps must leave what is carried.
    void check_clamp(const EngineClause& line, const ir::Pin& pin, std::uint32_t index)
    {
        if (!pin.range) return;
        const ir::Parameter& parameter = program_.parameters[index];
        const ir::Field* field = packing_ == nullptr ? nullptr : field_of(index);
        const ir::Range carried = field == nullptr ? parameter.range : field->range;
        const bool above = carried.high > pin.range->high;
        if (!above && carried.low >= pin.range->low) return;
        const double lost = above ? carried.high : carried.low;
        const double arrives = above ? pin.range->high : pin.range->low;
        diagnostics_.report(
            {.code = Code::range_clamped,
             .message = fmt::format("the pin `{}` does not let all of `{}` pass", pin.name,
                                    parameter.name),
             .primary = {line.span, fmt::format("{} = {} arrives as {}", parameter.name,
                                                describe(lost), describe(arrives))},
             .secondary = {{pin.span, fmt::format("it clamps to {}", describe(*pin.range))},
                           {field == nullptr ? parameter.span : field->span,
                            fmt::format("{} is carried", describe(carried))}},
             .helps = clamp_helps(carried)});
    }

    std::vector<std::string> clamp_helps(const ir::Range& carried) const
    {
        std::vector<std::string> wide;
        for (const ir::Pin& pin : gbuffer_.pins)
            if (!pin.range || (pin.range->low <= carried.low && pin.range->high >= carried.high))
                wide.push_back(fmt::format("`{}`", pin.name));
        std::vector<std::string> helps;
        if (!wide.empty())
            helps.push_back(
                fmt::format("feed it by a pin that lets it pass: {}", fmt::join(wide, ", ")));
        helps.push_back(wide.empty() ? "feed it by the node, which clamps nothing"
                                     : "or by the node, which clamps nothing");
        return helps;
    }

    void warn_unfed()
    {
        if (packing_ == nullptr) return;
        std::vector<std::uint32_t> seen;
        for (const ir::Field& field : packing_->fields) {
            if (fed_.contains(field.parameter) ||
                std::ranges::find(seen, field.parameter) != seen.end())
                continue;
            seen.push_back(field.parameter);
            const ir::Parameter& parameter = program_.parameters[field.parameter];
            if (meant_.contains(parameter.name)) continue;
            diagnostics_.report({.code = Code::unfed_parameter,
                                 .message = fmt::format(
                                     "`{}` is packed, but no pin or node feeds it", parameter.name),
                                 .primary = {field.span, ""},
                                 .secondary = {{result_.span, "the engine block"}},
                                 .notes = {"it is stored, and is its default everywhere"},
                                 .helps = {"feed it, or leave its bits to others"}});
        }
    }

    Program& program_;
    Subject subject_;
    const ir::Gbuffer& gbuffer_;
    Diagnostics& diagnostics_;
    const ir::Packing* packing_ = nullptr;
    const std::set<std::string>* failed_ = nullptr;  ///< parameters whose fields made no sense
    ir::Engine result_;
    bool has_shading_model_ = false;
    std::map<std::string, Span> pins_;
    std::map<std::uint32_t, Span> fed_;  ///< by parameter
    std::set<std::string> meant_;        ///< parameters of pins that were reported
};

}  // namespace

std::optional<ir::Engine> read_engine(Program& program, const syntax::EngineItem& node,
                                      const std::vector<ReadPacking>& packings,
                                      Diagnostics& diagnostics)
{
    const std::size_t root = program.files.size() - 1;
    auto subject = find_subject(program, root, node.model, node.gbuffer, diagnostics);
    if (!subject) return std::nullopt;
    // A packing whose subject is not known was reported, and may be the one that is meant.
    const bool expected =
        std::ranges::any_of(program.root().tree.items, [&](const syntax::Item& item) {
            const auto* packing = std::get_if<syntax::PackingItem>(&item.node);
            return packing && packing->model.text == node.model.text &&
                   packing->gbuffer.text == node.gbuffer.text;
        });
    return Reading{program, std::move(*subject), packings, diagnostics}.read(node, expected);
}

}  // namespace lobe::check
