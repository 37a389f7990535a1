// A module for known parameters: what a scene does not call for is not multiplied by zero, it is
// not in the code.
#pragma once

#include "ir/module.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lobe::optimize {

/// The values of some parameters and surface fields, by name, one per component.
using Settings = std::map<std::string, std::vector<double>>;

/// The module with these inputs fixed, simplified. Fixed ones are no inputs any more; constants
/// reach the bodies of the functions they are passed to: where all callers pass the same, the
/// argument vanishes, elsewhere the call is inlined. Comes before `optimize`.
///
/// A value stands for the shortest decimal that reads back as it: 0.1 is one tenth, as it would
/// be had the author written it, and what is made of such values is folded as on paper (decimal.h):
/// where 5 (1 - 0.9) is an exponent, it is one half. Names that are no inputs, and values of
/// another size than the input's, are ignored by the module: the caller checks them.
///
/// `Module::parameters` and `Module::effects` stay as they are. The condition of an effect that
/// the settings decide is a constant; `truth` (truth.h) reads it.
ir::Module specialize(const ir::Module& module, const Settings& settings);

/// The same for what one function knows of its inputs, of any origin: the value, or null.
using KnownValue =
    std::function<const std::vector<double>*(const ir::Function& function, const ir::Input& input)>;
ir::Module specialize_where(const ir::Module& module, const KnownValue& known);

/// The module where these inputs stay in narrower ranges: parameters, and fields of surfaces and
/// emitters, by name.
/// Functions that are no roots are then called with less than they were declared for; their
/// arguments' ranges become what their callers pass. Guards that this makes needless go in
/// `legalize`. A range is intersected with the declared one; where they do not meet, the declared
/// one stays.
using Limits = std::map<std::string, ir::Range>;
ir::Module narrow(const ir::Module& module, const Limits& limits);

/// The same for what one function knows of its inputs: the range, or null.
using KnownRange =
    std::function<const ir::Range*(const ir::Function& function, const ir::Input& input)>;
ir::Module narrow_where(const ir::Module& module, const KnownRange& known);

/// Every parameter at its default.
Settings defaults(const ir::Module& module);

}  // namespace lobe::optimize
