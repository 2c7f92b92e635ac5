// The real haustra-server on a small store, by TLS on the loopback.
#include "core/raycasters.h"
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "gpu/context.h"
#include "render/case_renderer.h"
#include "store/case_store.h"

#include <map>
#include <random>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ErrorReport;
constexpr TestClient::Vector inTheTube{-1.2, 2.2, 112.0};

class ServerTest : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeSmallStore(folder_->path());
        server_ = std::make_unique<ServerProcess>(folder_->path());
    }
    static void TearDownTestSuite() {
        server_.reset();
        folder_.reset();
    }
    void TearDown() override { ASSERT_TRUE(server_->running()) << server_->log(); }

    static std::unique_ptr<TestClient> connected() {
        return std::make_unique<TestClient>(server_->port());
    }
    static std::unique_ptr<TestClient> opened(const std::string& name = smallCaseName) {
        auto client = connected();
        const auto welcome = client->hello();
        EXPECT_TRUE(welcome && welcome->has_welcome());
        const auto open = client->openCase(name);
        EXPECT_TRUE(open && open->has_case_opened());
        return client;
    }
    static void expectError(const std::optional<protocol::ServerMessage>& answer,
                            ErrorReport::Code code, bool fatal) {
        ASSERT_TRUE(answer && answer->has_error());
        EXPECT_EQ(answer->error().code(), code) << answer->error().message();
        EXPECT_EQ(answer->error().fatal(), fatal) << answer->error().message();
        EXPECT_FALSE(answer->error().message().empty());
    }
    /// A fatal error, then the end.
    static void expectEnd(TestClient& client, ErrorReport::Code code) {
        expectError(client.answer(), code, true);
        EXPECT_FALSE(client.next(std::chrono::seconds(20)));
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::unique_ptr<ServerProcess> server_;
};
std::unique_ptr<TemporaryFolder> ServerTest::folder_;
std::unique_ptr<ServerProcess> ServerTest::server_;

TEST_F(ServerTest, WelcomesListsAndOpens) {
    auto client = connected();
    const auto welcome = client->hello();
    ASSERT_TRUE(welcome && welcome->has_welcome());
    EXPECT_EQ(welcome->welcome().protocol_version(), protocol::protocolVersion);
    EXPECT_FALSE(welcome->welcome().renderer().empty());

    protocol::ClientMessage list;
    list.mutable_list_cases();
    client->send(list);
    const auto cases = client->answer();
    ASSERT_TRUE(cases && cases->has_case_list());
    ASSERT_EQ(cases->case_list().names_size(), 2);
    EXPECT_EQ(cases->case_list().names(0), "scan");
    EXPECT_EQ(cases->case_list().names(1), smallCaseName);

    const auto answer = client->openCase(smallCaseName);
    ASSERT_TRUE(answer && answer->has_case_opened());
    const auto& facts = answer->case_opened();
    const SmallCase truth = makeSmallCase();
    EXPECT_EQ(facts.size_x(), 48u);
    EXPECT_EQ(facts.size_z(), 56u);
    ASSERT_EQ(facts.patient_from_voxel_size(), 12);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            EXPECT_EQ(facts.patient_from_voxel(4 * row + column),
                      truth.ct.grid().patientFromVoxel[column][row]);
    ASSERT_EQ(std::size_t(facts.centerline_size()), 5 * truth.centerline.points.size());
    EXPECT_EQ(facts.centerline(5 * 7 + 2), truth.centerline.points[7].positionMm.z);
    EXPECT_EQ(facts.centerline(5 * 7 + 3), truth.centerline.points[7].arcMm);
    EXPECT_EQ(facts.gap_samples_size(), 2);
    EXPECT_EQ(facts.patient_position(), toString(PatientPosition::supine));
    EXPECT_EQ(facts.presets(0).name(), "mucosa");
    EXPECT_TRUE(facts.cleansed());
    // The raycaster is the fastest of those that were tried.
    double least = INFINITY;
    std::string fastest;
    for (const auto& trial : facts.trials()) {
        EXPECT_TRUE(trial.failure().empty() || trial.median_ms() == 0.0) << trial.raycaster();
        if (trial.median_ms() == 0.0 || trial.median_ms() >= least) continue;
        least = trial.median_ms();
        fastest = trial.raycaster();
    }
    EXPECT_EQ(facts.raycaster(), fastest);
    EXPECT_NE(server_->log().find("drawn by the " + fastest + " raycaster"), std::string::npos);
}

