// Wall that is thick all around is told, with where it lies and how thick it is; what is thick for
// another reason is not.
#include "cad/annular_wall.h"
#include "cad/detect.h"
#include "core/ct_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

constexpr double twoPi = 2.0 * std::numbers::pi, lengthMm = 240.0, openMm = 16.0;

/// A straight tube along z whose lumen is narrow on a stretch.
struct TubeShape {
    double fromMm = 100.0, toMm = 130.0;  ///< of the narrow stretch
    double channelMm = 7.0;               ///< radius there
    double outerMm = 17.5;                ///< where its tissue ends there; elsewhere at 17.5
    double share = 1.0;                   ///< of the circumference that is narrowed
    double aroundHu = -100.0;             ///< outside
    double organShare = 0.0;              ///< of the circumference, against which an organ lies
    double thickHu = 40.0;                ///< of the narrow stretch's tissue
};

struct RingTube {
    TubeShape shape;
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> lumen;
    TriMesh surface;
    FlatMap flat;
    Centerline centerline;
    TissueModel tissue;

    // 1 within the narrow stretch, 0 out of it, over 3 mm.
    double narrowness(double z, double angle) const {
        const auto within = [](double t) { return std::clamp(0.5 + t / 3.0, 0.0, 1.0); };
        const double along = std::min(z - shape.fromMm, shape.toMm - z);
        const double turned = std::abs(std::remainder(angle, twoPi)) / std::numbers::pi;
        return within(along) *
               (shape.share >= 1.0 ? 1.0 : within((shape.share - turned) * 0.5 * openMm));
    }
    double lumenMm(double z, double angle) const {
        return glm::mix(openMm, shape.channelMm, narrowness(z, angle));
    }

    explicit RingTube(const TubeShape& of) : shape(of) {
        const Grid grid =
            axisAlignedGrid({58, 58, int(lengthMm) + 1}, glm::dvec3(1.0), {-28.5, -28.5, 0.0});
        hu = Volume<std::int16_t>(grid), lumen = Volume<std::uint8_t>(grid);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
            const double r = std::hypot(p.x, p.y), angle = std::atan2(p.y, p.x),
                         inside = lumenMm(p.z, angle) - r,
                         outer = glm::mix(17.5, shape.outerMm, narrowness(p.z, angle)) - r;
            const auto step = [](double mm) { return 0.5 + 0.5 * std::tanh(mm / 0.6); };
            const bool isOrgan = std::abs(angle) < shape.organShare * std::numbers::pi;
            const double tissue = glm::mix(40.0, shape.thickHu, narrowness(p.z, angle));
            const double wall = glm::mix(isOrgan ? 40.0 : shape.aroundHu, tissue, step(outer));
            hu.writable()[n] = std::int16_t(std::lround(glm::mix(wall, -990.0, step(inside))));
            lumen.writable()[n] =
                std::uint8_t(inside > 0.0 ? LumenLabel::air : LumenLabel::outside);
        }
        tissue.meanHu = {-990.0, -100.0, 40.0, 600.0};
        tissue.airBelowHu = -475.0;
        constexpr int around = 48, along = 240;
        flat.height = lengthMm / (twoPi * openMm);
        for (int j = 0; j <= along; ++j) {
            const double z = 1.0 + (lengthMm - 2.0) * j / along;
            flat.cameras.push_back({{0.0, 0.0, z}, z});
            centerline.points.push_back({{0.0, 0.0, z}, z, lumenMm(z, 0.0), false});
            for (int i = 0; i <= around; ++i) {
                const double angle = twoPi * (i % around) / around, r = lumenMm(z, angle);
                flat.surface.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
                flat.flat.push_back({double(i) / around, flat.height * j / along});
                flat.camera.push_back(j);
            }
        }
        for (int j = 0; j < along; ++j)
            for (int i = 0; i < around; ++i) {
                const int a = j * (around + 1) + i, b = a + 1, d = a + around + 1, c = d + 1;
                for (const glm::ivec3 triangle : {glm::ivec3(a, b, c), glm::ivec3(a, c, d)}) {
                    flat.sourceTriangle.push_back(int(flat.surface.triangles.size()));
                    flat.surface.triangles.push_back(triangle);
                }
            }
        surface = flat.surface;
    }

    cad::PreparedColon colon() const {
        return {hu, hu, lumen, surface, flat, centerline, tissue, {}, {}};
    }
};

