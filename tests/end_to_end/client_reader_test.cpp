// The reader behind the window, against a server on the loopback: four views that follow the
// flight, exact when it rests, and alive again after a lost link.
#include "end_to_end/reader_fixture.h"
#include "protocol/haustra.pb.h"

namespace haustra::reader {
namespace {

using tests::FakeServer;
using tests::Misbehaviour;

constexpr View views[] = {View::endoscopic, View::axial, View::coronal, View::sagittal};

class ClientReader : public tests::ReaderFixture {
protected:
    using ReaderFixture::ReaderFixture;

    void SetUp() override {
        ReaderFixture::SetUp();
        reader_->setPaneSize(View::endoscopic, {240, 160});
        for (const View view : {View::axial, View::coronal, View::sagittal})
            reader_->setPaneSize(view, {100, 90});
    }
    bool allAtRest() const {
        if (!reader_->isOpen() || reader_->restless()) return false;
        for (const View view : views)
            if (!reader_->panes().picture(view).exact) return false;
        return true;
    }
    void expectPicturesOf(glm::dvec3 positionMm) const {
        EXPECT_EQ(tiles::rgbOf(reader_->panes().picture(View::endoscopic)),
                  tests::syntheticPicture(240, 160, positionMm, 0.0));
        for (const View view : {View::axial, View::coronal, View::sagittal}) {
            EXPECT_EQ(
                tiles::rgbOf(reader_->panes().picture(view)),
                tests::syntheticPicture(100, 90, positionMm, reader_->slices().window().centerHu));
            EXPECT_EQ(reader_->panes().shown<SliceView>(view)->positionMm, positionMm);
        }
    }
};

TEST_F(ClientReader, TheOverviewStandsStillWhileTheReaderFliesAndTurnsByHand) {
    reader_->setPaneSize(View::overview, {120, 100});
    reader_->setPaneSize(View::oblique, {80, 60});
    ASSERT_TRUE(runUntil([&] {
        return allAtRest() && reader_->panes().picture(View::overview).exact &&
               reader_->panes().picture(View::oblique).exact;
    }));
    const auto expectBoth = [&] {
        EXPECT_EQ(tiles::rgbOf(reader_->panes().picture(View::overview)),
                  tests::syntheticPicture(120, 100, cameraOf(reader_->outside().orbit()).positionMm,
                                          0.0));
        EXPECT_EQ(reader_->panes().shown<Overview>(View::overview)->camera,
                  cameraOf(reader_->outside().orbit()));
        EXPECT_EQ(tiles::rgbOf(reader_->panes().picture(View::oblique)),
                  tests::syntheticPicture(
                      80, 60, reader_->slices().oblique(reader_->flight().camera()).positionMm,
                      reader_->slices().window().centerHu));
        EXPECT_EQ(*reader_->panes().shown<ObliqueView>(View::oblique),
                  reader_->slices().oblique(reader_->flight().camera()));
    };
    expectBoth();
    const auto overviews = reader_->panes().pictureCount(View::overview);
    reader_->flight().goTo(70.0);
    reader_->slices().scrollOblique(8.0);
    ASSERT_TRUE(runUntil([&] {
        return *reader_->panes().shown<ObliqueView>(View::oblique) ==
               reader_->slices().oblique(reader_->flight().camera());
    }));
    ASSERT_TRUE(
        runUntil([&] { return allAtRest() && reader_->panes().picture(View::oblique).exact; }));
    EXPECT_EQ(reader_->panes().pictureCount(View::overview), overviews);
    reader_->outside().turn(40.0, -200.0);
    EXPECT_EQ(reader_->outside().orbit().elevationDegrees, -90.0);
    reader_->outside().zoom(2.0);
    ASSERT_TRUE(runUntil([&] {
        return reader_->panes().shown<Overview>(View::overview)->camera ==
                   cameraOf(reader_->outside().orbit()) &&
               reader_->panes().picture(View::overview).exact;
    }));
    expectBoth();
    reader_->outside().reset();
    EXPECT_EQ(reader_->outside().orbit().azimuthDegrees, 0.0);
}

TEST_F(ClientReader, OpticsAreShownWhileTheHandChangesThem) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    OpticsEditor& optics = reader_->optics();
    ASSERT_EQ(optics.presets(), 3u);
    EXPECT_EQ(optics.preset(optics.chosen()).name, "mucosa");
    EXPECT_EQ(optics.curve().points().front().hu, -700.0);  // the server's own
    for (int n = 0; n < 30; ++n) {
        TransferCurve curve = optics.curve();
        curve.move(1, -560.0 + n, 0.5);
        optics.setCurve(curve);
        reader_->update(0.01);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(std::holds_alternative<Optics>(optics.choice()));
    EXPECT_TRUE(reader_->restless());
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    EXPECT_TRUE(reader_->session().takeRefusals().empty());
    ASSERT_TRUE(optics.choose("translucent"));
    EXPECT_EQ(optics.choice(), OpticsChoice("translucent"));
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    EXPECT_TRUE(reader_->session().takeRefusals().empty());
}

/// Of a server that does one thing wrong.
template <auto misbehaves, auto value>
class ClientReaderWith : public ClientReader {
protected:
    static Misbehaviour misbehaviour() {
        Misbehaviour made;
        made.*misbehaves = value;
        return made;
    }
    ClientReaderWith() : ClientReader(misbehaviour()) {}
};

using ClientReaderWithALossyLink = ClientReaderWith<&Misbehaviour::dropAfterBookmarks, 2>;
using ClientReaderOfARestart = ClientReaderWith<&Misbehaviour::stopsWhileOpening, 2>;
using ClientReaderOfAFragileServer = ClientReaderWith<&Misbehaviour::closesAtWallQuestions, true>;
using ClientReaderOfAFullDisk = ClientReaderWith<&Misbehaviour::refuseBookmarks, 1>;

class ClientReaderOfAReplacedScan : public ClientReader {
protected:
    static Misbehaviour replacing() {
        Misbehaviour misbehaviour;
        misbehaviour.dropAfterBookmarks = 2;
        misbehaviour.anotherScanLater = true;
        return misbehaviour;
    }
    ClientReaderOfAReplacedScan() : ClientReader(replacing()) {}
};

class ClientReaderOfGarbage : public ClientReader, public ::testing::WithParamInterface<bool> {
protected:
    static Misbehaviour garbage() {
        Misbehaviour misbehaviour;
        misbehaviour.garbageTiles = true;
        misbehaviour.closesAfterTile = GetParam();
        return misbehaviour;
    }
    ClientReaderOfGarbage() : ClientReader(garbage()) {}
};

// Though it tries again after a lost link: what sends such tiles will send them again.
TEST_P(ClientReaderOfGarbage, ATileThatIsNoneEndsTheConnectionForGood) {
    reader_->setPaneSize(View::endoscopic, {64, 64});
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::failed; }));
    EXPECT_EQ(reader_->session().failure().kind, ErrorKind::badInput);
    EXPECT_NE(describe(reader_->session().failure()).find("tile"), std::string::npos);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));  // a lost link is tried after 500
    EXPECT_EQ(server_.connections(), 1);
}
INSTANTIATE_TEST_SUITE_P(ThatStaysAndThatCloses, ClientReaderOfGarbage, ::testing::Bool());

