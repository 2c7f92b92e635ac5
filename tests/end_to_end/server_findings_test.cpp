// What the real haustra-server tells and paints of a case's findings, and when it does not.
#include "core/findings.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"
#include "protocol/view_message.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::CaseOpened, protocol::ClientMessage, protocol::ErrorReport, protocol::FindingList;

constexpr int side = 128;
constexpr double cameraZ = 10.0, fovDegrees = 140.0, ballMm = 4.0;

class ServerFindingsTest : public FlatServer {
protected:
    static void SetUpTestSuite() {
        FlatServer::SetUpTestSuite();
        const auto store = store::CaseStore::open(folder_->path(), false).value();
        const auto plain = store.openCase(smallCaseName).value();
        const auto ct = plain.readVolume<std::int16_t>("ct").value();
        made() = findings(ct);
        for (const auto& named : {std::pair("found", findingsJson(made())),
                                  {"broken", std::string("no findings")},
                                  {"elsewhere", findingsJson(moved(made()))}}) {
            auto found = store.createCase(named.first).value();
            const auto key = [&](const char* stage) {
                return store::makeKey(stage, 1, std::string("of ") + stage + named.second, {});
            };
            ASSERT_TRUE(found.publishVolume("ct", store::makeKey("ct", 1, "", {}), ct));
            ASSERT_TRUE(
                found.publishCenterline("centerline", key("centerline"), tube().centerline()));
            ASSERT_TRUE(found.publishFlatMap("flatmap", key("flatmap"), tube().map()));
            ASSERT_TRUE(found.publishText("findings", key("findings"), named.second));
        }
    }

    static Findings& made() {
        static Findings findings;
        return findings;
    }
    /// On the flank of the first fold that faces the camera.
    static glm::dvec3 facing(double x) {
        for (double y = 0.0;; y += 0.005) {
            const glm::dvec3 place = tube().positionMm({x, y});
            const glm::dvec3 back = glm::normalize(glm::dvec3(0, 0, cameraZ) - place);
            if (place.z > cameraZ + 5.0 && glm::dot(back, tube().inwardNormal({x, y})) > 0.8)
                return place;
        }
    }
    /// The tissue of a ball, as detection tells it.
    static Finding ball(const Volume<std::int16_t>& ct, glm::dvec3 place, double score) {
        Finding finding{place, 2.0 * ballMm, score, "sessile"};
        finding.wallMm = place;
        finding.diameterEndsMm = {place - glm::dvec3(0, 0, ballMm),
                                  place + glm::dvec3(0, 0, ballMm)};
        finding.heightMm = 3.0;
        finding.arcMm = place.z;
        finding.segment = ColonSegment::sigmoid;
        for (std::size_t n = 0; n < ct.grid().voxelCount(); ++n) {
            const glm::ivec3 voxel = ct.grid().voxelAt(n);
            if (ct[n] > -480 &&
                glm::distance(ct.grid().patientFromVoxelPoint(glm::dvec3(voxel)), place) < ballMm)
                finding.voxels.push_back({voxel, 1});
        }
        return finding;
    }
    static Findings findings(const Volume<std::int16_t>& ct) {
        Findings all;
        all.model = {"haustra 0", "test-1", std::string(64, '0'), "nothing: this is a test"};
        all.operatingPoint = 0.5;
        all.warnings = {"a stretch was not looked at"};
        all.grid = ct.grid();
        all.findings = {ball(ct, tube().positionMm({0.5, 0.2}), 0.7), ball(ct, facing(0.3), 0.9)};
        all.candidates = {ball(ct, facing(0.75), 0.3)};
        all.candidates[0].heightMm = -0.25;  // a dent
        all.candidates[0].arcMm = 0.5 * (all.findings[0].arcMm + all.findings[1].arcMm);
        // As it comes back from its text.
        return findingsOfJson(findingsJson(all)).value();
    }
    static Findings moved(Findings of) {
        of.grid.patientFromVoxel[3].x += 1.0;
        return of;
    }

