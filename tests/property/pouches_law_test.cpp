// Laws of flat maps of tubes with blind fingers: no fold after rounding, nothing lost, and the wall
// outside the fingers as it would be without all this.
#include "flat_meshes.h"
#include "flatten/tube/disc_embedding.h"
#include "flatten/tube/flattening.h"
#include "flatten/tube/flip_repair.h"
#include "flatten/tube/grid_drawing.h"
#include "flatten/tube/polygon_roll.h"
#include "flatten/tube/pouches.h"
#include "flatten/tube/seam.h"
#include "mesh/halfedge_mesh.h"
#include "pouched_tubes.h"

#include <cstring>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using tests::areaMm2;
using tests::Finger;
using tests::FingeredTube;
using tests::fingeredTube;

constexpr double stepMm = 2.0;

/// Blind fingers from so short that a conformal map has room for them to so long that its tips are
/// e^-80 of their necks.
FingeredTube manyFingers(double shake, unsigned seed) {
    std::vector<Finger> fingers;
    for (int n = 0; n < 24; ++n)
        fingers.push_back({12 * (n % 5) + 2 * (n / 5 % 2), 8 + 9 * (n / 5) + n % 3, 4,
                           2.0 + 0.5 * (n % 5), 5.0 + 12.0 * (n % 7)});
    fingers.push_back({20, 62, 10, 8.0, 240.0});
    return fingeredTube(64, 84, stepMm, fingers, shake, seed);
}

FingeredTube oneFinger(double lengthMm, double shake = 0.1) {
    return fingeredTube(64, 60, stepMm, {{20, 26, 8, 6.0, lengthMm}}, shake);
}

/// A tube with a thread on its wall, as thin as three edges all along, whose beads have narrow
/// necks between them: each cross-section is a triangle of edges that parts the surface. Sections
/// are flattened to a share of their width.
TriMesh threadedTube(int sections, double flatness) {
    TriMesh mesh = fingeredTube(48, 40, stepMm, {}, 0.1).mesh;
    const auto chosen = std::size_t(48 * 2 * 20);  // in the middle of the wall
    const glm::ivec3 foot = mesh.triangles[chosen];
    mesh.triangles.erase(mesh.triangles.begin() + std::ptrdiff_t(chosen));
    const glm::dvec3 at[3] = {mesh.vertices[std::size_t(foot.x)],
                              mesh.vertices[std::size_t(foot.y)],
                              mesh.vertices[std::size_t(foot.z)]};
    const glm::dvec3 middle = (at[0] + at[1] + at[2]) / 3.0;
    const glm::dvec3 out = glm::normalize(glm::cross(at[1] - at[0], at[2] - at[0]));
    const glm::dvec3 thin = glm::normalize(at[1] - at[0]);
    glm::ivec3 ring = foot;
    for (int n = 1; n <= sections; ++n) {
        const double wide = n % 3 == 0 ? 0.9 : 0.3;
        glm::ivec3 next;
        for (int c = 0; c < 3; ++c) {
            glm::dvec3 away = wide * (at[c] - middle);
            away -= (1.0 - flatness) * glm::dot(away, thin) * thin;
            next[c] = int(mesh.vertices.size());
            mesh.vertices.push_back(middle + away + 0.8 * stepMm * n * out);
        }
        for (int c = 0; c < 3; ++c) {
            const int d = (c + 1) % 3;
            mesh.triangles.push_back({ring[c], ring[d], next[d]});
            mesh.triangles.push_back({ring[c], next[d], next[c]});
        }
        ring = next;
    }
    mesh.triangles.push_back(ring);
    return mesh;
}

double flatArea(const FlatMap& map, std::size_t t) {
    const glm::ivec3 corners = map.surface.triangles[t];
    const glm::dvec2 a = map.flat[std::size_t(corners.x)];
    const glm::dvec2 u = map.flat[std::size_t(corners.y)] - a,
                     v = map.flat[std::size_t(corners.z)] - a;
    return 0.5 * (u.x * v.y - u.y * v.x);
}

