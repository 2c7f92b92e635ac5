// Surfaces of any shape on the plane: which way each is taken, and laws of what comes out.
#include "flatten/general/surface_flattening.h"

#include "flat_meshes.h"
#include "handle_meshes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using tests::areaMm2;

TriMesh withoutTriangles(TriMesh mesh, const std::vector<std::size_t>& gone) {
    for (std::size_t n = gone.size(); n-- > 0;)
        mesh.triangles.erase(mesh.triangles.begin() + std::ptrdiff_t(gone[n]));
    return mesh;
}

TriMesh cylinder() {
    return tests::openTube([](double) { return 10.0; }, 50.0, 48, 39);
}

/// Every triangle of the mesh is in the map, once.
void expectWhole(const TriMesh& mesh, const SurfaceFlattening& flat) {
    EXPECT_NEAR(areaMm2(flat.map.surface), areaMm2(mesh), 1e-6 * areaMm2(mesh));
    EXPECT_EQ(flat.map.sourceTriangle.size(), flat.map.surface.triangles.size());
    std::vector<char> seen(mesh.triangles.size(), 0);
    for (const std::int32_t source : flat.map.sourceTriangle)
        seen.at(std::size_t(source)) = 1;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size()));
}

TEST(SurfaceFlattening, TellsTheShape) {
    const auto shape = [](const TriMesh& mesh) { return shapeOf(mesh).value(); };
    EXPECT_EQ(shape(cylinder()).boundaryLoops, 2);
    EXPECT_EQ(shape(cylinder()).genus, 0);
    const TriMesh torus = tests::torusMesh(30.0, 10.0, 40, 20);
    EXPECT_EQ(shape(torus).genus, 1);
    EXPECT_EQ(shape(torus).boundaryLoops, 0);
    EXPECT_EQ(shape(withoutTriangles(torus, {0, 700})).genus, 1);
    EXPECT_EQ(shape(withoutTriangles(torus, {0, 700})).boundaryLoops, 2);
    EXPECT_EQ(shape(tests::capsule(10.0, 30.0, 24)).genus, 0);
    TriMesh twisted = torus;
    std::swap(twisted.triangles[3].x, twisted.triangles[3].y);
    EXPECT_FALSE(shapeOf(twisted));
}

TEST(SurfaceFlattening, OfATubeIsItsStrip) {
    const auto flat = flattenSurface(cylinder());
    ASSERT_TRUE(flat) << describe(flat.error());
    ASSERT_TRUE(flat->strip);
    EXPECT_FALSE(flat->punched);
    expectWhole(cylinder(), *flat);
    // A prism with 48 sides.
    const double around = 48 * 20.0 * std::sin(std::numbers::pi / 48);
    EXPECT_NEAR(flat->strip->modulus, 50.0 / around, 2e-3);
    EXPECT_EQ(flat->map.height, flat->strip->modulus);
    EXPECT_EQ(flat->flips, 0u);
    EXPECT_EQ(flat->strip->seamMismatch, 0.0);
    EXPECT_LT(flat->distortion.angleErrorDegrees.mean, 0.5);
}

TEST(SurfaceFlattening, OfASphereIsTheTubeWithoutItsEnds) {
    const TriMesh capsule = tests::capsule(10.0, 60.0, 40);
    for (const bool told : {false, true}) {
        SurfaceFlatteningOptions options;
        if (told) options.endsMm = {glm::dvec3(0.0, 0.0, 70.0), glm::dvec3(0.0, 0.0, -10.0)};
        const auto flat = flattenSurface(capsule, options);
        ASSERT_TRUE(flat) << describe(flat.error());
        ASSERT_TRUE(flat->punched && flat->strip);
        EXPECT_NEAR(areaMm2(flat->map.surface) + flat->punched->capAreaMm2[0] +
                        flat->punched->capAreaMm2[1],
                    areaMm2(capsule), 1e-6);
        double lowest = 0.0, highest = 0.0;  // z of the rims
        for (std::size_t v = 0; v < flat->map.flat.size(); ++v) {
            if (flat->map.flat[v].y == 0.0) lowest = flat->map.surface.vertices[v].z;
            if (flat->map.flat[v].y == flat->map.height) highest = flat->map.surface.vertices[v].z;
        }
        EXPECT_NEAR(std::abs(highest - lowest), 80.0, 3.0);
        if (told) {
            EXPECT_GT(lowest, highest);
        }
        // Mercator's map of the two caps, and the tube between them.
        const double rim = flat->punched->rimLengthMm[0] / (2.0 * std::numbers::pi);
        const double modulus =
            60.0 / (20.0 * std::numbers::pi) +
            2.0 * std::log((1.0 + std::sqrt(1.0 - rim * rim / 100.0)) / (rim / 10.0)) /
                (2.0 * std::numbers::pi);
        EXPECT_NEAR(flat->strip->modulus, modulus, 0.015 * modulus);
        EXPECT_EQ(flat->flips, 0u);
    }
}

