// Lends lanes to the threads that run shaders, splits what is too much at once, and keeps time.
#include "device/device.h"

#include "device/declared.h"
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

/// Why this module cannot be run on this device, as far as it can be known beforehand.
Failure refusal(std::span<const std::uint32_t> spirv, std::string_view entry,
                const DeviceFacts& facts)
{
    const auto declared = declared_by(spirv, entry);
    if (!declared) return "the shader is not SPIR-V";
    if (!declared->has_entry) return fmt::format("the shader has no compute entry `{}`", entry);
    if (declared->needs_float16 && !facts.float16)
        return fmt::format("the shader computes in float16, which `{}` does not", facts.name);
    return std::nullopt;
}

/// A dispatch under way in a thread of its own, since a software device computes inside the
/// submission. The thread keeps the lane alive.
struct Work {
    std::thread thread;
    std::future<Failure> outcome;
};

Work start(std::shared_ptr<Lane> lane, std::uint32_t groups, std::uint32_t count)
{
    std::promise<Failure> promise;
    auto outcome = promise.get_future();
    std::thread thread{
        [lane = std::move(lane), groups, count, promise = std::move(promise)]() mutable {
            Failure failure = lane->dispatch(groups, count);
            lane.reset();  // before anyone can know that the work is done
            promise.set_value(std::move(failure));
        }};
    return {std::move(thread), std::move(outcome)};
}

}  // namespace

std::vector<DeviceFacts> list_devices(std::string& why)
{
    std::vector<DeviceFacts> facts;
    for (const PhysicalDevice& device : physical_devices(why)) facts.push_back(device.facts);
    return facts;
}

struct Device::State {
    PhysicalDevice physical;
    Limits limits;

    std::mutex mutex;  // of what follows
    std::condition_variable returned;
    std::vector<std::shared_ptr<Lane>> idle;
    std::size_t lanes = 0;    ///< that exist and are not given up
    std::vector<Work> stuck;  ///< given up, perhaps still running

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    std::shared_ptr<Lane> borrow(std::string& why);
    void give_back(std::shared_ptr<Lane> lane);
    void forget_lane();
    Failure dispatch(const std::shared_ptr<Lane>& lane, std::uint32_t count);
};

/// A driver must not go while it computes. A shader that was given up gets some seconds to end;
/// after that it will not, and its thread is left behind.
Device::State::~State()
{
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds{10};
    for (Work& work : stuck)
        if (work.outcome.wait_until(patience) == std::future_status::ready)
            work.thread.join();
        else
            work.thread.detach();
}

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
    std::shared_ptr<Lane> lane = Lane::open(physical, limits.always_stage, why);
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

Failure Device::State::dispatch(const std::shared_ptr<Lane>& lane, std::uint32_t count)
{
    Work work = start(lane, (count + group_size - 1) / group_size, count);
    if (work.outcome.wait_for(limits.time) == std::future_status::ready) {
        work.thread.join();
        return work.outcome.get();
    }
    const std::lock_guard lock{mutex};
    stuck.push_back(std::move(work));
    return fmt::format("the shader did not end within {} ms on `{}`", limits.time.count(),
                       physical.facts.name);
}

std::optional<Device> Device::open(std::string_view selector, std::string& why,
                                   const Limits& limits)
{
    auto state = std::make_unique<State>();
    const std::vector<PhysicalDevice> devices = physical_devices(why);
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
    if (auto why_not = refusal(spirv, entry, facts())) return why_not;
    std::string why;
    const auto portions =
        divide(state_->physical, state_->limits, input.size(), output.size(), count, why);
    if (!portions) return why;
    std::shared_ptr<Lane> lane = state_->borrow(why);
    if (!lane) return why;

    Failure failure = lane->load(spirv, entry);
    bool is_usable = true;
    for (std::uint32_t done = 0, turn = 0; done < count && !failure; ++turn) {
        const std::uint32_t points = std::min(portions->points, count - done);
        const auto results = piece(output, turn, portions->outputs);
        failure = lane->upload(piece(input, turn, portions->inputs), results);
        if (!failure) {
            failure = state_->dispatch(lane, points);
            is_usable = !failure;
        }
        if (!failure) lane->download(results);
        done += points;
    }
    // A lane whose dispatch failed may be lost or still at work; a fresh one is not.
    if (is_usable)
        state_->give_back(std::move(lane));
    else
        state_->forget_lane();
    return failure;
}

std::optional<std::string> Device::time(std::span<const std::uint32_t> spirv,
                                        std::string_view entry, std::span<const float> input,
                                        std::size_t outputs, std::uint32_t count,
                                        std::span<double> seconds)
{
    if (auto why_not = refusal(spirv, entry, facts())) return why_not;
    std::string why;
    const auto portions =
        divide(state_->physical, state_->limits, input.size(), outputs, count, why);
    if (!portions) return why;
    if (portions->points < count)
        return fmt::format("{} points do not fit `{}` at once", count, facts().name);
    std::shared_ptr<Lane> lane = state_->borrow(why);
    if (!lane) return why;
    Failure failure = lane->load(spirv, entry);
    if (!failure) failure = lane->upload(input, std::vector<float>(outputs));
    bool is_usable = true;
    const auto dispatch = [&] {
        failure = state_->dispatch(lane, count);
        is_usable = !failure;
    };
    if (!failure) dispatch();
    for (double& each : seconds) {
        if (failure) break;
        dispatch();
        each = lane->seconds();
    }
    if (is_usable)
        state_->give_back(std::move(lane));
    else
        state_->forget_lane();
    return failure;
}

}  // namespace lobe::device
