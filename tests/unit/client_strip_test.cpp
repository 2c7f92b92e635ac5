// The strip as the client knows it, the window onto it, the fly-over, and descriptions of strips
// that a server should not send.
#include "protocol/framing.h"
#include "protocol/optics_message.h"
#include "reader/incoming_messages.h"
#include "reader/strip_tour.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

FlatStrip evenStrip() {
    return {10.0, 100.0, {{0.0, 0.2}, {500.0, 5.0}, {900.0, 9.5}}};
}

TEST(ClientStrip, RowsAndArcsInterpolateAndAreHeldAtTheEnds) {
    const FlatStrip strip = evenStrip();
    EXPECT_DOUBLE_EQ(strip.yAtArc(500.0), 5.0);
    EXPECT_DOUBLE_EQ(strip.yAtArc(700.0), 7.25);
    EXPECT_DOUBLE_EQ(strip.yAtArc(-5.0), 0.2);
    EXPECT_DOUBLE_EQ(strip.yAtArc(1e4), 9.5);
    for (double arc = 0.0; arc <= 900.0; arc += 12.5)
        EXPECT_NEAR(strip.arcAtY(strip.yAtArc(arc)), arc, 1e-9);
    // Where several cameras look at one row, the middle of them.
    const FlatStrip level{3.0, 100.0, {{0, 0}, {10, 1}, {20, 1}, {30, 1}, {40, 2}}};
    EXPECT_DOUBLE_EQ(level.arcAtY(1.0), 20.0);
    EXPECT_DOUBLE_EQ(level.arcAtY(1.5), 35.0);
    EXPECT_DOUBLE_EQ(level.yAtArc(25.0), 1.0);
    EXPECT_DOUBLE_EQ((FlatStrip{1.0, 9.0, {{7.0, 0.5}}}).arcAtY(0.9), 7.0);
}

class ClientStripTour : public ::testing::Test {
protected:
    ClientStripTour() : tour_(evenStrip()) {
        tour_.setPaneSize({580, 300});
        tour_.showWholeCircumference();
    }
    glm::dvec2 flatAt(glm::dvec2 pixel) const {
        return tour_.window().flatFromPixel(pixel, tour_.paneSize());
    }
    StripTour tour_;
};

TEST_F(ClientStripTour, ShowsAllAroundAndAMarginWhateverThePanesSize) {
    EXPECT_NEAR(flatAt({0, 150}).x - flatAt({580, 150}).x, 1.16, 1e-12);
    tour_.setPaneSize({1000, 200});
    EXPECT_NEAR(flatAt({0, 100}).x - flatAt({1000, 100}).x, 1.16, 1e-12);
    EXPECT_EQ(wholeCircumference(1000), tour_.window().pixelsPerUnit);
}

TEST_F(ClientStripTour, WhatTheHandHoldsStaysUnderIt) {
    tour_.centerOn({0.5, 4.0});
    const glm::dvec2 held = flatAt({100, 80});
    tour_.drag({60, -25});
    EXPECT_LT(glm::distance(flatAt({160, 55}), held), 1e-12);
    tour_.zoom(1.7, {160, 55});
    EXPECT_LT(glm::distance(flatAt({160, 55}), held), 1e-12);
    tour_.zoom(1e9, {290, 150});
    EXPECT_EQ(tour_.window().pixelsPerUnit, StripTour::maxPixelsPerUnit);
    tour_.zoom(1e-9, {290, 150});
    EXPECT_EQ(tour_.window().pixelsPerUnit, 0.5 * wholeCircumference(580));
    tour_.drag({1e6, 1e6});
    EXPECT_EQ(tour_.window().center.y, 10.0);
    EXPECT_GE(tour_.window().center.x, 0.0);
    EXPECT_LT(tour_.window().center.x, 1.0);
}