TEST(Pouches, LeaveNoFoldAfterRounding) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const FingeredTube tube = manyFingers(0.05 * seed, seed);
        const auto made = flattenTube(tube.mesh, 0);
        ASSERT_TRUE(made) << describe(made.error());
        EXPECT_TRUE(foldedTriangles(made->map).empty());
        EXPECT_GT(made->pouches, 0u);
        EXPECT_EQ(made->seamMismatch, 0.0);
        // The strip is covered once, and the surface is all there.
        double flat = 0.0;
        for (std::size_t t = 0; t < made->map.surface.triangles.size(); ++t)
            flat += flatArea(made->map, t);
        EXPECT_NEAR(flat, made->map.height, 1e-9);
        EXPECT_NEAR(areaMm2(made->map.surface), areaMm2(tube.mesh), 1e-6 * areaMm2(tube.mesh));
        std::set<int> sources(made->map.sourceTriangle.begin(), made->map.sourceTriangle.end());
        EXPECT_EQ(sources.size(), tube.mesh.triangles.size());
        EXPECT_GE(*sources.begin(), 0);
        EXPECT_LT(*sources.rbegin(), int(tube.mesh.triangles.size()));
    }
}

TEST(Pouches, AreOnFingersAlone) {
    const FingeredTube tube = manyFingers(0.1, 5);
    const auto made = flattenTube(tube.mesh, 0);
    ASSERT_TRUE(made) << describe(made.error());
    ASSERT_EQ(made->isPouch.size(), made->map.surface.triangles.size());
    double wallMm2 = 0.0, pouchMm2 = 0.0, pouchWallMm2 = 0.0;
    for (std::size_t t = 0; t < made->isPouch.size(); ++t) {
        const double mm2 = areaMm2({made->map.surface.vertices, {made->map.surface.triangles[t]}});
        const bool finger = tube.inFinger[std::size_t(made->map.sourceTriangle[t])];
        if (!finger) wallMm2 += mm2;
        if (made->isPouch[t]) pouchMm2 += mm2;
        if (made->isPouch[t] && !finger) pouchWallMm2 += mm2;
    }
    EXPECT_NEAR(pouchMm2, made->pouchAreaMm2, 1e-6 * pouchMm2);
    EXPECT_LT(pouchWallMm2, 0.02 * wallMm2);
    EXPECT_GT(pouchMm2, 2.0 * std::numbers::pi * 8.0 * 200.0);  // the longest is one
}

/// A tube that a conformal map has room for gets that map, to the bit.
TEST(Pouches, ChangeNothingWhereThereAreNone) {
    for (const double lengthMm : {0.0, 10.0, 30.0}) {
        const TriMesh tube =
            lengthMm > 0.0 ? oneFinger(lengthMm).mesh : fingeredTube(64, 60, stepMm, {}, 0.1).mesh;
        const auto plain = conformalTube(tube, 0);
        const auto made = flattenTube(tube, 0);
        ASSERT_TRUE(plain && made);
        EXPECT_EQ(made->pouches, 0u);
        EXPECT_TRUE(made->isPouch.empty());
        const FlatMap cut = cutAlongSeam(tube, plain->map, made->seam);
        ASSERT_EQ(cut.flat.size(), made->map.flat.size());
        EXPECT_EQ(std::memcmp(cut.flat.data(), made->map.flat.data(),
                              cut.flat.size() * sizeof(glm::dvec2)),
                  0);
        EXPECT_EQ(cut.surface.triangles, made->map.surface.triangles);
        EXPECT_EQ(made->seam, bestSeam(tube, plain->map));
    }
}

