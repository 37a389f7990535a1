// Independent tasks on all cores. Each writes only what is its own, so that the results do not
// depend on which thread ran it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace lobe::analyze {

/// `body(task)` for every task below `count`, on up to `jobs` threads (0: as many as the machine
/// runs at once). Tasks start in order.
template <class Body>
void for_each_task(std::size_t count, unsigned jobs, const Body& body)
{
    if (jobs == 0) jobs = std::max(1U, std::thread::hardware_concurrency());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t task = next++; task < count; task = next++) body(task);
    };
    std::vector<std::thread> pool;
    for (std::size_t i = 1; i < std::min<std::size_t>(jobs, count); ++i) pool.emplace_back(work);
    work();
    for (std::thread& thread : pool) thread.join();
}

}  // namespace lobe::analyze