TEST_F(ClientStripTour, FollowingTheCameraKeepsTheSideThatIsSeen) {
    tour_.centerOn({0.9, 1.0});
    tour_.follow(500.0);
    EXPECT_EQ(tour_.window().center, glm::dvec2(0.9, 5.0));
}

TEST_F(ClientStripTour, TheFlyOverGoesFromEndToEndAtASteadyPace) {
    tour_.setMotion(Motion::forward);
    EXPECT_EQ(tour_.motion(), Motion::paused) << "not flying over";
    tour_.zoom(4.0, {290, 150});
    tour_.setFlyingOver(true);
    EXPECT_EQ(tour_.window().pixelsPerUnit, wholeCircumference(580));
    tour_.centerOn({0.5, 0.0});
    tour_.setMotion(Motion::forward);
    double before = 0.0, arcBefore = 0.0;
    int steps = 0;
    while (tour_.motion() == Motion::forward && steps < 1000) {
        tour_.advance(0.1, 50.0, FlightDirection::antegrade);  // 50 mm of 100 mm a second
        if (tour_.motion() == Motion::forward) {
            EXPECT_NEAR(tour_.window().center.y - before, 0.05, 1e-12);
        }
        EXPECT_GE(tour_.arcMm(), arcBefore);
        before = tour_.window().center.y;
        arcBefore = tour_.arcMm();
        ++steps;
    }
    EXPECT_NEAR(steps, 200, 1);
    EXPECT_EQ(tour_.window().center.y, 10.0);
    EXPECT_EQ(tour_.arcMm(), 900.0);
    tour_.setMotion(Motion::backward);
    tour_.advance(1.0, 100.0, FlightDirection::antegrade);
    EXPECT_DOUBLE_EQ(tour_.window().center.y, 9.0);
    tour_.setMotion(Motion::forward);
    tour_.advance(1.0, 100.0, FlightDirection::retrograde);
    EXPECT_DOUBLE_EQ(tour_.window().center.y, 8.0);
    tour_.setFlyingOver(false);
    EXPECT_EQ(tour_.motion(), Motion::paused);
}

TEST(ClientFlight, LooksAtAPlaceFromThePath) {
    Centerline path;
    for (int n = 0; n <= 100; ++n)
        path.points.push_back({{double(n), 0.1 * n, std::sin(0.1 * n)}, double(n), 10.0});
    for (const FlightDirection direction :
         {FlightDirection::antegrade, FlightDirection::retrograde}) {
        Flight flight(path);
        flight.setDirection(direction);
        flight.setMotion(Motion::forward);
        for (const glm::dvec3 target :
             {glm::dvec3(50, 20, 3), {40, 5, 12}, {40, 5, -12}, {60, -9, 0}, {50, 5, 1e3}}) {
            flight.lookAt(50.0, target);
            const Camera camera = flight.camera();
            EXPECT_EQ(flight.motion(), Motion::paused);
            EXPECT_EQ(flight.arcMm(), 50.0);
            EXPECT_FALSE(flight.isFree());
            const glm::dvec3 towards = glm::normalize(target - camera.positionMm);
            EXPECT_GT(glm::dot(camera.forward, towards), 1.0 - 1e-9);
            EXPECT_NEAR(glm::dot(camera.forward, camera.up), 0.0, 1e-9);
        }
    }
}

protocol::CaseOpened soundCase() {
    protocol::CaseOpened opened;
    opened.set_name("a-case");
    opened.set_size_x(10), opened.set_size_y(10), opened.set_size_z(10);
    for (const double number : {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})
        opened.add_patient_from_voxel(number);
    auto* flat = opened.mutable_flat();
    flat->set_height(3.0);
    flat->set_circumference_mm(120.0);
    for (const double number : {0.0, 0.1, 200.0, 1.5, 350.0, 2.9})
        flat->add_rows(number);
    OpticsPreset preset{"wall", "", {}};
    preset.optics.transferFunction.points = {{-750.0, {}, 0.0}, {-550.0, {}, 1.0}};
    fill(*opened.add_presets(), preset);
    auto* trust = opened.mutable_trust();
    trust->set_confidence(0.9);
    trust->set_length_mm(1500.0);
    trust->add_warnings("the sigmoid is collapsed over 31 mm, at (1, 2, 3) mm");
    for (int n = 0; n < colonSegments; ++n) {
        auto* segment = trust->add_segments();
        segment->set_length_mm(250.0 + n);
        segment->set_diameter_mm(40.0 + n);
        segment->set_gas_ml(300.0 + n);
        segment->set_tagged_ml(20.0 + n);
        segment->set_collapsed_mm(1.0 + n);
    }
    return opened;
}

