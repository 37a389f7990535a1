// `packing` blocks: which component of which parameter lives in which bits, and what is asked of
// the whole.
//
// packings.cpp reads a block, fields.cpp one field of it, channels.cpp looks at all fields
// together. What the codes come to as numbers is checked afterwards, by exactness.h.
#pragma once

#include "check/channels.h"
#include "check/subjects.h"

#include <set>

namespace lobe::check {

struct ReadPacking {
    /// Parameters are indices into Program::parameters. The fields whose bits, range and code make
    /// sense, whatever was reported about their channels.
    ir::Packing packing;
    std::set<std::string> failed;  ///< parameters with a field that made no sense
};

/// Reads a packing of the root file and reports everything that is wrong with it: E0301, E0302,
/// E0601 to E0605, E0613, E0615, and what `read_code` reports. Nothing if model or gbuffer are not
/// known.
std::optional<ReadPacking> read_packing(Program& program, const syntax::Item& item,
                                        const syntax::PackingItem& node, Diagnostics& diagnostics);

/// The fields of one line of a packing whose settings are known: one per component of the
/// parameter. Empty if something about it was reported: E0301, E0309, E0505, E0508, E0601, E0603,
/// E0607, E0615, and what `read_code` reports.
std::vector<PlacedField> read_field(Program& program, const Subject& subject,
                                    const ir::Configurations& supported,
                                    const syntax::FieldClause& clause, Diagnostics& diagnostics);

/// `retroreflection`, `tint.r`
std::string component_name(const ir::Parameter& parameter, int component);

}  // namespace lobe::check
