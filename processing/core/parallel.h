// Splitting loops over a fixed number of threads.
#pragma once

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

/// How far a long piece of work is, 0…1; called from the thread that started the work.
using Progress = std::function<void(double fraction)>;

}  // namespace haustra
