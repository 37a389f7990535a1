// Codes: how a value becomes a fraction of the codes that some bits have, and back.
//
// codes.cpp lowers declarations, field_code.cpp reads what a field says.
//
// In: `code` declarations and the `code` of a field. Out: two functions for each declaration, and
// an ir::Code that says what a field means. What the numbers come to is checked in exactness.h,
// once the functions of a packing are built.
#pragma once

#include "check/functions.h"

#include <optional>

namespace lobe::check {

/// `code gain(x: float in [0, 256]) { … }`: `gain_encode` over x, with a result in [0, 1], and
/// `gain_decode` over [0, 1], with a result in the range of x. Each is settled like a term.
struct LoweredCode {
    Lowered encode;
    Lowered decode;
};

/// Lowers Program::codes[index], whose callees are lowered. Reports a type that is no bounded
/// number (E0610) and an encode or decode that reads anything but its argument (E0610); that
/// encode stays in [0, 1] (E0607) and decode in the range (E0507) is proved when it is settled.
LoweredCode lower_code(Program& program, std::size_t index, const Sources& sources,
                       Diagnostics& diagnostics);

/// What holds of a declared code over the reals, once its functions are settled: decode undoes
/// encode (else E0608), and encode does not fall (else E0609). By intervals at some thousand
/// values, so what is reported is certain. False if something was reported.
bool check_inverse(const Program& program, const CodeDeclaration& code, const Sources& sources,
                   Diagnostics& diagnostics);

/// `linear`, `sqrt`, `power`, `log2`, `halving`.
bool is_builtin_code(std::string_view name);

/// The code of a field; linear where the clause names none. `field` has its component, its bits,
/// its sign and its range, `parameter` is what it stores. Nothing if it makes no sense (reported:
/// E0610, and E0607 where the range is wider than a declared code's).
std::optional<ir::Code> read_code(Program& program, std::size_t file,
                                  const syntax::FieldClause& clause, const ir::Field& field,
                                  const ir::Parameter& parameter, Diagnostics& diagnostics);

}  // namespace lobe::check
