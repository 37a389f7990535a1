// The two halves of statistics.h, and what they say to each other.
#pragma once

#include "device/conversation.h"
#include "device/statistics.h"

namespace lobe::device {

/// First argument of the child; the chip follows. Its standard input is the conversation.
inline constexpr const char* service_argument = "--serve-statistics-of";

/// The child speaks first: `ready` with the driver and the chip on a line each, or `failed`. Then
/// it is sent a shader's words, and answers `done` with a ShaderStatistics, or `failed` with why.
enum class Word : std::uint32_t {
    ready,
    shader,
    done,
    failed
};

/// Serves until the other end is gone.
int serve(int socket);

}  // namespace lobe::device
