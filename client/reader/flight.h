// Where the reader is and looks: along the colon's centerline, or flying freely. No clock, no
// window, no network: time comes in as seconds.
#pragma once

#include "core/camera.h"
#include "core/centerline.h"

#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::reader {

/// Where in a picture, in its heights from the middle, x to the right and y down, a camera with
/// unit, orthogonal directions and a perspective or fisheye lens sees a point; nothing where it
/// cannot: behind a perspective's plane, or a picture's height and more away.
std::optional<glm::dvec2> seenAt(const Camera& camera, glm::dvec3 pointMm);

/// `forward` goes where the camera faces, `backward` the other way without turning round.
enum class Motion { paused, forward, backward };

const char* toString(FlightDirection direction);

/// The state of a fly-through. Belongs to one thread.
class Flight {
public:
    static constexpr double defaultSpeedMmPerS = 30.0;
    static constexpr double minSpeedMmPerS = 2.0, maxSpeedMmPerS = 200.0;
    static constexpr double maxPitchDegrees = 85.0;

    /// `centerline` may be empty: then only free flight moves. The camera starts in the rectum,
    /// facing antegrade. Without a look offset it is exactly that of cameraAtArc.
    explicit Flight(Centerline centerline);

    /// Sets the arc (clamped to the path), back on the centerline; the look offset stays.
    void goTo(double arcMm);
    /// Moves on by `seconds` of flight; pauses at the end of the path. Nothing while paused or
    /// free.
    void advance(double seconds);
    void setMotion(Motion motion);
    void setDirection(FlightDirection direction) { direction_ = direction; }
    void setSpeed(double mmPerS);
    /// Between 10 and 150 degrees; of a fisheye, up to 240.
    void setFov(double degrees);
    /// Each lens keeps a field of view of its own: 90 degrees, of a fisheye 180, until it is set.
    void setFisheye(bool fisheye);
    bool isFisheye() const { return lens_ == Lens::fisheye; }

    /// Turns the view: positive yaw to the right, positive pitch up. On the centerline it adds to
    /// an offset from the direction of flight, in free flight it turns the camera itself.
    void look(double yawDegrees, double pitchDegrees);
    void setLook(double yawDegrees, double pitchDegrees);
    void resetLook() { setLook(0.0, 0.0); }

    /// Leaves the centerline, keeping the camera where it is.
    void flyFreely();
    /// Moves in free flight: right, up and forward as the camera sees them, mm.
    void moveFreely(glm::dvec3 rightUpForwardMm);
    /// Back to the nearest point of the centerline, looking along it.
    void returnToCenterline();
    /// Goes to a stored view: onto the centerline where `camera` stands within half a millimetre
    /// of `arcMm`, else freely.
    void goTo(const Camera& camera, double arcMm);

    /// Stands where `other` stands, and looks where it looks; pauses. Lens, field of view and
    /// speed stay.
    void standAs(const Flight& other);

    /// Goes to an arc of the path and looks at a patient point from there; pauses. Without a path,
    /// or where the point is the camera's own place, only the former.
    void lookAt(double arcMm, glm::dvec3 targetMm);

    /// Its directions are unit and orthogonal.
    Camera camera() const { return free_ ? freeCamera_ : centerlineCamera(); }
    double arcMm() const { return arcMm_; }  ///< in free flight: where the centerline was left
    /// Where the camera is along the path; in free flight, the nearest place of it.
    double placeArcMm() const;
    bool isFree() const { return free_; }
    Motion motion() const { return motion_; }
    FlightDirection direction() const { return direction_; }
    double speedMmPerS() const { return speedMmPerS_; }
    double yawDegrees() const { return yawDegrees_; }
    double pitchDegrees() const { return pitchDegrees_; }
    const Centerline& centerline() const { return path_->centerline; }

private:
    Camera centerlineCamera() const;
    Camera straightCamera() const;
    void lookAs(const Camera& camera);
    void lookAlong(glm::dvec3 direction);

    // Shared by copies: every step that can be taken back holds one.
    struct Path {
        Centerline centerline;
        std::vector<glm::dvec3> ups;  // of each of its points
    };
    std::shared_ptr<const Path> path_;
    double arcMm_ = 0.0, yawDegrees_ = 0.0, pitchDegrees_ = 0.0;
    double speedMmPerS_ = defaultSpeedMmPerS, fovDegrees_ = 90.0;
    double otherFovDegrees_ = 180.0;  // of the lens that is not on
    Lens lens_ = Lens::perspective;
    FlightDirection direction_ = FlightDirection::antegrade;
    Motion motion_ = Motion::paused;
    bool free_ = false;
    Camera freeCamera_;
};

}  // namespace haustra::reader
