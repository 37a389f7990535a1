#include "analyze/table.h"

#include "analyze/cells.h"
#include "analyze/columns.h"
#include "analyze/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <istream>
#include <ostream>

namespace lobe::analyze {
namespace {

/// Rows that travel together: enough to fill the tape's blocks, few enough to stay in cache.
constexpr std::size_t block_rows = 1024;

/// One pass over a table in numbers of one type.
template <class Number>
class Pass {
public:
    Pass(const Binding& binding, const NumberKind& number, CsvReader& in, std::ostream& out)
        : binding_(binding), number_(number), in_(in), out_(out)
    {
    }

    TableOutcome run(std::size_t columns)
    {
        columns_ = columns;
        const std::size_t outputs = binding_.tape.outputs.size();
        inputs_.assign(binding_.feeds.size(), std::vector<Number>(block_rows));
        results_.assign(outputs, std::vector<Number>(block_rows));
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            if (const std::string& text = binding_.feeds[i].text; !text.empty())
                for (Number& value : inputs_[i]) read_cell(text, number_, value);

        std::vector<std::string> cells;
        while (!outcome_.error && in_.next(cells)) {
            if (!read_row(cells)) break;
            if (++filled_ == block_rows) flush();
        }
        if (!in_.error().empty()) outcome_.error = TableError{in_.error(), in_.line(), "", {}};
        if (!outcome_.error) flush();
        return std::move(outcome_);
    }

    void name_columns(const std::vector<std::string>& header) { header_ = &header; }

private:
    bool read_row(const std::vector<std::string>& cells)
    {
        if (cells.size() != columns_) {
            outcome_.error =
                TableError{fmt::format("{} cells, where the header has {}", cells.size(), columns_),
                           in_.line(),
                           "",
                           {}};
            return false;
        }
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const Feed& feed = binding_.feeds[i];
            if (!feed.text.empty()) continue;
            const std::string& cell = cells[feed.column];
            if (read_cell(cell, number_, inputs_[i][filled_])) continue;
            outcome_.error = TableError{cell.empty() ? "an empty cell, where a number is needed"
                                                     : fmt::format("`{}` is not a number", cell),
                                        in_.line(),
                                        (*header_)[feed.column],
                                        {}};
            return false;
        }
        std::string record;
        for (const std::string& cell : cells) {
            if (!record.empty() || &cell != &cells.front()) record += ',';
            append_cell(record, cell);
        }
        records_.push_back(std::move(record));
        return true;
    }

    void flush()
    {
        if (filled_ == 0) return;
        std::vector<const Number*> inputs;
        for (const auto& column : inputs_) inputs.push_back(column.data());
        std::vector<Number*> outputs;
        for (auto& column : results_) outputs.push_back(column.data());
        run_cells(binding_.tape, number_, evaluate::Columns<Number>{inputs},
                  evaluate::Results<Number>{outputs}, filled_);
        for (std::size_t row = 0; row < filled_; ++row) {
            for (const auto& column : results_) write_cells(records_[row], column[row]);
            out_ << records_[row] << '\n';
        }
        outcome_.rows += filled_;
        records_.clear();
        filled_ = 0;
        if (!out_) outcome_.error = TableError{"the result cannot be written", 0, "", {}};
    }

    const Binding& binding_;
    const NumberKind& number_;
    CsvReader& in_;
    std::ostream& out_;
    const std::vector<std::string>* header_ = nullptr;
    std::size_t columns_ = 0;
    std::size_t filled_ = 0;
    std::vector<std::vector<Number>> inputs_;
    std::vector<std::vector<Number>> results_;
    std::vector<std::string> records_;
    TableOutcome outcome_;
};

template <class Number>
TableOutcome pass(const Binding& binding, const NumberKind& number,
                  const std::vector<std::string>& header, CsvReader& in, std::ostream& out)
{
    Pass<Number> pass{binding, number, in, out};
    pass.name_columns(header);
    return pass.run(header.size());
}

}  // namespace

std::optional<NumberKind> find_number_kind(std::string_view text)
{
    using enum NumberKind::Kind;
    struct Named {
        std::string_view name;
        NumberKind::Kind kind;
    };
    constexpr Named kinds[] = {
        {"double", float64},
        {"float", float32},
        {"half", half},
        {"half:flush", half_flush},
        {"interval", interval},
        {"acceptance", acceptance},
        {"acceptance:half", acceptance_half},
        {"mpfr", real},
    };
    for (const Named& named : kinds)
        if (named.name == text) return NumberKind{named.kind, 200};

    constexpr std::string_view prefix = "mpfr:";
    if (!text.starts_with(prefix)) return std::nullopt;
    text.remove_prefix(prefix.size());
    int bits = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), bits);
    const bool whole = error == std::errc{} && stop == text.data() + text.size();
    if (!whole || bits < 53 || bits > 4096) return std::nullopt;
    return NumberKind{real, bits};
}

std::optional<ir::FunctionId> find_function(const ir::Module& module, std::string_view name)
{
    std::string joined{name};
    std::ranges::replace(joined, '.', '_');
    return module.find(joined);
}

TableOutcome evaluate_table(const ir::Module& module, ir::FunctionId function, NumberKind number,
                            std::istream& in, std::ostream& out)
{
    CsvReader reader{in};
    std::vector<std::string> header;
    TableOutcome failed;
    if (!reader.next(header)) {
        failed.error =
            reader.error().empty()
                ? TableError{"the table is empty; its first line names the columns", 0, "", {}}
                : TableError{reader.error(), reader.line(), "", {}};
        return failed;
    }
    const Binding binding = bind_columns(module, function, header);
    if (binding.error) {
        failed.error = binding.error;
        return failed;
    }

    std::string record;
    for (const std::string& name : header) {
        if (&name != &header.front()) record += ',';
        append_cell(record, name);
    }
    for (const std::string& name : binding.tape.output_names)
        for (const std::string_view suffix : result_suffixes(number)) {
            record += ',';
            record += name;
            record += suffix;
        }
    out << record << '\n';

    using enum NumberKind::Kind;
    const auto outcome = [&] {
        switch (number.kind) {
        case float32:
        case half:
        case half_flush: return pass<float>(binding, number, header, reader, out);
        case float64: return pass<double>(binding, number, header, reader, out);
        case interval: return pass<evaluate::Interval>(binding, number, header, reader, out);
        case acceptance:
        case acceptance_half:
            return pass<evaluate::Acceptance>(binding, number, header, reader, out);
        case real: return pass<evaluate::Real>(binding, number, header, reader, out);
        }
        return TableOutcome{};
    };
    TableOutcome result = outcome();
    result.warnings.insert(result.warnings.begin(), binding.warnings.begin(),
                           binding.warnings.end());
    return result;
}

}  // namespace lobe::analyze
