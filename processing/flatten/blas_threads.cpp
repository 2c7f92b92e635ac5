#include "flatten/blas_threads.h"

#include <dlfcn.h>

namespace haustra::flatten {
namespace {

/// A function of a library that may or may not be in the process; null where it is not.
template <class Function>
Function* loaded(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

bool useSingleThreadedBlas() {
    if (const auto setThreads = loaded<void(int)>("openblas_set_num_threads")) setThreads(1);
    const auto parallelism = loaded<int()>("openblas_get_parallel");
    return !parallelism || parallelism() != 0;
}

SequentialOpenMp::SequentialOpenMp() {
    const auto levels = loaded<int()>("omp_get_max_active_levels");
    const auto setLevels = loaded<void(int)>("omp_set_max_active_levels");
    if (levels) levels_ = levels();
    if (setLevels) setLevels(0);
}

SequentialOpenMp::~SequentialOpenMp() {
    if (const auto setLevels = loaded<void(int)>("omp_set_max_active_levels")) setLevels(levels_);
}

}  // namespace haustra::flatten