TEST_F(ServerTest, ACaseWithoutCenterlineShowsItsSlices) {
    auto client = opened("scan");
    client->viewport(1, 2, protocol::CORONAL, 40, 32);
    client->slice(2, 2, inTheTube, 1.0, false);
    const auto picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->header.exact);
}

TEST_F(ServerTest, ACaseThatIsNotCleansedSaysSoAndRefusesCleansedSlices) {
    auto client = connected();
    client->hello();
    const auto answer = client->openCase("scan");
    ASSERT_TRUE(answer && answer->has_case_opened());
    EXPECT_FALSE(answer->case_opened().cleansed());
    client->viewport(1, 2, protocol::AXIAL, 40, 32);
    client->slice(2, 2, inTheTube, 1.0, false, true);
    expectError(client->answer(), ErrorReport::BAD_VALUE, false);
    client->slice(3, 2, inTheTube, 1.0, false);
    const auto picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->header.sequence, 3u);
}

TEST_F(ServerTest, OtherVersionsAndSilentStrangersAreTurnedAway) {
    auto client = connected();
    protocol::ClientMessage hello;
    hello.mutable_hello()->set_protocol_version(2);
    client->send(hello);
    expectEnd(*client, ErrorReport::VERSION);

    client = connected();
    hello.mutable_hello()->set_protocol_version(protocol::protocolVersion);
    hello.mutable_hello()->add_capabilities("jpeg");
    client->send(hello);
    expectEnd(*client, ErrorReport::VERSION);

    client = connected();
    protocol::ClientMessage early;
    early.mutable_list_cases();
    client->send(early);
    expectEnd(*client, ErrorReport::BAD_STATE);
}

TEST_F(ServerTest, GarbageEndsItsOwnSessionAlone) {
    auto bystander = opened();
    const auto ends = [&](bool greet, const TestClient::Bytes& garbage) {
        auto client = connected();
        if (greet) client->hello();
        client->sendBytes(garbage);
        expectEnd(*client, ErrorReport::BAD_MESSAGE);
    };
    ends(false, {0xff, 0xff, 0xff, 0xff, 0x01});             // four gigabytes
    ends(true, {0x01, 0x00, 0x01, 0x00, 0x01, 0x00});        // a byte over the bound
    ends(true, {0x00, 0x00, 0x00, 0x00, 0x02});              // a tile
    ends(true, {0x00, 0x00, 0x00, 0x00, 0x77});              // no such type
    ends(true, {0x02, 0x00, 0x00, 0x00, 0x01, 0x0a, 0x7f});  // no protobuf
    ends(true, {0x00, 0x00, 0x00, 0x00, 0x01});              // says nothing
    std::mt19937 random(1);
    for (int n = 0; n < 50; ++n) {
        TestClient::Bytes noise(64 + random() % 512);
        for (auto& byte : noise)
            byte = std::uint8_t(random());
        auto client = connected();
        if (n % 2) client->hello();
        try {
            client->sendBytes(noise);
        } catch (const std::system_error&) {
        }
    }
    protocol::ClientMessage ping;
    ping.mutable_ping()->set_request(42);
    bystander->send(ping);
    const auto pong = bystander->answer();
    ASSERT_TRUE(pong && pong->has_pong());
    EXPECT_EQ(pong->pong().request(), 42u);
}

