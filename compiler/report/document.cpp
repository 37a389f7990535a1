#include "report/document.h"

#include "emit/template.h"
#include "report/markup.h"

#include <fmt/format.h>

#include <cassert>

namespace lobe::report {
namespace {

using emit::Record;

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

Record text(std::string_view value)
{
    Record record;
    record.texts["text"] = escaped_xml(value);
    return record;
}

Record styled_text(std::string_view value, std::string style)
{
    Record record = text(value);
    record.texts["class"] = std::move(style);
    return record;
}

Record table_record(const Table& table)
{
    Record record;
    std::vector<Record>& columns = record.lists["columns"];
    for (const Column& column : table.columns)
        columns.push_back(styled_text(column.title, column.numeric ? "n" : ""));
    std::vector<Record>& rows = record.lists["rows"];
    for (const auto& row : table.rows) {
        std::vector<Record>& cells = rows.emplace_back().lists["cells"];
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const Cell cell = i < row.size() ? row[i] : Cell{};
            cells.push_back(
                styled_text(cell.text, fmt::format("{}{}", table.columns[i].numeric ? "n " : "",
                                                   class_of(cell.style))));
        }
    }
    return record;
}

Record section_record(const Section& section)
{
    assert(section.level == 2 || section.level == 3);
    Record record;
    record.texts["title"] = escaped_xml(section.title);
    record.texts["level"] = std::to_string(section.level);
    std::vector<Record>& paragraphs = record.lists["paragraphs"];
    for (const Paragraph& paragraph : section.paragraphs)
        paragraphs.push_back(styled_text(paragraph.text, std::string{class_of(paragraph.style)}));
    std::vector<Record>& pictures = record.lists["pictures"];
    for (const std::string& picture : section.pictures)
        pictures.emplace_back().texts["svg"] = picture;
    std::vector<Record>& texts = record.lists["texts"];
    // The frame ends the last line.
    if (!section.text.empty())
        texts.push_back(text(section.text.substr(0, section.text.find_last_not_of('\n') + 1)));
    std::vector<Record>& tables = record.lists["tables"];
    for (const Table& table : section.tables) tables.push_back(table_record(table));
    std::vector<Record>& commands = record.lists["commands"];
    if (!section.command.empty()) commands.push_back(text(section.command));
    return record;
}

}  // namespace

std::string to_page(const Document& document)
{
    Record page;
    page.texts["title"] = escaped_xml(document.title);
    page.texts["verdict_class"] = class_of(document.verdict.style);
    page.texts["verdict"] = escaped_xml(document.verdict.text);
    std::vector<Record>& sections = page.lists["sections"];
    for (const Section& section : document.sections) sections.push_back(section_record(section));
    return emit::render_embedded("report/document.html", page).text;
}

}  // namespace lobe::report
