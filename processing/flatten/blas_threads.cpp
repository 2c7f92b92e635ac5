#include "flatten/blas_threads.h"

#include <dlfcn.h>

namespace haustra::flatten {

bool useSingleThreadedBlas() {
    // Looked up by name, for no other BLAS has these.
    const auto setThreads =
        reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    const auto parallelism =
        reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_parallel"));
    if (setThreads) setThreads(1);
    return !parallelism || parallelism() != 0;
}

}  // namespace haustra::flatten
