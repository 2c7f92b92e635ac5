// Self-intersections against cases known by construction and CGAL's own answer on meshes.
#include "handles/self_intersection.h"

#include <algorithm>
#include <random>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

namespace haustra {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

TriMesh tetrahedron(glm::dvec3 at, double size) {
    TriMesh mesh;
    mesh.vertices = {at, at + glm::dvec3(size, 0, 0), at + glm::dvec3(0, size, 0),
                     at + glm::dvec3(0, 0, size)};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
}

TriMesh together(TriMesh a, const TriMesh& b) {
    const int shift = int(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const glm::ivec3& t : b.triangles)
        a.triangles.push_back(t + shift);
    return a;
}

TEST(SelfIntersection, SolidsApartHaveNone) {
    const TriMesh one = tetrahedron({0, 0, 0}, 1.0);
    EXPECT_TRUE(handles::selfIntersections(one).empty());
    EXPECT_TRUE(handles::selfIntersections(together(one, tetrahedron({2, 0, 0}, 1.0))).empty());
}

TEST(SelfIntersection, FindsSolidsThatOverlapOrTouch) {
    const TriMesh one = tetrahedron({0, 0, 0}, 1.0);
    EXPECT_FALSE(
        handles::selfIntersections(together(one, tetrahedron({0.1, 0.1, -0.1}, 1.0))).empty());
    // A corner that just touches, and the least that does not.
    EXPECT_FALSE(handles::selfIntersections(together(one, tetrahedron({1, 0, 0}, 1.0))).empty());
    const double after = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(handles::selfIntersections(together(one, tetrahedron({after, 0, 0}, 1.0))).empty());
}

TEST(SelfIntersection, FindsTrianglesFoldedOverEachOther) {
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.7, 0}, {0.5, 0.7, 1e-300}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(handles::selfIntersections(mesh), (Pairs{{0, 1}}));
    mesh.triangles[1].z = 4;  // out of the plane by the least: they share their side alone
    EXPECT_TRUE(handles::selfIntersections(mesh).empty());
}

TEST(SelfIntersection, FindsTrianglesThatMeetBeyondACommonCorner) {
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, -1}, {0.5, 0.5, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    EXPECT_EQ(handles::selfIntersections(mesh), (Pairs{{0, 1}}));
    mesh.vertices[3] = {-0.5, -0.5, -1}, mesh.vertices[4] = {-0.5, -0.5, 1};
    EXPECT_TRUE(handles::selfIntersections(mesh).empty());
}

TEST(SelfIntersection, FindsTrianglesWithoutAreaAndTwins) {
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 3}};
    EXPECT_EQ(handles::selfIntersections(mesh), (Pairs{{0, 0}, {1, 2}}));
}

TEST(SelfIntersection, AgreesWithCgalOnCrumpledSheets) {
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
    std::mt19937 random(1);
    std::size_t found = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        constexpr int side = 14;
        TriMesh mesh;
        CGAL::Surface_mesh<Point> sheet;
        for (int n = 0; n < side * side; ++n) {
            auto jitter = [&] { return double(random() % 1000) / 1000.0 * (0.5 + 0.1 * repeat); };
            const glm::dvec3 p(n % side + jitter(), n / side + jitter(), jitter());
            mesh.vertices.push_back(p);
            sheet.add_vertex(Point(p.x, p.y, p.z));
        }
        for (int n = 0; n < side * side; ++n) {
            if (n % side == side - 1 || n / side == side - 1) continue;
            mesh.triangles.push_back({n, n + 1, n + side});
            mesh.triangles.push_back({n + 1, n + side + 1, n + side});
        }
        using Vertex = CGAL::Surface_mesh<Point>::Vertex_index;
        for (const glm::ivec3& t : mesh.triangles)
            sheet.add_face(Vertex(t.x), Vertex(t.y), Vertex(t.z));
        std::vector<
            std::pair<CGAL::Surface_mesh<Point>::Face_index, CGAL::Surface_mesh<Point>::Face_index>>
            faces;
        CGAL::Polygon_mesh_processing::self_intersections(sheet, std::back_inserter(faces));
        Pairs expected;
        for (const auto& [a, b] : faces)
            expected.emplace_back(std::minmax(int(a), int(b)));
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(handles::selfIntersections(mesh), expected);
        found += expected.size();
    }
    EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace haustra