TEST(ClientCase, OnlySoundTrustIsTakenFromAServer) {
    const auto info = caseInfoFrom(soundCase());
    ASSERT_TRUE(info && info->trust);
    EXPECT_EQ(info->trust->confidence, 0.9);
    EXPECT_EQ(info->trust->warnings.size(), 1u);
    const SegmentDistension& cecum = info->trust->segments[5];
    EXPECT_EQ(cecum.lengthMm, 255.0);
    EXPECT_EQ(cecum.diameterMm, 45.0);
    EXPECT_EQ(cecum.gasMl, 305.0);
    EXPECT_EQ(cecum.taggedMl, 25.0);
    EXPECT_EQ(cecum.untaggedMl, 0.0);
    EXPECT_EQ(cecum.collapsedMm, 6.0);
    const auto refused = [](const auto& spoil) {
        protocol::CaseOpened opened = soundCase();
        spoil(*opened.mutable_trust());
        return !caseInfoFrom(opened);
    };
    for (const double bad : {-0.1, 1.1, std::nan("")})
        EXPECT_TRUE(refused([&](protocol::ColonTrust& trust) { trust.set_confidence(bad); }));
    for (const double bad : {-1.0, std::nan(""), double(INFINITY)}) {
        EXPECT_TRUE(refused([&](protocol::ColonTrust& trust) { trust.set_length_mm(bad); }));
        EXPECT_TRUE(refused(
            [&](protocol::ColonTrust& trust) { trust.mutable_segments(2)->set_gas_ml(bad); }));
    }
    EXPECT_TRUE(refused([](protocol::ColonTrust& trust) { trust.add_segments(); }));
    EXPECT_TRUE(refused([](protocol::ColonTrust& trust) {
        trust.add_warnings(std::string(protocol::maxWarningBytes + 1, 'x'));
    }));
    EXPECT_TRUE(refused([](protocol::ColonTrust& trust) {
        for (int n = 0; n < protocol::maxWarnings; ++n)
            trust.add_warnings("too many");
    }));
}

TEST(ClientCase, OnlySoundPresetsAndHistogramsAreTakenFromAServer) {
    const auto taken = [](const auto& spoil) {
        protocol::CaseOpened opened = soundCase();
        auto* histogram = opened.mutable_histogram();
        histogram->set_first_hu(-1024.0);
        histogram->set_hu_per_bin(16.0);
        for (const std::uint64_t voxels : {std::uint64_t(3), std::uint64_t(0), UINT64_MAX})
            histogram->add_voxels(voxels);
        spoil(opened);
        return bool(caseInfoFrom(opened));
    };
    EXPECT_TRUE(taken([](protocol::CaseOpened&) {}));
    EXPECT_TRUE(taken([](protocol::CaseOpened& opened) { opened.clear_histogram(); }));
    for (const double bad : {std::nan(""), double(INFINITY), -1e300})
        EXPECT_FALSE(taken([&](protocol::CaseOpened& opened) {
            opened.mutable_histogram()->set_first_hu(bad);
        })) << bad;
    for (const double bad : {std::nan(""), double(INFINITY), 0.0, -1.0, 1e300})
        EXPECT_FALSE(taken([&](protocol::CaseOpened& opened) {
            opened.mutable_histogram()->set_hu_per_bin(bad);
        })) << bad;
    EXPECT_FALSE(taken([](protocol::CaseOpened& opened) { opened.clear_presets(); }));
    EXPECT_FALSE(taken([](protocol::CaseOpened& opened) {
        opened.mutable_presets(0)->mutable_optics()->mutable_points(0)->set_opacity(2.0);
    }));
}

