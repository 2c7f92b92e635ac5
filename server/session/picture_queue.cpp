#include "session/picture_queue.h"

#include <algorithm>

namespace haustra::session {

void PictureQueue::add(PictureJob job) {
    withdraw(job.session);
    jobs_.push_back(std::move(job));
}

bool PictureQueue::replace(PictureJob& job) {
    const auto waiting = std::find_if(jobs_.begin(), jobs_.end(), [&](const PictureJob& other) {
        return other.session == job.session && other.header.viewport == job.header.viewport;
    });
    if (waiting == jobs_.end()) return false;
    std::swap(*waiting, job);
    return true;
}

void PictureQueue::withdraw(SessionId session) {
    std::erase_if(jobs_, [&](const PictureJob& job) { return job.session == session; });
}

std::optional<PictureJob> PictureQueue::take() {
    if (jobs_.empty()) return std::nullopt;
    PictureJob job = std::move(jobs_.front());
    jobs_.pop_front();
    return job;
}

}  // namespace haustra::session
