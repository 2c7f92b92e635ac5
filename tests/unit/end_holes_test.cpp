// Laws of the two end holes: a tube is left, its rims are smooth loops of the length asked for, and
// all else is the surface as it was.
#include "flatten/tube/end_holes.h"

#include "data_folder.h"
#include "flat_meshes.h"
#include "flatten/tube/rim_cut.h"
#include "handle_meshes.h"
#include "handles/handle_removal.h"
#include "mesh/halfedge_mesh.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using tests::areaMm2;
using tests::capsule;

/// The boundary loops, as vertices in order.
std::vector<std::vector<int>> rimsOf(const TriMesh& mesh) {
    const auto halfedges = mesh::HalfedgeMesh::of(mesh).value();
    std::map<int, int> next;
    for (int h = 0; h < halfedges.halfedgeCount(); ++h) {
        if (halfedges.opposite(h) < 0) next[halfedges.origin(h)] = halfedges.target(h);
    }
    std::vector<std::vector<int>> rims;
    while (!next.empty()) {
        std::vector<int>& rim = rims.emplace_back();
        for (int v = next.begin()->first; next.count(v);) {
            rim.push_back(v);
            const int to = next.at(v);
            next.erase(v);
            v = to;
        }
    }
    return rims;
}

double lengthMm(const TriMesh& mesh, const std::vector<int>& rim) {
    double sum = 0.0;
    for (std::size_t n = 0; n < rim.size(); ++n) {
        sum += glm::distance(mesh.vertices[std::size_t(rim[n])],
                             mesh.vertices[std::size_t(rim[(n + 1) % rim.size()])]);
    }
    return sum;
}

void expectTube(const TriMesh& closed, const PunchedTube& punched) {
    const TriMesh& tube = punched.tube;
    const auto halfedges = mesh::HalfedgeMesh::of(tube);
    ASSERT_TRUE(halfedges) << describe(halfedges.error());
    const MeshTopology topology = meshTopology(tube);
    EXPECT_EQ(topology.eulerCharacteristic, 0);
    EXPECT_EQ(topology.components, 1);
    const auto rims = rimsOf(tube);
    ASSERT_EQ(rims.size(), 2u);
    std::set<int> used;
    for (const glm::ivec3& t : tube.triangles)
        used.insert({t.x, t.y, t.z});
    EXPECT_EQ(used.size(), tube.vertices.size());

    // The first loop is the first end's.
    const bool swapped =
        std::find(rims[0].begin(), rims[0].end(), punched.firstLoop) == rims[0].end();
    std::set<int> onRim;
    for (int end = 0; end < 2; ++end) {
        const auto& rim = rims[std::size_t(swapped ? 1 - end : end)];
        EXPECT_NEAR(lengthMm(tube, rim), punched.rimLengthMm[end], 1e-9);
        onRim.insert(rim.begin(), rim.end());
    }
    EXPECT_TRUE(onRim.count(punched.firstLoop));
    // A triangle with all corners on a rim would be flattened to a line.
    for (const glm::ivec3& t : tube.triangles)
        EXPECT_FALSE(onRim.count(t.x) && onRim.count(t.y) && onRim.count(t.z));

    ASSERT_EQ(punched.sourceTriangle.size(), tube.triangles.size());
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const glm::ivec3 c = tube.triangles[t],
                         s = closed.triangles.at(std::size_t(punched.sourceTriangle[t]));
        const glm::dvec3 a = tube.vertices[std::size_t(c.x)], o = closed.vertices[std::size_t(s.x)];
        const glm::dvec3 normal =
            glm::cross(tube.vertices[std::size_t(c.y)] - a, tube.vertices[std::size_t(c.z)] - a);
        const glm::dvec3 old = glm::cross(closed.vertices[std::size_t(s.y)] - o,
                                          closed.vertices[std::size_t(s.z)] - o);
        EXPECT_GT(glm::dot(normal, old), 0.0);
    }
}

glm::dvec3 up{0.0, 0.0, 1.0}, down{0.0, 0.0, -1.0};

PunchedTube punch(const TriMesh& mesh, glm::dvec3 a, glm::dvec3 b, double rimMm,
                  glm::dvec3 outA = down, glm::dvec3 outB = up) {
    const glm::dvec3 ends[2] = {a, b}, outwards[2] = {outA, outB};
    auto punched = punchEnds(mesh, ends, outwards, {rimMm});
    EXPECT_TRUE(punched) << describe(punched.error());
    return punched.value_or(PunchedTube{});
}

