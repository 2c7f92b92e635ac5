// What nobody has seen of a wall falls into patches, each once and whole.
#include "core/missed_patches.h"

#include "tube_meshes.h"

#include <numeric>

#include <gtest/gtest.h>

namespace haustra {
namespace {

constexpr int around = 48, along = 60;
constexpr double radiusMm = 15.0, heightMm = 120.0;

TriMesh straightTube() {
    return tests::revolvedMesh(around, along, heightMm, [](double) { return radiusMm; });
}

Centerline axis(double fromX = 0.0) {
    Centerline line;
    for (int n = 0; n <= int(heightMm); ++n)
        line.points.push_back({{fromX, 0.0, double(n)}, double(n), radiusMm, false});
    return line;
}

/// Both triangles of square i of ring j.
std::size_t square(int i, int j) {
    return 2 * std::size_t(j * around + (i + around) % around);
}

double areaOf(const TriMesh& mesh, std::size_t triangle) {
    const glm::ivec3 t = mesh.triangles[triangle];
    const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
    return 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                        mesh.vertices[std::size_t(t.z)] - a));
}

struct Scene {
    TriMesh wall = straightTube();
    std::vector<glm::ivec3> neighbours = neighboursOf(wall);
    std::vector<std::uint8_t> seen = std::vector<std::uint8_t>(wall.triangles.size(), 1);
    std::vector<std::uint8_t> bridged = {};
    Centerline line = axis();

    void miss(int i, int j) { seen[square(i, j)] = seen[square(i, j) + 1] = 0; }
    std::vector<MissedPatch> patches() const {
        return missedPatches(wall, neighbours, seen, bridged, line);
    }
};

TEST(MissedPatches, NeighboursAreMutualAndEndAtTheRims) {
    const Scene scene;
    int rims = 0;
    for (std::size_t t = 0; t < scene.neighbours.size(); ++t) {
        for (int side = 0; side < 3; ++side) {
            const int other = scene.neighbours[t][side];
            if (other < 0) {
                ++rims;
                continue;
            }
            const glm::ivec3 back = scene.neighbours[std::size_t(other)];
            EXPECT_TRUE(back.x == int(t) || back.y == int(t) || back.z == int(t));
        }
    }
    EXPECT_EQ(rims, 2 * around);
}

TEST(MissedPatches, ACutAlongASeamPartsNothing) {
    Scene whole;
    for (int i = -3; i < 3; ++i)
        whole.miss(i, 20);
    // The same wall, cut open at turn 0: the seam's vertices are doubled.
    Scene cut = whole;
    const auto doubled = std::int32_t(cut.wall.vertices.size());
    for (int j = 0; j <= along; ++j)
        cut.wall.vertices.push_back(whole.wall.vertices[std::size_t(j * around)]);
    for (int j = 0; j < along; ++j)
        for (const std::size_t t : {square(-1, j), square(-1, j) + 1})
            for (int n = 0; n < 3; ++n)
                if (int& v = cut.wall.triangles[t][n]; v % around == 0) v = doubled + v / around;
    cut.neighbours = neighboursOf(cut.wall);
    EXPECT_EQ(cut.neighbours, whole.neighbours);
    EXPECT_EQ(cut.patches().size(), 1u);
}

