// Oblique slices, the overview, lenses and live optics through the real haustra-server.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "gpu/context.h"
#include "protocol/optics_message.h"
#include "render/case_renderer.h"
#include "render/optics/optics_presets.h"

#include <cmath>
#include <fstream>
#include <numeric>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ErrorReport;
constexpr TestClient::Vector inTheTube{-1.2, 2.2, 112.0};
constexpr char ownPreset[] = R"({"name": "plain", "shading": false,
    "points": [{"hu": -500, "color": [1, 1, 1], "opacity": 0},
               {"hu": -400, "color": [1, 0, 0], "opacity": 1}]})";

class ServerViews : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeSmallStore(folder_->path() / "store");
        std::filesystem::create_directory(folder_->path() / "presets");
        std::ofstream(folder_->path() / "presets" / "plain.json") << ownPreset;
        std::ofstream(folder_->path() / "presets" / "broken.json") << "{\"name\": ";
        server_ = std::make_unique<ServerProcess>(
            folder_->path() / "store",
            std::vector<std::string>{"--raycaster", "single-pass", "--presets",
                                     folder_->path() / "presets"});
        context_ = gpu::Context::create().value();
        const SmallCase truth = makeSmallCase();
        auto prepared = render::prepareCase(truth.ct, truth.cleansed).value();
        prepared.path = std::make_shared<const Centerline>(truth.centerline);
        renderer_ = render::CaseRenderer::upload(*context_, std::move(prepared)).value();
    }
    static void TearDownTestSuite() {
        renderer_.reset();
        context_.reset();
        server_.reset();
        folder_.reset();
    }
    void SetUp() override {
        client_ = std::make_unique<TestClient>(server_->port());
        ASSERT_TRUE(client_->hello()->has_welcome());
        opened_ = *client_->openCase(smallCaseName);
        ASSERT_TRUE(opened_.has_case_opened());
    }
    void TearDown() override { ASSERT_TRUE(server_->running()) << server_->log(); }

    void expectRefused(const protocol::ClientMessage& message) {
        client_->send(message);
        const auto answer = client_->answer();
        ASSERT_TRUE(answer && answer->has_error());
        EXPECT_EQ(answer->error().code(), ErrorReport::BAD_VALUE) << answer->error().message();
        EXPECT_FALSE(answer->error().fatal());
    }
    template <class View>
    void expectPicture(const View& view) {
        const auto picture = client_->picture();
        ASSERT_TRUE(picture);
        EXPECT_TRUE(picture->header.exact);
        const auto image = renderer_->render(view, 120, 90);
        ASSERT_TRUE(image) << describe(image.error());
        EXPECT_EQ(picture->rgb, image->rgb);
    }
    void camera(protocol::Camera* out, TestClient::Vector position, TestClient::Vector forward) {
        TestClient::set(out->mutable_position_mm(), position);
        TestClient::set(out->mutable_forward(), forward);
        TestClient::set(out->mutable_up(), {0, -1, 0});
        out->set_fov_degrees(60);
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::unique_ptr<ServerProcess> server_;
    static std::unique_ptr<gpu::Context> context_;
    static std::unique_ptr<render::CaseRenderer> renderer_;
    std::unique_ptr<TestClient> client_;
    protocol::ServerMessage opened_;
};
std::unique_ptr<TemporaryFolder> ServerViews::folder_;
std::unique_ptr<ServerProcess> ServerViews::server_;
std::unique_ptr<gpu::Context> ServerViews::context_;
std::unique_ptr<render::CaseRenderer> ServerViews::renderer_;

TEST_F(ServerViews, WhatIsNamedIsTakenWithoutTrying) {
    EXPECT_EQ(opened_.case_opened().raycaster(), "single-pass");
    EXPECT_EQ(opened_.case_opened().trials_size(), 0);
}

