// The electronic biopsy as a picture of the strip, and what detection makes of its texture.
#include "ball_colon.h"
#include "cad/biopsy_image.h"
#include "cad/biopsy_transfer.h"
#include "cad/detect.h"
#include "cad/strip_raster.h"
#include "cad/train.h"
#include "flat_tube.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

using tests::BallColon;
using tests::FlatTube;

// The flat coordinate in the middle of a pixel of a picture that lies on its side.
glm::dvec2 flatAt(const FlatTube& tube, glm::ivec2 size, int column, int row) {
    return {1.0 - (row + 0.5) / size.y, (column + 0.5) / size.x * tube.height()};
}

TEST(StripRaster, APixelHasThePlaceThatTheMapHasUnderItsMiddle) {
    const FlatTube tube;
    const FlatMap map = tube.map();
    const glm::ivec2 size(240, 80);
    const cad::StripRaster raster = cad::rasterStrip(map, size, 0);
    ASSERT_EQ(raster.pixels.size(), std::size_t(size.x * size.y));
    double farthest = 0.0;
    for (int row = 0; row < size.y; ++row) {
        for (int column = 0; column < size.x; ++column) {
            const auto& pixel = raster.pixels[std::size_t(row * size.x + column)];
            ASSERT_GE(pixel.triangle, 0) << "a hole at " << column << ", " << row;
            farthest =
                std::max(farthest, glm::distance(raster.placeOf(pixel, map),
                                                 tube.positionMm(flatAt(tube, size, column, row))));
        }
    }
    EXPECT_LT(farthest, 0.1) << "triangles are chords of the tube: no farther than their sagitta";
    for (const int threads : {1, 3, 7}) {
        const cad::StripRaster other = cad::rasterStrip(map, size, threads);
        for (std::size_t n = 0; n < raster.pixels.size(); ++n) {
            ASSERT_EQ(other.pixels[n].triangle, raster.pixels[n].triangle) << threads;
            ASSERT_EQ(other.pixels[n].weights, raster.pixels[n].weights) << threads;
        }
    }
}

TEST(BiopsyImage, ShowsBeneathEachPlaceWhatARayFromItMeets) {
    const FlatTube tube;
    const FlatMap map = tube.map();
    Volume<std::int16_t> hu = tube.scan();
    const glm::ivec2 size(120, 40);
    // Something dense 3 mm beneath the wall, under this pixel.
    const glm::ivec2 over(70, 11);
    const glm::dvec2 flat = flatAt(tube, size, over.x, over.y);
    const glm::dvec3 core = tube.positionMm(flat) - 3.0 * tube.inwardNormal(flat);
    Volume<std::uint8_t> lumen(hu.grid());
    double lowest = 1e9, highest = -1e9;
    for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n) {
        const glm::dvec3 p = hu.grid().patientFromVoxelPoint(glm::dvec3(hu.grid().voxelAt(n)));
        if (glm::distance(p, core) < 2.5) hu.writable()[n] = 300;
        lumen.writable()[n] = hu[n] < -480;
        lowest = std::min(lowest, p.x), highest = std::max(highest, p.x);
    }
    const cad::SmoothScan smooth(hu, {lowest, lowest, -12}, {highest, highest, 72}, 1.0, 1);
    const cad::BiopsyScan scan{smooth, lumen, -480.0};
    const cad::BiopsyTable table(cad::fixedBiopsyTransfer());
    const Image one = cad::biopsyImage(scan, map, table, size, 1, 1);
    const auto pixel = [&](const Image& image, int column, int row) {
        const std::uint8_t* p = &image.rgb[std::size_t(3 * (row * size.x + column))];
        return glm::ivec3(p[0], p[1], p[2]);
    };
    const cad::StripRaster raster = cad::rasterStrip(map, size, 0);
    for (int row = 0; row < size.y; row += 3) {
        for (int column = 0; column < size.x; column += 7) {
            const glm::dvec3 place =
                raster.placeOf(raster.pixels[std::size_t(row * size.x + column)], map);
            const glm::dvec3 into = glm::normalize(smooth.gradient(place));
            const glm::ivec3 ray(cad::displayed(
                cad::castBiopsyRay(scan, table, place, into, cad::RayEnd::opaque).color));
            EXPECT_EQ(pixel(one, column, row), ray);
        }
    }
    const glm::ivec3 dense = pixel(one, over.x, over.y),
                     plain = pixel(one, over.x, (over.y + size.y / 2) % size.y);
    EXPECT_GT(dense.r, dense.g) << "dense tissue is red";
    EXPECT_GT(plain.g, plain.r) << "the wall is green";
    EXPECT_EQ(cad::biopsyImage(scan, map, table, size, 1, 3).rgb, one.rgb);
    // Finer rays show the same, but for what a pixel's parts differ by.
    const Image fine = cad::biopsyImage(scan, map, table, size, 2, 2);
    EXPECT_GT(pixel(fine, over.x, over.y).r, pixel(fine, over.x, over.y).g);
}

