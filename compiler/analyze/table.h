// Evaluating a term over a table: columns of inputs in, the same table with the results
// appended out.
//
// Columns are found by name. An argument, a surface field and a parameter are their own names
// (`cos_d`, `roughness`, `retroreflection`), with .r .g .b or .x .y .z for components; a column
// named like a color or vector without a suffix stands for all of its components. A parameter
// without a column takes its default. The geometry is given in one of two ways:
//
//   by vectors   l.x .. v.z; n, x and y default to (0, 0, 1), (1, 0, 0) and (0, 1, 0)
//   by fields    cos_h, cos_i, ... as the term uses them; the stable companions of a cosine
//                (ir/geometry.h) are then computed from it: 1 - c and (1 - c)(1 + c)
//
// All other columns pass through. Rows are read, computed and written in blocks, so tables may
// be larger than memory.
#pragma once

#include "ir/module.h"

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

/// The kind of number that a table is evaluated in.
///
///   half, half_flush      binary16 per operation, denormals kept or flushed
///   interval              encloses the real result for the decimal that the cell shows
///   acceptance[_half]     what the Vulkan precision tables let a device return, for the float
///                         nearest to the cell
///   real                  MPFR at `bits`
struct NumberKind {
    enum class Kind {
        float32,
        float64,
        half,
        half_flush,
        interval,
        acceptance,
        acceptance_half,
        real,
    };
    Kind kind = Kind::float64;
    int bits = 200;  ///< of `real`: 53 .. 4096

    friend bool operator==(const NumberKind&, const NumberKind&) = default;
};

/// `double`, `float`, `half`, `half:flush`, `interval`, `acceptance`, `acceptance:half`,
/// `mpfr:200` (or `mpfr`, which is that); nothing for any other text.
std::optional<NumberKind> find_number_kind(std::string_view text);

/// The accepted texts, for a usage message.
inline constexpr std::string_view number_kinds =
    "double, float, half, half:flush, interval, acceptance, acceptance:half, mpfr:BITS";

/// Why a table could not be evaluated.
struct TableError {
    std::string message;   ///< one lower-case sentence without a full stop
    std::size_t line = 0;  ///< in the table's text, from 1; 0 when it is about no line
    std::string column;    ///< the column's name; empty when it is about no column
    std::vector<std::string> hints;
};

struct TableOutcome {
    std::size_t rows = 0;               ///< written, without the header
    std::vector<std::string> warnings;  ///< in the order of the columns
    std::optional<TableError> error;    ///< then what was written so far is to be thrown away
};

/// The function a user means by a name: a term, a form (`F_Schlick_spherical_gaussian`), an
/// output (`callisto_diffuse`), or the last two with a point (`F_Schlick.spherical_gaussian`).
std::optional<ir::FunctionId> find_function(const ir::Module& module, std::string_view name);

/// Evaluates `function` for every record of `in` and writes the table with the result columns
/// to `out`. Result columns are named as tape outputs are: `D_GGX`, or `c1.r`, `c1.g`, `c1.b`;
/// an interval has two, `.low` and `.high`; an acceptance interval also `.undefined`, 0 or 1.
/// Numbers are written with the fewest digits that read back as exactly themselves.
TableOutcome evaluate_table(const ir::Module& module, ir::FunctionId function, NumberKind number,
                            std::istream& in, std::ostream& out);

}  // namespace lobe::analyze