TEST_F(ServerViews, ObliqueSlicesAreTheRenderersOwn) {
    client_->viewport(1, 0, protocol::OBLIQUE, 120, 90);
    protocol::ClientMessage message;
    auto* body = message.mutable_set_oblique();
    body->set_sequence(2);
    TestClient::set(body->mutable_position_mm(), inTheTube);
    TestClient::set(body->mutable_forward(), {0.2, 0.1, 1});
    TestClient::set(body->mutable_up(), {0, -1, 0});
    body->set_height_mm(45);
    body->set_cleansed(true);
    client_->send(message);
    ObliqueView view{{-1.2, 2.2, 112.0}, {0.2, 0.1, 1}, {0, -1, 0}, 45.0, {}, Scan::cleansed};
    expectPicture(view);

    protocol::ClientMessage window;
    window.mutable_set_window_level()->set_sequence(3);
    window.mutable_set_window_level()->mutable_window()->set_center_hu(30);
    window.mutable_set_window_level()->mutable_window()->set_width_hu(300);
    client_->send(window);
    view.window = {30.0, 300.0};
    expectPicture(view);

    std::uint64_t sequence = 3;
    const auto refused = [&](auto change) {
        protocol::ClientMessage bad = message;
        bad.mutable_set_oblique()->set_sequence(++sequence);
        change(*bad.mutable_set_oblique());
        expectRefused(bad);
    };
    refused([](auto& b) { b.set_height_mm(0); });
    refused([](auto& b) { b.set_height_mm(1e9); });
    refused([](auto& b) { b.set_height_mm(NAN); });
    refused([](auto& b) { b.clear_forward(); });
    refused([](auto& b) { *b.mutable_up() = b.forward(); });
    refused([](auto& b) { b.mutable_position_mm()->set_x(INFINITY); });
}

