// Lends lanes to the threads that run shaders, splits what is too much at once, and keeps time.
#include "device/device.h"

#include "device/lane.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

namespace lobe::device {
namespace {

constexpr std::uint32_t group_size = 64;

/// A software device compiles and runs in the thread that submits, so each thread gets a lane. A
/// hardware one computes while another thread's shader compiles: two keep it busy.
std::size_t lanes_worth_having(const DeviceFacts& facts)
{
    return facts.software ? std::max(1U, std::thread::hardware_concurrency()) : 2;
}

/// How the points are divided among dispatches.
struct Portions {
    std::uint32_t points = 0;  ///< of one dispatch
    std::size_t inputs = 0;    ///< floats of one dispatch
    std::size_t outputs = 0;
};

std::optional<Portions> divide(const PhysicalDevice& physical, const Limits& limits,
                               std::size_t input, std::size_t output, std::uint32_t count,
                               std::string& why)
{
    const std::size_t most_floats = physical.limits.maxStorageBufferRange / sizeof(float);
    const std::uint32_t most_groups = physical.limits.maxComputeWorkGroupCount[0];
    const std::uint64_t most_points = std::min<std::uint64_t>(
        std::max(limits.points, 1U), std::uint64_t{most_groups} * group_size);
    if (count <= most_points && input <= most_floats && output <= most_floats)
        return Portions{count, input, output};
    if (input % count != 0 || output % count != 0) {
        why = fmt::format("{} points with {} inputs and {} outputs do not fit `{}` at once, and "
                          "cannot be divided evenly",
                          count, input, output, physical.facts.name);
        return std::nullopt;
    }
    const std::size_t per_point = std::max({input / count, output / count, std::size_t{1}});
    const auto points =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(most_points, most_floats / per_point));
    if (points == 0) {
        why = fmt::format("one point has {} floats, `{}` takes {}", per_point, physical.facts.name,
                          most_floats);
        return std::nullopt;
    }
    return Portions{points, input / count * points, output / count * points};
}

/// The `index`-th piece of `length` numbers; the last may be shorter.
template <typename T>
std::span<T> piece(std::span<T> all, std::size_t index, std::size_t length)
{
    const std::size_t first = std::min(index * length, all.size());
    return all.subspan(first, std::min(length, all.size() - first));
}

/// Whether the module declares OpCapability Float16, which comes among the first instructions.
bool needs_float16(std::span<const std::uint32_t> spirv)
{
    constexpr std::size_t header_words = 5;
    constexpr std::uint32_t op_capability = 17;
    constexpr std::uint32_t capability_float16 = 9;
    for (std::size_t i = header_words; i + 1 < spirv.size(); i += 2) {
        if (spirv[i] != (2U << 16 | op_capability)) return false;
        if (spirv[i + 1] == capability_float16) return true;
    }
    return false;
}

}  // namespace

std::vector<DeviceFacts> list_devices(std::string& why)
{
    const auto instance = Instance::open(why);
    if (!instance) return {};
    std::vector<DeviceFacts> facts;
    for (const PhysicalDevice& device : physical_devices(*instance, why))
        facts.push_back(device.facts);
    return facts;
}

struct Device::State {
    std::shared_ptr<const Instance> instance;
    PhysicalDevice physical;
    Limits limits;

    std::mutex mutex;  // of what follows
    std::condition_variable returned;
    std::vector<std::shared_ptr<Lane>> idle;
    std::size_t lanes = 0;  ///< that exist and are not given up

    std::shared_ptr<Lane> borrow(std::string& why);
    void give_back(std::shared_ptr<Lane> lane);
    void forget_lane();
    Failure dispatch(const std::shared_ptr<Lane>& lane, std::uint32_t count, bool& is_stuck) const;
};

