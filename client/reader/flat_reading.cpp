#include "reader/flat_reading.h"

#include <algorithm>

namespace haustra::reader {

void FlatReading::open(std::shared_ptr<const CaseInfo> info, glm::ivec2 paneSize) {
    case_ = std::move(info);
    tour_ = case_->flat ? StripTour(*case_->flat) : StripTour();
    tour_.setPaneSize(paneSize);
    tour_.showWholeCircumference();
    followedArcMm_ = flight_.arcMm();
    if (case_->flat) tour_.follow(followedArcMm_);
    wall_.reset();
    picked_.reset();
}

std::optional<WallPlace> FlatReading::update(double seconds) {
    wall_.update(*case_);
    const auto reached = takePicked();
    travel(seconds);
    return reached;
}

// The flight moves the window of the zoom view; the fly-over's window moves the camera.
void FlatReading::travel(double seconds) {
    flight_.advance(seconds);
    if (!case_->flat) return;
    const double arc = flight_.placeArcMm();
    if (arc != followedArcMm_) {
        tour_.follow(arc);
    } else {
        tour_.advance(seconds, flight_.speedMmPerS(), flight_.direction());
        if (!tour_.flyingOver() || tour_.window().center.y == followedY_) return;
        flight_.goTo(tour_.arcMm());
    }
    picked_.reset();
    followedArcMm_ = flight_.placeArcMm();
    followedY_ = tour_.window().center.y;
}

void FlatReading::goTo(glm::dvec2 flat, bool center) {
    if (!hasStrip()) return;
    flat.y = std::clamp(flat.y, 0.0, case_->flat->height);
    centerPicked_ = center;
    cameraStays_ = false;
    wall_.pick(flat);
}

void FlatReading::pick(glm::dvec3 fromMm, glm::dvec3 direction) {
    centerPicked_ = cameraStays_ = true;
    wall_.pick(fromMm, direction);
}

std::optional<WallPlace> FlatReading::takePicked() {
    const auto place = wall_.takePicked();
    if (!place) return std::nullopt;
    tour_.setMotion(Motion::paused);
    if (cameraStays_)
        flight_.setMotion(Motion::paused);
    else
        flight_.lookAt(place->arcMm, place->positionMm);
    // The camera's new place is not followed: slices and window show what was picked.
    followedArcMm_ = flight_.placeArcMm();
    if (centerPicked_ && place->flat) tour_.centerOn(*place->flat);
    followedY_ = tour_.window().center.y;
    picked_ = place;
    return place;
}

void FlatReading::setFlyingOver(bool on) {
    flight_.setMotion(Motion::paused);
    tour_.setFlyingOver(on && hasStrip());
    if (tour_.flyingOver()) flight_.resetLook();
    followedY_ = tour_.window().center.y;
}

bool FlatReading::setPaint(const WallPaintChoice& paint) {
    if (!hasStrip()) return false;
    session_.setWallPaint(paint);
    return true;
}

void FlatReading::forgetSeen() {
    if (hasStrip()) session_.askSeen(true);
}

}  // namespace haustra::reader
