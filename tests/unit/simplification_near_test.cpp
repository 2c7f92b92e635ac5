// Nearness of points and triangles, against distances in double precision.
#include "simplification/near.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace haustra::simplification {
namespace {

double segmentDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const double squared = glm::dot(b - a, b - a);
    const double along =
        squared > 0.0 ? glm::clamp(glm::dot(p - a, b - a) / squared, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + along * (b - a));
}

double triangleDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    const double toRim =
        std::min({segmentDistance(p, a, b), segmentDistance(p, b, c), segmentDistance(p, c, a)});
    const glm::dvec3 upright = glm::cross(b - a, c - a);
    const double length = glm::length(upright);
    if (!(length > 0.0)) return toRim;
    const glm::dvec3 n = upright / length, foot = p - glm::dot(n, p - a) * n;
    const auto left = [&](const glm::dvec3& u, const glm::dvec3& v) {
        return glm::dot(glm::cross(v - u, foot - u), n) >= 0.0;
    };
    return left(a, b) && left(b, c) && left(c, a) ? std::abs(glm::dot(n, p - a)) : toRim;
}

class SimplificationNear : public testing::Test {
protected:
    glm::vec3 point() { return {coordinate(), coordinate(), coordinate()}; }
    float coordinate() { return float(random_() % 20001) / 10000.0f - 1.0f; }
    std::mt19937 random_{7};
};

TEST_F(SimplificationNear, IsNearAgreesWithTheDistance) {
    int near = 0;
    for (int n = 0; n < 20000; ++n) {
        const glm::vec3 a = point(), b = n % 50 == 0 ? a : point(),
                        c = n % 30 == 0 ? 0.5f * (a + b) : point(), p = point();
        const double distance = triangleDistance(p, a, b, c);
        if (std::abs(distance - 0.3) < 1e-4) continue;
        EXPECT_EQ(isNear(p, a, b, c, 0.09f), distance < 0.3) << n;
        near += distance < 0.3;
    }
    EXPECT_GT(near, 1000);
}

TEST_F(SimplificationNear, FindsANearTriangleExactlyWhereThereIsOne) {
    int found = 0, failed = 0;
    for (int n = 0; n < 3000; ++n) {
        std::vector<NearTriangle> triangles;
        for (int t = 0; t < 1 + n % 7; ++t) {
            const glm::vec3 a = point(), b = point();
            triangles.emplace_back(a, b, t == 3 ? a : point());
        }
        PointArrays points;
        for (int i = 0; i < 1 + n % 21; ++i)
            points.add(0.3f * point());
        points.fill();
        bool all = true, close = false;
        const auto distance = [&](std::size_t i, const NearTriangle& t) {
            return triangleDistance(points.at(i), t.corner[0], t.corner[1], t.corner[2]);
        };
        for (std::size_t i = 0; i < points.size(); ++i) {
            double least = 10.0;
            for (const NearTriangle& t : triangles)
                least = std::min(least, distance(i, t));
            all = all && least < 0.5;
            close = close || std::abs(least - 0.5) < 1e-4;
        }
        if (close) continue;
        std::vector<int> number;
        std::vector<float> room;
        ASSERT_EQ(findNear(points, triangles, 0.25f, number, room), all) << n;
        (all ? found : failed) += 1;
        for (std::size_t i = 0; all && i < points.size(); ++i)
            EXPECT_LT(distance(i, triangles[std::size_t(number[i])]), 0.5 + 1e-4);
    }
    EXPECT_GT(found, 100);
    EXPECT_GT(failed, 100);
}

TEST_F(SimplificationNear, FindsTheNearestPoint) {
    for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 64u, 65u, 300u}) {
        PointArrays points;
        for (std::size_t i = 0; i < count; ++i)
            points.add(point());
        points.fill();
        for (int n = 0; n < 100; ++n) {
            const glm::vec3 p = point();
            float least = 100.0f;
            for (std::size_t i = 0; i < count; ++i)
                least = std::min(least, glm::distance(p, points.at(i)));
            const std::size_t nearest = nearestPoint(points, p);
            ASSERT_LT(nearest, count);
            EXPECT_LE(glm::distance(p, points.at(nearest)), 1.001f * least);
        }
    }
}

}  // namespace
}  // namespace haustra::simplification