/// However thin and long a thread is, the strip covers each place of the plane once.
TEST(Pouches, HoldThreadsOfThreeEdges) {
    for (const int sections : {4, 12, 24, 48, 200}) {
        for (const double flatness : {1.0, 0.02}) {
            const TriMesh tube = threadedTube(sections, flatness);
            const auto made = flattenTube(tube, 0);
            ASSERT_TRUE(made) << sections << " sections: " << describe(made.error());
            EXPECT_TRUE(foldedTriangles(made->map).empty());
            double flat = 0.0;
            for (std::size_t t = 0; t < made->map.surface.triangles.size(); ++t)
                flat += flatArea(made->map, t);
            EXPECT_NEAR(flat, made->map.height, 1e-9);
            EXPECT_NEAR(areaMm2(made->map.surface), areaMm2(tube), 1e-9 * areaMm2(tube));
            EXPECT_TRUE(mesh::HalfedgeMesh::of(made->map.surface));
        }
    }
}

/// A blind pouch as large as the tube that it hangs on, wide and narrow in turn as a colon is: what
/// a centerline's shortcut leaves of one. `neckMm`: the radius where it is narrow.
FingeredTube blindColon(double neckMm) {
    constexpr double radiusMm = 12.0, lengthMm = 800.0, turnMm = 50.0;
    FingeredTube tube = fingeredTube(64, 60, stepMm, {{20, 26, 8, radiusMm, lengthMm}}, 0.05);
    const double angle = 2.0 * std::numbers::pi * 24.0 / 64.0;
    const glm::dvec3 out(std::cos(angle), std::sin(angle), 0.0);
    const glm::dvec3 foot =
        stepMm * 64 / (2.0 * std::numbers::pi) * out + glm::dvec3(0.0, 0.0, stepMm * 30.0);
    for (glm::dvec3& v : tube.mesh.vertices) {
        const double along = glm::dot(v - foot, out);
        if (along < 5.0) continue;
        const double wave = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (along - 5.0) / turnMm);
        const glm::dvec3 axis = foot + along * out;
        v = axis + (1.0 - wave * (1.0 - neckMm / radiusMm)) * (v - axis);
    }
    return tube;
}

/// However large a blind pouch, no triangle is turned over, and the work is in proportion.
TEST(Pouches, MayBeAsLargeAsAColon) {
    for (const double neckMm : {10.0, 4.0}) {
        const FingeredTube tube = blindColon(neckMm);
        const auto pouch = std::ranges::count(tube.inFinger, char(1));
        ASSERT_GT(pouch, 20000);
        const auto made = flattenTube(tube.mesh, 0);
        ASSERT_TRUE(made) << describe(made.error());
        EXPECT_TRUE(foldedTriangles(made->map).empty());
        EXPECT_EQ(made->seamMismatch, 0.0);
        EXPECT_LE(made->pouchWork, 6 * tube.mesh.triangles.size() + 20000);
        double flat = 0.0;
        for (std::size_t t = 0; t < made->map.surface.triangles.size(); ++t)
            flat += flatArea(made->map, t);
        EXPECT_NEAR(flat, made->map.height, 1e-9);
        EXPECT_NEAR(areaMm2(made->map.surface), areaMm2(tube.mesh), 1e-9 * areaMm2(tube.mesh));
    }
}

/// A colon with polyps and diverticula whose centerline takes a shortcut: closed at its far end,
/// with the second hole in its side after `rows` of its 300 rows. The rest is one blind pouch with
/// fingers of its own.
TriMesh passedByColon(int rows, unsigned seed) {
    constexpr int around = 48, along = 300;
    std::vector<Finger> fingers;
    for (int n = 0; n < 60; ++n) {
        const int row = 4 + n / 3 * 14;
        if (row < rows - 8 || row > rows + 8)
            fingers.push_back({16 * (n % 3) + n % 5, row, 4, 2.0 + 0.5 * (n % 4), 3.0 + n % 20});
    }
    TriMesh mesh = fingeredTube(around, along, stepMm, fingers, 0.05, seed).mesh;
    const auto ofHole = [&](const glm::ivec3& t) {
        glm::dvec3 middle(0.0);
        for (int c = 0; c < 3; ++c)
            middle += mesh.vertices[std::size_t(t[c])] / 3.0;
        return middle.x > 0.0 && std::abs(middle.y) < 4.0 &&
               std::abs(middle.z - stepMm * rows) < 4.0;
    };
    std::erase_if(mesh.triangles, ofHole);
    // The far rim: its edges have one triangle each, and lie at the highest z.
    const double end = stepMm * along;
    const auto halfedges = mesh::HalfedgeMesh::of(mesh);
    const int tip = int(mesh.vertices.size());
    for (int h = 0; halfedges && h < halfedges->halfedgeCount(); ++h) {
        const int from = halfedges->origin(h), to = halfedges->target(h);
        if (halfedges->opposite(h) >= 0 || mesh.vertices[std::size_t(from)].z != end ||
            mesh.vertices[std::size_t(to)].z != end)
            continue;
        mesh.triangles.push_back({to, from, tip});
    }
    mesh.vertices.push_back({0.0, 0.0, end + 4.0});
    return mesh;
}

