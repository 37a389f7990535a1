// Messages between a process and the children that compile for it: a word, a length, bytes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace lobe::device {

struct Message {
    std::uint32_t kind = 0;
    std::string bytes;
};

/// False when the other end is gone.
bool send(int socket, const Message& message);

/// Nothing when the other end is gone, or silent for longer than `patience`.
std::optional<Message> receive(int socket, std::chrono::milliseconds patience);

/// Values that are copied byte by byte: both ends are one program.
template <class T>
std::string bytes_of(const T& value)
{
    static_assert(std::is_trivially_copyable_v<T>);
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace lobe::device
