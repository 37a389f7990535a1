// A planted violation: this stage must not know of the one that writes text.
#include "emit/emit.h"