TEST_F(ServerTest, ValuesOutOfBoundsAreRefusedAndTheSessionGoesOn) {
    auto client = connected();
    client->hello();
    client->viewport(1, 0, protocol::ENDOSCOPIC, 64, 64);
    expectError(client->answer(), ErrorReport::BAD_STATE, false);
    for (const char* name : {"nobody", "../tube", "", "/etc"})
        expectError(client->openCase(name), ErrorReport::NO_SUCH_CASE, false);
    ASSERT_TRUE(client->openCase(smallCaseName)->has_case_opened());

    std::uint64_t sequence = 1;
    client->camera(++sequence, 3, inTheTube, false);
    expectError(client->answer(), ErrorReport::BAD_STATE, false);  // viewport 3 is not open
    for (const auto& [width, height] : {std::pair(15, 64), {64, 2049}, {1 << 20, 1 << 20}}) {
        client->viewport(++sequence, 0, protocol::ENDOSCOPIC, width, height);
        expectError(client->answer(), ErrorReport::BAD_VALUE, false);
    }
    client->viewport(++sequence, protocol::maxViewports, protocol::ENDOSCOPIC, 64, 64);
    expectError(client->answer(), ErrorReport::BAD_VALUE, false);
    client->viewport(++sequence, 0, protocol::VIEW_UNSPECIFIED, 64, 64);
    expectError(client->answer(), ErrorReport::BAD_VALUE, false);

    client->viewport(++sequence, 0, protocol::ENDOSCOPIC, 64, 64);
    client->viewport(++sequence, 1, protocol::AXIAL, 64, 64);
    const double nan = std::nan(""), infinity = INFINITY;
    client->camera(++sequence, 0, {nan, 0, 0}, false);
    client->camera(++sequence, 0, {1e7, 0, 0}, false);
    client->camera(++sequence, 0, inTheTube, false, {0, 0, 0});
    client->camera(++sequence, 0, inTheTube, false, {0, 0, infinity});
    client->camera(++sequence, 0, inTheTube, false, {0, 2, 0}, {0, -1, 0});
    client->camera(++sequence, 0, inTheTube, false, {0, 0, 1}, {0, -1, 0}, 171);
    client->slice(++sequence, 0, inTheTube, 1, false);
    client->camera(++sequence, 1, inTheTube, false);
    client->slice(++sequence, 1, inTheTube, 0.5, false);
    client->slice(++sequence, 1, inTheTube, nan, false);
    client->slice(sequence, 1, inTheTube, 1, false);  // a sequence number used twice
    for (int n = 0; n < 11; ++n)
        expectError(client->answer(), ErrorReport::BAD_VALUE, false);

    auto bookmark = TestClient::bookmark(77, "key", std::string(2001, 'x'));
    client->send(bookmark);
    auto answer = client->answer();
    expectError(answer, ErrorReport::BAD_VALUE, false);
    EXPECT_EQ(answer->error().request(), 77u);
    for (const auto& [key, note] :
         {std::pair("", "note"), {"with space", "note"}, {"key", "bell\a"}}) {
        client->send(TestClient::bookmark(78, key, note));
        expectError(client->answer(), ErrorReport::BAD_VALUE, false);
    }
    client->slice(++sequence, 1, inTheTube, 1, false);
    ASSERT_TRUE(client->picture());
}

TEST_F(ServerTest, AClientThatVanishesDisturbsNobody) {
    auto bystander = opened();
    bystander->viewport(1, 0, protocol::ENDOSCOPIC, 96, 96);
    std::uint64_t sequence = 1;
    for (int n = 0; n < 12; ++n) {
        auto client = opened();
        client->viewport(1, 0, protocol::ENDOSCOPIC, 512, 512);
        client->camera(2, 0, inTheTube, true);
        if (n % 3 == 1) client->sendBytes({0x40, 0x00, 0x00});                    // half a header
        if (n % 3 == 2) client->sendBytes({0x40, 0x00, 0x00, 0x00, 0x01, 0x0a});  // half a message
        client->vanish();
        bystander->camera(++sequence, 0, {-1.2, 2.2, 108.0 + n}, false);
        const auto picture = bystander->picture();
        ASSERT_TRUE(picture);
        EXPECT_EQ(picture->header.sequence, sequence);
        EXPECT_TRUE(picture->header.exact);
    }
}

