// How the BLAS beneath CHOLMOD gets along with threads.
#pragma once

namespace haustra::flatten {

/// Has BLAS work in the thread that calls it, so that the same sums are formed on any machine, and
/// tells whether several threads may call it at once. Which BLAS that is, is the system's choice:
/// OpenBLAS without threads of its own is not safe to call from several, all others are. Remains in
/// force for the whole process. Thread-safe.
bool useSingleThreadedBlas();

}  // namespace haustra::flatten
