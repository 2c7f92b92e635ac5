// What the real haustra-server says about the values of an open case's scan, and the wall before an
// eye.
#include "core/scan_values.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ClientMessage;
using protocol::ErrorReport;
using protocol::ServerMessage;

class ServerQuestions : public FlatServer {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeFlatStore(folder_->path(), tube());
        auto store = store::CaseStore::open(folder_->path(), false).value();
        const auto key = [](const char* stage) { return store::makeKey(stage, 3, "", {}); };
        {
            const SmallCase small = makeSmallCase();
            auto made = store.createCase("cleansed").value();
            ASSERT_TRUE(made.publishVolume("ct", key("ct"), small.ct));
            ASSERT_TRUE(made.publishVolume("cleansed", key("cleansed"), small.cleansed));
        }
        {
            auto made = store.createCase("meshed").value();
            ASSERT_TRUE(made.publishVolume("ct", key("its scan"), tube().scan()));
            ASSERT_TRUE(made.publishMesh("surface", key("its mesh"), tube().map().surface));
        }
        {
            auto made = store.createCase("rimmed").value();
            ASSERT_TRUE(made.publishVolume("ct", key("rimmed"), rimmedScan()));
            ASSERT_TRUE(made.publishCenterline("centerline", key("its path"), tube().centerline()));
            ASSERT_TRUE(made.publishFlatMap("flatmap", key("its map"), tube().map()));
        }
        server_ = std::make_unique<ServerProcess>(folder_->path());
    }

    /// The crest of the fold in the middle of the tube: its radius and its z.
    static glm::dvec2 crest() {
        glm::dvec2 least(1e9, 0.0);
        for (double y = 0.0; y < tube().height(); y += 1e-3) {
            const glm::dvec3 p = tube().positionMm({0.0, y});
            if (p.z > 15.0 && p.z < 30.0 && p.x < least.x) least = {p.x, p.z};
        }
        return least;
    }
    /// The tube's scan, whose tissue reaches up to a millimetre before that crest, as the mucosa's
    /// picture reaches before the mesh; at angles from 1.5 to 2.5 it does not, but a ball stands in
    /// the lumen.
    static Volume<std::int16_t> rimmedScan() {
        Volume<std::int16_t> scan = tube().scan();
        const Grid grid = scan.grid();
        const auto voxels = scan.writable();
        const glm::dvec2 fold = crest();
        const glm::dvec3 ball = rayPast(2.0) + 3.0 * along(2.0);
        for (std::size_t n = 0; n < voxels.size(); ++n) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
            const double angle = std::atan2(p.y, p.x);
            const bool isRim = std::hypot(p.x, p.y) > fold.x - 1.0 &&
                               std::abs(p.z - fold.y) < 1.0 && (angle < 1.5 || angle > 2.5);
            if (isRim || glm::distance(p, ball) < 1.5) voxels[n] = 40;
        }
        return scan;
    }
    /// Of a ray that passes half a millimetre before the crest, outwards: where it begins, 6 mm
    /// before, and its direction.
    static glm::dvec3 along(double angle) {
        return glm::normalize(glm::dvec3(0.2 * std::cos(angle), 0.2 * std::sin(angle), 1.0));
    }
    static glm::dvec3 rayPast(double angle) {
        const double r = crest().x - 0.5;
        return glm::dvec3(r * std::cos(angle), r * std::sin(angle), crest().y) - 6.0 * along(angle);
    }
    static std::unique_ptr<TestClient> reader(const std::string& name) {
        auto client = std::make_unique<TestClient>(server_->port());
        const auto welcome = client->hello();
        EXPECT_TRUE(welcome && welcome->has_welcome());
        const auto opened = client->openCase(name);
        EXPECT_TRUE(opened && opened->has_case_opened());
        return client;
    }
    static ServerMessage ask(TestClient& client, const ClientMessage& question) {
        client.send(question);
        const auto answer = client.answer();
        if (!answer) throw std::runtime_error("no answer came");
        return *answer;
    }
    static void expectRefusal(const ServerMessage& answer, ErrorReport::Code code,
                              std::uint64_t request) {
        ASSERT_TRUE(answer.has_error()) << answer.ShortDebugString();
        EXPECT_EQ(answer.error().code(), code) << answer.error().message();
        EXPECT_EQ(answer.error().request(), request);
        EXPECT_FALSE(answer.error().fatal());
    }
    static void set(protocol::Vec3* out, glm::dvec3 v) { TestClient::set(out, {v.x, v.y, v.z}); }

    static ClientMessage pick(std::uint64_t request, glm::dvec3 from, glm::dvec3 direction) {
        ClientMessage message;
        message.mutable_pick_wall()->set_request(request);
        set(message.mutable_pick_wall()->mutable_position_mm(), from);
        set(message.mutable_pick_wall()->mutable_direction(), direction);
        return message;
    }
    static ClientMessage measure(std::uint64_t request, const ScanRegion& region) {
        ClientMessage message;
        auto* body = message.mutable_measure_scan();
        body->set_request(request);
        set(body->mutable_center_mm(), region.centerMm);
        set(body->mutable_half_a_mm(), region.halfAMm);
        set(body->mutable_half_b_mm(), region.halfBMm);
        body->set_cleansed(region.scan == Scan::cleansed);
        body->mutable_slab()->set_thickness_mm(region.slab.thicknessMm);
        if (region.slab.projection == Projection::maximum)
            body->mutable_slab()->set_projection(protocol::MAXIMUM);
        return message;
    }
};

