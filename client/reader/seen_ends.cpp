#include "reader/seen_ends.h"

#include "protocol/capabilities.h"
#include "reader/flight.h"

#include <algorithm>

namespace haustra::reader {
namespace {

// An end is a place of the wall, or of the scan beside it: what is met this near to it is the wall
// there, by the voxels' size and what smoothing has moved; or this share of the way, as a ray along
// the wall meets the drawn mucosa before the mesh.
constexpr double atEndMm = 2.0, atEndShare = 0.06;
constexpr std::size_t mostAsked = 8;

}  // namespace

void SeenEnds::reset() {
    camera_.reset();
    answers_.clear();
    due_.clear();
    asked_.clear();
}

SeenEnds::Answer* SeenEnds::answerOf(glm::dvec3 end) {
    const auto found = std::ranges::find(answers_, end, &Answer::end);
    return found == answers_.end() ? nullptr : &*found;
}

void SeenEnds::ask(glm::dvec3 end) {
    due_.push_back(end);
    asked_.push_back(
        {wall_.expect(session_.pick(camera_->positionMm, end - camera_->positionMm, true)), end,
         camera_->positionMm});
}

void SeenEnds::update(const Camera* resting, std::span<const glm::dvec3> ends) {
    std::erase_if(asked_, [&](const Asked& asked) {
        const auto told = wall_.takeTold(asked.request);
        if (!told) return false;
        if (!asked.counts) return true;
        const double farMm = glm::distance(asked.fromMm, asked.end);
        const bool seen = *told && glm::distance((*told)->positionMm, asked.end) <=
                                       std::max(atEndMm, atEndShare * farMm);
        if (Answer* before = answerOf(asked.end))
            before->seen = seen;
        else
            answers_.push_back({asked.end, seen});
        return true;
    });
    // What was asked over a link that was lost may have been refused.
    if (session_.phase() != Phase::open) camera_.reset();
    if (!resting || session_.phase() != Phase::open ||
        !session_.serverCan(protocol::capability::pick))
        return;
    if (camera_ != *resting) {
        camera_ = *resting;
        due_.clear();
        for (Asked& asked : asked_)
            asked.counts = false;
        std::erase_if(answers_, [&](const Answer& answer) {
            return std::ranges::find(ends, answer.end) == ends.end();
        });
    }
    for (const glm::dvec3 end : ends) {
        if (asked_.size() >= mostAsked) return;
        if (end == camera_->positionMm || !seenAt(*camera_, end) ||
            std::ranges::find(due_, end) != due_.end())
            continue;
        ask(end);
    }
}

bool SeenEnds::has(const Camera& camera, glm::dvec3 end) const {
    constexpr double nearMm = 40.0;
    if (!session_.serverCan(protocol::capability::pick))
        return glm::distance(camera.positionMm, end) <= nearMm;
    const auto found = std::ranges::find(answers_, end, &Answer::end);
    return found != answers_.end() && found->seen;
}

}  // namespace haustra::reader