TEST_F(ClientReader, TilesAreDecodedWhileTheReaderDoesOtherThings) {
    Session& session = reader_->session();
    session.setViewport(0, View::endoscopic, 64, 64);
    ASSERT_TRUE(runUntil([&] { return reader_->isOpen(); }));
    bool decodedBefore = false;
    for (int picture = 0; picture < 200 && !decodedBefore; ++picture) {
        session.look(0, reader_->flight().camera(), false);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        const auto before = Clock::now();
        session.poll(std::chrono::milliseconds(0));
        for (const link::PictureDone& arrival : session.takePictures())
            decodedBefore |= arrival.decodedAt < before;
    }
    EXPECT_TRUE(decodedBefore);
}

TEST_F(ClientReaderOfAFullDisk, ARefusedBookmarkIsNeverCalledSavedAndItsNoteIsNotLost) {
    ASSERT_TRUE(runUntil([&] { return reader_->isOpen(); }));
    Session& session = reader_->session();
    std::vector<BookmarkOutcome> outcomes;
    const auto settled = [&](std::size_t count) {
        return runUntil([&] {
            for (BookmarkOutcome& outcome : session.takeBookmarkOutcomes())
                outcomes.push_back(std::move(outcome));
            return outcomes.size() >= count;
        });
    };
    reader_->addBookmark("sessile, 8 mm");
    ASSERT_TRUE(settled(1));
    EXPECT_FALSE(outcomes[0].saved);
    EXPECT_EQ(outcomes[0].bookmark.note, "sessile, 8 mm");
    EXPECT_EQ(session.owedBookmarks(), 0u);  // it is not sent again by itself
    ASSERT_EQ(session.takeRefusals().size(), 1u);
    EXPECT_TRUE(server_.storedBookmarkKeys().empty());

    reader_->addBookmark("sessile, 8 mm");
    ASSERT_TRUE(settled(2));
    EXPECT_TRUE(outcomes[1].saved);
    EXPECT_EQ(server_.storedBookmarkKeys(),
              std::vector<std::string>{outcomes[1].bookmark.clientKey});
}

