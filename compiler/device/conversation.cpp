#include "device/conversation.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace lobe::device {
namespace {

using Clock = std::chrono::steady_clock;

/// More than any shader or its statistics take: a length above it is no length.
constexpr std::uint32_t longest = 1U << 30;

bool send_all(int socket, const char* bytes, std::size_t size)
{
    while (size > 0) {
        // Without a signal: a child that died is an answer, not the end of this process.
        const ssize_t sent = ::send(socket, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_all(int socket, char* bytes, std::size_t size, Clock::time_point deadline)
{
    while (size > 0) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return false;
        pollfd waiting{socket, POLLIN, 0};
        constexpr std::chrono::milliseconds::rep longest_wait = 1 << 30;
        const int ready = ::poll(&waiting, 1, static_cast<int>(std::min(left, longest_wait)));
        if (ready < 0 && errno == EINTR) continue;
        if (ready < 0) return false;
        if (ready == 0) continue;
        const ssize_t received = ::recv(socket, bytes, size, 0);
        if (received < 0 && errno == EINTR) continue;
        if (received <= 0) return false;
        bytes += received;
        size -= static_cast<std::size_t>(received);
    }
    return true;
}

struct Header {
    std::uint32_t kind = 0;
    std::uint32_t size = 0;
};

}  // namespace

bool send(int socket, const Message& message)
{
    const Header header{message.kind, static_cast<std::uint32_t>(message.bytes.size())};
    return send_all(socket, reinterpret_cast<const char*>(&header), sizeof header) &&
           send_all(socket, message.bytes.data(), message.bytes.size());
}

std::optional<Message> receive(int socket, std::chrono::milliseconds patience)
{
    const Clock::time_point deadline = Clock::now() + patience;
    Header header;
    if (!receive_all(socket, reinterpret_cast<char*>(&header), sizeof header, deadline) ||
        header.size > longest)
        return std::nullopt;
    Message message{header.kind, std::string(header.size, '\0')};
    if (!receive_all(socket, message.bytes.data(), header.size, deadline)) return std::nullopt;
    return message;
}

}  // namespace lobe::device