TEST(EndHoles, OfABallAreRoundAndOfTheLengthAskedFor) {
    const double radiusMm = 20.0;
    const TriMesh closed = tests::HandledSphere(radiusMm, 40).mesh();
    for (const double rimMm : {4.0, 8.0, 15.0, 40.0}) {
        SCOPED_TRACE(rimMm);
        const PunchedTube punched = punch(closed, {0, 0, -1}, {0, 0, 1}, rimMm);
        expectTube(closed, punched);
        const double rim = rimMm / (2.0 * std::numbers::pi), z = std::sqrt(400.0 - rim * rim);
        for (const auto& loop : rimsOf(punched.tube)) {
            for (const int v : loop) {
                const glm::dvec3 p = punched.tube.vertices[std::size_t(v)];
                EXPECT_NEAR(glm::length(glm::dvec2(p)), rim, 0.1 * rim);
                EXPECT_NEAR(std::abs(p.z), z, 0.1);
            }
        }
        const double cap = 2.0 * std::numbers::pi * radiusMm * (radiusMm - z);
        for (int end = 0; end < 2; ++end) {
            EXPECT_NEAR(punched.rimLengthMm[end], rimMm, 0.03 * rimMm);
            EXPECT_NEAR(punched.capAreaMm2[end], cap, 0.15 * cap);  // the shortest is a hexagon
        }
        EXPECT_LT(punched.tube.vertices[std::size_t(punched.firstLoop)].z, 0.0);
        EXPECT_GT(tests::leastAngleDegrees(punched.tube), 15.0);
        // Nothing else has changed.
        EXPECT_NEAR(areaMm2(punched.tube) + punched.capAreaMm2[0] + punched.capAreaMm2[1],
                    areaMm2(closed), 1e-6);
    }
}

TEST(EndHoles, FarFromTheRimsEveryTriangleIsTheOneItWas) {
    const TriMesh closed = capsule(20.0, 60.0, 60);
    const PunchedTube punched = punch(closed, {0, 0, 10}, {0, 0, 50}, 15.0);
    std::size_t near = 0;
    for (std::size_t t = 0; t < punched.tube.triangles.size(); ++t) {
        const glm::ivec3 c = punched.tube.triangles[t],
                         s = closed.triangles[std::size_t(punched.sourceTriangle[t])];
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 was = closed.vertices[std::size_t(s[corner])];
            if (glm::length(glm::dvec2(was)) < 6.0 && (was.z < 0.0 || was.z > 60.0)) {
                ++near;
                break;
            }
            EXPECT_EQ(punched.tube.vertices[std::size_t(c[corner])], was);
        }
    }
    EXPECT_GT(near, 100u);
    EXPECT_LT(near, punched.tube.triangles.size() / 5);
}

// Wherever the ends are, however uneven the triangles.
TEST(EndHoles, LeaveATubeAnywhereOnAShakenSurface) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> angle(-3.0, 3.0);
    for (unsigned seed = 0; seed < 12; ++seed) {
        const TriMesh closed = tests::shaken(capsule(20.0, 60.0, 48), seed % 3 * 0.35, seed);
        const glm::dvec3 a{std::cos(angle(random)), std::sin(angle(random)), 0.0},
            b{std::cos(angle(random)), std::sin(angle(random)), 0.3};
        for (const double rimMm : {3.0, 15.0, 30.0}) {
            SCOPED_TRACE(testing::Message() << seed << ", " << rimMm << " mm");
            const PunchedTube punched =
                punch(closed, {0, 0, 5}, {0, 0, 55}, rimMm, a, glm::normalize(b));
            expectTube(closed, punched);
            for (int end = 0; end < 2; ++end)
                EXPECT_NEAR(punched.rimLengthMm[end], rimMm, 0.15 * rimMm);
        }
    }
}

TEST(EndHoles, AreWhereTheCenterlineLooksOrNearestToItsEnd) {
    const TriMesh closed = capsule(20.0, 60.0, 60);
    const auto firstRim = [&](glm::dvec3 end, glm::dvec3 outward) {
        const PunchedTube punched = punch(closed, end, {0, 0, 70}, 15.0, outward, up);
        return punched.tube.vertices[std::size_t(punched.firstLoop)];
    };
    EXPECT_LT(glm::distance(firstRim({0, 0, 20}, down), {0, 0, -20}), 4.0);
    EXPECT_LT(glm::distance(firstRim({0, 0, 20}, {1, 0, 0}), {20, 0, 20}), 4.0);
    EXPECT_LT(glm::distance(firstRim({0, -3, 20}, {0, 0, 0}), {0, -20, 20}), 4.0);
    // From outside it looks into the surface or past it.
    EXPECT_LT(glm::distance(firstRim({0, 0, -50}, up), {0, 0, -20}), 4.0);
    EXPECT_LT(glm::distance(firstRim({0, 0, -50}, down), {0, 0, -20}), 4.0);
}

TEST(EndHoles, OfANarrowEndReachNoFartherThanTheyMay) {
    const TriMesh closed = capsule(1.5, 80.0, 24);  // 9.4 mm round
    const PunchedTube punched = punch(closed, {0, 0, 10}, {0, 0, 70}, 15.0);
    expectTube(closed, punched);
    for (const auto& rim : rimsOf(punched.tube)) {
        for (const int v : rim) {
            const double z = punched.tube.vertices[std::size_t(v)].z;
            EXPECT_LT(z < 40.0 ? z + 1.5 : 81.5 - z, 15.0 / std::numbers::pi + 2.5);
        }
    }
}