class ClientReaderRefused : public ClientReader, public ::testing::WithParamInterface<int> {
protected:
    static Misbehaviour refusing() {
        Misbehaviour misbehaviour;
        misbehaviour.refuseCaseWith = GetParam();
        return misbehaviour;
    }
    ClientReaderRefused() : ClientReader(refusing()) {}
};

TEST_P(ClientReaderRefused, ACaseThatCannotBeOpenedEndsTheWaitWithTheServersWords) {
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::failed; }));
    EXPECT_NE(reader_->session().failure().message.find("the scan's file is damaged"),
              std::string::npos);
    EXPECT_EQ(server_.connections(), 1);
}
INSTANTIATE_TEST_SUITE_P(Codes, ClientReaderRefused,
                         ::testing::Values(protocol::ErrorReport::NO_SUCH_CASE,
                                           protocol::ErrorReport::INTERNAL,
                                           protocol::ErrorReport::BUSY));

TEST_F(ClientReaderOfARestart, AServerThatStopsWhileItOpensTheCaseIsTriedAgain) {
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::lost; }));
    EXPECT_NE(reader_->session().failure().message.find("the server stops"), std::string::npos);
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    EXPECT_EQ(server_.connections(), 3);
    EXPECT_TRUE(reader_->session().takeRefusals().empty());
}

class ClientReaderOfAnotherServer : public ClientReader {
protected:
    static Misbehaviour stopping() {
        Misbehaviour misbehaviour;
        misbehaviour.stopsWhileOpening = 1;
        misbehaviour.anotherCertificateLater = true;
        return misbehaviour;
    }
    ClientReaderOfAnotherServer() : ClientReader(stopping()) {}
};

TEST_F(ClientReaderOfAnotherServer, ACertificateThatChangedIsToldWhateverTheServerSaidLast) {
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::failed; }));
    const std::string& told = reader_->session().failure().message;
    EXPECT_NE(told.find("certificate"), std::string::npos) << told;
    EXPECT_EQ(told.find("stops"), std::string::npos) << told;
}

TEST_F(ClientReaderOfAFragileServer, AQuestionThatEndsTheLinkTwiceIsNotAskedAgain) {
    Session& session = reader_->session();
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    const std::uint64_t request = session.locate(glm::dvec2(0.5, 0.5));
    std::vector<Session::WallAnswer> answers;
    for (int n = 0; n < 200 && answers.empty(); ++n) {
        session.poll(std::chrono::milliseconds(50));
        answers = session.takeWallAnswers();
    }
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].request, request);
    EXPECT_FALSE(answers[0].body);
    EXPECT_EQ(session.takeRefusals().size(), 1u);
    EXPECT_EQ(session.phase(), Phase::lost);
    ASSERT_TRUE(runUntil([&] { return session.phase() == Phase::open && allAtRest(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    reader_->update(0.0);
    EXPECT_EQ(session.phase(), Phase::open);
    EXPECT_EQ(server_.connections(), 3);
}

TEST_F(ClientReader, AtRestAllViewsAreExactAndShowTheCamerasPlace) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    expectPicturesOf(reader_->flight().camera().positionMm);
    reader_->slices().setWindow({40, 400});
    reader_->flight().goTo(300.0);
    ASSERT_TRUE(runUntil([&] {
        return allAtRest() && reader_->panes().shown<SliceView>(View::axial)->positionMm ==
                                  reader_->flight().camera().positionMm;
    }));
    expectPicturesOf(reader_->flight().camera().positionMm);
}

TEST_F(ClientReader, InFlightPicturesMoveAndAfterwardsTheyAreExact) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    const auto before = reader_->panes().pictureCount(View::endoscopic);
    reader_->flight().setMotion(Motion::forward);
    ASSERT_TRUE(
        runUntil([&] { return reader_->panes().pictureCount(View::endoscopic) > before + 10; }));
    EXPECT_TRUE(reader_->restless());
    EXPECT_FALSE(reader_->panes().picture(View::endoscopic).exact);
    EXPECT_GT(reader_->panes().latencyMs().count, 5u);
    reader_->flight().setMotion(Motion::paused);
    EXPECT_GT(reader_->flight().arcMm(), 0.0);
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    expectPicturesOf(reader_->flight().camera().positionMm);
}

TEST_F(ClientReader, SlicesShowTheCleansedScanOnRequest) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    reader_->slices().setCleansed(true);
    ASSERT_TRUE(runUntil(
        [&] { return showsCleansed(*reader_->panes().shown<SliceView>(View::sagittal)); }));
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    const glm::dvec3 camera = reader_->flight().camera().positionMm;
    for (const View view : {View::axial, View::coronal, View::sagittal}) {
        EXPECT_TRUE(showsCleansed(*reader_->panes().shown<SliceView>(view)));
        EXPECT_EQ(
            tiles::rgbOf(reader_->panes().picture(view)),
            tests::syntheticPicture(100, 90, camera,
                                    reader_->slices().window().centerHu + tests::cleansedShiftHu));
    }
    reader_->slices().setCleansed(false);
    ASSERT_TRUE(
        runUntil([&] { return !showsCleansed(*reader_->panes().shown<SliceView>(View::axial)); }));
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    expectPicturesOf(camera);
}