TEST_F(ServerQuestions, ValuesOfTheScanAreThoseOfTheFile) {
    const SmallCase truth = makeSmallCase();
    const auto client = reader("cleansed");
    const Grid& grid = truth.ct.grid();
    std::uint64_t request = 0;
    const auto expectSame = [&](const ScanRegion& region) {
        const auto answer = ask(*client, measure(++request, region));
        ASSERT_TRUE(answer.has_scan_statistics()) << answer.ShortDebugString();
        const auto& told = answer.scan_statistics();
        const auto expected =
            measureScan(region.scan == Scan::cleansed ? truth.cleansed : truth.ct, region);
        ASSERT_TRUE(expected);
        EXPECT_EQ(told.request(), request);
        EXPECT_EQ(told.samples(), expected->samples);
        EXPECT_EQ(told.mean_hu(), expected->meanHu);
        EXPECT_EQ(told.deviation_hu(), expected->deviationHu);
        EXPECT_EQ(told.least_hu(), expected->leastHu);
        EXPECT_EQ(told.greatest_hu(), expected->greatestHu);
        EXPECT_EQ(told.area_mm2(), expected->areaMm2);
    };
    // Where cleansing has changed most: in the pool of tagged fluid.
    std::size_t tagged = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        if (truth.ct[n] - truth.cleansed[n] > truth.ct[tagged] - truth.cleansed[tagged]) tagged = n;
    const glm::dvec3 pool = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(tagged)));
    for (const Scan scan : {Scan::original, Scan::cleansed}) {
        expectSame({pool, {}, {}, scan});
        expectSame({pool, {6, 1, 0}, {0, 3, 2}, scan});
        expectSame({pool, {6, 1, 0}, {0, 3, 2}, scan, {5.0, Projection::maximum}});
    }
    // Half beyond the scan's border, and all of it.
    const glm::dvec3 corner = grid.patientFromVoxelPoint(glm::dvec3(-0.5));
    expectSame({corner, {7, 0, 0}, {0, 7, 0}, Scan::original, {4.0}});
    const auto nothing = ask(*client, measure(99, {pool + glm::dvec3(1e5, 0, 0)}));
    ASSERT_TRUE(nothing.has_scan_statistics());
    EXPECT_EQ(nothing.scan_statistics().samples(), 0u);
}

TEST_F(ServerQuestions, RegionsThatAreNoneAreRefusedAndTheSessionGoesOn) {
    const auto client = reader("scan");
    const glm::dvec3 x(5, 0, 0), y(0, 5, 0);
    const double nan = std::nan("");
    std::uint64_t request = 0;
    for (const ScanRegion& bad :
         {ScanRegion{{nan, 0, 0}}, ScanRegion{{2e6, 0, 0}}, ScanRegion{{}, x, {}},
          ScanRegion{{}, x, 2.0 * x}, ScanRegion{{}, nan * x, y}, ScanRegion{{}, 101.0 * x, y},
          ScanRegion{{}, x, y, Scan::original, {101.0}},
          ScanRegion{{}, x, y, Scan::original, {nan}},
          ScanRegion{{}, 90.0 * x, 90.0 * y, Scan::original, {100.0}},
          ScanRegion{{}, x, y, Scan::cleansed}}) {
        ++request;
        expectRefusal(ask(*client, measure(request, bad)), ErrorReport::BAD_VALUE, request);
    }
    auto strange = measure(++request, {{}, x, y});
    strange.mutable_measure_scan()->mutable_slab()->set_projection(protocol::Projection(7));
    expectRefusal(ask(*client, strange), ErrorReport::BAD_VALUE, request);
    EXPECT_TRUE(ask(*client, measure(++request, {})).has_scan_statistics());

    TestClient early(server_->port());
    ASSERT_TRUE(early.hello());
    expectRefusal(ask(early, measure(3, {})), ErrorReport::BAD_STATE, 3);
}

