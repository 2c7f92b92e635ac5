#include "session/picture_queue.h"

#include <algorithm>

namespace haustra::session {

std::optional<PictureJob> PictureQueue::add(PictureJob job) {
    auto dropped = withdraw(job.session);
    jobs_.push_back(std::move(job));
    return dropped;
}

bool PictureQueue::replace(PictureJob& job) {
    const auto waiting = std::find_if(jobs_.begin(), jobs_.end(), [&](const PictureJob& other) {
        return other.session == job.session && other.header.viewport == job.header.viewport;
    });
    if (waiting == jobs_.end()) return false;
    std::swap(*waiting, job);
    return true;
}

std::optional<PictureJob> PictureQueue::withdraw(SessionId session) {
    const auto waiting = std::find_if(
        jobs_.begin(), jobs_.end(), [&](const PictureJob& job) { return job.session == session; });
    if (waiting == jobs_.end()) return std::nullopt;
    std::optional<PictureJob> job(std::move(*waiting));
    jobs_.erase(waiting);
    return job;
}

std::optional<PictureJob> PictureQueue::take() {
    if (jobs_.empty()) return std::nullopt;
    PictureJob job = std::move(jobs_.front());
    jobs_.pop_front();
    return job;
}

}  // namespace haustra::session
