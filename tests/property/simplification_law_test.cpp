// Laws of simplification: topology and embedding kept, the distance bounded both ways, corners not
// sharpened, the same mesh for any number of threads.
#include "contouring/dual_contouring.h"
#include "data_folder.h"
#include "handles/self_intersection.h"
#include "mesh/mesh_file.h"
#include "mesh_laws.h"
#include "simplification/simplification.h"
#include "surface_measure.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

using simplification::SimplificationOptions;
using simplification::simplify;

/// The surface where `depthMm` is 0, as a scan of a smooth wall with noise shows it.
TriMesh contoured(glm::ivec3 size, double noiseHu,
                  const std::function<double(glm::dvec3)>& depthMm) {
    const Grid grid = axisAlignedGrid(size, {0.75, 0.75, 1.0}, {-100.0, 20.0, 300.0});
    Volume<std::int16_t> hu(grid);
    Volume<std::uint8_t> inside(grid);
    std::mt19937 random(5);
    const glm::dvec3 center = glm::dvec3(size - 1) * 0.5 * glm::dvec3(0.75, 0.75, 1.0);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = glm::dvec3(grid.voxelAt(n)) * glm::dvec3(0.75, 0.75, 1.0) - center;
        const double depth = depthMm(p);
        const double noise = noiseHu * (double(random() % 2001) / 1000.0 - 1.0);
        hu.writable()[n] = std::int16_t(-480.0 - 520.0 * std::tanh(depth / 0.9) + noise);
        inside.writable()[n] = depth > 0.0 ? 1 : 0;
    }
    const auto mesh = contouring::contourLumen(hu, inside, -480.0);
    EXPECT_TRUE(mesh) << describe(mesh.error());
    return mesh ? *mesh : TriMesh{};
}

TriMesh ball(double noiseHu = 0.0) {
    return contoured({42, 42, 34}, noiseHu,
                     [](const glm::dvec3& p) { return 13.0 - glm::length(p); });
}

TriMesh torus(double noiseHu = 0.0) {
    return contoured({52, 52, 20}, noiseHu, [](const glm::dvec3& p) {
        return 5.0 - glm::length(glm::dvec2(glm::length(glm::dvec2(p)) - 11.0, p.z));
    });
}

/// So large that several regions are worked on at once.
TriMesh largeTorus(double noiseHu) {
    return contoured({80, 80, 30}, noiseHu, [](const glm::dvec3& p) {
        return 8.0 - glm::length(glm::dvec2(glm::length(glm::dvec2(p)) - 18.0, p.z));
    });
}

/// Two balls with less than a voxel of wall between them, beside a thin fold.
TriMesh closeWalls() {
    return contoured({60, 36, 28}, 20.0, [](const glm::dvec3& p) {
        const double left = 8.0 - glm::length(p + glm::dvec3(8.4, 0.0, 0.0));
        const double right = 8.0 - glm::length(p - glm::dvec3(8.4, 0.0, 0.0));
        const double fold = std::max(std::abs(p.x - 9.0) - 0.8, p.y);
        return std::min(std::max(left, right), fold);
    });
}

/// A ball with sheets of wall in it, as thin as a voxel and no further apart.
TriMesh thinSheets() {
    return contoured({48, 48, 36}, 60.0, [](const glm::dvec3& p) {
        const double wave = p.x + 1.5 * std::sin(0.5 * p.y) * std::cos(0.4 * p.z);
        const double sheet = 0.45 - std::abs(wave - 2.4 * std::round(wave / 2.4));
        return std::min(15.0 - glm::length(p), -std::min(sheet, 11.0 - glm::length(p)));
    });
}

