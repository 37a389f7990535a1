#include "syntax/random_tree.h"

#include <array>
#include <string>
#include <string_view>

namespace lobe::tests {
namespace {

using namespace lobe::syntax;

class Grower {
public:
    Grower(std::mt19937& random, int depth) : random_(random), depth_(depth) {}

    Tree grow()
    {
        tree_.header = comments(true);
        tree_.module = name();
        for (int i = below(3); i > 0; --i) add(Import{name(), names()});
        const int size = 1 + below(6);
        for (int i = 0; i < size; ++i) add_any();
        tree_.footer = comments(false);
        return std::move(tree_);
    }

private:
    int below(int bound) { return std::uniform_int_distribution<int>{0, bound - 1}(random_); }
    bool chance(int in) { return below(in) == 0; }

    template <std::size_t size>
    std::string pick(const std::array<std::string_view, size>& from)
    {
        return std::string{from[static_cast<std::size_t>(below(static_cast<int>(size)))]};
    }

    Identifier name()
    {
        static constexpr std::array<std::string_view, 26> words{
            "a",
            "b",
            "cos_d",
            "D_GGX",
            "term",
            "form",
            "in",
            "off",
            "when",
            "param",
            "source",
            "tier",
            "code",
            "on",
            "for",
            "lent",
            "exists",
            "channel",
            "gbuffer",
            "require",
            "color",
            "pi",
            "m",
            "base",
            "quite_a_long_name_that_fills",
            "a_name_that_is_so_long_that_lines_break_before_and_behind_it_wherever_they_can"};
        return {pick(words), {}};
    }

    std::vector<Identifier> names()
    {
        std::vector<Identifier> result{name()};
        for (int i = below(12); i > 0; --i) result.push_back(name());
        return result;
    }

    std::string text()
    {
        static constexpr std::array<std::string_view, 5> texts{
            "", "Diffuse Fresnel", "a \"b\" \\ c", "\u00E4 \u4E2D", "// no comment"};
        return pick(texts);
    }

    std::vector<Comment> comments(bool docs)
    {
        static constexpr std::array<std::string_view, 5> texts{"", "slides 85", "  indented",
                                                               "/ slash", "---- caf\u00E9"};
        std::vector<Comment> result;
        for (int i = chance(2) ? below(4) : 0; i > 0; --i)
            result.push_back({pick(texts), {}, docs && chance(2), chance(3)});
        return result;
    }

    std::vector<Comment> trailing()
    {
        if (!chance(4)) return {};
        return {Comment{"behind", {}, false, false}};
    }

    template <class Node>
    ExpressionId make(Node node)
    {
        tree_.expressions.push_back({{}, std::move(node), chance(4)});
        return ExpressionId{tree_.expressions.size() - 1};
    }

    ExpressionId expression(int depth)
    {
        static constexpr std::array<std::string_view, 6> numbers{"0",    "1",       "0.75",
                                                                 "1e-3", "5.55473", "4096"};
        if (depth <= 0 || chance(6))
            return chance(2) ? make(Number{pick(numbers)}) : make(Name{name().text});
        const int next = depth - 1;
        switch (below(9)) {
        case 0: return make(Member{expression(next), name()});
        case 1:
            return make(Unary{chance(3) ? UnaryOperator::logical_not : UnaryOperator::negate,
                              expression(next)});
        case 2: {
            Call call{name(), {}};
            for (int i = below(4); i > 0; --i) call.arguments.push_back(expression(next));
            return make(std::move(call));
        }
        case 3: {
            const ExpressionId condition = expression(next);
            const ExpressionId then_value = expression(next);
            return make(Conditional{condition, then_value, expression(next)});
        }
        case 4: {
            const ExpressionId first = expression(next);
            const ExpressionId last = expression(next);
            return make(Sum{name(), first, last, sum_body(next)});
        }
        default: {
            const auto op = static_cast<BinaryOperator>(below(13));
            const ExpressionId left = expression(next);
            const ExpressionId right = expression(next);
            const bool limited = op == BinaryOperator::divide && chance(2);
            return make(Binary{op, left, right, limited ? expression(next) : ExpressionId{}, {}});
        }
        }
    }
    ExpressionId expression() { return expression(1 + below(depth_)); }

