// How the libraries beneath CHOLMOD get along with threads.
#pragma once

namespace haustra::flatten {

/// Has BLAS work in the thread that calls it, so that any number of cores forms the same sums, and
/// tells whether several threads may call it at once. Which BLAS that is, is the system's choice:
/// OpenBLAS without threads of its own is not safe to call from several, all others are. Remains in
/// force for the whole process. Thread-safe.
bool useSingleThreadedBlas();

/// While it lives, OpenMP's parallel regions entered from this thread run in this thread: CHOLMOD
/// opens one for each of many thousand small copies, and waking threads for them takes a quarter of
/// its time.
class SequentialOpenMp {
public:
    SequentialOpenMp();
    SequentialOpenMp(const SequentialOpenMp&) = delete;
    SequentialOpenMp& operator=(const SequentialOpenMp&) = delete;
    ~SequentialOpenMp();

private:
    int levels_ = 0;  ///< of active regions that were allowed before
};

}  // namespace haustra::flatten