void expectLaws(const TriMesh& before, const TriMesh& after, double errorMm) {
    const MeshTopology was = meshTopology(before), is = meshTopology(after);
    EXPECT_TRUE(is.closed());
    EXPECT_TRUE(tests::everyVertexHasOneFan(after));
    EXPECT_EQ(is.eulerCharacteristic, was.eulerCharacteristic);
    EXPECT_EQ(is.components, was.components);
    EXPECT_EQ(handles::selfIntersections(after).size(), 0u);
    EXPECT_LE(after.triangles.size(), before.triangles.size());

    const tests::SurfaceDistance toBefore(before), toAfter(after);
    const auto vertices = tests::sortedDistances(before.vertices, toAfter);
    EXPECT_LE(vertices.back(), errorMm);
    EXPECT_LE(tests::sortedDistances(after.vertices, toBefore).back(), errorMm);
    std::vector<glm::dvec3> centers;
    for (const glm::ivec3& t : before.triangles) {
        const glm::dvec3 &a = before.vertices[t.x], &b = before.vertices[t.y],
                         &c = before.vertices[t.z];
        centers.insert(centers.end(),
                       {(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)});
    }
    EXPECT_LE(tests::sortedDistances(centers, toAfter).back(), errorMm);

    // Between the samples nothing is promised, but little is lost.
    for (const auto& distances : {tests::sortedDistances(tests::samplesOn(before, 0.5), toAfter),
                                  tests::sortedDistances(tests::samplesOn(after, 0.4), toBefore)}) {
        EXPECT_LE(distances[distances.size() * 995 / 1000], errorMm);
        EXPECT_LE(distances.back(), 2.0 * errorMm);
    }
}

TEST(SimplificationLaw, HoldsForSmoothAndNoisyWalls) {
    const std::pair<const char*, TriMesh> meshes[] = {{"ball", ball()},
                                                      {"noisy ball", ball(60.0)},
                                                      {"torus", torus()},
                                                      {"noisy torus", torus(60.0)},
                                                      {"close walls", closeWalls()}};
    for (const auto& [name, mesh] : meshes) {
        for (const double errorMm : {0.05, 0.1, 0.2}) {
            SCOPED_TRACE(testing::Message() << name << " at " << errorMm << " mm");
            const auto simple = simplify(mesh, {.errorMm = errorMm});
            ASSERT_TRUE(simple) << describe(simple.error());
            expectLaws(mesh, *simple, errorMm);
        }
    }
}

TEST(SimplificationLaw, ThinSheetsStayApartWhereTheBoundIsAsWideAsThey) {
    const TriMesh mesh = thinSheets();
    ASSERT_EQ(handles::selfIntersections(mesh).size(), 0u);
    for (const double errorMm : {0.2, 0.5, 1.0}) {
        SCOPED_TRACE(errorMm);
        const auto simple = simplify(mesh, {.errorMm = errorMm});
        ASSERT_TRUE(simple) << describe(simple.error());
        EXPECT_TRUE(meshTopology(*simple).closed());
        EXPECT_EQ(meshTopology(*simple).eulerCharacteristic,
                  meshTopology(mesh).eulerCharacteristic);
        EXPECT_EQ(handles::selfIntersections(*simple).size(), 0u);
        EXPECT_LT(simple->triangles.size(), mesh.triangles.size() / 4);
    }
}

TEST(SimplificationLaw, ALooserBoundGivesFewerTriangles) {
    const TriMesh mesh = torus(30.0);
    std::size_t last = mesh.triangles.size();
    for (const double errorMm : {0.02, 0.05, 0.1, 0.2, 0.4}) {
        const auto simple = simplify(mesh, {.errorMm = errorMm});
        ASSERT_TRUE(simple);
        EXPECT_LT(simple->triangles.size(), last) << errorMm;
        last = simple->triangles.size();
    }
    EXPECT_LT(last, mesh.triangles.size() / 20);
}

TEST(SimplificationLaw, SharpCornersBecomeFewer) {
    const TriMesh mesh = ball(60.0);
    const auto simple = simplify(mesh, {.errorMm = 0.1});
    ASSERT_TRUE(simple);
    const auto before = tests::sortedSmallestAngles(mesh);
    const auto after = tests::sortedSmallestAngles(*simple);
    EXPECT_GE(after.front(), std::min(5.0, before.front()));
    const auto sharp = std::lower_bound(after.begin(), after.end(), 12.0) - after.begin();
    EXPECT_LE(double(sharp), 0.01 * double(after.size()));
}