/// What a course passes by lies on the strip without a fold all the same, fingers and all, and the
/// pouch is told for what it is.
TEST(Pouches, MayHaveFingersHoweverLarge) {
    for (const int rows : {5, 8, 20, 120}) {
        const TriMesh tube = passedByColon(rows, unsigned(rows));
        const auto made = flattenTube(tube, 0);
        ASSERT_TRUE(made) << rows << " rows: " << describe(made.error());
        EXPECT_TRUE(foldedTriangles(made->map).empty());
        double flat = 0.0;
        TriMesh beyond{made->map.surface.vertices, {}};
        for (std::size_t t = 0; t < made->map.surface.triangles.size(); ++t) {
            flat += flatArea(made->map, t);
            const glm::ivec3 corners = made->map.surface.triangles[t];
            // More than two circumferences past the hole.
            if (beyond.vertices[std::size_t(corners.x)].z > stepMm * (rows + 100))
                beyond.triangles.push_back(corners);
        }
        EXPECT_NEAR(flat, made->map.height, 1e-9);
        EXPECT_NEAR(areaMm2(made->map.surface), areaMm2(tube), 1e-9 * areaMm2(tube));
        EXPECT_NEAR(made->wallAreaMm2, areaMm2(tube), 1e-9 * areaMm2(tube));
        EXPECT_TRUE(mesh::HalfedgeMesh::of(made->map.surface));
        EXPECT_GE(made->largestPouchMm2, areaMm2(beyond));
        EXPECT_LE(made->largestPouchMm2, made->pouchAreaMm2);
        EXPECT_GT(made->pouches, 0u);
        // It begins near the hole, which is the strip's end.
        EXPECT_NEAR(made->largestPouchY, made->map.height, 0.35);
    }
}

/// Setting a pouch in moves no vertex outside of it.
TEST(Pouches, LeaveTheMapOutsideAsItIs) {
    const TriMesh tube = oneFinger(240.0).mesh;
    ConformalTubeOptions options;
    options.repairFlips = false;
    const auto plain = conformalTube(tube, 0, options);
    ASSERT_TRUE(plain);
    const auto pouches = findPouches(tube, plain->map);
    ASSERT_EQ(pouches.size(), 1u);
    PouchWork work{10 * tube.triangles.size(), 0};
    const SetIn made = setIn(tube, plain->map, pouches, work);
    EXPECT_EQ(made.pouches, 1u);
    std::vector<char> inPouch(tube.triangles.size(), 0);
    for (const int t : pouches[0].triangles)
        inPouch[std::size_t(t)] = 1;
    double outside = 0.0, inside = 0.0;
    for (std::size_t t = 0; t < made.tube.triangles.size(); ++t) {
        const auto source = std::size_t(made.sourceTriangle[t]);
        EXPECT_EQ(made.apart[t], inPouch[source]);
        const glm::dvec2 a = made.map.corner(made.tube, t, 0);
        const glm::dvec2 u = made.map.corner(made.tube, t, 1) - a,
                         v = made.map.corner(made.tube, t, 2) - a;
        (inPouch[source] ? inside : outside) += 0.5 * (u.x * v.y - u.y * v.x);
        if (inPouch[source]) {
            EXPECT_GT(u.x * v.y - u.y * v.x, 0.0);
            continue;
        }
        EXPECT_EQ(made.tube.triangles[t], tube.triangles[source]);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(made.map.flat[std::size_t(made.tube.triangles[t][c])],
                      plain->map.flat[std::size_t(tube.triangles[source][c])]);
        }
    }
    EXPECT_NEAR(inside + outside, made.map.height, 1e-9);
    // As much as a circle that lies within the hole by less than an edge.
    const double radius = pouches[0].radius;
    EXPECT_LT(inside, std::numbers::pi * radius * radius);
    EXPECT_GT(inside, 0.4 * std::numbers::pi * radius * radius);
    EXPECT_TRUE(mesh::HalfedgeMesh::of(made.tube));
    EXPECT_NEAR(areaMm2(made.tube), areaMm2(tube), 1e-9 * areaMm2(tube));
}

