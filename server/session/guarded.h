// Keeping a request's exceptions from ending its thread.
#pragma once

#include "core/result.h"

#include <new>
#include <stdexcept>

namespace haustra::session {

/// What `work` returns, a Result; memory that runs out in a library costs that one request.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::device, "there is not enough memory", "render");
    } catch (const std::exception& error) {
        return fail(ErrorKind::device, error.what(), "render");
    }
}

}  // namespace haustra::session
