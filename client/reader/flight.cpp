#include "reader/flight.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::reader {
namespace {

glm::dvec3 rightOf(const Camera& camera) {
    return glm::cross(camera.forward, camera.up);
}

// Yaw about the camera's up, then pitch about its right; forward and up stay orthonormal.
Camera turned(Camera camera, double yawDegrees, double pitchDegrees) {
    if (yawDegrees == 0.0 && pitchDegrees == 0.0) return camera;
    const double yaw = glm::radians(yawDegrees), pitch = glm::radians(pitchDegrees);
    const glm::dvec3 level = std::cos(yaw) * camera.forward + std::sin(yaw) * rightOf(camera);
    const glm::dvec3 up = camera.up;
    camera.forward = glm::normalize(std::cos(pitch) * level + std::sin(pitch) * up);
    camera.up = glm::normalize(std::cos(pitch) * up - std::sin(pitch) * level);
    return camera;
}

}  // namespace

std::optional<glm::dvec2> seenAt(const Camera& camera, glm::dvec3 pointMm) {
    const glm::dvec3 to = pointMm - camera.positionMm;
    const double depth = glm::dot(to, camera.forward);
    const glm::dvec2 aside(glm::dot(to, rightOf(camera)), -glm::dot(to, camera.up));
    const double half = glm::radians(0.5 * camera.fovDegrees), sine = glm::length(aside);
    glm::dvec2 place(0.0);
    if (camera.lens == Lens::fisheye) {
        if (sine > 0.0) place = aside / sine * std::atan2(sine, depth) / half;
    } else if (depth > 0.0) {
        place = aside / (depth * std::tan(half));
    } else {
        return std::nullopt;
    }
    if (!(glm::length(place) < 4.0)) return std::nullopt;
    return 0.5 * place;
}

const char* toString(FlightDirection direction) {
    return direction == FlightDirection::antegrade ? "antegrade" : "retrograde";
}

Flight::Flight(Centerline centerline) : free_(centerline.points.empty()) {
    Path path{std::move(centerline), {}};
    if (!free_) path.ups = rotationMinimizingUps(path.centerline, flightPreferredUp);
    path_ = std::make_shared<const Path>(std::move(path));
}

void Flight::goTo(double arcMm) {
    if (centerline().points.empty()) return;
    arcMm_ = std::clamp(std::isfinite(arcMm) ? arcMm : 0.0, 0.0, centerline().lengthMm());
    free_ = false;
}

void Flight::advance(double seconds) {
    if (free_ || motion_ == Motion::paused || !(seconds > 0.0)) return;
    const double facing = direction_ == FlightDirection::antegrade ? 1.0 : -1.0;
    const double going = motion_ == Motion::forward ? facing : -facing;
    const double target = arcMm_ + going * speedMmPerS_ * seconds;
    arcMm_ = std::clamp(target, 0.0, centerline().lengthMm());
    if (arcMm_ != target) motion_ = Motion::paused;
}

void Flight::setMotion(Motion motion) {
    if (motion != Motion::paused && free_) returnToCenterline();
    motion_ = motion;
}

void Flight::setSpeed(double mmPerS) {
    speedMmPerS_ = std::clamp(mmPerS, minSpeedMmPerS, maxSpeedMmPerS);
}

void Flight::setFov(double degrees) {
    fovDegrees_ = std::clamp(degrees, 10.0, isFisheye() ? 240.0 : 150.0);
    freeCamera_.fovDegrees = fovDegrees_;
}

void Flight::setFisheye(bool fisheye) {
    if (fisheye == isFisheye()) return;
    lens_ = fisheye ? Lens::fisheye : Lens::perspective;
    std::swap(fovDegrees_, otherFovDegrees_);
    freeCamera_.fovDegrees = fovDegrees_;
    freeCamera_.lens = lens_;
}

void Flight::standAs(const Flight& other) {
    motion_ = Motion::paused;
    arcMm_ = other.arcMm_;
    yawDegrees_ = other.yawDegrees_;
    pitchDegrees_ = other.pitchDegrees_;
    free_ = other.free_;
    freeCamera_ = other.freeCamera_;
    freeCamera_.fovDegrees = fovDegrees_;
    freeCamera_.lens = lens_;
    // Yaw is from the direction of flight: with another one, the same numbers look backwards.
    if (!free_) direction_ = other.direction_;
}