std::vector<cad::AnnularWall> told(const TubeShape& shape, int threads = 2) {
    const RingTube tube(shape);
    const auto colon = tube.colon();
    cad::EvidenceOptions options;
    options.threads = threads;
    return cad::annularWalls(colon, cad::gatherEvidence(colon, options), threads);
}

TEST(AnnularWall, IsToldWithItsStretchAndItsThickness) {
    const auto walls = told({});
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_NEAR(walls[0].fromMm, 100.0, 4.0);
    EXPECT_NEAR(walls[0].toMm, 130.0, 4.0);
    EXPECT_NEAR(walls[0].thicknessMm, 17.5 - 7.0, 1.0);
    EXPECT_NEAR(walls[0].middleHu, 40.0, 2.0);
    EXPECT_NEAR(walls[0].channelMm, 14.0, 0.5);
}

TEST(AnnularWall, WhatIsThickForAnotherReasonIsNot) {
    EXPECT_TRUE(told({.channelMm = openMm}).empty()) << "nothing is thick";
    EXPECT_TRUE(told({.outerMm = 11.0}).empty()) << "contracted: 4 mm";
    EXPECT_TRUE(told({.share = 0.6}).empty()) << "on one side";
    EXPECT_TRUE(told({.aroundHu = 40.0}).empty()) << "whatever lies against the colon";
    EXPECT_TRUE(told({.fromMm = 100.0, .toMm = 107.0}).empty()) << "a fold that goes all around";
    EXPECT_TRUE(told({.fromMm = 6.0, .toMm = 38.0}).empty()) << "the anal canal";
}

TEST(AnnularWall, MayLieAgainstAnOrganOnUpToHalfOfItsCircumference) {
    EXPECT_EQ(told({.organShare = 0.35}).size(), 1u);
    EXPECT_TRUE(told({.organShare = 0.7}).empty());
}

// Another loop's wall is part of what is measured there.
TEST(AnnularWall, IsNotSureWhereOnlyOtherLoopsGasEndsIt) {
    const auto walls = told({.aroundHu = -950.0});
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_TRUE(walls[0].isBesideLoops);
    EXPECT_NEAR(walls[0].thicknessMm, 17.5 - 7.0, 2.0);  // gas blurs farther in than fat
    EXPECT_FALSE(told({})[0].isBesideLoops);
    EXPECT_TRUE(told({.channelMm = openMm, .aroundHu = -950.0}).empty()) << "nothing is thick";
}

TEST(AnnularWall, IsNotLookedForWithoutAFlatMap) {
    RingTube tube({});
    tube.flat = {};
    const auto colon = tube.colon();
    EXPECT_TRUE(cad::annularWalls(colon, cad::gatherEvidence(colon, {}), 0).empty());
}

TEST(AnnularWall, ASampleIsAsThickAsItsTissue) {
    const RingTube tube({});
    const auto colon = tube.colon();
    const auto evidence = cad::gatherEvidence(colon, {});
    const auto& places = evidence.samples.mesh.vertices;
    std::size_t thick = 0, thin = 0;
    for (std::uint32_t v = 0; v < places.size(); ++v) {
        const auto mm = cad::wallThicknessMm(evidence, v);
        if (std::abs(places[v].z - 115.0) < 8.0) {
            ASSERT_TRUE(mm);
            EXPECT_NEAR(*mm, 10.5, 0.7);
            ++thick;
        } else if (std::abs(places[v].z - 180.0) < 20.0) {
            ASSERT_TRUE(mm);
            EXPECT_LT(*mm, 3.0);
            ++thin;
        }
    }
    EXPECT_GT(thick, 1000u);
    EXPECT_GT(thin, 1000u);
    const RingTube touched({.aroundHu = 40.0});
    const auto around = cad::gatherEvidence(touched.colon(), {});
    EXPECT_FALSE(cad::wallThicknessMm(around, std::uint32_t(places.size() / 2)));
    const RingTube besideGas({.aroundHu = -950.0});
    const auto byGas = cad::gatherEvidence(besideGas.colon(), {});
    for (std::uint32_t v = 0; v < places.size(); ++v) {
        if (std::abs(places[v].z - 115.0) < 8.0) {
            EXPECT_FALSE(cad::wallThicknessMm(byGas, v));
        }
    }
}

