// The reader's flattened views, against a server on the loopback: strip, window, camera and slices
// follow each other; bookmarks find their wall; lines are measured.
#include "end_to_end/fake_wall.h"
#include "end_to_end/reader_fixture.h"

namespace haustra::reader {
namespace {

using tests::FakeServer;
using tests::Misbehaviour;

class ClientFlatReader : public tests::ReaderFixture {
protected:
    using ReaderFixture::ReaderFixture;

    void SetUp() override {
        ReaderFixture::SetUp();
        for (const View view : {View::endoscopic, View::axial, View::flattened})
            reader_->setPaneSize(view, {100, 90});
        reader_->setPaneSize(View::flattenedZoom, {232, 100});
        ASSERT_TRUE(runUntil([&] { return atRest(); }));
    }
    bool atRest() const {
        if (!reader_->isOpen() || reader_->restless()) return false;
        for (const View view :
             {View::endoscopic, View::axial, View::flattened, View::flattenedZoom})
            if ((reader_->flat().hasStrip() || !isFlat(view)) &&
                !reader_->panes().picture(view).exact)
                return false;
        return true;
    }
    void expectZoomPictureOf(glm::dvec2 center, double pixelsPerCircumference) const {
        EXPECT_EQ(tiles::rgbOf(reader_->panes().picture(View::flattenedZoom)),
                  tests::syntheticPicture(
                      232, 100, tests::syntheticPosition(center, pixelsPerCircumference), 0.0));
    }
    double length() const { return FakeServer::centerline().lengthMm(); }
    static glm::dvec3 vector(const protocol::Vec3& v) { return {v.x(), v.y(), v.z()}; }
};

TEST_F(ClientFlatReader, TheWindowFollowsTheFlight) {
    EXPECT_TRUE(reader_->flat().hasStrip());
    expectZoomPictureOf({0.5, 0.0}, 200.0);  // all around, with the seam's margins
    reader_->flight().goTo(0.5 * length());
    reader_->update(0.0);
    EXPECT_NEAR(reader_->flat().tour().window().center.y, 3.0, 1e-9);
    ASSERT_TRUE(runUntil([&] { return atRest(); }));
    expectZoomPictureOf(reader_->flat().tour().window().center, 200.0);
    EXPECT_EQ(reader_->panes().shown<FlatWindow>(View::flattenedZoom)->center,
              reader_->flat().tour().window().center);
    reader_->flight().flyFreely();
    const double arc = reader_->flight().placeArcMm();
    reader_->flight().moveFreely({0.0, 0.0, 40.0});
    reader_->update(0.0);
    EXPECT_GT(reader_->flight().placeArcMm(), arc + 10.0);
    EXPECT_NEAR(reader_->flat().tour().window().center.y,
                6.0 * reader_->flight().placeArcMm() / length(), 1e-6);
}

TEST_F(ClientFlatReader, MovingTheWindowLeavesTheCamera) {
    const Camera camera = reader_->flight().camera();
    reader_->flat().tour().drag({30.0, 50.0});
    reader_->flat().tour().zoom(2.0, {116.0, 50.0});
    ASSERT_TRUE(runUntil([&] {
        return atRest() && reader_->panes().shown<FlatWindow>(View::flattenedZoom)->center ==
                               reader_->flat().tour().window().center;
    }));
    EXPECT_EQ(reader_->flight().camera(), camera);
    EXPECT_NEAR(reader_->flat().tour().window().center.y, 0.25, 1e-12);
    expectZoomPictureOf(reader_->flat().tour().window().center, 400.0);
}

TEST_F(ClientFlatReader, AClickOnTheStripLeadsAllViewsThere) {
    const glm::dvec2 flat(0.3, 2.4);
    const glm::dvec3 wall = vector(tests::fakePlace(flat).position_mm());
    reader_->flight().setMotion(Motion::forward);
    reader_->flat().goTo(flat, true);
    EXPECT_TRUE(reader_->restless());
    ASSERT_TRUE(runUntil([&] { return reader_->flat().picked().has_value(); }));
    const Camera camera = reader_->flight().camera();
    EXPECT_EQ(reader_->flight().motion(), Motion::paused);
    EXPECT_NEAR(reader_->flight().arcMm(), 0.4 * length(), 1e-9);
    EXPECT_GT(glm::dot(camera.forward, glm::normalize(wall - camera.positionMm)), 1.0 - 1e-9);
    EXPECT_EQ(reader_->flat().tour().window().center, flat);
    ASSERT_TRUE(runUntil([&] {
        return atRest() && reader_->panes().shown<FlatWindow>(View::flattenedZoom)->center == flat;
    }));
    EXPECT_LT(glm::distance(reader_->panes().shown<SliceView>(View::axial)->positionMm, wall),
              1e-9);
    EXPECT_EQ(tiles::rgbOf(reader_->panes().picture(View::endoscopic)),
              tests::syntheticPicture(100, 90, camera.positionMm, 0.0));
    expectZoomPictureOf(flat, 200.0);
    // The mark goes when the camera goes on, and slices follow the camera again.
    reader_->flight().goTo(10.0);
    reader_->update(0.0);
    EXPECT_FALSE(reader_->flat().picked());
    EXPECT_EQ(reader_->slices().slice(View::axial).positionMm,
              reader_->flight().camera().positionMm);
}

TEST_F(ClientFlatReader, TheSliceAcrossTheGazeGoesThroughThePlaceThatIsShown) {
    const auto cameraMm = [&] { return reader_->flight().camera().positionMm; };
    const auto aheadOf = [&](glm::dvec3 place) {
        const Camera gaze = reader_->flight().camera();
        return glm::dot(reader_->slices().oblique(gaze).positionMm - place, gaze.forward);
    };
    const auto goTo = [&](glm::dvec2 flat) {
        reader_->flat().goTo(flat, true);
        const glm::dvec3 wall = vector(tests::fakePlace(flat).position_mm());
        ASSERT_TRUE(runUntil([&] {
            const auto& picked = reader_->flat().picked();
            return picked && glm::distance(picked->positionMm, wall) < 1e-9;
        }));
    };
    const glm::dvec2 flat(0.3, 2.4);
    const glm::dvec3 wall = vector(tests::fakePlace(flat).position_mm());
    reader_->slices().scrollOblique(5.0);
    goTo(flat);
    EXPECT_NEAR(aheadOf(wall), 0.0, 1e-9);
    EXPECT_GT(aheadOf(cameraMm()), 1.0);
    reader_->slices().scrollOblique(3.0);
    EXPECT_NEAR(aheadOf(wall), 3.0, 1e-9);
    // Where the camera goes on it is as it was before.
    reader_->flight().goTo(10.0);
    reader_->update(0.0);
    EXPECT_NEAR(aheadOf(cameraMm()), 5.0, 1e-9);
    // Nor does it stay where others leave: not where slices are linked again, ...
    goTo(flat);
    reader_->slices().setLinked(false);
    EXPECT_NEAR(aheadOf(wall), 0.0, 1e-9);
    reader_->slices().setLinked(true);
    EXPECT_NEAR(aheadOf(cameraMm()), 5.0, 1e-9);
    // ... and of slices that are not, not where the reader goes to another place.
    goTo({0.6, 3.0});
    reader_->slices().setLinked(false);
    goTo({0.3, 4.0});
    reader_->update(0.0);
    EXPECT_NEAR(aheadOf(cameraMm()), 5.0, 1e-9);
}

TEST_F(ClientFlatReader, AClickOnTheWallBeforeTheCameraLeavesItWhereItIs) {
    reader_->flight().goTo(150.0);
    reader_->flight().setMotion(Motion::forward);
    const Camera camera = reader_->flight().camera();
    reader_->flat().pick(camera.positionMm, {1, 0, 0});
    ASSERT_TRUE(runUntil([&] { return reader_->flat().picked().has_value(); }));
    EXPECT_EQ(reader_->flight().motion(), Motion::paused);
    const WallPlace picked = *reader_->flat().picked()->wall;
    EXPECT_LT(
        glm::distance(picked.positionMm, camera.positionMm + glm::dvec3(tests::fakeRadiusMm, 0, 0)),
        1e-9);
    EXPECT_EQ(reader_->flat().tour().window().center, *picked.flat);
    ASSERT_TRUE(runUntil([&] { return atRest(); }));
    EXPECT_EQ(reader_->panes().shown<SliceView>(View::axial)->positionMm, picked.positionMm);
    EXPECT_TRUE(reader_->flat().picked());
}

TEST_F(ClientFlatReader, AClickInTheWindowLeavesItWhereItIs) {
    reader_->flat().tour().centerOn({0.5, 3.0});
    reader_->flat().goTo({1.2, 3.1}, false);  // past the seam
    ASSERT_TRUE(runUntil([&] { return reader_->flat().picked().has_value(); }));
    EXPECT_NEAR(reader_->flat().picked()->wall->flat->x, 0.2, 1e-9);
    EXPECT_EQ(reader_->flat().tour().window().center, glm::dvec2(0.5, 3.0));
    EXPECT_NEAR(reader_->flight().arcMm(), 3.1 / 6.0 * length(), 1e-9);
    reader_->flat().goTo({0.5, 99.0}, false);  // held to the strip
    ASSERT_TRUE(runUntil([&] { return reader_->flat().picked()->wall->flat->y == 6.0; }));
    EXPECT_TRUE(reader_->session().takeRefusals().empty());
}

TEST_F(ClientFlatReader, TheCameraFollowsTheFlyOver) {
    reader_->flat().setFlyingOver(true);
    reader_->flight().setSpeed(180.0);  // two circumferences a second
    reader_->setMotion(Motion::forward);
    EXPECT_EQ(reader_->flight().motion(), Motion::paused);
    const auto pictures = reader_->panes().pictureCount(View::flattenedZoom),
               followed = reader_->panes().pictureCount(View::endoscopic);
    double y = 0.0;
    ASSERT_TRUE(runUntil([&] {
        EXPECT_GE(reader_->flat().tour().window().center.y, y);
        y = reader_->flat().tour().window().center.y;
        EXPECT_NEAR(reader_->flight().arcMm(), y / 6.0 * length(), 1e-6);
        return reader_->motion() == Motion::paused;
    }));
    EXPECT_EQ(y, 6.0);
    EXPECT_GT(reader_->panes().pictureCount(View::flattenedZoom), pictures + 10);
    EXPECT_GT(reader_->panes().pictureCount(View::endoscopic), followed + 10);
    ASSERT_TRUE(runUntil([&] { return atRest(); }));
    expectZoomPictureOf({0.5, 6.0}, 200.0);
    // Whoever takes the camera elsewhere takes the fly-over along.
    reader_->setMotion(Motion::backward);
    reader_->flight().goTo(0.5 * length());
    reader_->update(0.01);
    EXPECT_EQ(reader_->motion(), Motion::paused);
    EXPECT_NEAR(reader_->flat().tour().window().center.y, 3.0, 1e-9);
    reader_->flat().setFlyingOver(false);
    reader_->setMotion(Motion::forward);
    EXPECT_EQ(reader_->flight().motion(), Motion::forward);
}

TEST_F(ClientFlatReader, BookmarksFindTheirPlaceOnTheStrip) {
    for (const double arc : {100.0, 200.0, 300.0}) {
        reader_->flight().goTo(arc);
        reader_->flight().setLook(90.0, 0.0);
        reader_->addBookmark("");
    }
    ASSERT_TRUE(runUntil([&] { return reader_->flat().wall().bookmarkPlaces().size() == 3; }));
    for (const Bookmark& bookmark : reader_->session().bookmarks()) {
        const WallPlace& place = reader_->flat().wall().bookmarkPlaces().at(bookmark.clientKey);
        EXPECT_NEAR(place.flat->y, 6.0 * bookmark.arcMm / length(), 0.2);
        EXPECT_NEAR(place.flat->x, 0.75, 1e-9) << "not the server's mark";
    }
}

class ClientFlatReaderOfAnOldServer : public ClientFlatReader {
protected:
    static Misbehaviour old() {
        Misbehaviour misbehaviour;
        misbehaviour.old = true;
        return misbehaviour;
    }
    ClientFlatReaderOfAnOldServer() : ClientFlatReader(old()) {}
};

TEST_F(ClientFlatReaderOfAnOldServer, BookmarksPlacesAreAskedFor) {
    for (const double arc : {100.0, 200.0}) {
        reader_->flight().goTo(arc);
        reader_->addBookmark("");
    }
    ASSERT_TRUE(runUntil([&] { return reader_->flat().wall().bookmarkPlaces().size() == 2; }));
    for (const Bookmark& bookmark : reader_->session().bookmarks()) {
        const WallPlace& place = reader_->flat().wall().bookmarkPlaces().at(bookmark.clientKey);
        EXPECT_NEAR(place.flat->x, 0.25, 1e-9);
    }
}

TEST_F(ClientFlatReader, LinesAndOutlinesAreMeasuredWhileTheyAreDrawn) {
    WallQuestions& wall = reader_->flat().wall();
    for (const double x : {0.6, 0.7, 0.8, 0.9})  // only the newest counts
        wall.measure({{0.5, 1.0}, {x, 1.0}}, false);
    ASSERT_TRUE(runUntil([&] {
        return wall.measurement()->result &&
               std::abs(wall.measurement()->result->lengthMm - 0.4 * 90.0) < 1e-9;
    }));
    wall.measure({{0.5, 1.0}, {0.7, 1.0}, {0.7, 1.1}, {0.5, 1.1}}, true);
    EXPECT_FALSE(wall.measurement()->result) << "a line's length is no outline's";
    ASSERT_TRUE(runUntil([&] { return wall.measurement()->result.has_value(); }));
    EXPECT_NEAR(wall.measurement()->result->areaMm2, 0.02 * 90.0 * 90.0, 1e-6);
    EXPECT_NEAR(wall.measurement()->result->largestDiameterMm, std::hypot(18.0, 9.0), 1e-6);
    wall.clearMeasurement();
    EXPECT_FALSE(wall.measurement());
}

class ClientFlatReaderWithoutStrip : public ClientFlatReader {
protected:
    static Misbehaviour bare() {
        Misbehaviour misbehaviour;
        misbehaviour.notFlattened = true;
        return misbehaviour;
    }
    ClientFlatReaderWithoutStrip() : ClientFlatReader(bare()) {}
};

TEST_F(ClientFlatReaderWithoutStrip, NothingOfItIsAskedFor) {
    EXPECT_FALSE(reader_->flat().hasStrip());
    reader_->flat().goTo({0.5, 0.5}, true);
    reader_->flat().setFlyingOver(true);
    EXPECT_FALSE(reader_->flat().tour().flyingOver());
    reader_->addBookmark("");
    EXPECT_TRUE(reader_->optics().choose("translucent"));
    reader_->flight().goTo(200.0);
    ASSERT_TRUE(runUntil([&] { return atRest(); }));
    EXPECT_EQ(reader_->panes().pictureCount(View::flattened), 0u);
    EXPECT_EQ(reader_->panes().pictureCount(View::flattenedZoom), 0u);
    EXPECT_TRUE(reader_->session().takeRefusals().empty());
    // A place before the camera can be picked all the same.
    const glm::dvec3 from = reader_->flight().camera().positionMm;
    reader_->flat().pick(from, {0, 1, 0});
    ASSERT_TRUE(runUntil([&] { return reader_->flat().picked().has_value(); }));
    EXPECT_FALSE(reader_->flat().picked()->wall->flat);
    EXPECT_LT(glm::distance(reader_->slices().slice(View::axial).positionMm,
                            from + glm::dvec3(0, tests::fakeRadiusMm, 0)),
              1e-9);
}

}  // namespace
}  // namespace haustra::reader
