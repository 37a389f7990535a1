// A planted violation: a hermetic stage must not ask what time it is.
#include <chrono>