    Body sum_body(int depth)
    {
        Body result;
        result.block = true;
        for (int i = chance(2) ? below(3) : 0; i > 0; --i) {
            const ExpressionId value = expression(depth);
            result.lets.push_back({name(), value, comments(true), {}, chance(3), trailing()});
        }
        result.value_comments = comments(false);
        result.value_blank_before = chance(3);
        result.value = expression(depth);
        return result;
    }

    TypeClause type()
    {
        TypeClause result{name(), std::nullopt, {}};
        if (chance(2)) {
            const ExpressionId low = expression(2);
            result.range = RangeClause{low, expression(2), {}};
        }
        return result;
    }

    std::vector<ParameterClause> parameters()
    {
        std::vector<ParameterClause> result;
        for (int i = below(4); i > 0; --i) result.push_back({name(), type()});
        return result;
    }

    Let let() { return {name(), expression(), comments(true), {}, chance(3), trailing()}; }

    std::vector<Let> lets()
    {
        std::vector<Let> result;
        for (int i = below(3); i > 0; --i) result.push_back(let());
        return result;
    }

    Body body()
    {
        Body result;
        result.block = chance(2);
        if (result.block) {
            result.lets = lets();
            result.value_comments = comments(false);
            result.value_blank_before = chance(3);
        }
        result.value = expression();
        result.trailing = trailing();
        return result;
    }

    // ---- blocks of lines

    /// What stands around a line; docs only where they document.
    template <class Line>
    Line surrounded(Line line, bool docs)
    {
        line.comments = comments(docs);
        line.blank_before = chance(4);
        line.trailing = trailing();
        return line;
    }

    RangeClause range()
    {
        const ExpressionId low = expression(2);
        return {low, expression(2), {}};
    }
    StorageClause storage() { return {name(), below(64), {}}; }

    FactClause fact()
    {
        FactClause result;
        result.kind = static_cast<FactClause::Kind>(below(6));
        if (result.kind == FactClause::Kind::format)
            result.storage = storage();
        else if (result.kind != FactClause::Kind::exists)
            result.text = text();
        if (result.kind == FactClause::Kind::holds) {
            result.name = name();
            result.lent = chance(2);
        }
        const bool exists = result.kind == FactClause::Kind::exists;
        if (exists || (result.kind != FactClause::Kind::field && chance(2)))
            result.condition = expression();
        if (exists && chance(2)) result.otherwise = expression();
        return surrounded(std::move(result), false);
    }
    std::vector<FactClause> facts()
    {
        std::vector<FactClause> result;
        for (int i = below(4); i > 0; --i) result.push_back(fact());
        return result;
    }

    GbufferItem gbuffer()
    {
        GbufferItem result;
        result.name = name();
        for (int i = below(3); i > 0; --i) {
            SettingItem setting;
            setting.name = name();
            setting.label = text();
            setting.values = names();
            setting.default_value = name();
            result.settings.push_back(surrounded(std::move(setting), true));
        }
        for (int i = below(3); i > 0; --i) {
            TargetClause target;
            target.name = name();
            target.label = text();
            target.facts = facts();
            for (int j = below(4); j > 0; --j) {
                ChannelClause channel;
                channel.name = name();
                channel.label = text();
                channel.facts = facts();
                target.channels.push_back(surrounded(std::move(channel), true));
            }
            result.targets.push_back(surrounded(std::move(target), true));
        }
        for (int i = below(3); i > 0; --i) {
            PinClause pin;
            pin.name = name();
            pin.label = text();
            if (chance(2)) pin.range = range();
            pin.default_value = expression();
            result.pins.push_back(surrounded(std::move(pin), true));
        }
        return result;
    }

    CodeItem code()
    {
        CodeItem result;
        result.name = name();
        result.value = {name(), type()};
        result.encode = expression();
        result.stored = name();
        result.decode = expression();
        result.encode_comments = comments(false);
        result.encode_trailing = trailing();
        result.decode_comments = comments(false);
        result.decode_trailing = trailing();
        return result;
    }

