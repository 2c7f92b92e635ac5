#include "coverage/eyepiece.h"

#include "coverage/lens_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::coverage {
namespace {

/// Rounding in floats, of directions and of pixels.
constexpr float roundingRadians = 1e-4f, roundingPixels = 0.05f;
constexpr double stepRadians = 1e-4;

glm::dvec3 directionAt(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The most pixels that a small turn of a direction moves its pixel by, for each radian.
float scaleAt(const FisheyeLens& lens, double theta, double phi) {
    const auto at = [&](double t, double p) {
        return pixelOf(lens, directionAt(t, p)).value_or(glm::dvec2(INFINITY));
    };
    const glm::dvec2 along = (at(theta + stepRadians, phi) - at(theta - stepRadians, phi)) /
                             (2.0 * stepRadians),
                     around = (at(theta, phi + stepRadians) - at(theta, phi - stepRadians)) /
                              (2.0 * stepRadians * std::sin(theta));
    // The greater singular value of the two columns.
    const double sum = glm::dot(along, along) + glm::dot(around, around),
                 area = along.x * around.y - along.y * around.x;
    return float(std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * area * area)))));
}

}  // namespace

Pose::Pose(const CenterlineCamera& camera, glm::dvec3 originMm)
    : eye(camera.positionMm - originMm) {
    const glm::dvec3 ahead = glm::normalize(camera.forward),
                     aside = glm::normalize(glm::cross(ahead, camera.up));
    forward = glm::vec3(ahead);
    right = glm::vec3(aside);
    down = glm::vec3(glm::cross(ahead, aside));
}

Eyepiece Eyepiece::of(const Colonoscope& scope) {
    Eyepiece made;
    made.size_ = scope.pictureSize;
    made.nearestMm_ = float(scope.nearestMm);
    made.farthestMm_ = float(scope.farthestMm);
    made.lens_ = scope.lens;
    float widest = 0.0f;
    for (int y = 0; y < made.size_.y; ++y) {
        for (int x = 0; x < made.size_.x; ++x) {
            const auto direction = directionOf(scope, glm::dvec2(x, y));
            made.directions_.push_back(direction ? glm::vec3(*direction) : glm::vec3(0.0f));
            if (!direction) continue;
            ++made.openPixels_;
            widest = std::max(widest, float(std::acos(std::clamp(direction->z, -1.0, 1.0))));
        }
    }
    widest += roundingRadians;
    made.cosHalfField_ = std::cos(widest);
    made.sinHalfField_ = std::sin(widest);
    made.fieldEnd_ = std::min(widest, float(largestAngle(scope.lens)) - 2.0f * float(stepRadians));
    float most = 0.0f;
    for (int degree = 0; float(degree) <= glm::degrees(made.fieldEnd_) + 1.0f; ++degree) {
        const double theta =
            std::min(glm::radians(std::max(0.5, double(degree))), double(made.fieldEnd_));
        for (int turn = 0; turn < 24; ++turn)
            most = std::max(most, scaleAt(scope.lens, theta, glm::radians(15.0 * turn)));
        made.mostScale_.push_back(1.02f * most);  // what lies between the samples
    }
    return made;
}

Eyepiece Eyepiece::of(const PinholePicture& picture) {
    Eyepiece made;
    made.size_ = glm::ivec2(picture.side);
    made.nearestMm_ = float(picture.nearestMm);
    made.farthestMm_ = float(picture.farthestMm);
    const double tangent = std::tan(glm::radians(0.5 * picture.fovDegrees));
    made.tangent_ = float(tangent);
    for (int y = 0; y < picture.side; ++y) {
        for (int x = 0; x < picture.side; ++x) {
            const glm::dvec2 at = (glm::dvec2(x, y) + 0.5) * (2.0 / picture.side) - 1.0;
            made.directions_.push_back(glm::vec3(glm::normalize(glm::dvec3(at * tangent, 1.0))));
        }
    }
    made.openPixels_ = picture.side * picture.side;
    const float widest = float(std::atan(tangent * std::numbers::sqrt2)) + roundingRadians;
    made.cosHalfField_ = std::cos(widest);
    made.sinHalfField_ = std::sin(widest);
    return made;
}

