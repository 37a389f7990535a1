// Large inputs on all cores: the points are cut into one run per thread.
#pragma once

#include "evaluate/kernels.h"
#include "evaluate/run.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace lobe::evaluate {

/// `body(begin, size)` for consecutive parts of `count` points, on up to `threads` threads (0: as
/// many as the machine runs at once). Every part but the last is a whole number of blocks, and
/// none is worth less than the start of a thread.
template <class Body>
void in_parallel(std::size_t count, unsigned threads, const Body& body)
{
    constexpr std::size_t least = 8 * block_lanes;
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t parts = std::clamp<std::size_t>(count / least, 1, threads);
    const std::size_t blocks = (count + block_lanes - 1) / block_lanes;
    const std::size_t size = (blocks + parts - 1) / parts * block_lanes;

    std::vector<std::thread> pool;
    for (std::size_t begin = size; begin < count; begin += size)
        pool.emplace_back(
            [&body, begin, part = std::min(size, count - begin)] { body(begin, part); });
    body(0, std::min(size, count));
    for (std::thread& thread : pool) thread.join();
}

/// As `run`, on many threads; the results are the same.
template <class Number>
void run_parallel(const Tape& tape, Columns<Number> inputs, Results<Number> outputs,
                  std::size_t count, unsigned threads = 0)
{
    in_parallel(count, threads, [&](std::size_t begin, std::size_t size) {
        std::vector<const Number*> in;
        std::vector<Number*> out;
        for (const Number* column : inputs) in.push_back(column + begin);
        for (Number* column : outputs) out.push_back(column + begin);
        run(tape, Columns<Number>{in}, Results<Number>{out}, size);
    });
}

}  // namespace lobe::evaluate
