// Splitting loops over a fixed number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>

namespace haustra {

/// `threads` where positive, else the number of cores this process may use.
int threadCount(int threads);

/// Calls body(begin, end) on disjoint ranges that cover [0, count), in chunks of at most `grain`
/// handed out in order to `threads` threads (≤ 0: all cores). Returns when all are done. The body
/// must give the same result however the range is split. An exception in a body is rethrown here.
void parallelFor(std::size_t count, std::size_t grain, int threads,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body(n, scratch) for each n in [0, count), one after the other as threads become free: for
/// pieces that differ much in size. Each thread has a scratch of its own, makeScratch(), and the
/// body must give the same result with whichever. Else as parallelFor.
template <class MakeScratch, class Body>
void parallelForEach(std::size_t count, int threads, const MakeScratch& makeScratch,
                     const Body& body) {
    std::atomic<std::size_t> next = 0;
    const std::size_t workers = std::min(std::size_t(threadCount(threads)), count);
    parallelFor(workers, 1, threads, [&](std::size_t, std::size_t) {
        auto scratch = makeScratch();
        for (std::size_t n; (n = next++) < count;)
            body(n, scratch);
    });
}

/// Runs different pieces of work side by side, each on one of `threads` threads (≤ 0: all cores),
/// begun in their order. A piece may use parallelFor with as many threads itself, so that cores are
/// not idle where others have ended; for that while there are more threads than `threads`. Returns
/// when all are done. Else as parallelFor.
template <class... Parts>
void parallelInvoke(int threads, const Parts&... parts) {
    const std::array<std::function<void()>, sizeof...(parts)> all{std::cref(parts)...};
    parallelFor(all.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part)
            all[part]();
    });
}

/// How far a long piece of work is, 0…1; called from the thread that started the work.
using Progress = std::function<void(double fraction)>;

}  // namespace haustra