/// The wall far from a finger does not tell how long that is.
TEST(Pouches, WallOutsideIsThatOfAShorterFinger) {
    const auto shorter = oneFinger(60.0), longer = oneFinger(300.0);
    const auto a = flattenTube(shorter.mesh, 0), b = flattenTube(longer.mesh, 0);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(b->pouches, 1u);
    const auto wallArea = [](const FingeredTube& tube, const Flattening& flat) {
        double sum = 0.0;
        for (std::size_t t = 0; t < flat.map.surface.triangles.size(); ++t) {
            if (!tube.inFinger[std::size_t(flat.map.sourceTriangle[t])])
                sum += flatArea(flat.map, t);
        }
        return sum;
    };
    EXPECT_NEAR(wallArea(shorter, *a), wallArea(longer, *b), 1e-4 * wallArea(shorter, *a));
    EXPECT_NEAR(a->map.height, b->map.height, 1e-6);
    EXPECT_NEAR(a->outside.angleErrorDegrees.mean, b->outside.angleErrorDegrees.mean, 1.0);
}

TEST(Pouches, AreTheSameForAnyNumberOfThreads) {
    const TriMesh tube = manyFingers(0.1, 7).mesh;
    FlatteningOptions options;
    options.threads = 1;
    const auto one = flattenTube(tube, 0, options);
    options.threads = 2;
    const auto two = flattenTube(tube, 0, options);
    ASSERT_TRUE(one && two);
    ASSERT_EQ(one->map.flat.size(), two->map.flat.size());
    EXPECT_EQ(std::memcmp(one->map.flat.data(), two->map.flat.data(),
                          one->map.flat.size() * sizeof(glm::dvec2)),
              0);
    EXPECT_EQ(one->map.surface.triangles, two->map.surface.triangles);
    EXPECT_EQ(one->map.sourceTriangle, two->map.sourceTriangle);
}

/// Rounding alone turns a triangle over that doubles still hold apart.
TEST(FoldedTriangles, AreThoseOfTheLattice) {
    FlatMap map;
    map.height = 1.0;
    const double unit = 1.0 / flatUnitsPerCircumference(map.height);
    map.surface.vertices.resize(4);
    map.surface.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 2}};
    map.flat = {{0.0, 0.0}, {0.5, 0.0}, {0.25, 0.4 * unit}, {0.25, 0.6 * unit}};
    EXPECT_EQ(foldedTriangles(map), (std::vector<int>{0, 2}));
}

/// Triangles without area on the wall, between the rims' vertices alone, cannot be turned up: such
/// a tube is refused.
TEST(FoldedTriangles, AreNotPublished) {
    TriMesh tube = tests::openTube([](double) { return 10.0; }, 50.0, 48, 39);
    // A splinter along the rim: its three vertices stay on one straight line.
    const int a = tube.triangles[0].x, b = tube.triangles[0].y;
    const int middle = int(tube.vertices.size());
    tube.vertices.push_back(0.5 * (tube.vertices[std::size_t(a)] + tube.vertices[std::size_t(b)]));
    const int apex = tube.triangles[0].z;
    tube.triangles[0] = {a, middle, apex};
    tube.triangles.push_back({middle, b, apex});
    const int outer = int(tube.vertices.size());
    tube.vertices.push_back(0.5 *
                            (tube.vertices[std::size_t(a)] + tube.vertices[std::size_t(middle)]));
    tube.triangles.push_back({a, outer, middle});
    FlatteningOptions options;
    options.placeName = [](const glm::dvec3& at) { return at.z < 2.0 ? "the rim" : "elsewhere"; };
    const auto made = flattenTube(tube, 0, options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::noResult);
    EXPECT_NE(made.error().message.find("1 of the flat map's triangles"), std::string::npos)
        << made.error().message;
    EXPECT_NE(made.error().message.find("the rim"), std::string::npos) << made.error().message;
}

