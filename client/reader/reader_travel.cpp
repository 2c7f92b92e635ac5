// Where the reader is: flight and flattened window lead each other along the colon.
#include "reader/overview_map.h"
#include "reader/reader.h"

#include <algorithm>
#include <limits>

namespace haustra::reader {

// The flight moves the window of the zoom view; the fly-over's window moves the camera.
void Reader::travel(double seconds) {
    flight_.advance(seconds);
    if (!case_->flat) return;
    const double arc = placeArcMm();
    if (arc != followedArcMm_) {
        tour_.follow(arc);
    } else {
        tour_.advance(seconds, flight_.speedMmPerS(), flight_.direction());
        if (!tour_.flyingOver() || tour_.window().center.y == followedY_) return;
        flight_.goTo(tour_.arcMm());
    }
    picked_.reset();
    followedArcMm_ = placeArcMm();
    followedY_ = tour_.window().center.y;
}

double Reader::placeArcMm() const {
    return flight_.isFree() && !flight_.centerline().points.empty()
               ? nearestArc(flight_.centerline(), flight_.camera().positionMm)
               : flight_.arcMm();
}

void Reader::goToFlat(glm::dvec2 flat, bool center) {
    if (!hasStrip()) return;
    flat.y = std::clamp(flat.y, 0.0, case_->flat->height);
    centerPicked_ = center;
    wall_.pick(flat);
}

void Reader::takePicked() {
    const auto place = wall_.takePicked();
    if (!place) return;
    tour_.setMotion(Motion::paused);
    flight_.lookAt(place->arcMm, place->positionMm);
    // The camera's new place is not followed: slices and window show what was picked.
    lastCamera_ = flight_.camera();
    pacers_[std::size_t(View::endoscopic)].touch();
    followedArcMm_ = placeArcMm();
    sliceFocusMm_ = place->positionMm;
    if (centerPicked_) tour_.centerOn(place->flat);
    followedY_ = tour_.window().center.y;
    picked_ = place;
}

Motion Reader::motion() const {
    return tour_.flyingOver() ? tour_.motion() : flight_.motion();
}

void Reader::setMotion(Motion motion) {
    if (tour_.flyingOver())
        tour_.setMotion(motion);
    else
        flight_.setMotion(motion);
}

void Reader::setFlyingOver(bool on) {
    flight_.setMotion(Motion::paused);
    tour_.setFlyingOver(on && hasStrip());
    if (tour_.flyingOver()) flight_.resetLook();
    followedY_ = tour_.window().center.y;
}

void Reader::goNear(glm::dvec3 patientMm) {
    if (!case_ || case_->centerline.points.empty()) return;
    setMotion(Motion::paused);
    flight_.goTo(nearestArc(case_->centerline, patientMm));
}

void Reader::addBookmark(std::string note) {
    if (case_) session_.addBookmark(flight_.camera(), flight_.arcMm(), std::move(note));
}

void Reader::goToBookmark(int step) {
    const double here = flight_.arcMm();
    double nearest = std::numeric_limits<double>::max();
    std::optional<Bookmark> found;
    for (const Bookmark& bookmark : session_.bookmarks()) {
        const double ahead = step * (bookmark.arcMm - here);
        if (ahead > 0.5 && ahead < nearest) nearest = ahead, found = bookmark;
    }
    if (found) goTo(*found);
}

}  // namespace haustra::reader