TEST(MissedPatches, EachIsWholeOnItsSurfaceAndTheLargestComesFirst) {
    Scene scene;
    scene.miss(0, 10);
    for (int i = 10; i < 16; ++i)
        for (int j = 30; j < 34; ++j)
            scene.miss(i, j);
    const auto patches = scene.patches();
    ASSERT_EQ(patches.size(), 2u);
    double unseen = 0.0, sum = 0.0;
    for (std::size_t t = 0; t < scene.seen.size(); ++t)
        if (!scene.seen[t]) unseen += areaOf(scene.wall, t);
    for (const MissedPatch& patch : patches) {
        sum += patch.areaMm2;
        EXPECT_NEAR(glm::length(glm::dvec2(patch.centerMm)), radiusMm, 0.05) << "on the wall";
        EXPECT_LT(glm::dot(patch.inward, glm::dvec3(glm::dvec2(patch.centerMm), 0.0)),
                  -0.98 * radiusMm);
    }
    EXPECT_NEAR(sum, unseen, 1e-9 * unseen);
    EXPECT_EQ(patches[0].triangles.size(), 48u);
    EXPECT_NEAR(patches[0].arcMm, 64.0, 1.0);
    EXPECT_NEAR(patches[1].arcMm, 21.0, 1.0);
    const double turn = 2.0 * std::numbers::pi * 13.0 / around;
    EXPECT_NEAR(patches[0].centerMm.x, radiusMm * std::cos(turn), 0.05);
    EXPECT_NEAR(patches[0].centerMm.y, radiusMm * std::sin(turn), 0.05);
}

// The centre of a patch that goes all the way around is on the wall, not in the lumen.
TEST(MissedPatches, ARingsCentreIsOnTheRing) {
    Scene scene;
    for (int i = 0; i < around; ++i)
        scene.miss(i, 25);
    const auto patches = scene.patches();
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_NEAR(glm::length(glm::dvec2(patches[0].centerMm)), radiusMm, 0.05);
}

TEST(MissedPatches, OneTriangleBetweenSeenOnesCountsAsSeenTwoDoNot) {
    Scene scene;
    scene.seen[square(5, 5)] = 0;
    EXPECT_TRUE(scene.patches().empty());
    EXPECT_EQ(withoutSingles(scene.neighbours, scene.seen)[square(5, 5)], 1);
    scene.miss(5, 5);
    ASSERT_EQ(scene.patches().size(), 1u);
    EXPECT_EQ(scene.patches()[0].triangles.size(), 2u);
    // Where nothing has been seen there is one patch, the whole wall.
    std::fill(scene.seen.begin(), scene.seen.end(), 0);
    ASSERT_EQ(scene.patches().size(), 1u);
    EXPECT_EQ(scene.patches()[0].triangles.size(), scene.wall.triangles.size());
}

TEST(MissedPatches, BridgesPartPatchesAndBelongToNone) {
    Scene scene;
    for (int j = 10; j < 20; ++j)
        scene.miss(7, j);
    scene.bridged.assign(scene.seen.size(), 0);
    for (int i = 0; i < around; ++i)
        scene.bridged[square(i, 15)] = scene.bridged[square(i, 15) + 1] = 1;
    const auto patches = scene.patches();
    ASSERT_EQ(patches.size(), 2u);
    EXPECT_EQ(patches[0].triangles.size() + patches[1].triangles.size(), 18u);
}

// Another loop of the colon lies against this one, its axis nearer than this one's own.
TEST(MissedPatches, TheArcIsOfTheLoopWhoseWallItIs) {
    Scene scene;
    scene.miss(0, 40);  // at x = radius, z = 81
    Centerline other = axis(radiusMm + 6.0);
    for (CenterlinePoint& point : other.points)
        point.arcMm += 500.0;
    scene.line.points.insert(scene.line.points.end(), other.points.begin(), other.points.end());
    ASSERT_EQ(scene.patches().size(), 1u);
    EXPECT_NEAR(scene.patches()[0].arcMm, 81.0, 1.0);
}

// Past the axis's end, looking away from it: only another loop, far off, lies before it.
TEST(MissedPatches, AWallThatLooksAwayFromItsAxisIsNotOfAFarLoop) {
    Scene scene;
    scene.miss(0, 40);  // at x = radius, z = 81; its inner side is towards smaller x
    scene.line = axis(radiusMm + 6.0);
    Centerline far = axis(-100.0);
    for (CenterlinePoint& point : far.points)
        point.arcMm += 500.0;
    scene.line.points.insert(scene.line.points.end(), far.points.begin(), far.points.end());
    ASSERT_EQ(scene.patches().size(), 1u);
    EXPECT_NEAR(scene.patches()[0].arcMm, 81.0, 1.0);
}

}  // namespace
}  // namespace haustra