TEST_F(ClientReader, ScrollingASliceLeavesTheCameraAndStaysWithinTheScan) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    const glm::dvec3 camera = reader_->flight().camera().positionMm;
    reader_->slices().scroll(View::axial, 15.0);
    EXPECT_EQ(reader_->slices().slice(View::axial).positionMm, camera + glm::dvec3(0, 0, 15));
    EXPECT_EQ(reader_->flight().camera().positionMm, camera);
    reader_->slices().scroll(View::axial, 1e6);
    const Grid& grid = reader_->session().caseInfo()->grid;
    EXPECT_NEAR(reader_->slices().slice(View::axial).positionMm.z,
                grid.patientFromVoxelPoint(grid.size - 1).z, 1e-9);
    reader_->flight().goTo(50.0);
    reader_->update(0.0);
    EXPECT_EQ(reader_->slices().slice(View::axial).positionMm,
              reader_->flight().camera().positionMm);
}

TEST_F(ClientReader, BookmarksLeadAlongTheColon) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    Flight& flight = reader_->flight();
    for (const double arc : {400.0, 100.0, 250.0}) {
        flight.goTo(arc);
        reader_->addBookmark("at " + std::to_string(int(arc)));
    }
    ASSERT_TRUE(runUntil([&] { return reader_->session().owedBookmarks() == 0; }));
    EXPECT_EQ(reader_->session().bookmarks().size(), 3u);
    flight.goTo(0.0);
    for (const double arc : {100.0, 250.0, 400.0, 400.0}) {
        if (const auto next = reader_->nextBookmark(+1)) reader_->goTo(*next);
        EXPECT_NEAR(flight.arcMm(), arc, 1e-9);
    }
    reader_->goTo(reader_->nextBookmark(-1).value());
    EXPECT_NEAR(flight.arcMm(), 250.0, 1e-9);
}

TEST_F(ClientReader, ABookmarkOfFreeFlightLiesWhereTheCameraHasGone) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    Flight& flight = reader_->flight();
    flight.goTo(400.0);
    reader_->addBookmark("on the centerline");
    flight.goTo(100.0);
    flight.flyFreely();
    flight.moveFreely({0.0, 0.0, 150.0});
    ASSERT_TRUE(flight.isFree());
    const double arc = flight.placeArcMm();
    ASSERT_GT(std::abs(arc - 100.0), 50.0);
    EXPECT_NEAR(reader_->nextBookmark(+1).value().arcMm, 400.0, 1e-9);
    reader_->addBookmark("off it");
    ASSERT_TRUE(runUntil([&] { return reader_->session().owedBookmarks() == 0; }));
    EXPECT_NEAR(reader_->session().bookmarks().back().arcMm, arc, 1e-9);
    EXPECT_FALSE(reader_->nextBookmark(-1)) << "it is here";
}

