// Comma-separated text: what RFC 4180 allows, what spreadsheets write, and what is broken.
#include "analyze/csv.h"

#include <catch2/catch.hpp>

#include <sstream>
#include <vector>

namespace lobe::analyze {
namespace {

using Record = std::vector<std::string>;

std::vector<Record> read(const std::string& text, std::string* error = nullptr)
{
    std::istringstream in{text};
    CsvReader reader{in};
    std::vector<Record> records;
    for (Record cells; reader.next(cells);) records.push_back(cells);
    if (error)
        *error = reader.error();
    else
        CHECK(reader.error().empty());
    return records;
}

}  // namespace

TEST_CASE("records end at LF, at CRLF, and at the end of the text")
{
    const std::vector<Record> expected{{"a", "b"}, {"1", "2"}};
    CHECK(read("a,b\n1,2\n") == expected);
    CHECK(read("a,b\r\n1,2\r\n") == expected);
    CHECK(read("a,b\n1,2") == expected);
}

TEST_CASE("empty cells are cells, empty lines are not records")
{
    CHECK(read("a,,\n\n,b,\r\n\r\n") == std::vector<Record>{{"a", "", ""}, {"", "b", ""}});
    CHECK(read("\"\"\n") == std::vector<Record>{{""}});
    CHECK(read("").empty());
    CHECK(read("\n\n").empty());
}

TEST_CASE("quoted cells hold commas, quotes and line ends")
{
    CHECK(read("\"a,b\",\"say \"\"hi\"\"\",\"two\nlines\"\n") ==
          std::vector<Record>{{"a,b", "say \"hi\"", "two\nlines"}});
}

TEST_CASE("a byte order mark is no part of the first name")
{
    CHECK(read("\xEF\xBB\xBF"
               "a,b\n") == std::vector<Record>{{"a", "b"}});
}

TEST_CASE("lines are counted through quoted line ends")
{
    std::istringstream in{"a\n\"1\n2\n3\"\n\nlast\n"};
    CsvReader reader{in};
    Record cells;
    std::vector<std::size_t> lines;
    while (reader.next(cells)) lines.push_back(reader.line());
    CHECK(lines == std::vector<std::size_t>{1, 2, 6});
}

TEST_CASE("broken quotes are reported where they begin")
{
    std::string error;
    CHECK(read("a\n\"never closed\n", &error).size() == 1);
    CHECK(error == "a quoted cell is never closed");
    read("a\"b\n", &error);
    CHECK(error == "a quote inside a cell that does not begin with one");
    read("\"a\"b\n", &error);
    CHECK(error == "text follows a quoted cell's closing quote");
}

TEST_CASE("what is written reads back")
{
    const Record cells{"plain", "with,comma", "with \"quotes\"", "two\r\nlines", ""};
    std::string record;
    for (const std::string& cell : cells) {
        if (&cell != &cells.front()) record += ',';
        append_cell(record, cell);
    }
    CHECK(read(record + "\n") == std::vector<Record>{cells});
}

}  // namespace lobe::analyze
