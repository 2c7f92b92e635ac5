#include "render/wall/review_camera.h"

#include "render/wall/wall_coverage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::render {
namespace {

constexpr std::size_t mostSamples = 64;
constexpr double fovDegrees = 90.0;
constexpr double alongMm = 30.0, alongStepMm = 5.0;
constexpr double nearestEyeMm = 6.0, farthestEyeMm = 40.0, shareOfWay = 0.6;
// A path's camera has an outlook that a reader knows.
constexpr double pathsAdvantage = 1.05;

glm::dvec3 anyAcross(glm::dvec3 direction) {
    const glm::dvec3 axis = std::abs(direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(direction, axis));
}

/// Chooses among cameras that look at a patch's centre.
class Review {
public:
    Review(const WallSight& sight, const MissedPatch& patch, glm::dvec3 towardsCecum)
        : sight_(sight), patch_(patch), towardsCecum_(towardsCecum) {
        const std::size_t step = (patch.triangles.size() + mostSamples - 1) / mostSamples;
        for (std::size_t n = 0; n < patch.triangles.size(); n += step)
            samples_.push_back(patch.triangles[n]);
    }

    void tryEye(glm::dvec3 eyeMm, double advantage = 1.0) {
        const glm::dvec3 way = patch_.centerMm - eyeMm;
        if (!(glm::length(way) > 1e-3)) return;
        Camera camera{eyeMm, glm::normalize(way), towardsCecum_, fovDegrees};
        if (!(glm::length(glm::cross(camera.forward, camera.up)) > 0.05))
            camera.up = anyAcross(camera.forward);
        const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
        camera.up = glm::cross(right, camera.forward);
        const double shown = advantage * shownBy(camera);
        if (shown > best_) best_ = shown, camera_ = camera;
    }
    /// Before the centre, as far as the lumen leaves room.
    void tryBefore(glm::dvec3 direction) {
        constexpr double offMm = 0.5;
        const auto across = sight_.firstMet(patch_.centerMm + offMm * direction, direction);
        const double wanted = std::clamp(1.3 * std::sqrt(patch_.areaMm2 / std::numbers::pi),
                                         nearestEyeMm, farthestEyeMm);
        tryEye(patch_.centerMm +
               std::min(wanted, across ? shareOfWay * across->distanceMm : wanted) * direction);
    }
    const Camera& camera() const { return camera_; }
    double shown() const { return std::max(best_, 0.0); }  ///< by it, mm² of what is sampled

private:
    double shownBy(const Camera& camera) const {
        const glm::dvec3 right = glm::cross(camera.forward, camera.up), up = camera.up;
        const double leastCosine = std::cos(glm::radians(sightLimits.mostAngleDegrees));
        double area = 0.0;
        for (const std::int32_t triangle : samples_) {
            const WallSight::Facet& facet = sight_.facets()[std::size_t(triangle)];
            const glm::dvec3 way =
                sight_.originMm() + glm::dvec3(facet.middleMm) - camera.positionMm;
            const double distance = glm::length(way), depth = glm::dot(way, camera.forward);
            if (distance < sightLimits.nearestMm || distance > sightLimits.farthestMm ||
                std::max(std::abs(glm::dot(way, right)), std::abs(glm::dot(way, up))) > depth ||
                -glm::dot(way, glm::dvec3(facet.inward)) < leastCosine * distance)
                continue;
            if (!sight_.hides(camera.positionMm, triangle)) area += double(facet.areaMm2);
        }
        return area;
    }

    const WallSight& sight_;
    const MissedPatch& patch_;
    glm::dvec3 towardsCecum_;
    std::vector<std::int32_t> samples_;
    Camera camera_;
    double best_ = -1.0;
};

glm::dvec3 towardsCecum(const MissedPatch& patch, const Centerline& centerline) {
    return centerline.points.empty() ? glm::dvec3(0, 0, 1)
                                     : poseAtArc(centerline, patch.arcMm).tangent;
}

glm::dvec3 onPath(const Centerline& centerline, double arcMm) {
    return poseAtArc(centerline, arcMm).point.positionMm;
}

Review reviewOf(const WallSight& sight, const MissedPatch& patch, const Centerline& centerline) {
    const glm::dvec3 inward = glm::length(patch.inward) > 0.5 ? patch.inward : glm::dvec3(0, 0, 1);
    Review review(sight, patch, towardsCecum(patch, centerline));
    if (!centerline.points.empty())
        for (double off = 0.0; off <= alongMm; off += alongStepMm)
            for (const double side : {-1.0, 1.0})
                review.tryEye(onPath(centerline, patch.arcMm + side * off), pathsAdvantage);
    review.tryBefore(inward);
    const glm::dvec3 a = anyAcross(inward), b = glm::cross(inward, a);
    for (const double slant : {25.0, 50.0})
        for (int side = 0; side < 8; ++side) {
            const double turn = side * std::numbers::pi / 4.0;
            review.tryBefore(std::cos(glm::radians(slant)) * inward +
                             std::sin(glm::radians(slant)) *
                                 (std::cos(turn) * a + std::sin(turn) * b));
        }
    return review;
}

}  // namespace

Camera reviewCamera(const WallSight& sight, const MissedPatch& patch,
                    const Centerline& centerline) {
    return reviewOf(sight, patch, centerline).camera();
}

std::optional<Camera> viewBesidePath(const WallSight& sight, const MissedPatch& patch,
                                     const Centerline& centerline) {
    if (centerline.points.empty() || patch.triangles.empty()) return {};
    Review fromPath(sight, patch, towardsCecum(patch, centerline));
    fromPath.tryEye(onPath(centerline, patch.arcMm));
    const Review best = reviewOf(sight, patch, centerline);
    constexpr double enough = 0.5;
    if (fromPath.shown() >= enough * best.shown()) return {};
    return best.camera();
}

}  // namespace haustra::render
