// The page: templates/report/packing.html, filled.
#include "emit/template.h"
#include "report/markup.h"
#include "report/packing_plot.h"
#include "report/packing_svg.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::report {
namespace {

using emit::Record;

Record text(std::string value, std::string_view style = "")
{
    Record record;
    record.texts["text"] = escaped_xml(value);
    record.texts["class"] = std::string{style};
    return record;
}

Record plain_text(std::string value)
{
    Record record;
    record.texts["text"] = escaped_xml(value);
    return record;
}

std::string_view class_of(Style style)
{
    switch (style) {
    case Style::plain: return "";
    case Style::strong: return "strong";
    case Style::good: return "good";
    case Style::bad: return "bad";
    case Style::faint: return "soft";
    }
    return "";
}

Record table_record(const Table& table)
{
    Record record;
    std::vector<Record>& columns = record.lists["columns"];
    for (const Column& column : table.columns)
        columns.push_back(text(column.title, column.numeric ? "n" : ""));
    std::vector<Record>& rows = record.lists["rows"];
    for (const auto& row : table.rows) {
        std::vector<Record>& cells = rows.emplace_back().lists["cells"];
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const Cell cell = i < row.size() ? row[i] : Cell{};
            cells.push_back(
                text(cell.text, fmt::format("{}{}", table.columns[i].numeric ? "n " : "",
                                            class_of(cell.style))));
        }
    }
    return record;
}

struct Section {
    std::string title;
    std::vector<std::string> remarks;
    std::string text;
    std::string plot;
    std::vector<Table> tables;
};

Record section_record(const Section& section)
{
    Record record;
    record.texts["title"] = escaped_xml(section.title);
    std::vector<Record>& remarks = record.lists["remarks"];
    for (const std::string& remark : section.remarks) remarks.push_back(plain_text(remark));
    std::vector<Record>& texts = record.lists["texts"];
    // The frame ends the last line.
    if (!section.text.empty())
        texts.push_back(
            plain_text(section.text.substr(0, section.text.find_last_not_of('\n') + 1)));
    std::vector<Record>& plots = record.lists["plots"];
    if (!section.plot.empty()) plots.emplace_back().texts["svg"] = section.plot;
    std::vector<Record>& tables = record.lists["tables"];
    for (const Table& table : section.tables) tables.push_back(table_record(table));
    return record;
}

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

std::vector<Section> sections_of(const Packed& packed)
{
    std::vector<Section> out;
    if (is_found(packed)) {
        out.push_back({"Fields", {}, "", "", {field_table(packed)}});
        out.push_back({"Error of radiance",
                       {fmt::format("Relative to the exact radiance, or, where the pixel is darker "
                                    "than that, to a grey card lit alike. Over {} points, then "
                                    "uphill from the worst.",
                                    grouped(packed.errors.points))},
                       "",
                       "",
                       {errors_with_places(packed)}});
    }
    if (packed.suggestion == nullptr) return out;
    const analyze::Suggestion& suggestion = *packed.suggestion;
    if (!suggestion.give_ups.empty())
        out.push_back({suggestion.found ? "To gain more, give up" : "To fit, give up",
                       suggestion.give_ups,
                       "",
                       "",
                       {}});
    if (suggestion.found) out.push_back({"To paste", {}, suggestion.text, "", {}});
    if (!suggestion.trade.empty())
        out.push_back(
            {"Error against bits",
             {"Measured: the best layout of so many bits, as a whole. Predicted: the sum "
              "of its parameters' own errors. Bits of each are in the order of the next table."},
             "",
             plot_svg(trade_plot(packed)),
             {trade_table(suggestion)}});
    if (!suggestion.curves.empty())
        out.push_back(
            {"Each parameter by its bits",
             {"Stored alone, in its best code. A star marks the bits that it got; a dash, "
              "that no code has its default there."},
             "",
             plot_svg(curve_plot(suggestion)),
             {curve_table(suggestion, 0)}});
    return out;
}

Record packing_record(const Packed& packed)
{
    Record record;
    record.texts["title"] = escaped_xml(title_of(packed));
    std::vector<Record> lines, layouts;
    if (is_found(packed)) {
        std::string line =
            fmt::format("Worst radiance error {}", percent(packed.errors.whole.worst));
        if (packed.limit)
            line += fmt::format("; less than {} is asked for", percent(*packed.limit));
        lines.push_back(text(line + ".", packed.met ? "" : "bad"));
        const std::string words = comparison(packed);
        for (std::size_t at = 0; at < words.size(); at = words.find('\n', at) + 1)
            lines.push_back(text(words.substr(at, words.find('\n', at) - at), "soft"));
        SvgBody body = layout_body(packed);
        Record& layout = layouts.emplace_back();
        layout.texts["width"] = fmt::format("{:.0f}", body.width);
        layout.texts["height"] = fmt::format("{:.0f}", body.height);
        layout.texts["title"] = escaped_xml("layout of " + title_of(packed));
        layout.texts["body"] = std::move(body.text);
    } else {
        lines.push_back(text(packed.suggestion->why_not, "bad"));
    }
    record.lists["lines"] = std::move(lines);
    record.lists["layouts"] = std::move(layouts);
    std::vector<Record>& sections = record.lists["sections"];
    for (const Section& section : sections_of(packed)) sections.push_back(section_record(section));
    return record;
}

}  // namespace

std::string to_page(std::span<const Packed> packings)
{
    std::string names;
    std::size_t unmet = 0, lost = 0;
    for (const Packed& packed : packings) {
        names += (names.empty() ? "" : ", ") + title_of(packed);
        unmet += packed.met ? 0 : 1;
        lost += is_found(packed) ? 0 : 1;
    }
    Record page;
    page.texts["title"] = escaped_xml("Packing of " + names);
    page.texts["verdict_class"] = unmet + lost == 0 ? "good" : "bad";
    page.texts["verdict"] = lost > 0    ? "No packing was found that keeps what is asked for."
                            : unmet > 0 ? "A requirement on radiance is not met."
                                        : "Every requirement is met.";
    std::vector<Record>& records = page.lists["packings"];
    for (const Packed& packed : packings) records.push_back(packing_record(packed));
    return emit::render_embedded("report/packing.html", page).text;
}

}  // namespace lobe::report
