// The coloured wall of the real haustra-server: bookmarks, and what a session has not been shown.
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ClientMessage;
using protocol::ErrorReport;
using protocol::ServerMessage;

constexpr int side = 96;

class ServerPaintTest : public FlatServer {
protected:
    std::unique_ptr<TestClient> reader(const std::string& name = smallCaseName) {
        auto client = std::make_unique<TestClient>(server_->port());
        EXPECT_TRUE(client->hello());
        const auto opened = client->openCase(name);
        EXPECT_TRUE(opened && opened->has_case_opened());
        return client;
    }
    /// An endoscopic picture from the axis, at rest.
    static TestPicture look(TestClient& client, std::uint64_t sequence, double z = 10.0) {
        client.viewport(sequence, 0, protocol::ENDOSCOPIC, side, side);
        client.camera(sequence + 1, 0, {0, 0, z}, false);
        return awaitPicture(client, 0, sequence + 1);
    }
    static TestPicture awaitPicture(TestClient& client, int viewport, std::uint64_t sequence) {
        for (;;) {
            auto picture = client.picture();
            if (!picture) throw std::runtime_error("no picture came");
            if (picture->header.viewport == viewport && picture->header.sequence >= sequence)
                return std::move(*picture);
        }
    }
    static ClientMessage paint(std::uint64_t sequence, bool marks, bool unseen,
                               double radiusMm = 0.0) {
        ClientMessage message;
        auto* body = message.mutable_set_wall_paint();
        body->set_sequence(sequence);
        body->set_marks(marks);
        body->set_unseen(unseen);
        body->set_mark_radius_mm(radiusMm);
        return message;
    }
    static double seen(TestClient& client, std::uint64_t request, bool forget = false) {
        ClientMessage message;
        message.mutable_ask_seen()->set_request(request);
        message.mutable_ask_seen()->set_forget(forget);
        client.send(message);
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no answer came");
            if (answer->has_wall_seen() && answer->wall_seen().request() == request)
                return answer->wall_seen().share();
        }
    }
    /// Looks at a place of the wall from the axis.
    static ClientMessage bookmark(const std::string& key, glm::dvec3 place) {
        ClientMessage message = TestClient::bookmark(1, key, "a finding");
        auto* body = message.mutable_add_bookmark();
        TestClient::set(body->mutable_position_mm(), {0, 0, 10.0});
        TestClient::set(body->mutable_forward(), {place.x, place.y, place.z - 10.0});
        TestClient::set(body->mutable_up(), {place.y, -place.x, 0.0});
        return message;
    }
    /// On the flank of a fold that faces look()'s camera.
    static glm::dvec3 facing(double x) {
        glm::dvec3 place(0.0);
        for (double y = 0.5 * tube().height(); y < tube().height(); y += 0.005) {
            place = tube().positionMm({x, y});
            const glm::dvec3 back = glm::normalize(glm::dvec3(0, 0, 10) - place);
            if (glm::dot(back, tube().inwardNormal({x, y})) > 0.8) break;
        }
        return place;
    }
    static void openStrip(TestClient& client, std::uint64_t sequence) {
        client.viewport(sequence, 4, protocol::FLATTENED, 64, 128);
        ClientMessage strip;
        strip.mutable_set_flat()->set_sequence(sequence + 1);
        strip.mutable_set_flat()->set_viewport(4);
        client.send(strip);
    }
    static glm::ivec3 pixel(const TestPicture& picture, int x, int y) {
        const std::uint8_t* rgb =
            &picture.rgb[3 * std::size_t(y * picture.header.pictureWidth + x)];
        return {rgb[0], rgb[1], rgb[2]};
    }
    /// Where look()'s camera has a place: its right is forward × up = (1, 0, 0).
    static glm::dvec2 projected(glm::dvec3 place, double z = 10.0) {
        const double depth = place.z - z;
        return 0.5 * side * (1.0 + glm::dvec2(place.x, place.y) / depth);
    }
    static void expectRefusal(TestClient& client, ErrorReport::Code code) {
        const auto answer = client.answer();
        ASSERT_TRUE(answer && answer->has_error());
        EXPECT_EQ(answer->error().code(), code) << answer->error().message();
        EXPECT_FALSE(answer->error().fatal());
    }
};

