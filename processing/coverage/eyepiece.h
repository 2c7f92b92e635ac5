// A picture as the rays of its pixels: what the simulated colonoscopies look through.
#pragma once

#include "core/wall_visibility.h"
#include "coverage/colonoscope.h"

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::coverage {

/// Pixels low.x … high.x, low.y … high.y; empty where high is less than low.
struct PixelBox {
    glm::ivec2 low{0}, high{-1};
};

/// One ray through the centre of each open pixel, in the camera's frame: x right, y down, z
/// forward. Immutable; any number of threads.
class Eyepiece {
public:
    /// Of a colonoscope: the pixels of its picture that its field leaves open (§2.3: an ellipse,
    /// cut to an octagon by the picture's border).
    static Eyepiece of(const Colonoscope& scope);
    /// Pixel (i, j) of a pinhole picture looks to ((i + ½) · 2 / side − 1, likewise j) ·
    /// tan(fov/2).
    static Eyepiece of(const PinholePicture& picture);

    glm::ivec2 size() const { return size_; }
    /// Rows from the top; unit, or zero where the picture is dark.
    const std::vector<glm::vec3>& directions() const { return directions_; }
    int openPixels() const { return openPixels_; }
    float nearestMm() const { return nearestMm_; }
    float farthestMm() const { return farthestMm_; }

    /// Whether a ball around `middle` may show in the picture; false only where it cannot.
    bool mayShow(glm::vec3 middle, float radius) const;
    /// All pixels whose rays meet a triangle are in this box. Corners in the camera's frame; none
    /// of them is the camera's own place.
    PixelBox boxOf(const std::array<glm::vec3, 3>& corners) const;

private:
    Eyepiece() = default;
    PixelBox clipped(glm::vec2 low, glm::vec2 high) const;

    glm::ivec2 size_{0};
    std::vector<glm::vec3> directions_;
    int openPixels_ = 0;
    float nearestMm_ = 0.0f, farthestMm_ = 0.0f;
    float cosHalfField_ = 0.0f, sinHalfField_ = 1.0f;
    float tangent_ = 0.0f;  // of a pinhole; 0: a fisheye
    FisheyeLens lens_;
    float fieldEnd_ = 0.0f;  // no ray of a fisheye is farther from its axis, radians
    // Most pixels that a radian spans anywhere within n degrees of its axis.
    std::vector<float> mostScale_;
};

/// A camera's place and axes as rays start from it, in floats that count from `originMm`.
struct Pose {
    Pose(const CenterlineCamera& camera, glm::dvec3 originMm);
    glm::vec3 eye, right, down, forward;
    glm::vec3 toCamera(glm::vec3 v) const {
        return {glm::dot(right, v), glm::dot(down, v), glm::dot(forward, v)};
    }
    glm::vec3 toWorld(glm::vec3 v) const { return v.x * right + v.y * down + v.z * forward; }
};

}  // namespace haustra::coverage