TEST_F(ServerViews, TheOverviewIsTheRenderersOwn) {
    client_->viewport(1, 0, protocol::OVERVIEW, 120, 90);
    protocol::ClientMessage message;
    auto* body = message.mutable_set_overview();
    body->set_sequence(2);
    camera(body->mutable_camera(), {0, -150, 130}, {0, 1, 0.05});
    TestClient::set(body->mutable_camera()->mutable_up(), {0, 0, 1});
    camera(body->mutable_reader(), inTheTube, {0, 0, 1});
    TestClient::set(body->add_bookmarks_mm(), {0, 0, 120});
    client_->send(message);
    render::OverviewView view;
    view.camera = {{0, -150, 130}, {0, 1, 0.05}, {0, 0, 1}, 60.0};
    view.reader = Camera{{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 60.0};
    view.bookmarksMm = {{0, 0, 120}};
    view.optics = render::opticsPreset("body").value();
    expectPicture(view);

    std::uint64_t sequence = 2;
    const auto refused = [&](auto change) {
        protocol::ClientMessage bad = message;
        bad.mutable_set_overview()->set_sequence(++sequence);
        change(*bad.mutable_set_overview());
        expectRefused(bad);
    };
    refused([](auto& b) { b.clear_camera(); });
    refused([](auto& b) { b.mutable_camera()->set_lens(protocol::FISHEYE); });
    refused([](auto& b) { b.mutable_camera()->set_lens(protocol::Lens(77)); });
    refused([](auto& b) { b.mutable_reader()->clear_up(); });
    refused([](auto& b) { b.add_bookmarks_mm()->set_y(NAN); });
    refused([](auto& b) {
        for (int n = 0; n < 1100; ++n)
            b.add_bookmarks_mm()->set_z(n);
    });
}

TEST_F(ServerViews, LensesAndOpticsReachTheRaycaster) {
    client_->viewport(1, 0, protocol::ENDOSCOPIC, 120, 90);
    protocol::ClientMessage look;
    auto* body = look.mutable_set_camera();
    body->set_sequence(2);
    TestClient::set(body->mutable_position_mm(), inTheTube);
    TestClient::set(body->mutable_forward(), {0, 0, 1});
    TestClient::set(body->mutable_up(), {0, -1, 0});
    body->set_fov_degrees(240);
    body->set_lens(protocol::FISHEYE);
    client_->send(look);
    render::CameraView view;
    view.camera = {{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 240.0, Lens::fisheye};
    view.optics = render::opticsPreset("mucosa").value();
    expectPicture(view);

    body->set_sequence(3);
    body->set_lens(protocol::ORTHOGRAPHIC);
    body->set_height_mm(30);
    client_->send(look);
    view.camera = {{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 90.0, Lens::orthographic, 30.0};
    expectPicture(view);

    protocol::ClientMessage optics;
    auto* set = optics.mutable_set_transfer_function();
    set->set_sequence(4);
    for (const double hu : {-600.0, 100.0}) {
        auto* point = set->mutable_optics()->add_points();
        point->set_hu(hu);
        point->set_red(0.9);
        point->set_opacity(hu > 0 ? 0.3 : 0.0);
    }
    set->mutable_optics()->set_pre_integrated(true);
    client_->send(optics);
    view.optics = {};
    view.optics.transferFunction.points = {{-600.0, {0.9, 0, 0}, 0.0}, {100.0, {0.9, 0, 0}, 0.3}};
    view.optics.preIntegrated = true;
    expectPicture(view);

    set->set_sequence(5);
    set->mutable_optics()->set_pre_integrated(false);
    set->mutable_optics()->set_composition(protocol::MAXIMUM_INTENSITY);
    client_->send(optics);
    view.optics.preIntegrated = false;
    view.optics.composition = render::Composition::maximumIntensity;
    expectPicture(view);

    set->set_sequence(6);
    view.optics.composition = render::Composition::emissionAbsorption;
    view.optics.transferFunction.rows = {
        {150.0, {{-600.0, {0.9, 0, 0}, 0.0}, {100.0, {0.9, 0, 0}, 0.8}}}};
    view.optics.light = {20.0, 0.3, 0.5, 0.4, 8.0};
    protocol::fill(*set->mutable_optics(), view.optics);
    client_->send(optics);
    expectPicture(view);
}

TEST_F(ServerViews, OpticsThatAreNoneAreRefusedAndTheSessionGoesOn) {
    client_->viewport(1, 0, protocol::ENDOSCOPIC, 120, 90);
    render::CameraView view;
    view.camera = {{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 90.0};
    view.optics.transferFunction = {
        {{-600.0, {0.9, 0, 0}, 0.0}, {100.0, {0.9, 0, 0}, 0.3}},
        {{150.0, {{-600.0, {0.9, 0, 0}, 0.0}, {0.0, {0, 0, 1}, 1.0}, {100.0, {1, 0, 0}, 0.8}}}}};
    protocol::ClientMessage optics;
    protocol::fill(*optics.mutable_set_transfer_function()->mutable_optics(), view.optics);
    std::uint64_t sequence = 1;
    const auto refused = [&](auto change) {
        protocol::ClientMessage bad = optics;
        bad.mutable_set_transfer_function()->set_sequence(++sequence);
        change(*bad.mutable_set_transfer_function()->mutable_optics());
        expectRefused(bad);
    };
    refused([](auto& b) { b.clear_points(); });
    refused([](auto& b) { b.Clear(); });
    refused([](auto& b) { b.mutable_points()->RemoveLast(); });
    refused([](auto& b) { b.mutable_points(0)->set_hu(500.0); });  // unsorted
    refused([](auto& b) { b.mutable_points(0)->set_hu(100.0); });  // of no width
    refused([](auto& b) { b.mutable_points(0)->set_hu(-1e9); });
    refused([](auto& b) { b.mutable_points(1)->set_hu(NAN); });
    refused([](auto& b) { b.mutable_points(1)->set_hu(INFINITY); });
    refused([](auto& b) { b.mutable_points(1)->set_opacity(NAN); });
    refused([](auto& b) { b.mutable_points(1)->set_opacity(-0.1); });
    refused([](auto& b) { b.mutable_points(1)->set_opacity(1.0001); });
    refused([](auto& b) { b.mutable_points(1)->set_green(2.0); });
    refused([](auto& b) { b.mutable_points(1)->set_blue(NAN); });
    refused([](auto& b) { b.set_composition(protocol::Composition(9)); });
    refused([](auto& b) { b.set_pre_integrated(true); });  // of a 2-D function
    refused([](auto& b) { *b.add_rows() = b.rows(0); });   // no steeper
    refused([](auto& b) { b.mutable_rows(0)->set_gradient_hu_per_mm(NAN); });
    refused([](auto& b) { b.mutable_rows(0)->set_gradient_hu_per_mm(0.0); });
    refused([](auto& b) { b.mutable_rows(0)->mutable_points(0)->set_opacity(1.5); });
    refused([](auto& b) { b.mutable_rows(0)->mutable_points()->SwapElements(0, 1); });
    refused([](auto& b) { b.mutable_rows(0)->clear_points(); });
    refused([](auto& b) { b.mutable_light(); });  // that does not shine
    refused([](auto& b) { b.mutable_light()->set_half_depth_mm(NAN); });
    const auto grow = [](auto* points, int count) {
        while (points->size() < count)
            *points->Add() = *points->rbegin();
    };
    refused([&](auto& b) { grow(b.mutable_points(), 257); });
    refused([&](auto& b) { grow(b.mutable_points(), 1200); });
    // Each row has what a row may, and all together too much.
    refused([&](auto& b) {
        for (int n = 0; n < 10; ++n) {
            *b.add_rows() = b.rows(0);
            b.mutable_rows(n + 1)->set_gradient_hu_per_mm(200 + n);
            grow(b.mutable_rows(n + 1)->mutable_points(), 110);
        }
    });
    refused([](auto& b) {
        for (int n = 0; n < 80; ++n) {
            *b.add_rows() = b.rows(0);
            b.mutable_rows(n + 1)->set_gradient_hu_per_mm(200 + n);
        }
    });
    protocol::ClientMessage both = optics;
    both.mutable_set_transfer_function()->set_sequence(++sequence);
    both.mutable_set_transfer_function()->set_preset("mucosa");
    expectRefused(both);
    protocol::ClientMessage neither;
    neither.mutable_set_transfer_function()->set_sequence(++sequence);
    expectRefused(neither);

    // Rows of different lengths are sound, and all that was refused has left no trace.
    optics.mutable_set_transfer_function()->set_sequence(++sequence);
    client_->send(optics);
    client_->camera(++sequence, 0, inTheTube, false);
    expectPicture(view);
}

TEST_F(ServerViews, AMessageOverTheProtocolsBoundEndsItsSessionAlone) {
    protocol::ClientMessage endless;
    auto* points = endless.mutable_set_transfer_function()->mutable_optics();
    endless.mutable_set_transfer_function()->set_sequence(1);
    for (int n = 0; n < 10'000; ++n) {
        auto* point = points->add_points();
        point->set_hu(n);
        point->set_opacity(0.5);
        point->set_red(0.5);
    }
    TestClient other(server_->port());
    ASSERT_TRUE(other.hello()->has_welcome());
    client_->send(endless);
    const auto answer = client_->answer();
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->error().fatal());
    EXPECT_EQ(answer->error().code(), protocol::ErrorReport::BAD_MESSAGE);
    EXPECT_FALSE(answer->error().message().empty());
    protocol::ClientMessage ping;
    ping.mutable_ping()->set_request(7);
    other.send(ping);
    const auto pong = other.answer();
    ASSERT_TRUE(pong);
    EXPECT_EQ(pong->pong().request(), 7u);
}

TEST_F(ServerViews, APresetComesWithAllThatMakesIt) {
    for (const auto& sent : opened_.case_opened().presets()) {
        const auto preset = protocol::presetFrom(sent);
        ASSERT_TRUE(preset) << describe(preset.error());
        EXPECT_FALSE(preset->description.empty() && preset->name != "plain") << preset->name;
        const auto expected = preset->name == "plain"
                                  ? render::parsePreset(ownPreset, "test").value().optics
                                  : render::opticsPreset(preset->name).value();
        EXPECT_EQ(preset->optics, expected) << preset->name;
    }
    const auto& histogram = opened_.case_opened().histogram();
    EXPECT_EQ(histogram.voxels_size(), 256);
    EXPECT_GT(std::accumulate(histogram.voxels().begin(), histogram.voxels().end(), 0.0), 1000.0);
}

TEST_F(ServerViews, AFolderOfPresetsIsOfferedAndABadFileIsNot) {
    const auto& presets = opened_.case_opened().presets();
    EXPECT_EQ(presets.Get(0).name(), "mucosa");
    EXPECT_EQ(std::count_if(presets.begin(), presets.end(),
                            [](const auto& preset) { return preset.name() == "plain"; }),
              1);
    EXPECT_NE(server_->log().find("a preset is not used"), std::string::npos);

    client_->viewport(1, 0, protocol::ENDOSCOPIC, 120, 90);
    protocol::ClientMessage choose;
    choose.mutable_set_transfer_function()->set_sequence(2);
    choose.mutable_set_transfer_function()->set_preset("plain");
    client_->send(choose);
    client_->camera(3, 0, inTheTube, false);
    render::CameraView view;
    view.camera = {{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 90.0};
    view.optics = render::parsePreset(ownPreset, "test").value().optics;
    expectPicture(view);

    choose.mutable_set_transfer_function()->set_sequence(4);
    choose.mutable_set_transfer_function()->set_preset("nobody's");
    expectRefused(choose);
}

}  // namespace
}  // namespace haustra::tests
