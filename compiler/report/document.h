// A page that needs no other file: headings, words, pictures and tables in one frame
// (templates/report/document.html), light and dark.
//
// Who has results says what to show as sections; how a page looks is decided here, once.
#pragma once

#include "report/table.h"

#include <string>
#include <vector>

namespace lobe::report {

/// A sentence or two. Plain text.
struct Paragraph {
    std::string text;
    Style style = Style::plain;
};

/// In this order on the page, whatever is empty left out.
struct Section {
    int level = 2;  ///< of its heading: 2 or 3
    std::string title;
    std::vector<Paragraph> paragraphs;
    std::vector<std::string> pictures;  ///< complete `<svg …>` elements
    std::string text;                   ///< shown as it is, in a box
    std::vector<Table> tables;
    std::string command;  ///< what prints these numbers again
};

struct Document {
    std::string title;
    Paragraph verdict;
    std::vector<Section> sections;
};

std::string to_page(const Document& document);

}  // namespace lobe::report
