// A model with parameters of every kind, and a packing that stores them in every way.
#pragma once

#include "emit/modules.h"

namespace lobe::tests {

/// `skin on ue4`: whole channels, fields within one, a field over two, a color, snorm, and every
/// built-in code. Through optimize.
Builder packed_skin();

}  // namespace lobe::tests
