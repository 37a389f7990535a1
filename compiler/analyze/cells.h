// Text to number and back, for every kind of number that a table is evaluated in.
//
// Reading follows the cell's decimal: `float` and `double` take the nearest, an interval encloses
// it, MPFR rounds it once at its own precision. Writing uses the fewest digits that read back as
// exactly the same number.
#pragma once

#include "analyze/table.h"
#include "evaluate/run.h"

#include <span>
#include <string>
#include <string_view>

namespace lobe::analyze {

/// Reads a decimal, `inf` or `nan`, with blanks around it; false on anything else.
bool read_cell(std::string_view text, const NumberKind& kind, float& number);
bool read_cell(std::string_view text, const NumberKind& kind, double& number);
bool read_cell(std::string_view text, const NumberKind& kind, evaluate::Interval& number);
bool read_cell(std::string_view text, const NumberKind& kind, evaluate::Acceptance& number);
bool read_cell(std::string_view text, const NumberKind& kind, evaluate::Real& number);

/// Appends `,` and the number's cells to a record.
void write_cells(std::string& record, float number);
void write_cells(std::string& record, double number);
void write_cells(std::string& record, const evaluate::Interval& number);
void write_cells(std::string& record, const evaluate::Acceptance& number);
void write_cells(std::string& record, const evaluate::Real& number);

/// What follows a result's name in the names of its columns: nothing, or `.low`, `.high`, ….
std::span<const std::string_view> result_suffixes(const NumberKind& kind);

/// Runs a tape in a kind of number.
void run_cells(const evaluate::Tape& tape, const NumberKind& kind, evaluate::Columns<float> inputs,
               evaluate::Results<float> outputs, std::size_t count);
void run_cells(const evaluate::Tape& tape, const NumberKind& kind, evaluate::Columns<double> inputs,
               evaluate::Results<double> outputs, std::size_t count);
void run_cells(const evaluate::Tape& tape, const NumberKind& kind,
               evaluate::Columns<evaluate::Interval> inputs,
               evaluate::Results<evaluate::Interval> outputs, std::size_t count);
void run_cells(const evaluate::Tape& tape, const NumberKind& kind,
               evaluate::Columns<evaluate::Acceptance> inputs,
               evaluate::Results<evaluate::Acceptance> outputs, std::size_t count);
void run_cells(const evaluate::Tape& tape, const NumberKind& kind,
               evaluate::Columns<evaluate::Real> inputs, evaluate::Results<evaluate::Real> outputs,
               std::size_t count);

}  // namespace lobe::analyze