void Flight::look(double yawDegrees, double pitchDegrees) {
    if (free_)
        freeCamera_ = turned(freeCamera_, yawDegrees, pitchDegrees);
    else
        setLook(yawDegrees_ + yawDegrees, pitchDegrees_ + pitchDegrees);
}

void Flight::setLook(double yawDegrees, double pitchDegrees) {
    yawDegrees_ = std::remainder(yawDegrees, 360.0);
    pitchDegrees_ = std::clamp(pitchDegrees, -maxPitchDegrees, maxPitchDegrees);
}

void Flight::flyFreely() {
    if (free_) return;
    freeCamera_ = centerlineCamera();
    motion_ = Motion::paused;
    free_ = true;
}

void Flight::moveFreely(glm::dvec3 rightUpForwardMm) {
    if (!free_) return;
    freeCamera_.positionMm += rightUpForwardMm.x * rightOf(freeCamera_) +
                              rightUpForwardMm.y * freeCamera_.up +
                              rightUpForwardMm.z * freeCamera_.forward;
}

void Flight::returnToCenterline() {
    if (!free_ || centerline().points.empty()) return;
    goTo(nearestArc(centerline(), freeCamera_.positionMm));
    const double along = glm::dot(freeCamera_.forward, poseAtArc(centerline(), arcMm_).tangent);
    direction_ = along < 0.0 ? FlightDirection::retrograde : FlightDirection::antegrade;
    resetLook();
}

double Flight::placeArcMm() const {
    return free_ && !centerline().points.empty() ? nearestArc(centerline(), freeCamera_.positionMm)
                                                 : arcMm_;
}

void Flight::goTo(const Camera& camera, double arcMm) {
    motion_ = Motion::paused;
    if (!centerline().points.empty()) {
        const CenterlinePose pose = poseAtArc(centerline(), arcMm);
        if (glm::distance(pose.point.positionMm, camera.positionMm) < 0.5) {
            goTo(arcMm);
            lookAs(camera);
            return;
        }
        arcMm_ = nearestArc(centerline(), camera.positionMm);
    }
    freeCamera_ = camera;
    freeCamera_.fovDegrees = fovDegrees_;
    freeCamera_.lens = lens_;
    free_ = true;
}

// Sets direction and look offset so that the camera at this arc is `camera`. Either direction can
// face any way; the one that made the view also gives its up.
void Flight::lookAs(const Camera& camera) {
    const auto face = [&](FlightDirection direction) {
        direction_ = direction;
        lookAlong(camera.forward);
        return glm::distance(centerlineCamera().up, camera.up);
    };
    const double retrograde = face(FlightDirection::retrograde);
    const double antegrade = face(FlightDirection::antegrade);
    if (retrograde < antegrade) face(FlightDirection::retrograde);
}

void Flight::lookAt(double arcMm, glm::dvec3 targetMm) {
    motion_ = Motion::paused;
    if (centerline().points.empty()) return;
    goTo(arcMm);
    const glm::dvec3 towards = targetMm - straightCamera().positionMm;
    const double length = glm::length(towards);
    if (length > 0.0) lookAlong(towards / length);
}

// Sets the look offset to a unit direction, also to one steeper than the hand can turn to.
void Flight::lookAlong(glm::dvec3 direction) {
    const Camera straight = straightCamera();
    const double right = glm::dot(direction, rightOf(straight));
    const double ahead = glm::dot(direction, straight.forward);
    const double above = std::clamp(glm::dot(direction, straight.up), -1.0, 1.0);
    yawDegrees_ = glm::degrees(std::atan2(right, ahead));
    pitchDegrees_ = glm::degrees(std::asin(above));
}

// The camera that looks straight along the path.
Camera Flight::straightCamera() const {
    const CenterlineCamera camera = cameraAtArc(centerline(), path_->ups, arcMm_, direction_);
    return {camera.positionMm, camera.forward, camera.up, fovDegrees_, lens_};
}

Camera Flight::centerlineCamera() const {
    return turned(straightCamera(), yawDegrees_, pitchDegrees_);
}

}  // namespace haustra::reader