TEST_F(ServerPaintTest, BookmarksAreDiscsOnTheWallForWhoeverWantsThem) {
    const auto mine = reader(), others = reader();
    const TestPicture plain = look(*mine, 1);
    ASSERT_EQ(look(*others, 1).rgb, plain.rgb);
    const glm::dvec3 place = facing(0.3);
    mine->send(paint(3, true, false, 2.0));
    EXPECT_EQ(awaitPicture(*mine, 0, 3).rgb, plain.rgb) << "no bookmark yet";
    // Another reader's: it appears by itself, in pictures of the newest input.
    others->send(bookmark("theirs", place));
    for (auto answer = others->answer(); !answer->has_bookmark_added(); answer = others->answer())
        ASSERT_TRUE(answer->has_wall_seen()) << answer->ShortDebugString();
    const TestPicture marked = awaitPicture(*mine, 0, 3);
    EXPECT_TRUE(marked.header.exact);
    EXPECT_EQ(marked.header.sequence, 3u);
    const glm::dvec2 at = projected(place);
    // Of what is within the radius, and a pixel or two of the strip more, through space.
    const double reachMm = 2.6, depth = place.z - 10.0, aside = std::hypot(place.x, place.y);
    const double reachPixels =
        0.5 * side * (reachMm + reachMm * aside / depth) / (depth - reachMm) + 1.0;
    int changed = 0;
    for (int row = 0; row < side; ++row) {
        for (int x = 0; x < side; ++x) {
            if (pixel(marked, x, row) == pixel(plain, x, row)) continue;
            ++changed;
            EXPECT_LT(glm::distance(glm::dvec2(x + 0.5, row + 0.5), at), reachPixels);
        }
    }
    EXPECT_GT(changed, 8);
    const glm::ivec2 middle(at);
    EXPECT_NE(pixel(marked, middle.x, middle.y), pixel(plain, middle.x, middle.y));
    EXPECT_LT(pixel(marked, middle.x, middle.y).b, pixel(plain, middle.x, middle.y).b);
    // Who has not asked for marks has none, and without them pictures are as before.
    EXPECT_EQ(look(*others, 3).rgb, plain.rgb);
    mine->send(paint(4, false, false));
    EXPECT_EQ(awaitPicture(*mine, 0, 4).rgb, plain.rgb);
    // Who asks later has those that are there.
    others->send(paint(5, true, false, 2.0));
    EXPECT_EQ(awaitPicture(*others, 0, 5).rgb, marked.rgb);
}

// The place that comes with a bookmark is the one that its disc is painted around, also where
// another wall is nearer to the camera than the one that it looks at.
TEST_F(ServerPaintTest, TheMarkOfABookmarkIsTheMiddleOfItsDisc) {
    const auto client = reader();
    std::uint64_t sequence = 0;
    // Away from where the other tests have theirs.
    for (const double x : {0.05, 0.83}) {
        const auto strip = [&](glm::dvec2 center) {
            client->viewport(++sequence, 5, protocol::FLATTENED_ZOOM, 200, 200);
            ClientMessage window;
            window.mutable_set_flat()->set_sequence(++sequence);
            window.mutable_set_flat()->set_viewport(5);
            window.mutable_set_flat()->mutable_center()->set_x(center.x);
            window.mutable_set_flat()->mutable_center()->set_y(center.y);
            window.mutable_set_flat()->set_pixels_per_circumference(700);
            client->send(window);
            return awaitPicture(*client, 5, sequence);
        };
        const glm::dvec3 place = facing(x);
        // Where the gaze first meets the wall, by the tube's own shape.
        const double slope = std::hypot(place.x, place.y) / (place.z - 10.0);
        double y = 0.0;
        const auto isBeyond = [&] {
            const glm::dvec3 wall = tube().positionMm({0.0, y});
            return wall.z > 10.0 && wall.x <= slope * (wall.z - 10.0);
        };
        while (!isBeyond())
            y += 0.001;
        const glm::dvec2 expected(x, y);
        client->send(bookmark("middle" + std::to_string(x), place));
        std::optional<protocol::Bookmark> told;
        while (!told) {
            const auto answer = client->answer();
            ASSERT_TRUE(answer);
            if (answer->has_bookmark_added()) told = answer->bookmark_added().bookmark();
        }
        ASSERT_TRUE(told->has_mark());
        const glm::dvec2 mark(told->mark().flat().x(), told->mark().flat().y());
        EXPECT_LT(glm::distance(mark, expected), 0.02);
        client->send(paint(++sequence, false, false));
        const TestPicture bare = strip(mark);
        client->send(paint(++sequence, true, false, 3.0));
        const TestPicture marked = strip(mark);
        glm::dvec2 sum(0.0), low(200.0), high(0.0);
        int changed = 0;
        for (int row = 0; row < 200; ++row)
            for (int column = 0; column < 200; ++column)
                if (pixel(bare, column, row) != pixel(marked, column, row)) {
                    const glm::dvec2 at(column + 0.5, row + 0.5);
                    sum += at, ++changed;
                    low = glm::min(low, at), high = glm::max(high, at);
                }
        ASSERT_GT(changed, 100);
        const double radius = 0.25 * (high.x - low.x + high.y - low.y);
        EXPECT_LT(glm::distance(sum / double(changed), glm::dvec2(100.0)), 0.2 * radius)
            << "of a disc of " << radius << " pixels";
    }
}