std::shared_ptr<Lane> Device::State::borrow(std::string& why)
{
    std::unique_lock lock{mutex};
    returned.wait(lock,
                  [&] { return !idle.empty() || lanes < lanes_worth_having(physical.facts); });
    if (!idle.empty()) {
        std::shared_ptr<Lane> lane = std::move(idle.back());
        idle.pop_back();
        return lane;
    }
    ++lanes;
    lock.unlock();
    std::shared_ptr<Lane> lane = Lane::open(instance, physical, limits.always_stage, why);
    if (!lane) forget_lane();
    return lane;
}

void Device::State::give_back(std::shared_ptr<Lane> lane)
{
    {
        const std::lock_guard lock{mutex};
        idle.push_back(std::move(lane));
    }
    returned.notify_one();
}

void Device::State::forget_lane()
{
    {
        const std::lock_guard lock{mutex};
        --lanes;
    }
    returned.notify_one();
}

/// Waits in another thread, since a software device computes inside the submission. On a timeout
/// that thread keeps the lane alive and frees it when the shader ends after all.
Failure Device::State::dispatch(const std::shared_ptr<Lane>& lane, std::uint32_t count,
                                bool& is_stuck) const
{
    const std::uint32_t groups = (count + group_size - 1) / group_size;
    std::promise<Failure> promise;
    std::future<Failure> outcome = promise.get_future();
    std::thread worker{[lane, groups, count, promise = std::move(promise)]() mutable {
        promise.set_value(lane->dispatch(groups, count));
    }};
    if (outcome.wait_for(limits.time) == std::future_status::ready) {
        worker.join();
        return outcome.get();
    }
    worker.detach();
    is_stuck = true;
    return fmt::format("the shader did not end within {} ms on `{}`", limits.time.count(),
                       physical.facts.name);
}

std::optional<Device> Device::open(std::string_view selector, std::string& why,
                                   const Limits& limits)
{
    auto state = std::make_unique<State>();
    state->instance = Instance::open(why);
    if (!state->instance) return std::nullopt;
    const std::vector<PhysicalDevice> devices = physical_devices(*state->instance, why);
    if (devices.empty()) return std::nullopt;
    const auto selected = select_device(devices, selector, why);
    if (!selected) return std::nullopt;
    state->physical = devices[*selected];
    state->limits = limits;
    // The first lane now, so that a device that cannot be used is known at once.
    auto lane = state->borrow(why);
    if (!lane) return std::nullopt;
    state->give_back(std::move(lane));
    return Device{std::move(state)};
}

Device::Device(std::unique_ptr<State> state) : state_{std::move(state)} {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceFacts& Device::facts() const { return state_->physical.facts; }

std::optional<std::string> Device::run(std::span<const std::uint32_t> spirv, std::string_view entry,
                                       std::span<const float> input, std::span<float> output,
                                       std::uint32_t count)
{
    if (count == 0) return std::nullopt;
    if (needs_float16(spirv) && !facts().float16)
        return fmt::format("the shader computes in float16, which `{}` does not", facts().name);
    std::string why;
    const auto portions =
        divide(state_->physical, state_->limits, input.size(), output.size(), count, why);
    if (!portions) return why;
    std::shared_ptr<Lane> lane = state_->borrow(why);
    if (!lane) return why;

    bool is_stuck = false;
    Failure failure = lane->load(spirv, entry);
    for (std::uint32_t done = 0, turn = 0; done < count && !failure; ++turn) {
        const std::uint32_t points = std::min(portions->points, count - done);
        const auto results = piece(output, turn, portions->outputs);
        failure = lane->upload(piece(input, turn, portions->inputs), results);
        if (!failure) failure = state_->dispatch(lane, points, is_stuck);
        if (!failure) lane->download(results);
        done += points;
    }
    // After a failure the lane's queue may be lost or still at work; a fresh one is not.
    if (failure)
        state_->forget_lane();
    else
        state_->give_back(std::move(lane));
    return failure;
}

}  // namespace lobe::device