    std::unique_ptr<TestClient> reader(const std::string& name = "found") {
        auto client = std::make_unique<TestClient>(server_->port());
        EXPECT_TRUE(client->hello());
        const auto opened = client->openCase(name);
        EXPECT_TRUE(opened && opened->has_case_opened());
        if (opened) opened_ = opened->case_opened();
        return client;
    }
    static void choose(TestClient& client, std::uint64_t sequence, const DetectionChoice& choice) {
        client.send(protocol::detectionMessage(sequence, choice));
    }
    static FindingList list(TestClient& client, std::uint64_t request = 1) {
        ClientMessage message;
        message.mutable_list_findings()->set_request(request);
        client.send(message);
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no answer came");
            if (answer->has_finding_list() && answer->finding_list().request() == request)
                return answer->finding_list();
            if (answer->has_error()) throw std::runtime_error(answer->error().message());
        }
    }
    static TestPicture await(TestClient& client, std::uint64_t sequence) {
        for (;;) {
            auto picture = client.picture();
            if (!picture) throw std::runtime_error("no picture came");
            if (picture->header.sequence >= sequence) return std::move(*picture);
        }
    }
    static TestPicture look(TestClient& client) {
        client.viewport(1, 0, protocol::ENDOSCOPIC, side, side);
        client.camera(2, 0, {0, 0, cameraZ}, false, {0, 0, 1}, {0, -1, 0}, fovDegrees);
        return await(client, 2);
    }
    static void expectRefusal(TestClient& client, ErrorReport::Code code) {
        for (;;) {
            const auto answer = client.answer();
            ASSERT_TRUE(answer);
            if (!answer->has_error()) continue;
            EXPECT_EQ(answer->error().code(), code) << answer->error().message();
            EXPECT_FALSE(answer->error().fatal());
            return;
        }
    }
    CaseOpened opened_;
};

const DetectionChoice early{DetectionMode::secondReader, false, 0.0},
    late{DetectionMode::secondReader, true}, concurrent{DetectionMode::concurrent};

TEST_F(ServerFindingsTest, ListsWhatTheProductHasAlongTheColonWhereItMayBeShown) {
    const auto client = reader();
    EXPECT_EQ(opened_.detection(), CaseOpened::THERE);
    EXPECT_EQ(list(*client).state(), FindingList::OFF);
    EXPECT_EQ(list(*client).findings_size(), 0);
    choose(*client, 1, early);
    const FindingList hidden = list(*client);
    EXPECT_EQ(hidden.state(), FindingList::FIRST_PASS);
    EXPECT_EQ(hidden.findings_size() + hidden.warnings_size(), 0);
    EXPECT_EQ(hidden.trained_on(), made().model.trainedOn);
    for (const DetectionChoice& choice : {late, concurrent}) {
        static std::uint64_t sequence = 1;
        choose(*client, ++sequence, choice);
        const FindingList shown = list(*client);
        EXPECT_EQ(shown.state(), FindingList::SHOWN);
        EXPECT_EQ(shown.operating_point(), 0.5);
        ASSERT_EQ(shown.findings_size(), 2);
        ASSERT_EQ(shown.warnings_size(), 1);
        EXPECT_EQ(shown.warnings(0), made().warnings[0]);
        for (int n = 0; n < 2; ++n) {
            const protocol::Finding& told = shown.findings(n);
            const Finding& is = made().findings[std::size_t(n)];
            EXPECT_EQ(told.number(), std::uint32_t(n + 1));
            EXPECT_EQ(protocol::vectorFrom(told.position_mm()), is.positionMm);
            EXPECT_EQ(protocol::vectorFrom(told.diameter_from_mm()), is.diameterEndsMm.first);
            EXPECT_EQ(protocol::vectorFrom(told.diameter_to_mm()), is.diameterEndsMm.second);
            EXPECT_EQ(told.diameter_mm(), is.diameterMm);
            EXPECT_EQ(told.height_mm(), is.heightMm);
            EXPECT_EQ(told.arc_mm(), is.arcMm);
            EXPECT_EQ(told.probability(), is.score);
            EXPECT_EQ(told.segment(), protocol::Finding::SIGMOID);
            EXPECT_FALSE(told.below_operating_point());
            EXPECT_LT(glm::distance(protocol::vectorFrom(told.wall().position_mm()), is.wallMm),
                      0.1);
            EXPECT_TRUE(told.wall().has_flat());
            ASSERT_EQ(told.voxels_size(), 4 * int(is.voxels.size()));
            for (int run = 0; run < int(is.voxels.size()); ++run) {
                const VoxelRun& of = is.voxels[std::size_t(run)];
                EXPECT_EQ(glm::ivec3(told.voxels(4 * run), told.voxels(4 * run + 1),
                                     told.voxels(4 * run + 2)),
                          of.first);
                EXPECT_EQ(int(told.voxels(4 * run + 3)), of.count);
            }
        }
    }
    // Candidates stand among the others, under numbers of their own.
    choose(*client, 10, {DetectionMode::concurrent, false, 0.3});
    const FindingList all = list(*client);
    ASSERT_EQ(all.findings_size(), 3);
    EXPECT_EQ(all.findings(1).number(), 3u);
    EXPECT_TRUE(all.findings(1).below_operating_point());
    EXPECT_EQ(all.findings(1).height_mm(), -0.25);
    choose(*client, 11, {DetectionMode::concurrent, false, 0.31});
    EXPECT_EQ(list(*client).findings_size(), 2);
    // Each session chooses for itself, and anew for each case that it opens.
    EXPECT_EQ(list(*reader()).state(), FindingList::OFF);
    client->openCase("found");
    EXPECT_EQ(list(*client).state(), FindingList::OFF);
}

