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
    asked_ = center ? Asked::atFlatToCenter : Asked::atFlat;
    wall_.pick(flat);
}

void FlatReading::pick(glm::dvec3 fromMm, glm::dvec3 direction) {
    asked_ = Asked::alongRay;
    wall_.pick(fromMm, direction);
}

void FlatReading::goTo(glm::dvec3 placeMm) {
    tour_.setMotion(Motion::paused);
    if (!case_->centerline.points.empty())
        flight_.lookAt(nearestArc(case_->centerline, placeMm), placeMm);
    stay();
    wall_.forgetPick();
    picked_ = GoneTo{placeMm};
    if (!hasStrip()) return;
    asked_ = Asked::nearPlace;
    wall_.pickNear(placeMm);
}

void FlatReading::goTo(const WallPlace& place, const std::optional<Camera>& view) {
    tour_.setMotion(Motion::paused);
    if (view)
        flight_.goTo(*view, place.arcMm);
    else if (!case_->centerline.points.empty())
        flight_.lookAt(place.arcMm, place.positionMm);
    if (hasStrip() && place.flat) tour_.centerOn(*place.flat);
    stay();
    wall_.forgetPick();
    picked_ = GoneTo{place.positionMm, place};
}

// The camera's new place is not followed: slices and window show what was picked.
void FlatReading::stay() {
    followedArcMm_ = flight_.placeArcMm();
    followedY_ = tour_.window().center.y;
}

std::optional<WallPlace> FlatReading::takePicked() {
    const auto place = wall_.takePicked();
    if (!place) return std::nullopt;
    if (asked_ == Asked::nearPlace) {
        if (!picked_) return std::nullopt;  // the reader has moved on
        picked_->wall = place;
        if (place->flat) tour_.centerOn(*place->flat);
        stay();
        return std::nullopt;
    }
    tour_.setMotion(Motion::paused);
    flight_.setMotion(Motion::paused);
    if (asked_ != Asked::alongRay) flight_.lookAt(place->arcMm, place->positionMm);
    if (asked_ != Asked::atFlat && place->flat) tour_.centerOn(*place->flat);
    stay();
    picked_ = GoneTo{place->positionMm, place};
    return place;
}

void FlatReading::forgetPicked() {
    wall_.forgetPick();
    picked_.reset();
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
