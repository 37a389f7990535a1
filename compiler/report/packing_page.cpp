// What the page of `lobec pack` shows; how it looks is document.h's.
#include "report/document.h"
#include "report/markup.h"
#include "report/packing_plot.h"
#include "report/packing_svg.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

/// The error table with where each worst error is reached.
Table errors_with_places(const Packed& packed)
{
    Table table = error_table(packed);
    table.columns.push_back({"where the worst is"});
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const analyze::RadianceError& error = i < packed.errors.parameters.size()
                                                  ? packed.errors.parameters[i].error
                                                  : packed.errors.whole;
        if (error.worst > 0)
            table.rows[i].push_back({in_words(packed, error.witness), Style::faint});
    }
    return table;
}

bool is_found(const Packed& packed)
{
    return packed.suggestion == nullptr || packed.suggestion->found;
}

Section titled(std::string title, std::vector<Paragraph> paragraphs = {})
{
    return {.level = 3,
            .title = std::move(title),
            .paragraphs = std::move(paragraphs),
            .pictures = {},
            .text = {},
            .tables = {},
            .command = {}};
}

Paragraph soft(std::string text) { return {std::move(text), Style::faint}; }

/// What was found in short, over the picture of the layout.
Section head_of(const Packed& packed)
{
    Section out = titled(title_of(packed));
    out.level = 2;
    if (!is_found(packed)) {
        out.paragraphs.push_back({packed.suggestion->why_not, Style::bad});
        return out;
    }
    std::string line = fmt::format("Worst radiance error {}", percent(packed.errors.whole.worst));
    if (packed.limit) line += fmt::format("; less than {} is asked for", percent(*packed.limit));
    out.paragraphs.push_back({line + ".", packed.met ? Style::plain : Style::bad});
    const std::string words = comparison(packed);
    for (std::size_t at = 0; at < words.size(); at = words.find('\n', at) + 1)
        out.paragraphs.push_back(soft(words.substr(at, words.find('\n', at) - at)));
    const SvgBody body = layout_body(packed);
    out.pictures.push_back(fmt::format("<svg class=\"layout\" viewBox=\"0 0 {:.0f} {:.0f}\" "
                                       "role=\"img\" aria-label=\"layout of {}\">\n{}\n</svg>",
                                       body.width, body.height, escaped_xml(title_of(packed)),
                                       body.text));
    return out;
}

std::vector<Section> sections_of(const Packed& packed)
{
    std::vector<Section> out{head_of(packed)};
    const auto add = [&out](std::string title, std::vector<Paragraph> paragraphs = {}) -> Section& {
        return out.emplace_back(titled(std::move(title), std::move(paragraphs)));
    };
    if (is_found(packed)) {
        add("Fields").tables = {field_table(packed)};
        add("Error of radiance",
            {soft(fmt::format("Relative to the exact radiance, or, where the pixel is darker than "
                              "that, to a grey card lit alike. Over {} points, then uphill from "
                              "the worst.",
                              grouped(packed.errors.points)))})
            .tables = {errors_with_places(packed)};
    }
    if (packed.suggestion == nullptr) return out;
    const analyze::Suggestion& suggestion = *packed.suggestion;
    if (!suggestion.give_ups.empty()) {
        Section& section = add(suggestion.found ? "To gain more, give up" : "To fit, give up");
        for (const std::string& give_up : suggestion.give_ups)
            section.paragraphs.push_back(soft(give_up));
    }
    if (suggestion.found) add("To paste").text = suggestion.text;
    if (!suggestion.trade.empty()) {
        Section& section =
            add("Error against bits",
                {soft("Measured: the best layout of so many bits, as a whole. Predicted: the sum "
                      "of its parameters' own errors. Bits of each are in the order of the next "
                      "table.")});
        section.pictures = {plot_svg(trade_plot(packed))};
        section.tables = {trade_table(suggestion)};
    }
    if (!suggestion.curves.empty()) {
        Section& section =
            add("Each parameter by its bits",
                {soft("Stored alone, in its best code. A star marks the bits that it got; a dash, "
                      "that no code has its default there.")});
        section.pictures = {plot_svg(curve_plot(suggestion))};
        section.tables = {curve_table(suggestion, 0)};
    }
    return out;
}

}  // namespace

std::string to_page(std::span<const Packed> packings)
{
    Document document;
    std::size_t unmet = 0, lost = 0;
    for (const Packed& packed : packings) {
        document.title += (document.title.empty() ? "Packing of " : ", ") + title_of(packed);
        unmet += packed.met ? 0 : 1;
        lost += is_found(packed) ? 0 : 1;
        for (Section& section : sections_of(packed))
            document.sections.push_back(std::move(section));
    }
    document.verdict = {lost > 0    ? "No packing was found that keeps what is asked for."
                        : unmet > 0 ? "A requirement on radiance is not met."
                                    : "Every requirement is met.",
                        unmet + lost == 0 ? Style::good : Style::bad};
    return to_page(document);
}

}  // namespace lobe::report
