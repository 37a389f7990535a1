// A model with parameters of every kind, and a packing that stores them in every way.
#pragma once

#include "emit/modules.h"

namespace lobe::tests {

/// `skin on ue4`: whole channels, fields within one, a field over two, a color, snorm, and every
/// built-in code. As the checker makes it.
Builder checked_skin();
/// The same through optimize.
Builder packed_skin();

}  // namespace lobe::tests