TEST_F(ServerTest, NewestInputWinsAndEchoesNeverGoBack) {
    auto client = opened();
    client->viewport(1, 0, protocol::ENDOSCOPIC, 200, 150);
    client->viewport(2, 5, protocol::SAGITTAL, 64, 64);
    constexpr std::uint64_t inputs = 400;
    std::uint64_t sequence = 2;
    for (std::uint64_t n = 0; n < inputs; n += 2) {
        client->camera(++sequence, 0, {-1.2, 2.2, 105.0 + 0.1 * double(n)}, true);
        client->slice(++sequence, 5, {-1.2, 2.2, 105.0 + 0.1 * double(n)}, 1.0, true);
    }
    const std::uint64_t lastCamera = sequence - 1, lastSlice = sequence;
    std::map<int, std::uint64_t> newest;
    std::uint32_t pictures = 0;
    bool cameraAtRest = false, sliceAtRest = false;
    while (!cameraAtRest || !sliceAtRest) {
        const auto picture = client->picture();
        ASSERT_TRUE(picture) << "no exact still after the last input";
        const auto& header = picture->header;
        EXPECT_EQ(header.picture, ++pictures);
        EXPECT_GE(header.sequence, newest[header.viewport]);
        newest[header.viewport] = header.sequence;
        EXPECT_EQ(header.exact, header.codec == protocol::TileCodec::lossless);
        if (header.exact && header.sequence == lastCamera) cameraAtRest = true;
        if (header.exact && header.sequence == lastSlice) sliceAtRest = true;
    }
    EXPECT_LT(pictures, inputs) << "inputs that had been overtaken were drawn";
    EXPECT_FALSE(client->next(std::chrono::milliseconds(400))) << "a picture that nobody asked for";
}

TEST_F(ServerTest, AClientWithoutJpegGetsLosslessWhileMoving) {
    auto client = connected();
    ASSERT_TRUE(client->hello(protocol::protocolVersion, {"lossless"})->has_welcome());
    ASSERT_TRUE(client->openCase(smallCaseName)->has_case_opened());
    client->viewport(1, 0, protocol::ENDOSCOPIC, 64, 64);
    client->camera(2, 0, inTheTube, true);
    const auto picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->header.codec, protocol::TileCodec::lossless);
}

// Small at most while it moves, at most for who takes them so, and whole at rest.
TEST_F(ServerTest, MovingPicturesAreCoarseOnlyForWhoTakesThemSo) {
    for (const bool takesCoarse : {true, false}) {
        auto client = connected();
        std::vector<std::string> capabilities{"jpeg", "lossless"};
        if (takesCoarse) capabilities.push_back("coarse");
        ASSERT_TRUE(client->hello(protocol::protocolVersion, capabilities)->has_welcome());
        ASSERT_TRUE(client->openCase(smallCaseName)->has_case_opened());
        client->viewport(1, 0, protocol::ENDOSCOPIC, 800, 600);
        std::uint64_t sequence = 1;
        for (int n = 0; n < 4; ++n) {
            client->camera(++sequence, 0, {-1.2, 2.2, 110.0 + n}, true);
            const auto picture = client->picture();
            ASSERT_TRUE(picture);
            const auto& header = picture->header;
            EXPECT_EQ(header.viewportWidth, 800);
            EXPECT_EQ(header.viewportHeight, 600);
            EXPECT_TRUE(takesCoarse || header.pictureWidth == 800);
        }
        for (;;) {
            const auto picture = client->picture();
            ASSERT_TRUE(picture) << "no exact still at rest";
            if (!picture->header.exact) continue;
            EXPECT_EQ(picture->header.sequence, sequence);
            EXPECT_EQ(picture->header.pictureWidth, 800);
            EXPECT_EQ(picture->header.pictureHeight, 600);
            break;
        }
    }
}

