#include "reader/wall_questions.h"

#include "protocol/capabilities.h"

namespace haustra::reader {
namespace {

constexpr std::size_t maxBookmarksAsked = 8;

}  // namespace

void WallQuestions::reset() {
    pick_ = measuring_ = 0;
    picked_.reset();
    measurement_.reset();
    bookmarkPlaces_.clear();
    bookmarksAsked_.clear();
    bookmarksSeen_.clear();
    askedRevision_.reset();
    expected_.clear();
}

std::uint64_t WallQuestions::expect(std::uint64_t request) {
    expected_[request];
    return request;
}

std::optional<std::optional<WallPlace>> WallQuestions::takeTold(std::uint64_t request) {
    const auto found = expected_.find(request);
    // What another case has forgotten has no answer.
    if (found == expected_.end()) return std::optional<WallPlace>();
    const auto told = found->second;
    if (told) expected_.erase(found);
    return told;
}

void WallQuestions::update(const CaseInfo& info) {
    for (const Session::WallAnswer& answer : session_.takeWallAnswers())
        take(answer);
    if (!info.flat) return;
    if (measurement_ && measurementChanged_ && measuring_ == 0) {
        measuring_ = session_.measure(measurement_->points, measurement_->closed);
        measurementChanged_ = false;
    }
    placeBookmarks(info.centerline);
}

void WallQuestions::take(const Session::WallAnswer& answer) {
    const auto* place = answer.body ? std::get_if<WallPlace>(&*answer.body) : nullptr;
    if (answer.request == pick_) {
        pick_ = 0;
        if (place) picked_ = *place;
    } else if (answer.request == measuring_) {
        measuring_ = 0;
        const auto* measured = answer.body ? std::get_if<FlatMeasure>(&*answer.body) : nullptr;
        if (measurement_) measurement_->result = measured ? std::optional(*measured) : std::nullopt;
    } else if (const auto expected = expected_.find(answer.request); expected != expected_.end()) {
        expected->second = place ? std::optional(*place) : std::nullopt;
    } else if (const auto asked = bookmarksAsked_.find(answer.request);
               asked != bookmarksAsked_.end()) {
        if (place) bookmarkPlaces_[asked->second] = *place;
        bookmarksAsked_.erase(asked);
    }
}

void WallQuestions::measure(std::vector<glm::dvec2> points, bool closed) {
    if (measurement_ && measurement_->closed == closed) {
        if (measurement_->points == points) return;
        measurement_->points = std::move(points);
    } else {
        measurement_ = Measurement{std::move(points), closed, {}};
        measuring_ = 0;  // that answer is of another drawing
    }
    measurementChanged_ = true;
}

void WallQuestions::placeBookmarks(const Centerline& path) {
    const std::uint64_t revision = session_.bookmarksRevision();
    if (session_.phase() != Phase::open || revision == askedRevision_) return;
    const bool told = session_.serverCan(protocol::capability::marks);
    for (const Bookmark& bookmark : session_.bookmarks()) {
        if (bookmark.mark) bookmarkPlaces_[bookmark.clientKey] = *bookmark.mark;
        if (told) continue;
        if (bookmarksAsked_.size() >= maxBookmarksAsked) return;
        if (!bookmarksSeen_.insert(bookmark.clientKey).second) continue;
        constexpr double withoutPathMm = 15.0;
        const double radiusMm =
            path.points.empty() ? withoutPathMm : poseAtArc(path, bookmark.arcMm).point.radiusMm;
        const glm::dvec3 ahead =
            bookmark.camera.positionMm + radiusMm * glm::normalize(bookmark.camera.forward);
        bookmarksAsked_[session_.locate(ahead)] = bookmark.clientKey;
    }
    askedRevision_ = revision;
}

}  // namespace haustra::reader
