// `gbuffer` items to canonical text. A channel about which one thing is said stands on one line.
#include "syntax/format_items.h"
#include "syntax/lex.h"

#include <fmt/format.h>

namespace lobe::syntax {
namespace {

constexpr std::size_t step = LineWriter::step;

std::string labeled(std::string_view word, const Identifier& name)
{
    return fmt::format("{} {}", word, name.text);
}

class GbufferWriter {
public:
    explicit GbufferWriter(LineWriter& writer) : writer_(writer) {}

    void write(const GbufferItem& gbuffer)
    {
        writer_.put(fmt::format("gbuffer {} {{\n", gbuffer.name.text));
        std::vector<Line> lines;
        for (const SettingItem& setting : gbuffer.settings) {
            Cell values = list(": ", setting.values);
            values.push_back({"= " + setting.default_value.text});
            lines.push_back(line_of(
                setting,
                {{{labeled("setting", setting.name)}}, {{quote(setting.label)}}, std::move(values)},
                true));
        }
        writer_.write_lines(lines, step);
        for (const TargetClause& target : gbuffer.targets) write(target);
        lines.clear();
        for (const PinClause& pin : gbuffer.pins) {
            Cell value;
            if (pin.range) value.push_back({"in " + writer_.range(*pin.range)});
            value.push_back({"=", pin.default_value});
            lines.push_back(line_of(
                pin, {{{labeled("pin", pin.name)}}, {{quote(pin.label)}}, std::move(value)}, true));
        }
        writer_.write_lines(lines, step);
        writer_.put("}");
    }

private:
    /// `word name "label" {`
    template <class Clause>
    void open(const Clause& clause, std::string_view word, std::size_t columns)
    {
        writer_.write_comments(clause.comments, columns);
        if (clause.blank_before) writer_.blank_line();
        writer_.indent(columns);
        writer_.write_broken({{{labeled(word, clause.name)}}, {{quote(clause.label) + " {"}}},
                             columns);
        writer_.put("\n");
    }

    template <class Clause>
    void close(const Clause& clause, std::size_t columns)
    {
        writer_.indent(columns);
        writer_.put("}");
        writer_.end_line(clause.trailing);
    }

    void write(const TargetClause& target)
    {
        open(target, "target", step);
        write(target.facts, 2 * step);
        // Channels on one line share columns with their neighbors.
        std::vector<Line> lines;
        for (const ChannelClause& channel : target.channels) {
            if (auto line = one_line(channel)) {
                lines.push_back(*std::move(line));
                continue;
            }
            writer_.write_lines(lines, 2 * step);
            lines.clear();
            open(channel, "channel", 2 * step);
            write(channel.facts, 3 * step);
            close(channel, 2 * step);
        }
        writer_.write_lines(lines, 2 * step);
        close(target, step);
    }

    std::optional<Line> one_line(const ChannelClause& channel) const
    {
        std::vector<Cell> cells{{{labeled("channel", channel.name)}}, {{quote(channel.label)}}};
        if (!channel.facts.empty()) {
            const FactClause& fact = channel.facts.front();
            if (channel.facts.size() > 1 || !fact.comments.empty() || !fact.trailing.empty())
                return std::nullopt;
            Cell inside{{"{"}};
            for (Piece& piece : pieces(fact)) inside.push_back(std::move(piece));
            inside.push_back({"}"});
            cells.push_back(std::move(inside));
            if (2 * step + writer_.width(cells) > ExpressionWriter::widest_line)
                return std::nullopt;
        }
        return line_of(channel, std::move(cells), true);
    }

    void write(const std::vector<FactClause>& facts, std::size_t columns)
    {
        std::vector<Line> lines;
        for (const FactClause& fact : facts) lines.push_back(line_of(fact, {pieces(fact)}, false));
        writer_.write_lines(lines, columns);
    }

    Cell pieces(const FactClause& fact) const
    {
        Cell result;
        const auto texts = [&](std::string word) {
            result.push_back({std::move(word)});
            result.push_back({quote(fact.text)});
        };
        bool branch = false;
        switch (fact.kind) {
        case FactClause::Kind::format:
            result.push_back(
                {fmt::format("format {} {}", fact.storage->kind.text, fact.storage->bits)});
            break;
        case FactClause::Kind::exists:
            result.push_back({"exists"});
            branch = writer_.expressions().parenthesize_before_else(fact.condition);
            break;
        case FactClause::Kind::field: texts("field"); break;
        case FactClause::Kind::holds:
            texts(labeled("holds", fact.name));
            if (fact.lent) result.push_back({"lent"});
            break;
        case FactClause::Kind::also: texts("also"); break;
        case FactClause::Kind::changes: texts("changes"); break;
        }
        if (fact.condition.valid()) result.push_back({"when", fact.condition, branch});
        if (fact.otherwise.valid()) result.push_back({"else", fact.otherwise});
        return result;
    }

    LineWriter& writer_;
};

}  // namespace

void write_gbuffer(LineWriter& writer, const GbufferItem& gbuffer)
{
    GbufferWriter{writer}.write(gbuffer);
}

}  // namespace lobe::syntax