// A view that is closed while its picture is drawn, and whose place in the line another takes, is
// not drawn again: it has nothing to show.
TEST_F(ServerTest, AViewThatClosesWhileItIsDrawnIsForgotten) {
    auto client = connected();
    ASSERT_TRUE(client->hello()->has_welcome());
    ASSERT_TRUE(client->openCase(smallCaseName)->has_case_opened());
    std::uint64_t sequence = 0;
    client->viewport(++sequence, 1, protocol::AXIAL, 64, 64);
    for (int n = 0; n < 6; ++n) {
        client->viewport(++sequence, 0, protocol::ENDOSCOPIC, 2048, 2048);
        client->camera(++sequence, 0, {-1.2, 2.2, 110.0}, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(30 + 10 * n));
        client->viewport(++sequence, 0, protocol::ENDOSCOPIC, 0, 0);
        client->slice(++sequence, 1, {-1.2, 2.2, 110.0 + n}, 1.0, true);
        for (;;) {
            const auto picture = client->picture();
            ASSERT_TRUE(picture) << "the server is gone";
            if (picture->header.viewport == 1 && picture->header.sequence == sequence) break;
        }
    }
}

TEST_F(ServerTest, StillsAreTheRenderersOwnPixels) {
    const SmallCase truth = makeSmallCase();
    auto context = gpu::Context::create();
    ASSERT_TRUE(context);
    auto renderer = render::CaseRenderer::create(**context, truth.ct, truth.cleansed);
    ASSERT_TRUE(renderer);

    auto client = opened();
    render::CameraView endoscopic;
    endoscopic.camera = {{-1.2, 2.2, 112.0}, {0.1, 0.2, 1.0}, {0.0, -1.0, 0.1}, 80.0};
    endoscopic.optics = *render::opticsPreset("mucosa");
    client->viewport(1, 0, protocol::ENDOSCOPIC, 531, 300);  // more than one tile
    client->camera(2, 0, {-1.2, 2.2, 112.0}, false, {0.1, 0.2, 1.0}, {0.0, -1.0, 0.1}, 80.0);
    auto picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->header.exact);
    EXPECT_EQ(picture->header.sequence, 2u);
    EXPECT_EQ(picture->header.pictureWidth, 531);
    EXPECT_FALSE(picture->header.coarse());
    const std::uint8_t drawnBy = picture->header.raycaster;
    ASSERT_STRNE(raycasterName(drawnBy), "");
    const auto kind = raycasterFromString(raycasterName(drawnBy));
    ASSERT_TRUE(kind && (*renderer)->use(*kind)) << int(drawnBy);
    auto image = (*renderer)->render(endoscopic, 531, 300);
    ASSERT_TRUE(image);
    EXPECT_EQ(picture->rgb, image->rgb);

    // Moving, the same picture is nearly that, and it is the same again at rest.
    client->camera(3, 0, {-1.2, 2.2, 112.0}, true, {0.1, 0.2, 1.0}, {0.0, -1.0, 0.1}, 80.0);
    picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_FALSE(picture->header.exact);
    double squares = 0.0;
    for (std::size_t n = 0; n < image->rgb.size(); ++n)
        squares += std::pow(double(picture->rgb[n]) - double(image->rgb[n]), 2);
    EXPECT_GT(10.0 * std::log10(255.0 * 255.0 * double(image->rgb.size()) / squares), 30.0);
    picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->header.exact);
    EXPECT_EQ(picture->header.sequence, 3u);
    EXPECT_EQ(picture->rgb, image->rgb);

    protocol::ClientMessage preset;
    preset.mutable_set_transfer_function()->set_sequence(4);
    preset.mutable_set_transfer_function()->set_preset("translucent");
    client->send(preset);
    picture = client->picture();
    endoscopic.optics = *render::opticsPreset("translucent");
    image = (*renderer)->render(endoscopic, 531, 300);
    ASSERT_TRUE(picture && image);
    EXPECT_EQ(picture->header.sequence, 4u);
    EXPECT_EQ(picture->rgb, image->rgb);

    client->viewport(5, 1, protocol::AXIAL, 100, 90);
    protocol::ClientMessage window;
    window.mutable_set_window_level()->set_sequence(6);
    window.mutable_set_window_level()->set_viewport(1);
    window.mutable_set_window_level()->mutable_window()->set_center_hu(40);
    window.mutable_set_window_level()->mutable_window()->set_width_hu(400);
    client->send(window);
    client->slice(7, 1, inTheTube, 2.0, false);
    picture = client->picture();
    image = (*renderer)->render(SliceView{View::axial, {-1.2, 2.2, 112.0}, 2.0, {40.0, 400.0}}, 100,
                                90);
    ASSERT_TRUE(picture && image);
    EXPECT_EQ(picture->header.viewport, 1);
    EXPECT_EQ(picture->rgb, image->rgb);
}

