// The parent: starts a process per chip, and starts it again when a shader took it down.
#include "device/statistics.h"

#include "device/statistics_service.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace lobe::device {
namespace {

constexpr std::chrono::milliseconds patience = std::chrono::minutes{1};

/// Whether this program's `main` answers a child's request.
std::atomic<bool> can_serve{false};

/// What a child may know: where libraries and drivers are, and the chip. Nothing else of the
/// caller's settings, and no cache.
std::vector<std::string> child_environment(const std::string& chip)
{
    std::vector<std::string> variables{
        "RADV_FORCE_FAMILY=" + chip,
        "MESA_SHADER_CACHE_DISABLE=true",
        "MESA_GLSL_CACHE_DISABLE=true",  // its older name
        // Of the installed drivers only this one is wanted. Loaders that do not know these two
        // load them all, and every implicit layer.
        "VK_LOADER_DRIVERS_SELECT=*radeon*",
        "VK_LOADER_LAYERS_DISABLE=~implicit~",
    };
    for (const char* const kept : {"PATH", "LD_LIBRARY_PATH", "XDG_DATA_DIRS", "VK_DRIVER_FILES",
                                   "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"})
        if (const char* const value = std::getenv(kept))
            variables.push_back(fmt::format("{}={}", kept, value));
    // Drivers that a user installed are found without HOME, where that user's settings of them are.
    if (const char* const data = std::getenv("XDG_DATA_HOME"))
        variables.push_back(fmt::format("XDG_DATA_HOME={}", data));
    else if (const char* const home = std::getenv("HOME"))
        variables.push_back(fmt::format("XDG_DATA_HOME={}/.local/share", home));
    return variables;
}

/// A running child. Ends it when destroyed: it has nothing to lose.
class Child {
public:
    Child(pid_t process, int socket) : process_{process}, socket_{socket} {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child()
    {
        ::close(socket_);
        ::kill(process_, SIGKILL);
        while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    int socket() const { return socket_; }

private:
    pid_t process_;
    int socket_;
};

std::unique_ptr<Child> start(const std::string& chip, std::string& why)
{
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        why = fmt::format("socketpair: {}", std::strerror(errno));
        return nullptr;
    }
    std::array<std::string, 3> arguments{"lobe", service_argument, chip};
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables = child_environment(chip);
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t process = 0;
    const int failed = ::posix_spawn(&process, "/proc/self/exe", &actions, nullptr, argv.data(),
                                     environment.data());
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (failed != 0) {
        ::close(ends[0]);
        why = fmt::format("cannot start a process for the driver: {}", std::strerror(failed));
        return nullptr;
    }
    return std::make_unique<Child>(process, ends[0]);
}

}  // namespace

struct ChipCompiler::State {
    std::string spelling;
    std::string driver;
    std::string chip;
    std::unique_ptr<Child> child;

    /// False, with why, if there is no driver that knows the spelling.
    bool begin(std::string& why)
    {
        child = start(spelling, why);
        if (!child) return false;
        const auto hello = receive(child->socket(), patience);
        if (hello && hello->kind == static_cast<std::uint32_t>(Word::ready)) {
            const std::size_t line = hello->bytes.find('\n');
            driver = hello->bytes.substr(0, line);
            chip = hello->bytes.substr(line + 1);
            return true;
        }
        child.reset();
        why = hello ? hello->bytes : fmt::format("the driver does not know `{}`", spelling);
        return false;
    }
};

ChipCompiler::ChipCompiler(std::unique_ptr<State> state) : state_{std::move(state)} {}
ChipCompiler::ChipCompiler(ChipCompiler&&) noexcept = default;
ChipCompiler& ChipCompiler::operator=(ChipCompiler&&) noexcept = default;
ChipCompiler::~ChipCompiler() = default;

std::optional<ChipCompiler> ChipCompiler::open(std::span<const std::string> chips, std::string& why)
{
    if (!can_serve) {
        why = "this program cannot start itself as a driver's host";
        return std::nullopt;
    }
    for (const std::string& spelling : chips) {
        auto state = std::make_unique<State>();
        state->spelling = spelling;
        if (state->begin(why)) return ChipCompiler{std::move(state)};
    }
    return std::nullopt;
}

const std::string& ChipCompiler::driver() const { return state_->driver; }
const std::string& ChipCompiler::chip() const { return state_->chip; }

std::optional<ShaderStatistics> ChipCompiler::compile(std::span<const std::uint32_t> spirv,
                                                      std::string& why)
{
    if (!state_->child && !state_->begin(why)) return std::nullopt;
    const Message request{
        static_cast<std::uint32_t>(Word::shader),
        std::string(reinterpret_cast<const char*>(spirv.data()), spirv.size_bytes())};
    std::optional<Message> reply;
    if (send(state_->child->socket(), request)) reply = receive(state_->child->socket(), patience);
    if (!reply) {
        state_->child.reset();
        why = fmt::format("the driver for {} failed at a shader", state_->chip);
        return std::nullopt;
    }
    ShaderStatistics statistics;
    if (reply->kind != static_cast<std::uint32_t>(Word::done) ||
        reply->bytes.size() != sizeof statistics) {
        why = reply->bytes;
        return std::nullopt;
    }
    std::memcpy(&statistics, reply->bytes.data(), sizeof statistics);
    return statistics;
}

std::optional<int> serve_statistics(int argc, const char* const* argv)
{
    can_serve = true;
    if (argc != 3 || std::strcmp(argv[1], service_argument) != 0) return std::nullopt;
    return serve(STDIN_FILENO);
}

}  // namespace lobe::device