TEST_F(ServerQuestions, ARayMeetsTheWallOfFlattenedMeshedAndBareCases) {
    // From the axis across: the wall's radius is known there, whoever finds it.
    const auto flattened = reader(smallCaseName), meshed = reader("meshed"), bare = reader("scan");
    for (const double angle : {0.3, 2.0, 4.4}) {
        const glm::dvec3 across(7.0 * std::cos(angle), 7.0 * std::sin(angle), 0.0);
        const glm::dvec3 from(0, 0, 31.0);
        const auto inStrip = ask(*flattened, pick(4, from, across));
        ASSERT_TRUE(inStrip.has_wall_place()) << inStrip.ShortDebugString();
        const auto& place = inStrip.wall_place();
        EXPECT_EQ(place.request(), 4u);
        ASSERT_TRUE(place.has_flat());
        EXPECT_NEAR(place.flat().x(), angle / (2.0 * std::numbers::pi), 1e-3);
        const glm::dvec3 wall = tube().positionMm({place.flat().x(), place.flat().y()});
        const auto at = [](const ServerMessage& answer) {
            const auto& p = answer.wall_place().position_mm();
            return glm::dvec3(p.x(), p.y(), p.z());
        };
        EXPECT_LT(glm::distance(at(inStrip), wall), 0.3);
        EXPECT_NEAR(at(inStrip).z, 31.0, 1e-3);
        EXPECT_NEAR(place.arc_mm(), 31.0, 1.0);

        const auto onMesh = ask(*meshed, pick(5, from, across));
        ASSERT_TRUE(onMesh.has_wall_place()) << onMesh.ShortDebugString();
        EXPECT_FALSE(onMesh.wall_place().has_flat());
        EXPECT_LT(glm::distance(at(onMesh), at(inStrip)), 1e-3);
        EXPECT_EQ(onMesh.wall_place().triangle(), place.triangle());
        // There is no path: it is looked at from where the ray begins.
        EXPECT_EQ(onMesh.wall_place().camera_mm().z(), 31.0);
    }
    const auto inScan = ask(*bare, pick(6, {-1.2, 2.2, 112.0}, {1, 0, 0}));
    ASSERT_TRUE(inScan.has_wall_place()) << inScan.ShortDebugString();
    EXPECT_FALSE(inScan.wall_place().has_flat());
    EXPECT_GT(inScan.wall_place().position_mm().x(), -1.2);
    EXPECT_NEAR(inScan.wall_place().position_mm().z(), 112.0, 1e-9);
}

TEST_F(ServerQuestions, ARayMeetsARimThatThePictureHasBeforeTheMesh) {
    const auto plain = reader(smallCaseName), rimmed = reader("rimmed");
    const auto metBy = [&](TestClient& client, double angle) {
        const auto answer = ask(client, pick(7, rayPast(angle), along(angle)));
        EXPECT_TRUE(answer.has_wall_place()) << answer.ShortDebugString();
        const auto& p = answer.wall_place().position_mm();
        return glm::dvec3(p.x(), p.y(), p.z());
    };
    for (const double angle : {0.4, 2.0}) {
        const glm::dvec3 behind = metBy(*plain, angle), met = metBy(*rimmed, angle);
        EXPECT_GT(behind.z, crest().y + 3.0) << "the wall behind the fold";
        if (angle < 1.5)
            EXPECT_LT(std::abs(met.z - crest().y), 2.0) << "the crest";
        else
            EXPECT_LT(glm::distance(met, behind), 1e-6) << "what stands free is no wall";
    }
}

TEST_F(ServerQuestions, RaysThatMeetNothingAreRefused) {
    const double nan = std::nan("");
    for (const char* name : {smallCaseName, "meshed", "scan"}) {
        const auto client = reader(name);
        std::uint64_t request = 10;
        for (const auto& [from, direction] :
             {std::pair{glm::dvec3(5000, 0, 0), glm::dvec3(1, 0, 0)},
              {glm::dvec3(0, 0, 0), glm::dvec3(0, 0, 0)},
              {glm::dvec3(0, 0, 0), glm::dvec3(nan, 0, 1)},
              {glm::dvec3(0, 0, 0), glm::dvec3(1e300, 1e300, 1)},
              {glm::dvec3(nan, 0, 0), glm::dvec3(0, 0, 1)},
              {glm::dvec3(0, 2e6, 0), glm::dvec3(0, 0, 1)}}) {
            ++request;
            expectRefusal(ask(*client, pick(request, from, direction)), ErrorReport::BAD_VALUE,
                          request);
        }
    }
    TestClient early(server_->port());
    ASSERT_TRUE(early.hello());
    expectRefusal(ask(early, pick(3, {}, {1, 0, 0})), ErrorReport::BAD_STATE, 3);
}

}  // namespace
}  // namespace haustra::tests
