// The flattened views of the real haustra-server, and its answers about the wall, on a tube whose
// conformal map is known.
#include "core/raycasters.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"
#include "gpu/context.h"
#include "render/case_renderer.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ClientMessage;
using protocol::ErrorReport;
using protocol::ServerMessage;

class ServerFlatTest : public FlatServer {
protected:
    void SetUp() override {
        client_ = std::make_unique<TestClient>(server_->port());
        ASSERT_TRUE(client_->hello());
    }

    protocol::CaseOpened open(const std::string& name = smallCaseName) {
        const auto answer = client_->openCase(name);
        EXPECT_TRUE(answer && answer->has_case_opened());
        return answer ? answer->case_opened() : protocol::CaseOpened{};
    }
    void setFlat(std::uint64_t sequence, std::uint32_t id, glm::dvec2 center, double scale,
                 bool moving = false) {
        ClientMessage message;
        auto* body = message.mutable_set_flat();
        body->set_sequence(sequence);
        body->set_viewport(id);
        body->mutable_center()->set_x(center.x);
        body->mutable_center()->set_y(center.y);
        body->set_pixels_per_circumference(scale);
        body->set_moving(moving);
        client_->send(message);
    }
    static ClientMessage locateFlat(std::uint64_t request, glm::dvec2 flat) {
        ClientMessage message;
        message.mutable_locate_flat()->set_request(request);
        message.mutable_locate_flat()->mutable_flat()->set_x(flat.x);
        message.mutable_locate_flat()->mutable_flat()->set_y(flat.y);
        return message;
    }
    static ClientMessage locatePoint(std::uint64_t request, glm::dvec3 p) {
        ClientMessage message;
        message.mutable_locate_point()->set_request(request);
        TestClient::set(message.mutable_locate_point()->mutable_position_mm(), {p.x, p.y, p.z});
        return message;
    }
    static ClientMessage measure(std::uint64_t request, const std::vector<glm::dvec2>& points,
                                 bool closed) {
        ClientMessage message;
        auto* body = message.mutable_measure_flat();
        body->set_request(request);
        body->set_closed(closed);
        for (const glm::dvec2 point : points) {
            body->add_points()->set_x(point.x);
            body->mutable_points(body->points_size() - 1)->set_y(point.y);
        }
        return message;
    }
    ServerMessage ask(const ClientMessage& question) {
        client_->send(question);
        return client_->answer().value_or(ServerMessage{});
    }
    void expectRefusal(const ServerMessage& answer, ErrorReport::Code code,
                       std::uint64_t request = 0) {
        ASSERT_TRUE(answer.has_error()) << answer.ShortDebugString();
        EXPECT_EQ(answer.error().code(), code) << answer.error().message();
        EXPECT_FALSE(answer.error().fatal());
        EXPECT_EQ(answer.error().request(), request);
    }
    static glm::dvec3 vector(const protocol::Vec3& v) { return {v.x(), v.y(), v.z()}; }

    std::unique_ptr<TestClient> client_;
};

TEST_F(ServerFlatTest, TellsTheStripAndWhereEachCamerasWallLies) {
    const auto opened = open();
    ASSERT_TRUE(opened.has_flat());
    const FlatMap map = tube().map();
    EXPECT_EQ(opened.flat().height(), map.height);
    // The mean circumference lies between those of the folds' crests and valleys, stretched by the
    // folds' slopes.
    const FlatTubeShape& shape = tube().shape();
    const double valley = 2.0 * std::numbers::pi * (shape.radiusMm + shape.foldMm);
    const double crest = 2.0 * std::numbers::pi * (shape.radiusMm - shape.foldMm);
    EXPECT_GT(opened.flat().circumference_mm(), crest);
    EXPECT_LT(opened.flat().circumference_mm(), valley);
    ASSERT_EQ(opened.flat().rows_size() % 2, 0);
    ASSERT_GT(opened.flat().rows_size(), 80);
    double lastArc = 0.0, lastY = 0.0;
    for (int n = 0; n < opened.flat().rows_size(); n += 2) {
        const double arc = opened.flat().rows(n), y = opened.flat().rows(n + 1);
        EXPECT_GE(arc, lastArc);
        EXPECT_GE(y, lastY);
        lastArc = arc, lastY = y;
        // A camera is at the height of the wall that it looks at, to its share of the path.
        EXPECT_NEAR(tube().positionMm({0.0, y}).z, arc, 0.6);
    }
    open("scan");
    EXPECT_FALSE(open("scan").has_flat());
}

