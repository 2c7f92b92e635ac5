// The wall as the server's sessions know it: where each camera's part of it lies in the strip.
#include "session/wall.h"

#include "flat_tube.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

std::shared_ptr<const Wall> wallOf(FlatMap map) {
    return makeWall(std::make_shared<const FlatMap>(std::move(map))).value();
}

TEST(Wall, RowsAreTheNearestMonotoneToTheMeanHeights) {
    const tests::FlatTube tube;
    std::mt19937 random(7);
    for (int round = 0; round < 5; ++round) {
        FlatMap map = tube.map({24, 40}, 2.0);
        const int cameras = int(map.cameras.size());
        std::vector<double> sum(std::size_t(cameras), 0.0), count(std::size_t(cameras), 0.0);
        for (std::size_t n = 0; n < map.camera.size(); ++n) {
            int camera = map.camera[n] + int(random() % 13) - 6;
            camera = std::clamp(camera, 0, cameras - 1);
            if (camera % 5 == 3) ++camera;  // some look at nothing
            map.camera[n] = std::min(camera, cameras - 1);
            sum[std::size_t(map.camera[n])] += map.flat[n].y;
            count[std::size_t(map.camera[n])] += 1.0;
        }
        const auto wall = wallOf(map);
        std::vector<std::size_t> seeing;
        for (std::size_t n = 0; n < count.size(); ++n)
            if (count[n] > 0.0) seeing.push_back(n);
        ASSERT_EQ(wall->rows.size(), seeing.size());
        // Isotonic regression's closed form: the greatest over beginnings of the least over ends of
        // the mean from the one to the other.
        for (std::size_t i = 0; i < seeing.size(); ++i) {
            EXPECT_EQ(wall->rows[i].arcMm, map.cameras[seeing[i]].arcMm);
            double best = -INFINITY;
            for (std::size_t a = 0; a <= i; ++a) {
                double least = INFINITY, total = 0.0, weight = 0.0;
                for (std::size_t b = a; b < seeing.size(); ++b) {
                    total += sum[seeing[b]];
                    weight += count[seeing[b]];
                    if (b >= i) least = std::min(least, total / weight);
                }
                best = std::max(best, least);
            }
            EXPECT_NEAR(wall->rows[i].y, best, 1e-12);
            if (i > 0) {
                EXPECT_GE(wall->rows[i].y, wall->rows[i - 1].y);
            }
        }
    }
}

TEST(Wall, TheCircumferenceIsThatOfAStraightTube) {
    tests::FlatTubeShape shape;
    shape.foldMm = 0.0;
    shape.lengthMm = 90.0;
    const auto wall = wallOf(tests::FlatTube(shape).map({120, 90}));
    EXPECT_NEAR(wall->circumferenceMm, 2.0 * std::numbers::pi * shape.radiusMm, 0.05);
}

TEST(Wall, ASurfaceWithoutAreaIsRefused) {
    FlatMap map = tests::FlatTube().map({12, 10});
    for (glm::dvec3& vertex : map.surface.vertices)
        vertex = {1.0, 2.0, 3.0};
    const auto wall = makeWall(std::make_shared<const FlatMap>(std::move(map)));
    ASSERT_FALSE(wall);
    EXPECT_EQ(wall.error().kind, ErrorKind::badInput);
}

TEST(Wall, TheCostliestQuestionsEnd) {
    const auto wall = wallOf(tests::FlatTube().map());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Measure question;
    question.closed = true;
    for (int n = 0; n < 128; ++n)
        question.points.push_back({0.3 + 0.12 * unit(random), 0.3 + 0.12 * unit(random)});
    const auto answered = answer(*wall, question);
    ASSERT_TRUE(answered);
    const auto& measured = std::get<WallMeasure>(*answered);
    // Even–odd: no more than the square holds.
    EXPECT_GT(measured.areaMm2, 0.0);
    EXPECT_LT(measured.areaMm2, 0.12 * 0.12 * 100.0 * 100.0);
    EXPECT_GT(measured.lengthMm, measured.largestDiameterMm);
}

}  // namespace
}  // namespace haustra::session
