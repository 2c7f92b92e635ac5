#include "simplification/near.h"

#include <algorithm>
#include <bit>
#include <limits>

// The same operations in the same order, hence the same results, on wider vectors where the
// processor has them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HAUSTRA_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define HAUSTRA_WIDE_VECTORS
#endif

namespace haustra::simplification {
namespace {

HAUSTRA_WIDE_VECTORS
int leastKey(const float* x, const float* y, const float* z, std::size_t count, int numbers,
             float px, float py, float pz) {
    // Floats that are not negative order as their bits do; with a point's number in the lowest
    // bits, the least key tells the nearest point in a loop without branches.
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < count; ++i) {
        const float dx = x[i] - px, dy = y[i] - py, dz = z[i] - pz;
        const int bits = std::bit_cast<int>(dx * dx + dy * dy + dz * dz);
        least = std::min(least, (bits & ~numbers) | int(i));
    }
    return least;
}

HAUSTRA_WIDE_VECTORS
void nearestAbove(const NearTriangle* triangles, int triangleCount, const float* __restrict x,
                  const float* __restrict y, const float* __restrict z, std::size_t count,
                  int* __restrict number, float* __restrict squared) {
    for (int n = 0; n < triangleCount; ++n) {
        const NearTriangle t = triangles[n];
        for (std::size_t i = 0; i < count; ++i) {
            float outside = t.outside;
            const auto measure = [&](const glm::vec3& corner, const glm::vec3& inward) {
                const float depth = inward.x * (x[i] - corner.x) + inward.y * (y[i] - corner.y) +
                                    inward.z * (z[i] - corner.z);
                outside = depth < outside ? depth : outside;
            };
            measure(t.corner[0], t.inward[0]);
            measure(t.corner[1], t.inward[1]);
            measure(t.corner[2], t.inward[2]);
            const float height = t.normal.x * (x[i] - t.corner[0].x) +
                                 t.normal.y * (y[i] - t.corner[0].y) +
                                 t.normal.z * (z[i] - t.corner[0].z);
            const float here = height * height;
            const bool nearer = (outside >= 0.0f) & (here <= squared[i]);
            squared[i] = nearer ? here : squared[i];
            number[i] = nearer ? n : number[i];
        }
    }
}

}  // namespace

void PointArrays::grow() {
    const std::size_t size = std::max<std::size_t>(64, 2 * x_.size());
    x_.resize(size);
    y_.resize(size);
    z_.resize(size);
}

void PointArrays::fill() {
    for (std::size_t i = count_; i < filledSize(); ++i) {
        x_[i] = x_[0];
        y_[i] = y_[0];
        z_[i] = z_[0];
    }
}

std::size_t nearestPoint(const PointArrays& points, const glm::vec3& p) {
    const std::size_t count = points.filledSize();
    const auto numbers = int(std::bit_ceil(count) - 1);
    return std::size_t(leastKey(points.x(), points.y(), points.z(), count, numbers, p.x, p.y, p.z) &
                       numbers);
}

NearTriangle::NearTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
    : corner{a, b, c}, edge{b - a, c - b, a - c} {
    const glm::vec3 upright = glm::cross(edge[0], edge[1]);
    const float length = glm::length(upright);
    normal = length > 0.0f ? upright / length : glm::vec3(0.0f);
    outside = length > 0.0f ? 0.0f : -1.0f;
    for (int k = 0; k < 3; ++k)
        inward[k] = glm::cross(normal, edge[k]);
}

bool isNear(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
            float squared) {
    const glm::vec3 corner[] = {a, b, c}, edge[] = {b - a, c - b, a - c};
    const glm::vec3 upright = glm::cross(edge[0], edge[1]);
    const float uprightSquared = glm::dot(upright, upright);
    const float height = glm::dot(upright, p - a);
    if (height * height > squared * uprightSquared) return false;
    bool inside = uprightSquared > 0.0f;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 from = p - corner[k];
        if (uprightSquared > 0.0f && glm::dot(glm::cross(upright, edge[k]), from) >= 0.0f) continue;
        inside = false;
        const float edgeSquared = glm::dot(edge[k], edge[k]);
        const float along = std::clamp(glm::dot(from, edge[k]), 0.0f, edgeSquared);
        const glm::vec3 away = edgeSquared > 0.0f ? from - along / edgeSquared * edge[k] : from;
        if (glm::dot(away, away) <= squared) return true;
    }
    return inside;
}

bool findNear(const PointArrays& points, const std::vector<NearTriangle>& triangles, float squared,
              std::vector<int>& number, std::vector<float>& heightSquared) {
    const std::size_t count = points.filledSize();
    number.assign(count, -1);
    heightSquared.assign(count, squared);
    nearestAbove(triangles.data(), int(triangles.size()), points.x(), points.y(), points.z(), count,
                 number.data(), heightSquared.data());
    std::size_t last = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (number[i] >= 0) continue;
        // Beside a ridge, or at the rim.
        const glm::vec3 p = points.at(i);
        const auto isNearTo = [&](const NearTriangle& t) {
            return isNear(p, t.corner[0], t.corner[1], t.corner[2], squared);
        };
        std::size_t tried = 0;
        while (tried < triangles.size() && !isNearTo(triangles[last])) {
            ++tried;
            last = last + 1 == triangles.size() ? 0 : last + 1;
        }
        if (tried == triangles.size()) return false;
        number[i] = int(last);
    }
    return true;
}

}  // namespace haustra::simplification