TEST_F(ServerFlatTest, FindsPlacesBothWays) {
    open();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (std::uint64_t n = 1; n <= 200; ++n) {
        const glm::dvec2 flat(unit(random) + double(n % 5) - 2.0, unit(random) * tube().height());
        const auto found = ask(locateFlat(n, flat));
        ASSERT_TRUE(found.has_wall_place()) << found.ShortDebugString();
        const auto& place = found.wall_place();
        EXPECT_EQ(place.request(), n);
        EXPECT_NEAR(place.flat().x(), flat.x - std::floor(flat.x), 1e-12);
        EXPECT_NEAR(place.flat().y(), flat.y, 1e-12);
        const glm::dvec3 truth = tube().positionMm(flat);
        EXPECT_LT(glm::distance(vector(place.position_mm()), truth), 0.08);
        EXPECT_NEAR(place.arc_mm(), truth.z, 1.0);
        EXPECT_NEAR(glm::distance(vector(place.camera_mm()), {0, 0, place.arc_mm()}), 0.0, 1e-9);
        EXPECT_LT(place.triangle(), 2u * 72u * 120u);

        const auto back = ask(locatePoint(1000 + n, vector(place.position_mm())));
        ASSERT_TRUE(back.has_wall_place());
        EXPECT_EQ(back.wall_place().request(), 1000 + n);
        const double around = std::abs(back.wall_place().flat().x() - place.flat().x());
        EXPECT_LT(std::min(around, 1.0 - around), 1e-9);
        EXPECT_NEAR(back.wall_place().flat().y(), place.flat().y(), 1e-9);
    }
}

TEST_F(ServerFlatTest, MeasuresTheSurfaceAndNotTheStrip) {
    open();
    // Half around, at the top of a fold and between two, where the strip is equally wide.
    for (const double z : {7.5, 15.0}) {
        const auto at = ask(locatePoint(1, {20.0, 0.0, z}));
        const double y = at.wall_place().flat().y();
        const double radius =
            std::hypot(at.wall_place().position_mm().x(), at.wall_place().position_mm().y());
        const auto half = ask(measure(2, {{0.8, y}, {1.3, y}}, false));
        ASSERT_TRUE(half.has_flat_measure()) << half.ShortDebugString();
        EXPECT_EQ(half.flat_measure().request(), 2u);
        EXPECT_NEAR(half.flat_measure().length_mm(), std::numbers::pi * radius, 0.05);
        EXPECT_NEAR(half.flat_measure().straight_mm(), 2.0 * radius, 0.05);
        EXPECT_EQ(half.flat_measure().area_mm2(), 0.0);
    }
    // A small circle in the strip is nearly one on the wall: conformal.
    const glm::dvec2 center(0.97, 0.4 * tube().height());
    constexpr double radius = 0.02;
    std::vector<glm::dvec2> circle;
    for (int n = 0; n < 100; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / 100;
        circle.push_back(center + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    const auto answer = ask(measure(3, circle, true));
    ASSERT_TRUE(answer.has_flat_measure()) << answer.ShortDebugString();
    const auto& measured = answer.flat_measure();
    const double diameter = glm::distance(tube().positionMm(center + glm::dvec2(radius, 0)),
                                          tube().positionMm(center - glm::dvec2(radius, 0)));
    EXPECT_NEAR(measured.largest_diameter_mm(), diameter, 0.1 * diameter);
    EXPECT_NEAR(measured.length_mm(), std::numbers::pi * diameter, 0.05 * diameter);
    EXPECT_NEAR(measured.area_mm2(), std::numbers::pi / 4 * diameter * diameter,
                0.05 * diameter * diameter);
}

TEST_F(ServerFlatTest, PicturesAreTheRenderersOwnPixels) {
    auto context = gpu::Context::create();
    ASSERT_TRUE(context);
    auto prepared = render::prepareCase(tube().scan(), {});
    ASSERT_TRUE(prepared);
    prepared->flatMap = std::make_shared<const FlatMap>(tube().map());
    auto renderer = render::CaseRenderer::upload(**context, std::move(*prepared));
    ASSERT_TRUE(renderer);
    open();
    const auto mucosa = *render::opticsPreset("mucosa");

    client_->viewport(1, 5, protocol::FLATTENED_ZOOM, 150, 120);
    setFlat(2, 5, {-0.75, 0.4}, 220.0);
    auto picture = client_->picture();
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->header.exact);
    EXPECT_EQ(picture->header.sequence, 2u);
    const auto kind = raycasterFromString(raycasterName(picture->header.raycaster));
    ASSERT_TRUE(kind && (*renderer)->use(*kind));
    auto image = (*renderer)->render(render::FlatView{{{0.25, 0.4}, 220.0}, mucosa, {}}, 150, 120);
    ASSERT_TRUE(image);
    EXPECT_EQ(picture->rgb, image->rgb);

    client_->viewport(3, 4, protocol::FLATTENED, 160, 130);
    setFlat(4, 4, {}, 0.0);  // the strip shows all of it, whatever the window
    picture = client_->picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->header.viewport, 4);
    image = (*renderer)->render(render::FlatOverview{mucosa, {}}, 160, 130);
    ASSERT_TRUE(image);
    EXPECT_EQ(picture->rgb, image->rgb);

    ClientMessage preset;
    preset.mutable_set_transfer_function()->set_sequence(5);
    preset.mutable_set_transfer_function()->set_viewport(5);
    preset.mutable_set_transfer_function()->set_preset("translucent");
    client_->send(preset);
    picture = client_->picture();
    image = (*renderer)->render(
        render::FlatView{{{0.25, 0.4}, 220.0}, *render::opticsPreset("translucent"), {}}, 150, 120);
    ASSERT_TRUE(picture && image);
    EXPECT_EQ(picture->rgb, image->rgb);

    // Far out the scale is that at which eight circumferences are seen.
    setFlat(6, 5, {0.5, 0.5}, 16.0);
    picture = client_->picture();
    image = (*renderer)->render(
        render::FlatView{{{0.5, 0.5}, 150.0 / 8}, *render::opticsPreset("translucent"), {}}, 150,
        120);
    ASSERT_TRUE(picture && image);
    EXPECT_EQ(picture->rgb, image->rgb);
}