/// Weighting areas keeps every triangle upright, or is given up, and told so: then the strip is the
/// conformal one, to the bit. A weight beyond 1 is one that unifiedFlattening cannot follow.
TEST(AreaWeight, FallsBackToTheConformalStrip) {
    const TriMesh tube = fingeredTube(32, 24, stepMm, {{8, 8, 6, 3.0, 20.0}}, 0.1).mesh;
    const auto plain = flattenTube(tube, 0);
    ASSERT_TRUE(plain);
    for (const double weight : {0.5, 1.5}) {
        FlatteningOptions options;
        options.areaWeight = weight;
        const auto made = flattenTube(tube, 0, options);
        ASSERT_TRUE(made) << describe(made.error());
        EXPECT_TRUE(foldedTriangles(made->map).empty());
        EXPECT_EQ(made->areaWeight, weight <= 1.0 ? weight : 0.0);
        EXPECT_EQ(made->conformal.logAreaDeviation, plain->distortion.logAreaDeviation);
        if (made->areaWeight > 0.0) {
            EXPECT_LT(made->distortion.logAreaDeviation, plain->distortion.logAreaDeviation);
            continue;
        }
        EXPECT_EQ(made->distortion.logAreaDeviation, plain->distortion.logAreaDeviation);
        ASSERT_EQ(made->map.flat.size(), plain->map.flat.size());
        EXPECT_EQ(std::memcmp(made->map.flat.data(), plain->map.flat.data(),
                              plain->map.flat.size() * sizeof(glm::dvec2)),
                  0);
        EXPECT_EQ(made->map.surface.triangles, plain->map.surface.triangles);
    }
}

/// A strip of `around` × `rows` shaken quadrilaterals with a tip beyond it.
struct RolledStrip {
    TriMesh disc;
    PeriodicMap map;
    std::vector<double> angles;
    int tip = 0;
};

RolledStrip shakenStrip(int around, int rows, std::mt19937& random) {
    std::uniform_real_distribution<double> shake(-0.3, 0.3);
    RolledStrip made;
    made.map.height = double(rows) / around;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < around; ++i) {
            const double x = (i + 0.5 + (j % 3 == 0 ? 0.0 : shake(random))) / around;
            const double y = (j + (j == 0 || j == rows ? 0.0 : shake(random))) / around;
            made.map.flat.push_back({x, j == rows ? made.map.height : y});
            made.disc.vertices.push_back({x, y, 0.0});
        }
    }
    made.tip = int(made.map.flat.size());
    made.disc.vertices.push_back({0.5, made.map.height + 1.0, 0.0});
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < around; ++i) {
            const int next = (i + 1) % around;
            const auto wrap = std::int8_t(next == 0);
            const int a = j * around + i, b = j * around + next, c = a + around, d = b + around;
            made.disc.triangles.push_back({a, b, d});
            made.map.turns.push_back({0, wrap, wrap});
            made.disc.triangles.push_back({a, d, c});
            made.map.turns.push_back({0, wrap, 0});
        }
    }
    for (int i = 0; i < around; ++i)
        made.disc.triangles.push_back(
            {rows * around + i, rows * around + (i + 1) % around, made.tip});
    for (int i = 0; i < around; ++i)
        made.angles.push_back(2.0 * std::numbers::pi * (i + 0.3 * shake(random)) / around);
    return made;
}

