// Gas within the lumen, and gas beside it.
#include "segmentation/enclosed_gas.h"

#include "core/ct_scan.h"
#include "segmentation/bowel_contents.h"
#include "topology/distance_field.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

using namespace haustra;
using segmentation::Content;
using segmentation::EnclosedGas;

namespace {

using Solid = std::function<bool(glm::dvec3)>;

Solid ball(glm::dvec3 center, double radiusMm) {
    return [=](glm::dvec3 p) { return glm::distance(p, center) < radiusMm; };
}

/// A tube of lumen along z through the grid's middle, and bodies of gas in or beside it.
struct Scene {
    static constexpr double tubeRadiusMm = 20.0, wallMm = 1.6;
    const Grid grid = axisAlignedGrid({90, 90, 70}, {0.8, 0.8, 0.8});
    const glm::dvec3 middle = grid.patientFromVoxelPoint(glm::dvec3(grid.size - 1) * 0.5);
    Volume<std::uint8_t> content{grid, std::uint8_t(Content::tissue)}, labels{grid, 0};
    segmentation::TubePieces cut{Volume<std::int32_t>(grid, -1), Volume<float>(grid, 0.0f), {}, {}};

    void paint(const Solid& inside, Content is, LumenLabel label, std::int32_t piece = -1) {
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (!inside(grid.patientFromVoxelPoint(grid.voxelAt(n)))) continue;
            content.writable()[n] = std::uint8_t(is);
            labels.writable()[n] = std::uint8_t(label);
            cut.pieceAt.writable()[n] = piece;
        }
    }
    Solid tube() const {
        return [c = middle](glm::dvec3 p) {
            return glm::distance(glm::dvec2(p), glm::dvec2(c)) < tubeRadiusMm;
        };
    }
    void paintTube(Content is = Content::tagged, LumenLabel label = LumenLabel::tagged) {
        paint(tube(), is, label, 0);
    }
    /// Gas behind a wall of its own.
    void paintBalloon(glm::dvec3 center, double radiusMm, std::int32_t piece = 1) {
        paint(ball(center, radiusMm + wallMm), Content::tissue, LumenLabel::outside);
        paint(ball(center, radiusMm), Content::gas, LumenLabel::outside, piece);
    }
    std::vector<EnclosedGas> takeIn(int threads = 2) {
        Volume<std::uint8_t> gas(grid);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n)
            gas.writable()[n] = Content(content[n]) == Content::gas;
        cut.distanceMm = topology::distanceToBoundaryMm(gas, threads);
        return takeInEnclosedGas(content, cut, labels, threads);
    }
    std::size_t count(LumenLabel label) const {
        std::size_t sum = 0;
        for (const std::uint8_t is : labels.voxels())
            sum += LumenLabel(is) == label;
        return sum;
    }
};

double ballMl(double radiusMm) {
    return 4.0 / 3.0 * M_PI * std::pow(radiusMm, 3) / 1000.0;
}

TEST(EnclosedGas, ABalloonInTheLumenIsLumenWithItsWall) {
    constexpr double radiusMm = 13.0;
    for (const auto& [is, label] : {std::pair(Content::tagged, LumenLabel::tagged),
                                    std::pair(Content::gas, LumenLabel::air)}) {
        Scene scene;
        scene.paintTube(is, label);
        scene.paintBalloon(scene.middle, radiusMm);
        const auto found = scene.takeIn();
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0].volumeMl, ballMl(radiusMm), 0.02 * ballMl(radiusMm));
        EXPECT_LT(glm::distance(found[0].placeMm, scene.middle), 0.1);
        EXPECT_EQ(found[0].pieces, std::vector<std::int32_t>{1});
        EXPECT_EQ(found[0].facing, 1.0);
        const Solid tube = scene.tube();
        for (std::size_t n = 0; n < scene.grid.voxelCount(); ++n) {
            const glm::dvec3 p = scene.grid.patientFromVoxelPoint(scene.grid.voxelAt(n));
            ASSERT_EQ(scene.labels[n] != 0, tube(p)) << glm::distance(p, scene.middle);
            const double mm = glm::distance(p, scene.middle);
            // A voxel of gas beside the wall is blurred by it, and goes with it.
            if (mm < radiusMm - 0.8) {
                ASSERT_EQ(LumenLabel(scene.labels[n]), LumenLabel::air);
            } else if (mm >= radiusMm && mm < radiusMm + Scene::wallMm) {
                ASSERT_EQ(LumenLabel(scene.labels[n]), LumenLabel::untagged);
            }
        }
    }
}

// A retention balloon sits on the wall of the rectum, with a catheter's bore through it.
TEST(EnclosedGas, ABoreThroughABalloonAndTheWallThatItSitsOnLeaveIt) {
    Scene scene;
    scene.paintTube();
    const glm::dvec3 center = scene.middle + glm::dvec3(5.0, 0.0, 0.0);
    scene.paintBalloon(center, 13.5);
    const auto shaft = [&](double radiusMm) {
        return [=](glm::dvec3 p) {
            return glm::distance(glm::dvec2(p), glm::dvec2(center)) < radiusMm;
        };
    };
    scene.paint(shaft(4.5), Content::tissue, LumenLabel::outside);
    scene.paint(shaft(2.5), Content::gas, LumenLabel::outside, 2);
    const auto found = scene.takeIn();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].pieces, std::vector<std::int32_t>{1});
    EXPECT_GT(found[0].facing, 0.75);
}

TEST(EnclosedGas, BowelBesideTheLumenStaysOut) {
    Scene scene;
    scene.paintTube();
    // One that dents the tube by half its width, one that lies along it, one far off.
    scene.paintBalloon(scene.middle + glm::dvec3(Scene::tubeRadiusMm, 0.0, -12.0), 9.0, 1);
    scene.paint(
        [&](glm::dvec3 p) {
            const glm::dvec2 at = glm::dvec2(p) - glm::dvec2(scene.middle);
            return glm::distance(at, glm::dvec2(0.0, -Scene::tubeRadiusMm - 7.6)) < 6.0;
        },
        Content::gas, LumenLabel::outside, 2);
    scene.paintBalloon(scene.middle + glm::dvec3(-28.0, 22.0, 0.0), 6.0, 3);
    const std::size_t lumen = scene.count(LumenLabel::tagged);
    EXPECT_TRUE(scene.takeIn().empty());
    EXPECT_EQ(scene.count(LumenLabel::tagged), lumen);
    EXPECT_EQ(scene.count(LumenLabel::air) + scene.count(LumenLabel::untagged), 0u);
}

// A loop between two others has them on two sides; its own go on and end in fat.
TEST(EnclosedGas, ALoopBetweenTwoLoopsStaysOut) {
    Scene scene;
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec2 axis = glm::dvec2(scene.middle) + glm::dvec2(side * 20.0, 0.0);
        scene.paint([&](glm::dvec3 p) { return glm::distance(glm::dvec2(p), axis) < 14.0; },
                    Content::gas, LumenLabel::air, 0);
    }
    scene.paintBalloon(scene.middle, 6.5);
    EXPECT_TRUE(scene.takeIn().empty());
}

TEST(EnclosedGas, ABubbleIsLeft) {
    Scene scene;
    scene.paintTube();
    scene.paintBalloon(scene.middle, 5.0);  // half a millilitre
    EXPECT_TRUE(scene.takeIn().empty());
}

}  // namespace
