// Straight lengths between two places, which are clicked in any views: how large a lesion is.
#pragma once

#include "reader/session.h"
#include "reader/wall_questions.h"

#include <deque>
#include <optional>
#include <vector>

namespace haustra::reader {

/// Patient coordinates.
struct PlaceRuler {
    struct End {
        glm::dvec3 positionMm{0.0};
        std::optional<glm::dvec2> flat{};  ///< where it lies on the flattened wall, or nearly
    };
    End from, to;
    int finding = 0;  ///< the number of the finding whose diameter it is; 0: it was clicked
    double lengthMm() const { return glm::distance(from.positionMm, to.positionMm); }
    /// Whether it is this finding's diameter, and not that of one which had its number before the
    /// case was searched anew.
    bool isOf(const ListedFinding& listed) const {
        return finding == listed.number &&
               listed.finding.diameterEndsMm == std::pair(from.positionMm, to.positionMm);
    }
};

/// Two ends make a ruler, wherever each was clicked. Belongs to the session's thread; session and
/// questions must outlive it.
class PlaceRulers {
public:
    PlaceRulers(Session& session, WallQuestions& wall) : session_(session), wall_(wall) {}
    /// Another case is open.
    void reset();
    /// Takes in answers, asks what is due. Call at every step of the loop, after the questions'.
    void update();

    // An end: of the scan, of the flattened wall, or the first wall that a ray meets.
    void addEnd(glm::dvec3 placeMm);
    void addEnd(glm::dvec2 flat);
    void addEnd(glm::dvec3 fromMm, glm::dvec3 direction);
    /// The largest diameter of a finding; it is measured once.
    void measure(const ListedFinding& finding);

    const std::vector<PlaceRuler>& rulers() const { return rulers_; }
    void set(std::vector<PlaceRuler> rulers);
    /// The first end, while the second is awaited.
    const std::optional<PlaceRuler::End>& begun() const { return begun_; }
    /// Whether it is known, or asked for.
    bool isBegun() const { return begun_ || !ends_.empty(); }
    /// What is begun is given up.
    void giveUp();
    /// Those before a ruler that has been made since the last call, for whoever undoes it.
    std::optional<std::vector<PlaceRuler>> takeBefore() {
        return std::exchange(before_, std::nullopt);
    }
    bool waits() const { return !ends_.empty() || flatOf_ != 0; }

private:
    void add(const PlaceRuler::End& end);
    void add(const PlaceRuler& ruler);
    PlaceRuler::End* withoutFlat();

    Session& session_;
    WallQuestions& wall_;
    std::vector<PlaceRuler> rulers_;
    std::optional<PlaceRuler::End> begun_;
    std::optional<std::vector<PlaceRuler>> before_;
    // Ends in the order of their clicks, from the first that the server has not told of on.
    struct AwaitedEnd {
        std::uint64_t request = 0;  // 0: it is known
        PlaceRuler::End known;
    };
    std::deque<AwaitedEnd> ends_;
    std::uint64_t flatOf_ = 0;  // a request without an answer, or 0
    glm::dvec3 flatOfMm_{0.0};
    std::vector<glm::dvec3> flatless_;  // places that are not near the flattened wall
};

}  // namespace haustra::reader