TEST_F(ServerPaintTest, EachSessionHasSeenWhatItWasShown) {
    const auto mine = reader(), others = reader();
    EXPECT_EQ(seen(*mine, 1), 0.0);
    look(*mine, 1);
    const double one = seen(*mine, 2);
    EXPECT_GT(one, 0.05);
    EXPECT_LT(one, 0.9);
    EXPECT_EQ(seen(*others, 3), 0.0);
    look(*mine, 3, 30.0);
    EXPECT_GT(seen(*mine, 4), one);
    EXPECT_EQ(seen(*others, 5), 0.0);
    EXPECT_EQ(seen(*mine, 6, true), 0.0);
    // Slices and strips show nothing of the wall as an eye would.
    mine->viewport(10, 4, protocol::FLATTENED, 64, 64);
    ClientMessage strip;
    strip.mutable_set_flat()->set_sequence(11);
    strip.mutable_set_flat()->set_viewport(4);
    mine->send(strip);
    awaitPicture(*mine, 4, 11);
    EXPECT_EQ(seen(*mine, 7), 0.0);
}

TEST_F(ServerPaintTest, WhatIsNotSeenIsColouredAlsoInTheStrip) {
    const auto client = reader();
    openStrip(*client, 1);
    const TestPicture plain = awaitPicture(*client, 4, 2);
    const auto changed = [&](const TestPicture& picture) {
        int pixels = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 64; ++x)
                pixels += pixel(picture, x, y) != pixel(plain, x, y);
        return pixels;
    };
    client->send(paint(3, false, true));
    const int all = changed(awaitPicture(*client, 4, 3));
    EXPECT_GT(all, 2000);
    const TestPicture first = look(*client, 4);
    EXPECT_GT(seen(*client, 1), 0.05);
    // It is drawn again by itself, and what the camera has shown has its own colour.
    const int left = changed(awaitPicture(*client, 4, 3));
    EXPECT_LT(left, all - 200);
    EXPECT_GT(left, 200);
    // Paint that is turned on late knows of it.
    client->send(paint(6, false, false));
    EXPECT_EQ(awaitPicture(*client, 4, 6).rgb, plain.rgb);
    client->send(paint(7, false, true));
    EXPECT_EQ(changed(awaitPicture(*client, 4, 7)), left);
}

TEST_F(ServerPaintTest, TheStripShowsWhatWasSeenInAMovementWhenItEnds) {
    const auto client = reader();
    openStrip(*client, 1);
    client->send(paint(3, false, true));
    const TestPicture unseen = awaitPicture(*client, 4, 3);
    client->viewport(4, 0, protocol::ENDOSCOPIC, side, side);
    std::optional<TestPicture> strip;
    const auto next = [&] {
        auto picture = client->picture();
        if (!picture) throw std::runtime_error("no picture came");
        const protocol::TileHeader header = picture->header;
        if (header.viewport == 4) strip = std::move(*picture);
        return header;
    };
    // Long enough for what the first picture shows to be painted while others follow, which show
    // nothing more.
    std::uint64_t sequence = 5;
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(1600);
    for (; std::chrono::steady_clock::now() < until; ++sequence) {
        client->camera(sequence, 0, {0, 0, 10.0}, true);
        for (auto header = next(); header.viewport != 0 || header.sequence < sequence;)
            header = next();
    }
    client->camera(sequence, 0, {0, 0, 10.0}, false);
    while (!strip || strip->rgb == unseen.rgb)
        next();
}

