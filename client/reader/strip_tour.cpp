#include "reader/strip_tour.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {

double wholeCircumference(int widthPixels) {
    return widthPixels / (1.0 + 2.0 * StripLayout::seamMargin);
}

StripTour::StripTour(FlatStrip strip) : strip_(std::move(strip)) {
    showWholeCircumference();
}

void StripTour::setPaneSize(glm::ivec2 pixels) {
    pixels = glm::max(pixels, glm::ivec2(1));
    window_.pixelsPerUnit *= double(pixels.x) / paneSize_.x;
    paneSize_ = pixels;
}

void StripTour::follow(double arcMm) {
    window_.center.y = strip_.yAtArc(arcMm);
    motion_ = Motion::paused;
}

void StripTour::centerOn(glm::dvec2 flat) {
    window_.center = flat;
    keepWithinStrip();
}

void StripTour::drag(glm::dvec2 pixels) {
    window_.center += pixels / window_.pixelsPerUnit;
    keepWithinStrip();
}

void StripTour::zoom(double factor, glm::dvec2 pixel) {
    const glm::dvec2 held = window_.flatFromPixel(pixel, paneSize_);
    // Far out the strip would be a thread in a black pane.
    window_.pixelsPerUnit = std::clamp(window_.pixelsPerUnit * factor,
                                       0.5 * wholeCircumference(paneSize_.x), maxPixelsPerUnit);
    window_.center += held - window_.flatFromPixel(pixel, paneSize_);
    keepWithinStrip();
}

void StripTour::showWholeCircumference() {
    window_.pixelsPerUnit = wholeCircumference(paneSize_.x);
}

void StripTour::setFlyingOver(bool on) {
    flyingOver_ = on;
    motion_ = Motion::paused;
    if (on) showWholeCircumference();
}

void StripTour::advance(double seconds, double speedMmPerS, FlightDirection direction) {
    if (motion_ == Motion::paused || !(seconds > 0.0)) return;
    const double facing = direction == FlightDirection::antegrade ? 1.0 : -1.0;
    const double going = motion_ == Motion::forward ? facing : -facing;
    const double target = window_.center.y + going * speedMmPerS * seconds / strip_.circumferenceMm;
    window_.center.y = std::clamp(target, 0.0, strip_.height);
    if (window_.center.y != target) motion_ = Motion::paused;
}

void StripTour::keepWithinStrip() {
    window_.center.x -= std::floor(window_.center.x);
    window_.center.y = std::clamp(window_.center.y, 0.0, strip_.height);
}

}  // namespace haustra::reader
