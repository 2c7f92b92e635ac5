// Nearness of points and triangles in single precision, many at once.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::simplification {

/// Points by coordinates, for arithmetic on several at once.
class PointArrays {
public:
    void clear() { count_ = 0; }
    void add(const glm::vec3& p) {
        if (count_ + lanes > x_.size()) grow();
        x_.data()[count_] = p.x;
        y_.data()[count_] = p.y;
        z_.data()[count_] = p.z;
        ++count_;
    }
    /// Repeats the first point up to whole vectors; to be called after the last add().
    void fill();

    std::size_t size() const { return count_; }
    /// With the points that fill() added.
    std::size_t filledSize() const { return (count_ + lanes - 1) / lanes * lanes; }
    glm::vec3 at(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
    const float* x() const { return x_.data(); }
    const float* y() const { return y_.data(); }
    const float* z() const { return z_.data(); }

    static constexpr std::size_t lanes = 8;

private:
    void grow();

    std::size_t count_ = 0;
    std::vector<float> x_, y_, z_;
};

/// The number of the point nearest to p, or of one as near within rounding. There must be one.
std::size_t nearestPoint(const PointArrays& points, const glm::vec3& p);

/// A triangle prepared for many questions of nearness.
struct NearTriangle {
    glm::vec3 corner[3];
    glm::vec3 edge[3];    ///< from corner k to the next
    glm::vec3 normal;     ///< of unit length; 0 where the triangle has no area
    glm::vec3 inward[3];  ///< in the plane, upright on edge k
    float outside;        ///< −1 where the triangle has no area, so that nothing is above it

    NearTriangle() = default;
    NearTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
};

/// Whether p is within √squared of the triangle abc: quicker than to prepare it for one question.
bool isNear(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
            float squared);

/// Finds for each point a triangle within √squared of it: of those that it lies above or below,
/// the nearest, else any. Whether there is one for each. `heightSquared` is room to work in.
bool findNear(const PointArrays& points, const std::vector<NearTriangle>& triangles, float squared,
              std::vector<int>& number, std::vector<float>& heightSquared);

}  // namespace haustra::simplification
