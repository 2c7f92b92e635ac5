// Which ends of rulers are in sight from where the camera rests.
#pragma once

#include "reader/wall_questions.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace haustra::reader {

/// Asks the server what the ray to each end meets first. A wall stands before most places of a
/// colon, and a ruler that is drawn over it would seem to measure that. Belongs to the session's
/// thread; session and questions must outlive it.
class SeenEnds {
public:
    SeenEnds(Session& session, WallQuestions& wall) : session_(session), wall_(wall) {}
    /// Another case is open.
    void reset();
    /// Takes in answers, asks what is due of those ends, mm, that the picture of a camera holds;
    /// without a camera, as while it moves, of none. Call at every step of the loop, after the
    /// questions'.
    void update(const Camera* resting, std::span<const glm::dvec3> ends);
    /// From where the camera rested last; of a server that cannot tell, whatever lies within 40 mm
    /// of `camera`.
    bool has(const Camera& camera, glm::dvec3 end) const;
    bool waits() const { return !asked_.empty(); }

private:
    struct Answer {
        glm::dvec3 end{0.0};
        bool seen = false;
    };
    struct Asked {
        std::uint64_t request = 0;
        glm::dvec3 end{0.0}, fromMm{0.0};
        bool counts = true;  // of the camera that rests now
    };
    Answer* answerOf(glm::dvec3 end);
    void ask(glm::dvec3 end);

    Session& session_;
    WallQuestions& wall_;
    std::optional<Camera> camera_;  // that rested last
    std::vector<Answer> answers_;   // from there, or else from where it rested before
    std::vector<glm::dvec3> due_;   // ends that have been asked about from there
    std::vector<Asked> asked_;
};

}  // namespace haustra::reader
