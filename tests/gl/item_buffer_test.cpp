// The item buffer on the GPU sees what rays on the CPU see.
#include "render/wall/item_buffer.h"

#include "core/missed_patches.h"
#include "coverage/corner_path.h"
#include "coverage/sight.h"
#include "coverage_vessels.h"

#include <gtest/gtest.h>

namespace haustra {
namespace {

using coverage::flightCameras;

constexpr int side = 256;

std::vector<CenterlineCamera> bothWays(const Centerline& line, int count) {
    auto cameras = flightCameras(line, count, FlightDirection::antegrade);
    const auto back = flightCameras(line, count, FlightDirection::retrograde);
    cameras.insert(cameras.end(), back.begin(), back.end());
    return cameras;
}

class ItemBufferTest : public testing::Test {
protected:
    void SetUp() override {
        auto made = gpu::Context::create();
        ASSERT_TRUE(made) << describe(made.error());
        context = std::move(*made);
    }
    std::vector<Visibility> byItems(const TriMesh& mesh, const std::vector<std::uint8_t>& bridged,
                                    const std::vector<CenterlineCamera>& cameras, bool tellFully) {
        auto items = render::ItemBuffer::create(*context, mesh, bridged, {90.0, side}, tellFully);
        EXPECT_TRUE(items) << describe(items.error());
        for (const CenterlineCamera& camera : cameras) {
            const auto looked = (*items)->look(camera);
            EXPECT_TRUE(looked) << describe(looked.error());
        }
        return (*items)->seen();
    }
    static std::vector<Visibility> byRays(const TriMesh& mesh,
                                          const std::vector<std::uint8_t>& bridged,
                                          const std::vector<CenterlineCamera>& cameras,
                                          bool tellFully) {
        const coverage::SightTree tree(coverage::WallRays::of(mesh, bridged).value());
        std::vector<Visibility> seen(mesh.triangles.size(), Visibility::unseen);
        EXPECT_TRUE(coverage::look(tree, coverage::Eyepiece::of(PinholePicture{90.0, side}),
                                   cameras, seen, {.tellFully = tellFully}));
        return seen;
    }
    std::unique_ptr<gpu::Context> context;
};

TEST_F(ItemBufferTest, AgreesWithRaysButForSilhouettes) {
    const TriMesh mesh = tests::foldedTube();
    std::vector<std::uint8_t> bridged(mesh.triangles.size(), 0);
    for (std::size_t n = 4000; n < 4300; ++n)
        bridged[n] = 1;
    const auto cameras = bothWays(tests::lineThrough(tests::foldedAxis, 8.0, 192.0), 30);
    const auto items = byItems(mesh, bridged, cameras, true),
               rays = byRays(mesh, bridged, cameras, true);
    const auto neighbours = neighboursOf(mesh);
    std::size_t differ = 0, silhouettes = 0;
    double differMm2 = 0.0, allMm2 = 0.0;
    const auto observed = [](const std::vector<Visibility>& seen, std::size_t n) {
        return seen[n] != Visibility::unseen;
    };
    for (std::size_t n = 0; n < rays.size(); ++n) {
        allMm2 += tests::triangleAreaMm2(mesh, n);
        if (bridged[n]) {
            EXPECT_EQ(items[n], Visibility::unseen);
        }
        if (observed(items, n) == observed(rays, n)) continue;
        ++differ;
        differMm2 += tests::triangleAreaMm2(mesh, n);
        // Where what is seen ends: not all around it are what it is to the rays.
        for (int edge = 0; edge < 3; ++edge)
            if (const int other = neighbours[n][edge];
                other >= 0 && observed(rays, std::size_t(other)) != observed(rays, n)) {
                ++silhouettes;
                break;
            }
    }
    EXPECT_EQ(silhouettes, differ);
    EXPECT_LE(double(differ), 1e-3 * double(rays.size()));
    EXPECT_LE(differMm2, 5e-4 * allMm2);
    const auto unseen = std::count(rays.begin(), rays.end(), Visibility::unseen);
    EXPECT_GT(unseen, 500);
    // Partly and fully, too: where a pixel's centre lies on an edge they may part.
    std::size_t partly = 0;
    for (std::size_t n = 0; n < rays.size(); ++n)
        partly += items[n] != rays[n];
    EXPECT_LE(double(partly), 0.01 * double(rays.size()));
}

TEST_F(ItemBufferTest, SeesAllOfAConvexVesselAndMissesAPocketToTheTriangle) {
    const TriMesh convex = tests::capsule(15.0, 110.0, 72);
    const auto whole = byItems(convex, {}, bothWays(tests::straightLine(4.0, 106.0), 40), false);
    EXPECT_EQ(std::count(whole.begin(), whole.end(), Visibility::unseen), 0);

    const TriMesh mesh = tests::pocketTube();
    const auto cameras =
        flightCameras(tests::straightLine(5.0, tests::lastEyeMm), 36, FlightDirection::antegrade);
    const auto seen = byItems(mesh, {}, cameras, false), byRay = byRays(mesh, {}, cameras, false);
    int inPocket = 0, observed = 0, differ = 0;
    for (std::size_t n = 0; n < seen.size(); ++n) {
        observed += seen[n] != Visibility::unseen;
        differ += (seen[n] != Visibility::unseen) != (byRay[n] != Visibility::unseen);
        double low = 1e9, high = -1e9, out = 0.0;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 v = mesh.vertices[std::size_t(mesh.triangles[n][corner])];
            low = std::min(low, v.z), high = std::max(high, v.z);
            out = std::max(out, glm::length(glm::dvec2(v)));
        }
        if (out > 8.1 && low > tests::pocketBeginMm - 0.1 && high < tests::pocketEndMm + 0.1) {
            EXPECT_EQ(seen[n], Visibility::unseen) << low;
            ++inPocket;
        }
    }
    EXPECT_GT(inPocket, 100);
    EXPECT_GT(observed, int(seen.size()) / 2);
    EXPECT_LE(differ, int(seen.size()) / 1000);
}

}  // namespace
}  // namespace haustra