/// However many rows and however few edges they have: nothing folds, the pieces fill the polygon
/// that their rim is, and each triangle is all there. No figure here depends on how long the strip
/// is.
TEST(PolygonRoll, FoldsNothing) {
    std::mt19937 random(3);
    for (const auto& [around, rows] : {std::pair{3, 400}, std::pair{4, 30}, std::pair{7, 1500},
                                       std::pair{12, 300}, std::pair{60, 400}}) {
        const RolledStrip strip = shakenStrip(around, rows, random);
        const auto rolled = rollAsPolygon(strip.disc, strip.map, strip.tip, strip.angles);
        ASSERT_TRUE(rolled) << around << " around";
        const auto at = [&](int v) { return rolled->places[std::size_t(v)]; };
        double area = 0.0, rim = 0.0;
        for (std::size_t t = 0; t < rolled->disc.triangles.size(); ++t) {
            const glm::ivec3 c = rolled->disc.triangles[t];
            const glm::dvec2 u = at(c.y) - at(c.x), v = at(c.z) - at(c.x);
            EXPECT_GT(u.x * v.y - u.y * v.x, 0.0) << around << " around, triangle " << t;
            area += 0.5 * (u.x * v.y - u.y * v.x);
        }
        for (int i = 0; i < around; ++i) {
            const glm::dvec2 from = at(i), to = at((i + 1) % around);
            rim += 0.5 * (from.x * to.y - from.y * to.x);
            EXPECT_LE(glm::length(from), 1.0 + 1e-12);
        }
        EXPECT_NEAR(area, rim, 1e-12);
        EXPECT_TRUE(mesh::HalfedgeMesh::of(rolled->disc));
        const std::set<int> sources(rolled->sourceTriangle.begin(), rolled->sourceTriangle.end());
        EXPECT_EQ(sources.size(), strip.disc.triangles.size());
        EXPECT_LT(rolled->disc.triangles.size(), 5 * strip.disc.triangles.size() + 1000);
    }
}