TEST_F(ServerTest, BookmarksAreKeptOnceAndPerCase) {
    auto client = opened("scan");
    for (int n = 0; n < 2; ++n) {
        client->send(TestClient::bookmark(5, "retried", "sessile, 7 mm"));
        const auto added = client->answer();
        ASSERT_TRUE(added && added->has_bookmark_added());
        EXPECT_EQ(added->bookmark_added().request(), 5u);
    }
    auto other = opened("scan");
    protocol::ClientMessage list;
    list.mutable_list_bookmarks()->set_request(9);
    other->send(list);
    const auto listed = other->answer();
    ASSERT_TRUE(listed && listed->has_bookmark_list());
    EXPECT_EQ(listed->bookmark_list().request(), 9u);
    ASSERT_EQ(listed->bookmark_list().bookmarks_size(), 1);
    EXPECT_EQ(listed->bookmark_list().bookmarks(0).note(), "sessile, 7 mm");
    EXPECT_EQ(listed->bookmark_list().bookmarks(0).arc_mm(), 12.5);
    auto elsewhere = opened(smallCaseName);
    elsewhere->send(list);
    EXPECT_EQ(elsewhere->answer()->bookmark_list().bookmarks_size(), 0);
}

TEST_F(ServerTest, BookmarksStayWithTheirScanWhenAnotherTakesItsPlace) {
    const auto cases = store::CaseStore::open(folder_->path(), false).value();
    const auto ct = cases.openCase("scan")->readVolume<std::int16_t>("ct").value();
    const auto become = [&](const char* scan) {
        auto writer = cases.createCase("turned").value();
        ASSERT_TRUE(
            writer.bind({store::makeKey(scan, 1, "", {}), "1.2." + std::string(scan), "1"}));
        ASSERT_TRUE(writer.publishVolume("ct", store::makeKey("ct of", 1, scan, {}), ct));
    };
    const auto listed = [&](TestClient& client) {
        protocol::ClientMessage list;
        list.mutable_list_bookmarks()->set_request(9);
        client.send(list);
        return client.answer()->bookmark_list().bookmarks_size();
    };
    become("A");
    auto ofA = opened("turned");
    ofA->send(TestClient::bookmark(5, "k", "on A"));
    ASSERT_TRUE(ofA->answer()->has_bookmark_added());
    become("B");
    auto ofB = opened("turned");
    EXPECT_EQ(listed(*ofB), 0);
    EXPECT_EQ(listed(*ofA), 1) << "who still looks at A still sees what is on it";
    become("A");
    EXPECT_EQ(listed(*opened("turned")), 1);
    EXPECT_EQ(listed(*ofB), 0);
    std::filesystem::remove_all(folder_->path() / "cases" / "turned");
}

}  // namespace
}  // namespace haustra::tests
