// What the reader wants to know about the wall: the place that was clicked, where bookmarks lie,
// how long a drawn line is.
#pragma once

#include "reader/session.h"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace haustra::reader {

/// A line or an outline that the reader draws in the strip.
struct Measurement {
    std::vector<glm::dvec2> points;
    bool closed = false;
    std::optional<FlatMeasure> result;  ///< of these points, or of those before while it is drawn
};

/// Keeps few questions under way, and of clicks and drawings only the newest. Belongs to the
/// session's thread; the session must outlive it.
class WallQuestions {
public:
    explicit WallQuestions(Session& session) : session_(session) {}
    /// Another case is open.
    void reset();
    /// Takes in answers, asks what is due. Call at every step of the loop.
    void update(const CaseInfo& info);

    /// A click on the flattened wall; the first wall that a ray meets; the wall nearest to a place.
    void pick(glm::dvec2 flat) { pick_ = session_.locate(flat); }
    void pick(glm::dvec3 fromMm, glm::dvec3 direction) { pick_ = session_.pick(fromMm, direction); }
    void pickNear(glm::dvec3 placeMm) { pick_ = session_.locate(placeMm); }
    void forgetPick() { pick_ = 0, picked_.reset(); }
    /// The place of the newest click, once.
    std::optional<WallPlace> takePicked() { return std::exchange(picked_, std::nullopt); }

    /// Starts a measurement, or goes on drawing it; at least two points (an outline: three).
    void measure(std::vector<glm::dvec2> points, bool closed);
    void clearMeasurement() { measurement_.reset(), measuring_ = 0; }
    const std::optional<Measurement>& measurement() const { return measurement_; }

    /// The answer to this question about a place is kept for takeTold(). Returns the request.
    std::uint64_t expect(std::uint64_t request);
    /// Empty while there is no answer; no place where it was refused. Once.
    std::optional<std::optional<WallPlace>> takeTold(std::uint64_t request);

    /// The place of the wall that each bookmark means, by its client key: its mark, as the server
    /// tells it and paints it. Of an old server's, which tells none, the place nearest to the point
    /// that lies the lumen's radius in front of its camera.
    const std::map<std::string, WallPlace>& bookmarkPlaces() const { return bookmarkPlaces_; }

    /// An answer is on its way that will change the picture.
    bool waits() const { return pick_ != 0 || measuring_ != 0; }

private:
    void take(const Session::WallAnswer& answer);
    void placeBookmarks(const Centerline& path);

    Session& session_;
    std::uint64_t pick_ = 0, measuring_ = 0;  // requests without an answer, or 0
    std::optional<WallPlace> picked_;
    std::optional<Measurement> measurement_;
    bool measurementChanged_ = false;
    std::map<std::uint64_t, std::optional<std::optional<WallPlace>>> expected_;  // by request
    std::map<std::string, WallPlace> bookmarkPlaces_;
    std::map<std::uint64_t, std::string> bookmarksAsked_;  // client keys, by request
    std::set<std::string> bookmarksSeen_;                  // client keys
    std::optional<std::uint64_t> askedRevision_;  // of the bookmarks: all of them are asked
};

}  // namespace haustra::reader