/// embedDisc gives back a target without folds, and undoes those of another.
TEST(EmbedDisc, KeepsTheTargetAndUnfolds) {
    constexpr int side = 12;
    std::vector<glm::ivec3> triangles;
    std::vector<glm::dvec2> target;
    // Rings around the middle, numbered from outside in.
    std::vector<int> first(side + 1);
    for (int r = side; r >= 1; --r) {
        first[std::size_t(r)] = int(target.size());
        for (int n = 0; n < 6 * side; ++n) {
            const double angle = 2.0 * std::numbers::pi * n / (6 * side);
            target.push_back(double(r) / side * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
    }
    const int middle = int(target.size());
    target.push_back({0.0, 0.0});
    for (int r = side; r >= 1; --r) {
        for (int n = 0; n < 6 * side; ++n) {
            const int a = first[std::size_t(r)] + n,
                      b = first[std::size_t(r)] + (n + 1) % (6 * side);
            if (r == 1) {
                triangles.push_back({a, b, middle});
                continue;
            }
            const int c = first[std::size_t(r - 1)] + n,
                      d = first[std::size_t(r - 1)] + (n + 1) % (6 * side);
            triangles.push_back({a, b, d});
            triangles.push_back({a, d, c});
        }
    }
    const std::vector<glm::dvec2> border(target.begin(), target.begin() + 6 * side);
    const auto same = embedDisc(triangles, border, target);
    ASSERT_TRUE(same);
    for (std::size_t v = 0; v < target.size(); ++v)
        EXPECT_LT(glm::distance((*same)[v], target[v]), 1e-10);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
    std::vector<glm::dvec2> folded = target;
    for (std::size_t v = border.size(); v < folded.size(); ++v) {
        if (random() % 3 == 0) folded[v] = {anywhere(random), anywhere(random)};
    }
    const auto unfolded = embedDisc(triangles, border, folded);
    ASSERT_TRUE(unfolded);
    for (const glm::ivec3& t : triangles) {
        const glm::dvec2 a = (*unfolded)[std::size_t(t.x)];
        const glm::dvec2 u = (*unfolded)[std::size_t(t.y)] - a,
                         v = (*unfolded)[std::size_t(t.z)] - a;
        EXPECT_GT(u.x * v.y - u.y * v.x, 0.0);
    }
}

/// Triangulations of a triangle: vertices set into triangles, and edges flipped where they may be.
std::vector<glm::ivec3> randomTriangulation(int vertices, int flips, std::mt19937& random) {
    std::vector<glm::ivec3> triangles{{0, 1, 2}};
    std::set<std::pair<int, int>> edges{{0, 1}, {1, 2}, {0, 2}};
    for (int v = 3; v < vertices; ++v) {
        const std::size_t n = random() % triangles.size();
        const glm::ivec3 t = triangles[n];
        triangles[n] = {t.x, t.y, v};
        triangles.push_back({t.y, t.z, v});
        triangles.push_back({t.z, t.x, v});
        for (int c = 0; c < 3; ++c)
            edges.insert({t[c], v});
    }
    for (int flip = 0; flip < flips; ++flip) {
        glm::ivec3& one = triangles[random() % triangles.size()];
        const int c = int(random() % 3), a = one[c], b = one[(c + 1) % 3], p = one[(c + 2) % 3];
        for (glm::ivec3& other : triangles) {
            for (int d = 0; d < 3; ++d) {
                const int q = other[(d + 2) % 3];
                if (other[d] != b || other[(d + 1) % 3] != a) continue;
                if (!edges.insert(std::minmax(p, q)).second) continue;
                edges.erase(std::minmax(a, b));
                one = {a, q, p};
                other = {q, b, p};
                d = 3;
            }
        }
    }
    return triangles;
}

TEST(GridDrawing, IsUprightForAnyTriangulation) {
    std::mt19937 random(11);
    const auto check = [](const std::vector<glm::ivec3>& triangles, int vertices) {
        const auto drawn = drawOnGrid(triangles, vertices);
        ASSERT_TRUE(drawn);
        for (const glm::ivec3& at : *drawn) {
            EXPECT_TRUE(at.x >= 0 && at.y >= 0 && at.z >= 0);
            EXPECT_EQ(at.x + at.y + at.z, vertices - 1);
        }
        for (const glm::ivec3& t : triangles) {
            const glm::ivec3 a = (*drawn)[std::size_t(t.x)];
            const glm::ivec3 u = (*drawn)[std::size_t(t.y)] - a, v = (*drawn)[std::size_t(t.z)] - a;
            EXPECT_GT(u.x * v.y - u.y * v.x, 0);
        }
    };
    for (int n = 0; n < 100; ++n) {
        const int vertices = 3 + int(random() % 120);
        check(randomTriangulation(vertices, n % 2 ? 200 : 0, random), vertices);
    }
    // Triangles in triangles, which embeddings by means shrink by a factor each.
    constexpr int nested = 200;
    std::vector<glm::ivec3> tower;
    for (int n = 0; n < nested; ++n) {
        for (int c = 0; c < 3; ++c) {
            const int d = (c + 1) % 3;
            tower.push_back({3 * n + c, 3 * n + d, 3 * n + 3 + d});
            tower.push_back({3 * n + c, 3 * n + 3 + d, 3 * n + 3 + c});
        }
    }
    tower.push_back({3 * nested, 3 * nested + 1, 3 * nested + 2});
    check(tower, 3 * nested + 3);
}

/// What is no triangulation of a triangle is told.
TEST(GridDrawing, RefusesWhatIsNoTriangulation) {
    EXPECT_TRUE(drawOnGrid({{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, 4));
    EXPECT_FALSE(drawOnGrid({{0, 1, 3}, {1, 2, 3}}, 4));             // a part is missing
    EXPECT_FALSE(drawOnGrid({{0, 1, 3}, {0, 1, 3}, {2, 0, 3}}, 4));  // one is there twice
    EXPECT_FALSE(drawOnGrid({{0, 1, 2}}, 4));                        // a vertex without a triangle
}

}  // namespace
}  // namespace haustra::flatten
