// Oblique slices, the overview, lenses and live optics through the real haustra-server.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "gpu/context.h"
#include "render/case_renderer.h"
#include "render/optics/optics_presets.h"

#include <fstream>

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
    render::ObliqueView view{{-1.2, 2.2, 112.0},    {0.2, 0.1, 1}, {0, -1, 0}, 45.0, {},
                             render::Scan::cleansed};
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
    view.reader = render::Camera{{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 60.0};
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
    view.camera = {{-1.2, 2.2, 112.0}, {0, 0, 1}, {0, -1, 0}, 240.0, render::Lens::fisheye};
    view.optics = render::opticsPreset("mucosa").value();
    expectPicture(view);

    body->set_sequence(3);
    body->set_lens(protocol::ORTHOGRAPHIC);
    body->set_height_mm(30);
    client_->send(look);
    view.camera = {{-1.2, 2.2, 112.0},         {0, 0, 1}, {0, -1, 0}, 90.0,
                   render::Lens::orthographic, 30.0};
    expectPicture(view);

    protocol::ClientMessage optics;
    auto* set = optics.mutable_set_transfer_function();
    set->set_sequence(4);
    for (const double hu : {-600.0, 100.0}) {
        auto* point = set->add_points();
        point->set_hu(hu);
        point->set_red(0.9);
        point->set_opacity(hu > 0 ? 0.3 : 0.0);
    }
    set->set_pre_integrated(true);
    client_->send(optics);
    view.optics = {};
    view.optics.transferFunction.points = {{-600.0, {0.9, 0, 0}, 0.0}, {100.0, {0.9, 0, 0}, 0.3}};
    view.optics.preIntegrated = true;
    expectPicture(view);

    set->set_sequence(5);
    set->set_pre_integrated(false);
    set->set_composition(protocol::MAXIMUM_INTENSITY);
    client_->send(optics);
    view.optics.preIntegrated = false;
    view.optics.composition = render::Composition::maximumIntensity;
    expectPicture(view);

    set->set_sequence(6);
    set->set_composition(protocol::EMISSION_ABSORPTION);
    set->set_unlit(true);
    auto* row = set->add_rows();
    row->set_gradient_hu_per_mm(150);
    *row->mutable_points() = set->points();
    row->mutable_points(1)->set_opacity(0.8);
    client_->send(optics);
    view.optics.composition = render::Composition::emissionAbsorption;
    view.optics.shading = false;
    view.optics.transferFunction.rows = {
        {150.0, {{-600.0, {0.9, 0, 0}, 0.0}, {100.0, {0.9, 0, 0}, 0.8}}}};
    expectPicture(view);

    std::uint64_t sequence = 6;
    const auto refused = [&](auto change) {
        protocol::ClientMessage bad = optics;
        bad.mutable_set_transfer_function()->set_sequence(++sequence);
        change(*bad.mutable_set_transfer_function());
        expectRefused(bad);
    };
    refused([](auto& b) { b.set_preset("mucosa"); });
    refused([](auto& b) { b.clear_points(); });
    refused([](auto& b) { b.set_composition(protocol::Composition(9)); });
    refused([](auto& b) { b.set_pre_integrated(true); });  // of a 2-D function
    refused([](auto& b) { *b.add_rows() = b.rows(0); });   // no steeper
    refused([](auto& b) { b.mutable_rows(0)->set_gradient_hu_per_mm(NAN); });
    refused([](auto& b) { b.mutable_rows(0)->mutable_points(0)->set_opacity(1.5); });
    refused([](auto& b) { b.mutable_rows(0)->clear_points(); });
    refused([](auto& b) {
        for (int n = 0; n < 80; ++n) {
            *b.add_rows() = b.rows(0);
            b.mutable_rows(n + 1)->set_gradient_hu_per_mm(200 + n);
        }
    });
}

TEST_F(ServerViews, AFolderOfPresetsIsOfferedAndABadFileIsNot) {
    const auto& names = opened_.case_opened().transfer_functions();
    EXPECT_EQ(names.Get(0), "mucosa");
    EXPECT_EQ(std::count(names.begin(), names.end(), "plain"), 1);
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
