#include "session/worker.h"

#include <asio/any_io_executor.hpp>
#include <asio/post.hpp>
#include <spdlog/spdlog.h>

namespace haustra::session {

void logFault(const char* thread, const std::exception& fault) {
    spdlog::error("the {} thread goes on after a fault: {}", thread, fault.what());
}

void post(const asio::any_io_executor& io, std::function<void()> work) {
    asio::post(io, std::move(work));
}

}  // namespace haustra::session