TEST(EndHoles, RefuseWhatHasNoTwoEnds) {
    const auto refused = [](const TriMesh& mesh, glm::dvec3 a, glm::dvec3 b, double rimMm) {
        const glm::dvec3 ends[2] = {a, b}, outwards[2] = {down, up};
        const auto punched = punchEnds(mesh, ends, outwards, {rimMm});
        return !punched && punched.error().kind == ErrorKind::badInput &&
               !punched.error().message.empty();
    };
    const TriMesh closed = capsule(20.0, 60.0, 60);
    TriMesh open = closed;
    open.triangles.pop_back();
    TriMesh twice = closed;
    for (const glm::dvec3& v : closed.vertices)
        twice.vertices.push_back(v + glm::dvec3(100.0, 0.0, 0.0));
    for (const glm::ivec3& t : closed.triangles)
        twice.triangles.push_back(t + int(closed.vertices.size()));
    EXPECT_TRUE(refused(open, {0, 0, 0}, {0, 0, 60}, 15.0));
    EXPECT_TRUE(refused(twice, {0, 0, 0}, {0, 0, 60}, 15.0));
    EXPECT_TRUE(refused(tests::torusMesh(30.0, 10.0, 60, 20), {30, 0, 0}, {-30, 0, 0}, 15.0));
    EXPECT_TRUE(refused({}, {0, 0, 0}, {0, 0, 60}, 15.0));
    EXPECT_TRUE(refused(closed, {0, 0, 60}, {0, 0, 62}, 15.0) == false);
    EXPECT_TRUE(refused(capsule(2.0, 1.0, 24), {0, 0, 0}, {0, 0, 1}, 15.0));
    for (const double rimMm : {0.0, -1.0, std::nan("")})
        EXPECT_TRUE(refused(closed, {0, 0, 0}, {0, 0, 60}, rimMm)) << rimMm;
    const glm::dvec3 ends[2] = {{0, 0, 0}, {0, 0, 1}}, same[2] = {down, down};
    EXPECT_FALSE(punchEnds(closed, ends, same));
}

/// How many edges of the mesh away each vertex is from the first.
std::vector<int> stepsFromFirst(const TriMesh& mesh) {
    const auto halfedges = mesh::HalfedgeMesh::ofClosed(mesh).value();
    std::vector<int> steps(mesh.vertices.size(), -1), front{0};
    steps[0] = 0;
    for (std::size_t head = 0; head < front.size(); ++head) {
        int h = halfedges.outgoing(front[head]);
        do {
            const int next = halfedges.target(h);
            if (steps[std::size_t(next)] < 0) {
                steps[std::size_t(next)] = steps[std::size_t(front[head])] + 1;
                front.push_back(next);
            }
            h = halfedges.turnLeft(h);
        } while (h != halfedges.outgoing(front[head]));
    }
    return steps;
}

// Around a vertex above the level whose neighbours are all just below it, what is left of the
// triangles hangs together with the rest across nothing but the rim, wherever the neighbours move.
TEST(RimCut, APocketWithinTheHoleGoesWithIt) {
    const TriMesh closed = tests::torusMesh(40.0, 15.0, 40, 80);
    const std::vector<int> steps = stepsFromFirst(closed);
    const double values[] = {0.9, 0.39, 0.2, 0.6, 0.8};
    TipFunction function;
    for (std::size_t v = 0; v < steps.size(); ++v) {
        function.value.push_back(steps[v] < 5 ? values[steps[v]] : 1.0);
        if (steps[v] == 2 && function.tip < 0) function.tip = int(v), function.value.back() = 0.0;
    }
    for (const double snapShare : {0.0, 0.1, 0.25}) {
        SCOPED_TRACE(snapShare);
        const auto cut = cutRim(closed, function, 0.4, snapShare);
        ASSERT_TRUE(cut);
        for (const glm::ivec3& t : cut->triangles)
            for (int corner = 0; corner < 3; ++corner)
                EXPECT_NE(t[corner], 0);
        EXPECT_EQ(std::set<int>(cut->rim.begin(), cut->rim.end()).size(), cut->rim.size());
        for (const int v : cut->rim)
            EXPECT_TRUE(v >= int(closed.vertices.size()) || steps[std::size_t(v)] >= 2);
    }
}

TEST(EndHoles, LeaveATubeAnywhereOnARealColon) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const auto colon = mesh::readMesh(file).value();
    const glm::dvec3 none[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    std::mt19937 random(6);
    const auto place = [&] { return colon.vertices[random() % colon.vertices.size()]; };
    // It has a handle: a closed surface, but not one with two ends.
    const glm::dvec3 some[2] = {place(), place()};
    const auto refused = punchEnds(colon, some, none);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("genus 1"), std::string::npos);

    const TriMesh closed = handles::removeHandles(colon)->mesh;
    for (int n = 0; n < 12; ++n) {
        SCOPED_TRACE(n);
        const glm::dvec3 ends[2] = {place(), place()};
        const auto punched = punchEnds(closed, ends, none, {n % 2 ? 15.0 : 5.0});
        ASSERT_TRUE(punched) << describe(punched.error());
        expectTube(closed, *punched);
    }
}

}  // namespace
}  // namespace haustra::flatten