TEST(TextureStencil, NeighboursAreThoseWithinTwoStepsAlongTheStripsAxes) {
    // Samples at every step of a tilted plane; the strip runs along one of its axes, however much
    // it leans out of the plane.
    constexpr int side = 9;
    const glm::dvec3 x = glm::normalize(glm::dvec3(1, 2, 0.5)),
                     y = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), x)), n = glm::cross(x, y);
    TriMesh plane;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            plane.vertices.push_back(cad::textureStepMm * (double(i) * x + double(j) * y));
    for (int j = 0; j + 1 < side; ++j) {
        for (int i = 0; i + 1 < side; ++i) {
            const int at = j * side + i;
            plane.triangles.push_back({at, at + 1, at + side + 1});
            plane.triangles.push_back({at, at + side + 1, at + side});
        }
    }
    const cad::WallSamples samples = cad::sampleWall(plane, 1.0);
    ASSERT_EQ(samples.mesh.vertices.size(), plane.vertices.size()) << "none is divided";
    const std::vector<glm::vec3> along(plane.vertices.size(), glm::vec3(y + 0.7 * n));
    const cad::TextureStencil stencil(samples, along);
    int looked = 0;
    for (std::uint32_t v = 0; v < samples.mesh.vertices.size(); ++v) {
        const auto inPlane = [&](std::uint32_t other) {
            const glm::dvec3 off = samples.mesh.vertices[other] - samples.mesh.vertices[v];
            return glm::ivec2(std::lround(glm::dot(off, x) / cad::textureStepMm),
                              std::lround(glm::dot(off, y) / cad::textureStepMm));
        };
        int near = 0;
        for (std::uint32_t other = 0; other < samples.mesh.vertices.size(); ++other) {
            const glm::ivec2 steps = glm::abs(inPlane(other));
            near += other != v && steps.x + steps.y <= 2;
        }
        if (near < cad::textureNeighbours) continue;  // at the plane's edge
        ++looked;
        const auto neighbours = stencil.around(v, glm::vec3(n));
        const std::set<std::uint32_t> different(neighbours.begin(), neighbours.end());
        EXPECT_EQ(different.size(), std::size_t(cad::textureNeighbours));
        for (const std::uint32_t neighbour : different) {
            const glm::ivec2 steps = glm::abs(inPlane(neighbour));
            EXPECT_LE(steps.x + steps.y, 2);
            EXPECT_NE(neighbour, v);
        }
    }
    EXPECT_EQ(looked, (side - 4) * (side - 4));
}

TEST(Detect, TextureFindsADenseCoreThatShapeAloneDoesNotTellFromOthers) {
    // Two bumps alike; the first is denser inside.
    BallColon ball;
    const glm::dvec3 dense = tests::bumps[0].centerMm;
    const Grid& grid = ball.hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        if (glm::distance(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))), dense) < 2.6)
            ball.hu.writable()[n] = std::int16_t(ball.hu[n] + 120);
    const cad::PreparedColon colon = ball.colon();
    cad::TrueLesion lesion;
    lesion.positionMm = lesion.wallMm = dense;
    lesion.diameterMm = 2.0 * tests::bumps[0].radiusMm, lesion.kind = "sessile";
    const auto evidence = cad::gatherEvidence(colon, {});
    const auto examples = cad::textureExamples(evidence, colon.flat, {lesion});
    ASSERT_FALSE(examples.polyps.empty());
    const cad::TextureModel texture = cad::learnTexture(examples.all, examples.polyps);
    auto candidates = cad::findCandidates(colon, evidence, &texture, {});
    std::erase_if(candidates, [](const cad::Candidate& candidate) {
        return candidate.lesion.patch.by != cad::Generator::texture;
    });
    ASSERT_FALSE(candidates.empty());
    for (const cad::Candidate& candidate : candidates) {
        EXPECT_LT(glm::distance(candidate.lesion.centerMm, dense), 4.0);
    }
}

TEST(GradientConcentration, IsOneInABallAndLessInASlab) {
    const Grid grid = axisAlignedGrid({48, 48, 48}, {0.75, 0.75, 0.75}, {-17.6, -17.6, -17.6});
    Volume<std::int16_t> ball(grid), slab(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        ball.writable()[n] = std::int16_t(std::lround(-500.0 * std::tanh(glm::length(p) - 5.0)));
        slab.writable()[n] = std::int16_t(std::lround(-500.0 * std::tanh(std::abs(p.z) - 5.0)));
    }
    const auto of = [](const Volume<std::int16_t>& hu) {
        const cad::SmoothScan scan(hu, {-12, -12, -12}, {12, 12, 12}, 1.0, 1);
        return cad::gradientConcentration(scan, {0, 0, 0}, 7.0);
    };
    EXPECT_GT(of(ball), 0.97);
    EXPECT_LT(of(slab), 0.8);
}

}  // namespace