    FieldClause field()
    {
        FieldClause result;
        for (int i = 1 + below(3); i > 0; --i) {
            SlotClause slot{name(), name(), std::nullopt, std::nullopt, {}};
            if (chance(2)) {
                slot.low = below(64);
                slot.high = *slot.low + below(64 - *slot.low);
            }
            result.slots.push_back(std::move(slot));
        }
        result.parameter = name();
        if (chance(3)) result.component = name();
        result.storage = storage();
        if (chance(2)) result.range = range();
        if (chance(2)) {
            CodeClause clause{name(), {}, {}};
            for (int i = below(3); i > 0; --i) clause.arguments.push_back(expression(2));
            result.code = std::move(clause);
        }
        return surrounded(std::move(result), true);
    }

    PackingClause clause()
    {
        PackingClause result;
        result.kind = static_cast<PackingClause::Kind>(below(5));
        switch (result.kind) {
        case PackingClause::Kind::exact:
            for (int i = 1 + below(4); i > 0; --i) result.exact.push_back({name(), expression(3)});
            break;
        case PackingClause::Kind::radiance: result.limit = make(Number{"2.5"}); break;
        case PackingClause::Kind::supports:
            result.name = name();
            result.names = names();
            break;
        case PackingClause::Kind::over:
            result.name = name();
            result.range = range();
            break;
        case PackingClause::Kind::without: result.names = names(); break;
        }
        return surrounded(std::move(result), false);
    }

    PackingItem packing()
    {
        PackingItem result{name(), name(), {}};
        for (int i = below(6); i > 0; --i) {
            if (chance(2))
                result.lines.emplace_back(field());
            else
                result.lines.emplace_back(clause());
        }
        return result;
    }

    EngineItem engine()
    {
        EngineItem result{name(), name(), {}};
        for (int i = below(6); i > 0; --i) {
            EngineClause line;
            line.kind = static_cast<EngineClause::Kind>(below(4));
            switch (line.kind) {
            case EngineClause::Kind::shading_model: line.text = text(); break;
            case EngineClause::Kind::pin:
                line.name = name();
                line.parameter = name();
                if (chance(2)) line.text = text();
                break;
            case EngineClause::Kind::node:
                line.text = text();
                line.names = names();
                break;
            case EngineClause::Kind::color:
                for (int j = 0; j < 3; ++j) line.color.push_back(expression(2));
                break;
            }
            result.lines.push_back(surrounded(std::move(line), false));
        }
        return result;
    }

    template <class Node>
    void add(Node node)
    {
        Item item;
        item.comments = comments(true);
        item.blank_lines_before = below(2);
        item.node = std::move(node);
        if (!std::holds_alternative<TermItem>(item.node)) item.trailing = trailing();
        tree_.items.push_back(std::move(item));
    }

    void add_any()
    {
        switch (below(10)) {
        case 6: return add(gbuffer());
        case 7: return add(code());
        case 8: return add(packing());
        case 9: return add(engine());
        case 0: return add(SourceItem{name(), text()});
        case 1: return add(TierItem{names()});
        case 2: {
            ParamItem param;
            param.name = name();
            param.type = type();
            const int components = chance(3) ? 3 : 1;
            for (int i = 0; i < components; ++i) param.default_value.push_back(expression(2));
            if (chance(2)) param.tier = name();
            if (chance(2)) param.label = text();
            return add(std::move(param));
        }
        case 3: {
            TermItem term;
            term.name = name();
            term.parameters = parameters();
            if (chance(2)) term.result = type();
            term.body = body();
            for (int i = below(3); i > 0; --i)
                term.forms.push_back({name(), body(), comments(true), {}});
            return add(std::move(term));
        }
        case 4: return add(EffectItem{text(), {}, expression()});
        default: {
            ModelItem model;
            model.is_light = chance(2);
            model.name = name();
            model.parameters = parameters();
            model.lets = lets();
            for (int i = below(4); i > 0; --i)
                model.outputs.push_back(
                    {name(), expression(), comments(true), {}, chance(3), trailing()});
            return add(std::move(model));
        }
        }
    }

    std::mt19937& random_;
    int depth_;
    Tree tree_;
};

}  // namespace

Tree random_tree(std::mt19937& random, int depth) { return Grower{random, depth}.grow(); }

}  // namespace lobe::tests
