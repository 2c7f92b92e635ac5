// Reading the flattened wall: where its window is, which leads the flight or is led by it, the
// place that was picked, and what colours the wall.
#pragma once

#include "reader/flight.h"
#include "reader/session.h"
#include "reader/strip_tour.h"
#include "reader/wall_questions.h"

#include <memory>
#include <optional>

namespace haustra::reader {

/// Where the reader has gone to by a click: of the scan, and the wall there or nearest to it, once
/// the server has said where that is.
struct GoneTo {
    glm::dvec3 positionMm{0.0};
    std::optional<WallPlace> wall{};
};

/// Belongs to the session's thread; session and flight must outlive it.
class FlatReading {
public:
    FlatReading(Session& session, Flight& flight) : session_(session), flight_(flight) {}

    /// Another case is open, and the flight is at its start.
    void open(std::shared_ptr<const CaseInfo> info, glm::ivec2 paneSize);
    bool hasStrip() const { return case_ && case_->flat; }

    /// The window of the zoom view. It follows the camera along the colon; moving it leaves the
    /// camera, but for the fly-over, which the camera follows.
    StripTour& tour() { return tour_; }
    const StripTour& tour() const { return tour_; }
    void setFlyingOver(bool on);

    /// Goes to a place of the flattened wall: once the server has said where it is, the camera
    /// looks at it, slices show it, and with `center` the zoom view has it in its middle.
    void goTo(glm::dvec2 flat, bool center);
    /// Goes to the first wall that the ray meets: slices and zoom view show it, the camera stays.
    void pick(glm::dvec3 fromMm, glm::dvec3 direction);
    /// Goes to a place of the scan: the camera looks at it from the nearest place of the path, and
    /// the zoom view shows the wall nearest to it.
    void goTo(glm::dvec3 placeMm);
    /// Goes to a place of the wall that the server has told: the camera looks at it, and the zoom
    /// view has it in its middle. With a view of it, the camera is that one.
    void goTo(const WallPlace& place, const std::optional<Camera>& view = {});
    /// The place that was gone to last, until the camera moves on.
    const std::optional<GoneTo>& picked() const { return picked_; }
    /// No mark, and what is still asked about is gone to no more.
    void forgetPicked();
    WallQuestions& wall() { return wall_; }
    const WallQuestions& wall() const { return wall_; }

    /// What colours the wall; refused (false) where the case has not been flattened.
    bool setPaint(const WallPaintChoice& paint);
    const WallPaintChoice& paint() const { return session_.wallPaint(); }
    void forgetSeen();

    /// One step of the loop: takes in the server's answers, and moves flight and window on by
    /// `seconds`. The place that has just been reached by goTo(), if any.
    std::optional<WallPlace> update(double seconds);

private:
    enum class Asked { atFlat, atFlatToCenter, alongRay, nearPlace };
    std::optional<WallPlace> takePicked();
    void stay();
    void travel(double seconds);

    Session& session_;
    Flight& flight_;
    std::shared_ptr<const CaseInfo> case_;
    StripTour tour_;
    WallQuestions wall_{session_};
    std::optional<GoneTo> picked_;
    Asked asked_ = Asked::atFlat;
    double followedArcMm_ = 0.0, followedY_ = 0.0;  // of camera and tour, when last one led
};

}  // namespace haustra::reader
