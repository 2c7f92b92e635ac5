// Where the reader is on the flattened strip: the window that the zoom view shows, and the
// fly-over (dissertation §6.3.2). No clock, no network: time comes in as seconds.
#pragma once

#include "reader/flat_strip.h"
#include "reader/flight.h"

namespace haustra::reader {

/// Belongs to one thread. Lengths on the screen are pixels of the zoom pane.
class StripTour {
public:
    static constexpr double maxPixelsPerUnit = 16384.0;

    StripTour() = default;
    /// Starts at the rectum, with the whole circumference in view.
    explicit StripTour(FlatStrip strip);

    const FlatStrip& strip() const { return strip_; }
    const FlatWindow& window() const { return window_; }
    glm::ivec2 paneSize() const { return paneSize_; }
    /// Keeps what is shown from side to side.
    void setPaneSize(glm::ivec2 pixels);

    /// The camera has moved to another place of the path: shows the wall around it. Ends motion.
    void follow(double arcMm);
    void centerOn(glm::dvec2 flat);
    /// What is shown moves with the hand.
    void drag(glm::dvec2 pixels);
    /// Enlarges by `factor`; what is at `pixel` stays there.
    void zoom(double factor, glm::dvec2 pixel);
    /// As large as shows the whole circumference and a margin past the seam.
    void showWholeCircumference();

    /// The fly-over shows the whole circumference and travels from end to end.
    bool flyingOver() const { return flyingOver_; }
    void setFlyingOver(bool on);
    Motion motion() const { return motion_; }
    void setMotion(Motion motion) { motion_ = flyingOver_ ? motion : Motion::paused; }
    /// Moves on at a steady pace in the picture: `speedMmPerS` of a wall of average circumference.
    /// `forward` is towards where `direction` faces. Pauses at the strip's end.
    void advance(double seconds, double speedMmPerS, FlightDirection direction);
    /// The place of the path around which the wall in the middle of the window lies.
    double arcMm() const { return strip_.arcAtY(window_.center.y); }

private:
    void keepWithinStrip();

    FlatStrip strip_;
    FlatWindow window_;
    glm::ivec2 paneSize_{512, 512};
    bool flyingOver_ = false;
    Motion motion_ = Motion::paused;
};

/// Pixels a circumference with which a picture so wide shows all around and the seam's margins.
double wholeCircumference(int widthPixels);

}  // namespace haustra::reader