TEST(ClientCase, OnlyCasesThatLieSomewhereAreTakenFromAServer) {
    const auto refused = [](const auto& spoil) {
        protocol::CaseOpened opened = soundCase();
        spoil(opened);
        return !caseInfoFrom(opened);
    };
    using Opened = protocol::CaseOpened;
    EXPECT_FALSE(refused([](Opened&) {}));
    for (const char* name : {"", ".hidden", "a b", "a/b", "<b>"})
        EXPECT_TRUE(refused([&](Opened& o) { o.set_name(name); })) << name;
    EXPECT_TRUE(refused([](Opened& o) { o.set_scan("a b"); }));
    EXPECT_TRUE(refused([](Opened& o) { o.set_scan(std::string(65, 'x')); }));
    for (const double bad : {1e7, -1e300, double(INFINITY)})
        EXPECT_TRUE(refused([&](Opened& o) { o.set_patient_from_voxel(3, bad); })) << bad;
    for (const double scale : {1e-9, 1e-200, 1e7, 1e200})
        EXPECT_TRUE(refused([&](Opened& o) {
            for (double& number : *o.mutable_patient_from_voxel())
                number *= scale;
        })) << scale;
    const auto withPath = [&](const std::array<double, 5>& sample) {
        return refused([&](Opened& o) {
            for (const double number : sample)
                o.add_centerline(number);
        });
    };
    EXPECT_FALSE(withPath({1, 2, 3, 0, 10}));
    EXPECT_TRUE(withPath({1e7, 2, 3, 0, 10}));
    EXPECT_TRUE(withPath({1, 2, std::nan(""), 0, 10}));
    EXPECT_TRUE(withPath({1, 2, 3, 1e7, 10}));
    EXPECT_TRUE(withPath({1, 2, 3, 0, -1}));
    EXPECT_TRUE(refused([](Opened& o) { *o.add_presets() = o.presets(0); }));
    EXPECT_TRUE(refused([](Opened& o) {
        const protocol::OpticsPreset first = o.presets(0);
        for (int n = 0; n < 64; ++n) {
            *o.add_presets() = first;
            o.mutable_presets(n + 1)->set_name("p" + std::to_string(n));
        }
    }));
}