TEST_F(ServerFlatTest, MovingPicturesAreJpegAndEndInAnExactOne) {
    open();
    client_->viewport(1, 5, protocol::FLATTENED_ZOOM, 96, 96);
    constexpr std::uint64_t last = 120;
    for (std::uint64_t n = 2; n <= last; ++n)
        setFlat(n, 5, {0.5, 0.005 * double(n)}, 90.0, true);
    int pictures = 0;
    std::uint64_t newest = 0;
    for (;;) {
        const auto picture = client_->picture();
        ASSERT_TRUE(picture);
        ++pictures;
        EXPECT_GE(picture->header.sequence, newest);
        newest = picture->header.sequence;
        if (picture->header.exact) break;
    }
    EXPECT_EQ(newest, last);
    EXPECT_LT(pictures, int(last)) << "windows that had been overtaken were drawn";
}

TEST_F(ServerFlatTest, WithoutAFlatMapViewsAndQuestionsAreRefused) {
    expectRefusal(ask(locateFlat(1, {0.5, 0.5})), ErrorReport::BAD_STATE, 1);
    open("scan");
    client_->viewport(1, 4, protocol::FLATTENED, 64, 64);
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    client_->viewport(2, 5, protocol::FLATTENED_ZOOM, 64, 64);
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    expectRefusal(ask(locateFlat(7, {0.5, 0.5})), ErrorReport::BAD_VALUE, 7);
    expectRefusal(ask(locatePoint(8, {0, 0, 0})), ErrorReport::BAD_VALUE, 8);
    expectRefusal(ask(measure(9, {{0, 0}, {1, 1}}, false)), ErrorReport::BAD_VALUE, 9);
    client_->viewport(3, 1, protocol::AXIAL, 40, 32);
    client_->slice(4, 1, {-1.2, 2.2, 112.0}, 1.0, false);
    EXPECT_TRUE(client_->picture());
}