TEST_F(ServerFindingsTest, PaintsThatVeryTissueAndNothingBefore) {
    const auto client = reader();
    const TestPicture plain = look(*client);
    choose(*client, 3, early);
    EXPECT_EQ(await(*client, 3).rgb, plain.rgb) << "the first reading is not done";
    choose(*client, 4, late);
    const TestPicture second = await(*client, 4);
    choose(*client, 5, concurrent);
    EXPECT_EQ(await(*client, 5).rgb, second.rgb);
    choose(*client, 6, {DetectionMode::concurrent, false, 0.2});
    const TestPicture withCandidates = await(*client, 6);
    // Where look()'s camera has a place; how far a pixel's ray passes from it.
    const auto away = [](int x, int y, glm::dvec3 place) {
        const double wide = std::tan(glm::radians(0.5 * fovDegrees)) / side;
        const glm::dvec3 ray = glm::normalize(
            glm::dvec3(wide * (2.0 * (x + 0.5) - side), wide * (2.0 * (y + 0.5) - side), 1.0));
        const glm::dvec3 to = place - glm::dvec3(0, 0, cameraZ);
        return glm::length(to - glm::dot(to, ray) * ray);
    };
    int changed = 0, greener = 0, more = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const std::size_t at = 3 * std::size_t(y * side + x);
            const auto differs = [&](const TestPicture& a, const TestPicture& b) {
                return !std::equal(&a.rgb[at], &a.rgb[at] + 3, &b.rgb[at]);
            };
            constexpr double slackMm = 1.6;
            if (differs(second, plain)) {
                ++changed;
                greener += second.rgb[at + 1] > second.rgb[at];
                EXPECT_LT(away(x, y, made().findings[1].positionMm), ballMm + slackMm);
            }
            if (differs(withCandidates, second)) {
                ++more;
                EXPECT_LT(away(x, y, made().candidates[0].positionMm), ballMm + slackMm);
            }
            // Its top is seen.
            if (away(x, y, made().findings[1].wallMm) < 0.2) {
                EXPECT_TRUE(differs(second, plain)) << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(changed, 60);
    EXPECT_GT(greener, changed * 2 / 3);
    EXPECT_GT(more, 40);
    choose(*client, 7, {});
    EXPECT_EQ(await(*client, 7).rgb, plain.rgb);
}

TEST_F(ServerFindingsTest, ACaseWithoutSoundFindingsOpensAndSaysSo) {
    for (const auto& [name, said, state] :
         {std::tuple("broken", CaseOpened::DAMAGED, FindingList::DAMAGED),
          {"elsewhere", CaseOpened::DAMAGED, FindingList::DAMAGED},
          {"scan", CaseOpened::NONE, FindingList::NONE},
          {smallCaseName, CaseOpened::NONE, FindingList::NONE}}) {
        SCOPED_TRACE(name);
        const auto client = reader(name);
        EXPECT_EQ(opened_.detection(), said);
        const TestPicture plain = look(*client);
        choose(*client, 3, concurrent);
        const FindingList none = list(*client);
        EXPECT_EQ(none.state(), state);
        EXPECT_EQ(none.findings_size(), 0);
        client->camera(4, 0, {0, 0, cameraZ}, false, {0, 0, 1}, {0, -1, 0}, fovDegrees);
        EXPECT_EQ(await(*client, 4).rgb, plain.rgb);
    }
}

TEST_F(ServerFindingsTest, RefusesInOneSentenceAndGoesOn) {
    const auto client = reader();
    std::uint64_t sequence = 0;
    for (const double least : {-0.1, 1.1, std::nan(""), double(INFINITY)}) {
        choose(*client, ++sequence, {DetectionMode::concurrent, false, least});
        expectRefusal(*client, ErrorReport::BAD_VALUE);
    }
    ClientMessage message;
    message.mutable_set_detection()->set_sequence(++sequence);
    message.mutable_set_detection()->set_mode(protocol::SetDetection::Mode(7));
    client->send(message);
    expectRefusal(*client, ErrorReport::BAD_VALUE);
    choose(*client, 1, concurrent);  // the sequence does not grow
    expectRefusal(*client, ErrorReport::BAD_VALUE);
    EXPECT_EQ(list(*client).state(), FindingList::OFF);

    TestClient early(server_->port());
    ASSERT_TRUE(early.hello());
    choose(early, 1, concurrent);
    expectRefusal(early, ErrorReport::BAD_STATE);
    ClientMessage ask;
    ask.mutable_list_findings()->set_request(5);
    early.send(ask);
    expectRefusal(early, ErrorReport::BAD_STATE);
}

}  // namespace
}  // namespace haustra::tests