bool Eyepiece::mayShow(glm::vec3 middle, float radius) const {
    if (tangent_ > 0.0f) {
        const float reach =
            radius * std::sqrt(1.0f + tangent_ * tangent_) + 1e-3f * (1.0f + std::abs(middle.z));
        return middle.z > -radius && std::abs(middle.x) - tangent_ * middle.z <= reach &&
               std::abs(middle.y) - tangent_ * middle.z <= reach;
    }
    const float distance = glm::length(middle);
    if (distance <= radius) return true;
    // Within half the field and the angle that the ball's radius spans.
    const float sine = radius / distance, cosine = std::sqrt(1.0f - sine * sine);
    if (cosHalfField_ <= -cosine) return true;
    return middle.z >= distance * (cosHalfField_ * cosine - sinHalfField_ * sine);
}

PixelBox Eyepiece::clipped(glm::vec2 low, glm::vec2 high) const {
    const glm::vec2 last(size_ - 1);
    return {glm::ivec2(glm::ceil(glm::clamp(low - roundingPixels, glm::vec2(0.0f), last + 1.0f))),
            glm::ivec2(glm::floor(glm::clamp(high + roundingPixels, glm::vec2(-1.0f), last)))};
}

PixelBox Eyepiece::boxOf(const std::array<glm::vec3, 3>& corners) const {
    const PixelBox whole{glm::ivec2(0), size_ - 1};
    if (tangent_ > 0.0f) {
        glm::vec2 low(INFINITY), high(-INFINITY);
        for (const glm::vec3& corner : corners) {
            if (!(corner.z > 0.01f)) return whole;
            const glm::vec2 at = glm::vec2(corner) / corner.z;
            low = glm::min(low, at), high = glm::max(high, at);
        }
        const float pixels = 0.5f * float(size_.x) / tangent_,
                    middle = 0.5f * float(size_.x) - 0.5f;
        return clipped(low * pixels + middle, high * pixels + middle);
    }
    // The triangle's directions lie within `spread` of one of them. From there to any of them that
    // is in the field, the lens moves by at most its greatest scale within reach times that angle.
    const glm::vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
    const float distance = glm::length(middle);
    float farthest = 0.0f;
    for (const glm::vec3& corner : corners)
        farthest = std::max(farthest, glm::distance(corner, middle));
    if (!(farthest < 0.5f * distance)) return whole;
    const float sine = farthest / distance;
    float spread = sine * (1.0f + 0.2f * sine * sine) + roundingRadians;  // ≥ its arcsine
    const float aside = glm::length(glm::vec2(middle)), theta = std::atan2(aside, middle.z);
    if (theta - spread > fieldEnd_) return {};
    const float end = std::min(theta, fieldEnd_);
    // From the field's border, where the middle is beyond it: that is no farther from the middle.
    if (theta > fieldEnd_) spread *= 2.0f;
    // Around a field of more than a half space the way within it is an arc, not the straight one.
    if (fieldEnd_ > 1.55f) spread *= 1.6f;
    const glm::vec2 toward = aside > 0.0f ? glm::vec2(middle) / aside : glm::vec2(1.0f, 0.0f);
    // As pixelOf does, but for the question whether the lens reaches so far, which it does.
    const glm::dvec3 d(glm::dvec2(toward) * std::sin(double(end)), std::cos(double(end)));
    const double pixelsPerMm[2] = {lens_.mu, lens_.mv}, center[2] = {lens_.u0, lens_.v0};
    glm::dvec2 pixel;
    projectTo(lens_.projection, lens_.k.data(), pixelsPerMm, center, lens_.decentring.data(), d.x,
              d.y, d.z, &pixel.x);
    const float reach = glm::degrees(end + spread) + 1.0f;
    const float pixels = spread * mostScale_[std::min(std::size_t(reach), mostScale_.size() - 1)];
    return clipped(glm::vec2(pixel) - pixels, glm::vec2(pixel) + pixels);
}

}  // namespace haustra::coverage