TEST_F(ClientReaderWithALossyLink, ALostLinkComesBackWithViewsFlightAndBookmarks) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    reader_->flight().goTo(123.0);
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    const auto before = reader_->panes().pictureCount(View::endoscopic);
    reader_->addBookmark("first");
    reader_->addBookmark("second: stored, but the link breaks before its acknowledgement");
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::lost; }));
    EXPECT_FALSE(reader_->session().failure().message.empty());
    reader_->addBookmark("third: made while the link is down");
    EXPECT_EQ(reader_->session().owedBookmarks(), 2u);
    ASSERT_TRUE(runUntil([&] { return reader_->session().owedBookmarks() == 0 && allAtRest(); }));
    EXPECT_EQ(server_.storedBookmarkKeys().size(), 3u);
    EXPECT_EQ(reader_->flight().arcMm(), 123.0);
    ASSERT_TRUE(runUntil([&] { return reader_->panes().pictureCount(View::endoscopic) > before; }));
    expectPicturesOf(reader_->flight().camera().positionMm);
}

TEST_F(ClientReaderWithALossyLink, WhileTheLinkIsDownTheFlightStandsAndItsPictureIsOld) {
    EXPECT_EQ(reader_->freshness(View::endoscopic), Freshness::none);
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    EXPECT_EQ(reader_->freshness(View::endoscopic), Freshness::exact);
    reader_->setMotion(Motion::forward);
    reader_->update(0.05);
    EXPECT_EQ(reader_->freshness(View::endoscopic), Freshness::moving);
    reader_->addBookmark("first");
    reader_->addBookmark("second: the link breaks");
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::lost; }));
    const double arc = reader_->flight().arcMm();
    EXPECT_EQ(reader_->motion(), Motion::paused);
    EXPECT_EQ(reader_->freshness(View::endoscopic), Freshness::old);
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::open && allAtRest(); }));
    EXPECT_EQ(reader_->flight().arcMm(), arc);
    EXPECT_EQ(reader_->freshness(View::endoscopic), Freshness::exact);
}

TEST_F(ClientReaderOfAReplacedScan, TheFirstReadingOfTheOneIsNotTheOthers) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    FindingsReading& findings = reader_->findings();
    ASSERT_TRUE(findings.choose(DetectionMode::secondReader));
    ASSERT_TRUE(findings.finishFirstPass());
    ASSERT_TRUE(runUntil([&] { return !findings.shown().empty(); }));
    reader_->addBookmark("first");
    reader_->addBookmark("second: the link breaks");
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::lost; }));
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::open && allAtRest(); }));
    ASSERT_EQ(reader_->session().caseInfo()->scan, "B");
    EXPECT_EQ(findings.choice().mode, DetectionMode::off);
    EXPECT_FALSE(findings.choice().firstPassDone);
    EXPECT_TRUE(findings.shown().empty());
    const auto refusals = reader_->session().takeRefusals();
    ASSERT_FALSE(refusals.empty()) << "whoever reads must know";
    EXPECT_NE(refusals[0].message.find("perhaps another patient's"), std::string::npos);
}

TEST_F(ClientReaderOfAReplacedScan, WhatWasMarkedOnTheOneIsNotSentToTheOther) {
    ASSERT_TRUE(runUntil([&] { return allAtRest(); }));
    reader_->addBookmark("first");
    reader_->addBookmark("second: the link breaks");
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::lost; }));
    reader_->addBookmark("third: on the former scan");
    ASSERT_TRUE(runUntil([&] { return reader_->session().phase() == Phase::open && allAtRest(); }));
    reader_->addBookmark("fourth: on the other");
    ASSERT_TRUE(runUntil([&] { return server_.storedBookmarkKeys().size() == 3; }));
    EXPECT_EQ(reader_->session().caseInfo()->scan, "B");
    // The second was stored before the link broke; the third is still owed to its own scan.
    const auto refusals = reader_->session().takeRefusals();
    ASSERT_EQ(refusals.size(), 2u);
    EXPECT_NE(refusals[0].message.find("perhaps another patient's"), std::string::npos);
    EXPECT_NE(refusals[1].message.find("bookmarks on the former one"), std::string::npos);
    EXPECT_EQ(server_.storedBookmarkKeys().size(), 3u);
    for (const Bookmark& bookmark : reader_->session().bookmarks())
        EXPECT_EQ(bookmark.note.find("third"), std::string::npos);
}

}  // namespace
}  // namespace haustra::reader