TEST_F(ServerFlatTest, HostileValuesAreRefusedAndTheSessionGoesOn) {
    open();
    const double nan = std::nan(""), infinity = INFINITY, height = tube().height();
    std::uint64_t n = 1;
    client_->viewport(n, 5, protocol::FLATTENED_ZOOM, 64, 64);
    client_->viewport(++n, 4, protocol::FLATTENED, 64, 64);
    client_->viewport(++n, 0, protocol::ENDOSCOPIC, 64, 64);
    const auto refused = [&](glm::dvec2 center, double scale) {
        setFlat(++n, 5, center, scale);
        expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    };
    for (const double bad : {nan, infinity, -infinity, 1e300}) {
        refused({bad, 0.5}, 100.0);
        refused({0.5, bad}, 100.0);
    }
    for (const double bad : {nan, 0.0, -1.0, 15.9, 65537.0, infinity})
        refused({0.5, 0.5}, bad);
    setFlat(++n, 0, {0.5, 0.5}, 100.0);  // an endoscopic view shows no strip
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    client_->camera(++n, 5, {0, 0, 30}, false);
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    client_->slice(++n, 4, {0, 0, 30}, 1.0, false);
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);
    client_->viewport(++n, 6, protocol::View(99), 64, 64);
    expectRefusal(*client_->answer(), ErrorReport::BAD_VALUE);

    for (const glm::dvec2 bad : {glm::dvec2(nan, 0.1),
                                 glm::dvec2(0.1, nan),
                                 {1e7, 0.1},
                                 {0.1, -0.01},
                                 {0.1, height * 1.001},
                                 {0.1, infinity}})
        expectRefusal(ask(locateFlat(11, bad)), ErrorReport::BAD_VALUE, 11);
    for (const glm::dvec3 bad : {glm::dvec3(nan, 0, 0), {0, infinity, 0}, {0, 0, 1e7}})
        expectRefusal(ask(locatePoint(12, bad)), ErrorReport::BAD_VALUE, 12);

    using Points = std::vector<glm::dvec2>;
    const Points many(129, glm::dvec2(0.1, 0.1)), zigzag = [] {
        Points points;
        for (int k = 0; k < 128; ++k)
            points.push_back({k % 2 ? 31.0 : -31.0, 0.1});
        return points;
    }();
    for (const Points& bad : {Points{},
                              Points{{0.1, 0.1}},
                              many,
                              zigzag,
                              {{nan, 0}, {0, 0}},
                              {{0, 0}, {33, 0}},
                              {{0, 0}, {0, 1e9}}})
        expectRefusal(ask(measure(13, bad, false)), ErrorReport::BAD_VALUE, 13);
    for (const Points& bad : {Points{{0, 0}, {0.1, 0.1}}, many, {{0, 0}, {1.01, 0}, {0.5, 0.3}}})
        expectRefusal(ask(measure(14, bad, true)), ErrorReport::BAD_VALUE, 14);

    // Beyond the strip's ends a line is held to it; a point far away has a nearest place.
    EXPECT_TRUE(ask(measure(15, {{0.5, -50.0}, {0.5, 50.0}}, false)).has_flat_measure());
    EXPECT_TRUE(ask(locatePoint(16, {-1e6, 1e6, 1e6})).has_wall_place());
    setFlat(++n, 5, {0.5, -4096.0}, 100.0);  // nothing but black is there
    const auto picture = client_->picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->rgb, TestClient::Bytes(std::size_t(64 * 64 * 3), 0));
}

TEST_F(ServerFlatTest, ManyQuestionsAreAnsweredInTheirOrder) {
    open();
    TestClient::Bytes all;
    constexpr std::uint64_t questions = 600;
    for (std::uint64_t n = 1; n <= questions; ++n) {
        const double y = tube().height() * double(n) / questions;
        const auto bytes =
            TestClient::frameOf(n % 7 == 0   ? measure(n, {{0.1, y}, {0.4, 0.2}, {0.2, 0.9}}, true)
                                : n % 3 == 0 ? locatePoint(n, {3.0, 2.0, double(n) / 10})
                                             : locateFlat(n, {0.3, y}));
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    client_->sendBytes(all);
    for (std::uint64_t n = 1; n <= questions; ++n) {
        const auto answer = client_->answer();
        ASSERT_TRUE(answer && (answer->has_wall_place() || answer->has_flat_measure()));
        EXPECT_EQ(answer->has_wall_place() ? answer->wall_place().request()
                                           : answer->flat_measure().request(),
                  n);
    }
}

}  // namespace
}  // namespace haustra::tests