TEST(SurfaceFlattening, OfASmallSphereHasSmallerHoles) {
    TriMesh ball = tests::HandledSphere(1.0, 20).mesh();
    const auto flat = flattenSurface(ball);
    ASSERT_TRUE(flat) << describe(flat.error());
    const double rootArea = std::sqrt(areaMm2(ball));
    EXPECT_NEAR(flat->punched->rimLengthMm[0], 0.1 * rootArea, 0.02 * rootArea);
    SurfaceFlatteningOptions options;
    options.rimMm = 1.0;
    EXPECT_NEAR(flattenSurface(ball, options)->punched->rimLengthMm[1], 1.0, 0.1);
    options.rimMm = 30.0;
    EXPECT_FALSE(flattenSurface(ball, options));
}

TEST(SurfaceFlattening, OfATorusIsItsParallelogram) {
    // Conformally a rectangle of sides R' = √(R² − r²) to r (the torus's inversion in a circle).
    const TriMesh torus = tests::torusMesh(30.0, 10.0, 120, 60);
    const auto flat = flattenSurface(torus);
    ASSERT_TRUE(flat) << describe(flat.error());
    ASSERT_TRUE(flat->tau);
    EXPECT_FALSE(flat->strip);
    expectWhole(torus, *flat);
    EXPECT_NEAR(flat->tau->real(), 0.0, 1e-3);
    EXPECT_NEAR(flat->tau->imag(), std::sqrt(30.0 * 30.0 - 100.0) / 10.0, 0.02);
    EXPECT_EQ(flat->map.height, flat->tau->imag());
    EXPECT_EQ(flat->flips, 0u);
}

TEST(SurfaceFlattening, OfAnythingElseIsAFundamentalDomain) {
    tests::HandledSphere sphere(50.0, 24);
    sphere.addTube(0, 4, 6, 6, 3, 2.0, true);
    sphere.addTube(3, 4, 6, 6, 3, 2.5, false);
    const TriMesh two = sphere.mesh();
    const auto flat = flattenSurface(two);
    ASSERT_TRUE(flat) << describe(flat.error());
    EXPECT_EQ(flat->shape.genus, 2);
    EXPECT_GE(flat->formZeros, 2u);
    EXPECT_FALSE(flat->strip || flat->tau);
    expectWhole(two, *flat);

    // Three loops: half of a double cover of genus 2. One handle and one loop: likewise.
    const TriMesh three = withoutTriangles(cylinder(), {1500});
    const TriMesh handle = withoutTriangles(tests::torusMesh(30.0, 10.0, 60, 30), {900});
    for (const TriMesh& mesh : {three, handle}) {
        const auto half = flattenSurface(mesh);
        ASSERT_TRUE(half) << describe(half.error());
        EXPECT_FALSE(half->strip || half->tau);
        expectWhole(mesh, *half);
    }
}

TEST(SurfaceFlattening, RefusesWhatItCannotFlattenInOneSentence) {
    const auto refused = [](const TriMesh& mesh) {
        const auto flat = flattenSurface(mesh);
        return flat ? std::string() : flat.error().message;
    };
    EXPECT_NE(refused(withoutTriangles(tests::capsule(10.0, 30.0, 24), {5})).find("a disc"),
              std::string::npos);
    TriMesh two = cylinder();
    const int count = int(two.vertices.size());
    for (int v = 0; v < count; ++v)
        two.vertices.push_back(two.vertices[std::size_t(v)] + glm::dvec3(100.0, 0.0, 0.0));
    for (const glm::ivec3& t : cylinder().triangles)
        two.triangles.push_back(t + count);
    EXPECT_NE(refused(two).find("2 parts"), std::string::npos);
    TriMesh twisted = cylinder();
    std::swap(twisted.triangles[3].x, twisted.triangles[3].y);
    EXPECT_NE(refused(twisted).find("not manifold"), std::string::npos);
    EXPECT_FALSE(refused({}).empty());
}

TEST(SurfaceFlattening, WeighsAreasOnRequestAndTellsBothDistortions) {
    const TriMesh tube =
        tests::openTube([](double z) { return 10.0 + 4.0 * std::sin(z * 0.25); }, 50.0, 48, 45);
    SurfaceFlatteningOptions options;
    options.areaWeight = 0.7;
    const auto flat = flattenSurface(tube, options);
    ASSERT_TRUE(flat) << describe(flat.error());
    ASSERT_TRUE(flat->strip);
    EXPECT_LT(flat->distortion.logAreaDeviation, 0.7 * flat->strip->conformal.logAreaDeviation);
    EXPECT_GT(flat->distortion.angleErrorDegrees.mean,
              flat->strip->conformal.angleErrorDegrees.mean);
    EXPECT_EQ(flat->flips, 0u);
    expectWhole(tube, *flat);
    const auto conformal = flattenSurface(tube);
    EXPECT_EQ(conformal->distortion.logAreaDeviation, flat->strip->conformal.logAreaDeviation);
}

}  // namespace
}  // namespace haustra::flatten