TEST(ClientCase, OnlySortedListsOfNamesAreTakenFromAServer) {
    const auto taken = [](const std::vector<std::string>& names) {
        protocol::CaseList list;
        for (const std::string& name : names)
            list.add_names(name);
        return bool(casesFrom(list));
    };
    EXPECT_TRUE(taken({}));
    EXPECT_TRUE(taken({"A", "a", "b-1"}));
    EXPECT_FALSE(taken({"b", "a"}));
    EXPECT_FALSE(taken({"a", "a"}));
    EXPECT_FALSE(taken({""}));
    EXPECT_FALSE(taken({std::string(65, 'x')}));
    protocol::CaseList many;
    for (int n = 0; n < 150'000; ++n)
        many.add_names(std::to_string(1'000'000 + n));
    EXPECT_EQ(casesFrom(many)->size(), protocol::maxListedCases);
}

TEST(ClientCase, OnlyBookmarksThatLookSomewhereAreTakenFromAServer) {
    protocol::Bookmark sound;
    sound.set_id(1);
    sound.set_client_key("key");
    sound.mutable_forward()->set_z(2.0);
    sound.mutable_up()->set_y(-3.0), sound.mutable_up()->set_z(1.0);
    sound.set_note("a note\non \u202Etwo lines\x07");
    const auto taken = bookmarkFrom(sound);
    ASSERT_TRUE(taken);
    EXPECT_NEAR(glm::length(taken->camera.forward), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(taken->camera.up), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(taken->camera.forward, taken->camera.up), 0.0, 1e-12);
    EXPECT_LT(taken->camera.up.y, 0.0);
    EXPECT_EQ(taken->note, "a note\non  two lines ");
    const auto refused = [&](const auto& spoil) {
        protocol::Bookmark bookmark = sound;
        spoil(bookmark);
        return !bookmarkFrom(bookmark);
    };
    using Message = protocol::Bookmark;
    EXPECT_TRUE(refused([](Message& b) { b.set_id(0); }));
    EXPECT_TRUE(refused([](Message& b) { b.clear_forward(); }));
    EXPECT_TRUE(refused([](Message& b) { *b.mutable_up() = b.forward(); }));
    EXPECT_TRUE(refused([](Message& b) { b.mutable_forward()->set_x(std::nan("")); }));
    EXPECT_TRUE(refused([](Message& b) { b.mutable_position_mm()->set_x(1e7); }));
    EXPECT_TRUE(refused([](Message& b) { b.set_arc_mm(-1e7); }));
    EXPECT_TRUE(refused([](Message& b) { b.set_note(std::string(2001, 'x')); }));
    EXPECT_TRUE(refused([](Message& b) { b.set_client_key("a key"); }));
}

TEST(ClientStrip, OnlySoundStripsAreTakenFromAServer) {
    const auto info = caseInfoFrom(soundCase());
    ASSERT_TRUE(info && info->flat);
    EXPECT_EQ(info->flat->rows.size(), 3u);
    EXPECT_EQ(info->flat->circumferenceMm, 120.0);
    protocol::CaseOpened without = soundCase();
    without.clear_flat();
    EXPECT_FALSE(caseInfoFrom(without)->flat);

    const double nan = std::nan("");
    const auto refused = [](const auto& spoil) {
        protocol::CaseOpened opened = soundCase();
        spoil(*opened.mutable_flat());
        return !caseInfoFrom(opened);
    };
    for (const double bad : {0.0, -1.0, nan, double(INFINITY), 5000.0})
        EXPECT_TRUE(refused([&](protocol::FlatStrip& flat) { flat.set_height(bad); })) << bad;
    for (const double bad : {0.0, -1.0, nan, double(INFINITY)})
        EXPECT_TRUE(refused([&](protocol::FlatStrip& flat) { flat.set_circumference_mm(bad); }));
    EXPECT_TRUE(refused([](protocol::FlatStrip& flat) { flat.clear_rows(); }));
    EXPECT_TRUE(refused([](protocol::FlatStrip& flat) { flat.add_rows(400.0); }));
    for (int n = 0; n < 6; ++n) {
        EXPECT_TRUE(refused([&](protocol::FlatStrip& flat) { flat.set_rows(n, nan); })) << n;
        EXPECT_TRUE(refused([&](protocol::FlatStrip& flat) { flat.set_rows(n, -1.0); })) << n;
        EXPECT_TRUE(refused([&](protocol::FlatStrip& flat) { flat.set_rows(n, INFINITY); })) << n;
    }

    protocol::WallPlace place;
    EXPECT_TRUE(placeFrom(place));
    place.mutable_position_mm()->set_y(nan);
    EXPECT_FALSE(placeFrom(place));
    place.mutable_position_mm()->set_y(0.0);
    for (const double beyond : {-0.1, 1.0, 1e17, nan}) {
        place.mutable_flat()->set_x(beyond);
        EXPECT_FALSE(placeFrom(place)) << beyond;
    }
    place.mutable_flat()->set_x(0.0);
    place.mutable_flat()->set_y(1e17);
    EXPECT_FALSE(placeFrom(place));
    protocol::FlatMeasure measure;
    EXPECT_TRUE(measureFrom(measure));
    measure.set_area_mm2(INFINITY);
    EXPECT_FALSE(measureFrom(measure));
}

}  // namespace
}  // namespace haustra::reader