TEST(SimplificationLaw, TheThreadsDoNotShow) {
    const TriMesh mesh = largeTorus(30.0);
    ASSERT_GT(mesh.vertices.size(), 10000u);
    const auto one = simplify(mesh, {.errorMm = 0.1, .threads = 1});
    const auto four = simplify(mesh, {.errorMm = 0.1, .threads = 4});
    ASSERT_TRUE(one && four);
    EXPECT_EQ(one->vertices, four->vertices);
    EXPECT_EQ(one->triangles, four->triangles);
}

TEST(SimplificationLaw, WhereAMeshIsDoesNotShow) {
    const TriMesh mesh = largeTorus(80.0);
    TriMesh moved = mesh;
    for (glm::dvec3& v : moved.vertices)
        v += glm::dvec3(-211.3, 17.7, 0.1);  // by what no binary fraction is
    const auto here = simplify(mesh), there = simplify(moved);
    ASSERT_TRUE(here && there);
    ASSERT_EQ(here->vertices.size(), there->vertices.size());
    EXPECT_EQ(here->triangles, there->triangles);
    for (std::size_t v = 0; v < here->vertices.size(); ++v)
        ASSERT_LT(glm::distance(here->vertices[v] - here->vertices[0],
                                there->vertices[v] - there->vertices[0]),
                  1e-9);
}

TEST(SimplificationLaw, RefusesWhatIsNotClosedAndManifold) {
    const TriMesh mesh = ball();
    TriMesh open = mesh;
    open.triangles.pop_back();
    EXPECT_FALSE(simplify(open));

    TriMesh doubled = mesh;
    doubled.triangles.push_back(mesh.triangles[0]);
    doubled.triangles.push_back({mesh.triangles[0].y, mesh.triangles[0].x, mesh.triangles[0].z});
    EXPECT_FALSE(simplify(doubled));

    TriMesh beyond = mesh;
    beyond.triangles[7].y = int(mesh.vertices.size());
    EXPECT_FALSE(simplify(beyond));

    TriMesh pinched = mesh;  // two balls that share one vertex
    for (const glm::dvec3& v : mesh.vertices)
        pinched.vertices.push_back(v + glm::dvec3(100.0, 0.0, 0.0));
    for (glm::ivec3 t : mesh.triangles) {
        t += int(mesh.vertices.size());
        for (int k = 0; k < 3; ++k) {
            if (t[k] == int(mesh.vertices.size())) t[k] = 0;
        }
        pinched.triangles.push_back(t);
    }
    EXPECT_FALSE(simplify(pinched));

    TriMesh infinite = mesh;
    infinite.vertices[3].x = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(simplify(infinite));
}

TEST(SimplificationLaw, KeepsTheSmallestSolids) {
    TriMesh tetrahedron;
    tetrahedron.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    const auto simple = simplify(tetrahedron, {.errorMm = 1.0});
    ASSERT_TRUE(simple);
    EXPECT_EQ(simple->triangles.size(), 4u);
    EXPECT_EQ(meshTopology(*simple).eulerCharacteristic, 2);
    EXPECT_TRUE(simplify(TriMesh{}));
}

TEST(SimplificationLaw, KeepsTheGenusOfARealColon) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const auto mesh = mesh::readMesh(file);
    ASSERT_TRUE(mesh) << describe(mesh.error());
    const auto simple = simplify(*mesh, {.errorMm = 0.1});
    ASSERT_TRUE(simple) << describe(simple.error());
    EXPECT_EQ(meshTopology(*simple).genus(), 1);
    expectLaws(*mesh, *simple, 0.1);
}

}  // namespace
}  // namespace haustra