TEST_F(ServerPaintTest, ABookmarkOfAReaderWhoHasGoneIsPainted) {
    const auto mine = reader();
    look(*mine, 1);
    mine->send(paint(3, true, false, 4.0));
    const TestPicture before = awaitPicture(*mine, 0, 3);
    auto others = reader();
    others->send(bookmark("gone", facing(0.6)));
    others.reset();  // without waiting for the acknowledgement
    EXPECT_NE(awaitPicture(*mine, 0, 3).rgb, before.rgb);
}

TEST_F(ServerPaintTest, RefusesInOneSentenceAndGoesOn) {
    const auto client = reader();
    for (const double radius : {-1.0, 0.5, 20.1, std::nan(""), double(INFINITY)}) {
        static std::uint64_t sequence = 0;
        client->send(paint(++sequence, true, true, radius));
        expectRefusal(*client, ErrorReport::BAD_VALUE);
    }
    client->send(paint(1, true, false));  // the sequence does not grow
    expectRefusal(*client, ErrorReport::BAD_VALUE);
    EXPECT_EQ(seen(*client, 9), 0.0);

    const auto bare = reader("scan");
    bare->send(paint(1, true, false));
    expectRefusal(*bare, ErrorReport::BAD_VALUE);
    ClientMessage ask;
    ask.mutable_ask_seen()->set_request(5);
    bare->send(ask);
    expectRefusal(*bare, ErrorReport::BAD_VALUE);

    TestClient early(server_->port());
    ASSERT_TRUE(early.hello());
    early.send(paint(1, true, false));
    expectRefusal(early, ErrorReport::BAD_STATE);
    early.send(ask);
    expectRefusal(early, ErrorReport::BAD_STATE);
}

// The same wall, of which a stretch is a bridge: without being asked, the server hatches it in
// grey, and changes no other pixel.
TEST_F(ServerPaintTest, BridgesAreHatchedWhateverIsPainted) {
    const auto store = store::CaseStore::open(folder_->path(), false).value();
    const auto plainCase = store.openCase(smallCaseName).value();
    {
        auto bridged = store.createCase("bridged").value();
        const auto key = [](const char* stage) { return store::makeKey(stage, 2, "", {}); };
        const auto ct = plainCase.readVolume<std::int16_t>("ct").value();
        Volume<std::uint8_t> lumen(ct.grid(), std::uint8_t(0));
        for (std::size_t n = 0; n < ct.grid().voxelCount(); ++n) {
            const double z = ct.grid().patientFromVoxelPoint(ct.grid().voxelAt(n)).z;
            if (ct[n] < -480) lumen.writable()[n] = z > 24.0 && z < 32.0 ? 3 : 1;
        }
        ASSERT_TRUE(bridged.publishVolume("ct", key("ct"), ct));
        ASSERT_TRUE(bridged.publishVolume("lumen", key("lumen"), lumen));
        ASSERT_TRUE(
            bridged.publishCenterline("centerline", key("centerline"), tube().centerline()));
        ASSERT_TRUE(bridged.publishFlatMap("flatmap", key("flatmap"), tube().map()));
    }
    auto ofPlain = reader(), ofBridged = reader("bridged");
    const TestPicture plain = look(*ofPlain, 1), hatched = look(*ofBridged, 1);
    ASSERT_EQ(plain.rgb.size(), hatched.rgb.size());
    const auto spread = [](const std::uint8_t* rgb) {
        return int(std::max({rgb[0], rgb[1], rgb[2]})) - int(std::min({rgb[0], rgb[1], rgb[2]}));
    };
    int changed = 0, grey = 0;
    for (std::size_t n = 0; n < plain.rgb.size(); n += 3) {
        const auto *before = &plain.rgb[n], *now = &hatched.rgb[n];
        if (std::equal(now, now + 3, before)) continue;
        ++changed;
        grey += spread(now) <= 2;
        // At the rim of the bridge grey goes over into the wall's colour.
        EXPECT_LE(spread(now), spread(before) + 2);
    }
    EXPECT_GT(changed, side * side / 50);
    EXPECT_LT(changed, side * side / 2);
    EXPECT_GT(grey, changed / 3);
    EXPECT_LT(seen(*ofBridged, 50), 1.0);
    std::filesystem::remove_all(folder_->path() / "cases" / "bridged");
}

}  // namespace
}  // namespace haustra::tests