TEST(AnnularWall, AsAFindingItIsItsTissue) {
    const RingTube tube({});
    const auto colon = tube.colon();
    const auto evidence = cad::gatherEvidence(colon, {});
    const auto walls = cad::annularWalls(colon, evidence, 0);
    ASSERT_EQ(walls.size(), 1u);
    const Finding finding = cad::findingOf(walls[0], colon, evidence, {});
    EXPECT_EQ(finding.kind, annularKind);
    EXPECT_NEAR(finding.diameterMm, 30.0, 6.0);
    EXPECT_NEAR(finding.heightMm, 10.5, 1.0);
    EXPECT_LT(glm::distance(finding.positionMm, glm::dvec3(0, 0, 115.0)), 4.0);
    EXPECT_NEAR(glm::length(glm::dvec2(finding.wallMm)), 7.0, 1.0);
    // The voxels of its stretch that are tissue, and no others.
    const auto isTissue = [&](glm::ivec3 voxel) {
        const double r = std::hypot(voxel.x - 28.5, voxel.y - 28.5);
        return r < 18.5 && tube.hu.at(voxel) > tube.tissue.airBelowHu;
    };
    std::size_t told = 0, tissue = 0, outside = 0;
    for (const VoxelRun& run : finding.voxels)
        for (int i = 0; i < run.count; ++i, ++told)
            outside += !isTissue(run.first + glm::ivec3(i, 0, 0));
    for (std::size_t n = 0; n < tube.hu.grid().voxelCount(); ++n) {
        const glm::ivec3 voxel = tube.hu.grid().voxelAt(n);
        tissue += voxel.z >= walls[0].fromMm && voxel.z < walls[0].toMm && isTissue(voxel);
    }
    EXPECT_LT(double(outside), 0.01 * double(told)) << "of the wall's surface, half gas";
    EXPECT_NEAR(double(told) / double(tissue), 1.0, 0.1);  // at its ends rays part
}

TEST(AnnularWall, IsTheSameForAnyNumberOfThreads) {
    const auto one = told({}, 1), three = told({}, 3);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t n = 0; n < one.size(); ++n) {
        EXPECT_EQ(one[n].fromMm, three[n].fromMm);
        EXPECT_EQ(one[n].toMm, three[n].toMm);
        EXPECT_EQ(one[n].thicknessMm, three[n].thicknessMm);
        EXPECT_EQ(one[n].samples, three[n].samples);
    }
}

// What is told of a colon without candidates.
Findings findingsOf(const TubeShape& shape, double operatingPoint = 0.0) {
    const RingTube tube(shape);
    const auto colon = tube.colon();
    cad::CadModel model;
    model.operatingPoint = operatingPoint;
    return cad::findingsOf(colon, cad::gatherEvidence(colon, {}), {}, model);
}

TEST(AnnularWall, AShortOneIsAFindingAndALongOneAWarning) {
    const Findings tumour = findingsOf({});
    ASSERT_EQ(tumour.findings.size(), 1u);
    EXPECT_EQ(tumour.findings[0].kind, annularKind);
    EXPECT_NEAR(tumour.findings[0].arcMm, 115.0, 3.0);

    EXPECT_EQ(findingsOf({}, 0.97).findings.size(), 1u) << "whatever point a model operates at";

    const Findings ascites = findingsOf({.thickHu = 8.0});
    EXPECT_TRUE(ascites.findings.empty());
    EXPECT_TRUE(std::ranges::any_of(ascites.warnings, [](const std::string& warning) {
        return warning.find("8 HU at most behind it are fluid's") != std::string::npos;
    }));
    EXPECT_EQ(findingsOf({.thickHu = 28.0}).findings.size(), 1u) << "a tumour that is dark";

    const Findings open = findingsOf({.channelMm = 14.0, .outerMm = 22.5});
    EXPECT_TRUE(open.findings.empty()) << "what lies around a lumen that is not narrowed";
    EXPECT_TRUE(std::ranges::any_of(open.warnings, [](const std::string& warning) {
        return warning.find("but the lumen is 28 mm wide") != std::string::npos;
    }));

    const Findings besideLoops = findingsOf({.aroundHu = -950.0});
    EXPECT_TRUE(besideLoops.findings.empty());
    EXPECT_TRUE(std::ranges::any_of(besideLoops.warnings, [](const std::string& warning) {
        return warning.find("what lies between it and other loops") != std::string::npos;
    }));

    const Findings segment = findingsOf({.fromMm = 80.0, .toMm = 220.0});
    EXPECT_TRUE(segment.findings.empty());
    EXPECT_TRUE(std::ranges::any_of(segment.warnings, [](const std::string& warning) {
        return warning.find("thick all around") != std::string::npos;
    }));
}

}  // namespace
