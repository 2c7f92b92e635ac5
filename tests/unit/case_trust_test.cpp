// What a reader is told of a case before anything of it is seen.
#include "store/case_trust.h"

#include "core/source_series.h"
#include "end_to_end/run_program.h"

#include <gtest/gtest.h>

namespace haustra::store {
namespace {

ColonRecord straightColon() {
    ColonRecord record;
    for (const double z : {0.0, 200.0, 400.0})
        record.pieces.push_back({ColonPart::sigmoid, {0.0, 0.0, z}, 15.0, 200.0, 100.0});
    record.junctions.resize(2);
    record.confidence = 0.9;
    record.warnings = {"the sigmoid is collapsed over 31 mm, at (0, 0, 100) mm"};
    return record;
}

Centerline alongZ(double toMm) {
    Centerline path;
    for (double z = 0.0; z <= toMm; z += 1.0)
        path.points.push_back({{0.0, 0.0, z}, z, 10.0});
    return path;
}

class CaseTrust : public testing::Test {
protected:
    Case made() { return CaseStore::open(folder_.path(), true).value().createCase("p").value(); }
    static ProductKey key() { return makeKey("test", 1, "", {}); }

    tests::TemporaryFolder folder_;
};

TEST_F(CaseTrust, IsTheQualitysWhereNoPathIsKnownOrTheWholeColonHasOne) {
    Case stored = made();
    ASSERT_TRUE(stored.publishText("quality", key(), qualityJson(straightColon())));
    for (const bool traced : {false, true}) {
        if (traced) {
            ASSERT_TRUE(stored.publishCenterline("centerline", key(), alongZ(400.0)));
        }
        const auto trust = readTrust(stored);
        ASSERT_TRUE(trust) << describe(trust.error());
        EXPECT_EQ(trust->confidence, 0.9);
        EXPECT_EQ(trust->warnings, straightColon().warnings);
    }
}

TEST_F(CaseTrust, SaysFirstWhatThePathPassesBy) {
    Case stored = made();
    ASSERT_TRUE(stored.publishText("quality", key(), qualityJson(straightColon())));
    ASSERT_TRUE(stored.publishCenterline("centerline", key(), alongZ(210.0)));
    const auto trust = readTrust(stored);
    ASSERT_TRUE(trust) << describe(trust.error());
    ASSERT_EQ(trust->warnings.size(), 2u);
    EXPECT_EQ(trust->warnings[0].rfind("about 200 mm of the colon have no centerline", 0), 0u)
        << trust->warnings[0];
    EXPECT_EQ(trust->warnings[1], straightColon().warnings[0]);
}

TEST_F(CaseTrust, HasWhatTheFlatMapWarnsOf) {
    Case stored = made();
    ASSERT_TRUE(stored.publishText("quality", key(), qualityJson(straightColon())));
    const FlatMap map{{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, {{0, 1, 2}}},
                      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}},
                      {0, 0, 0},
                      {0},
                      {{}},
                      1.0};
    ASSERT_TRUE(stored.publishFlatMap(
        "flatmap", key(), map,
        {{"notes", "modulus 1\nwarning: 9 % of the wall are dots\na warning: none"}}));
    const auto trust = readTrust(stored);
    ASSERT_TRUE(trust) << describe(trust.error());
    EXPECT_EQ(trust->warnings,
              (std::vector<std::string>{"9 % of the wall are dots", straightColon().warnings[0]}));
}

TEST_F(CaseTrust, HasWhatTheCleansedLumenWarnsOf) {
    Case stored = made();
    ASSERT_TRUE(stored.publishText("quality", key(), qualityJson(straightColon())));
    ASSERT_TRUE(stored.publishVolume(
        "cleansed-lumen", key(),
        Volume<std::uint8_t>(axisAlignedGrid({4, 4, 4}, glm::dvec3(1.0)), std::uint8_t(0)),
        {{"notes", "warning: 5 ml look like tissue"}}));
    const auto trust = readTrust(stored);
    ASSERT_TRUE(trust) << describe(trust.error());
    EXPECT_EQ(trust->warnings,
              (std::vector<std::string>{"5 ml look like tissue", straightColon().warnings[0]}));
}

TEST_F(CaseTrust, BeginsWithHowCoarseTheScanIs) {
    Case stored = made();
    ASSERT_TRUE(stored.publishText("quality", key(), qualityJson(straightColon())));
    const auto first = [&] {
        const auto trust = readTrust(stored);
        EXPECT_TRUE(trust) << describe(trust.error());
        return trust && trust->warnings.size() == 2u ? trust->warnings[0] : std::string();
    };
    const auto scanned = [&](double stepMm) {
        const Grid grid = axisAlignedGrid({4, 4, 4}, {1.0, 1.0, stepMm});
        ASSERT_TRUE(stored.publishVolume("ct", key(), Volume<std::int16_t>(grid, 0)));
    };
    scanned(2.0);
    EXPECT_NE(first().find("samples up to 2 mm apart"), std::string::npos) << first();
    // Of the series it is told how thick slices are that lie close together.
    scanned(1.0);
    EXPECT_EQ(first(), "");
    SourceSeries series;
    series.studyUid = "1.2", series.seriesUid = "1.3";
    series.images.resize(4);
    for (std::size_t n = 0; n < 4; ++n) {
        series.images[n] = {"1.2.840.10008.5.1.4.1.1.2",
                            "1.4." + std::to_string(n + 1),
                            0,
                            {0.0, 0.0, double(n)},
                            5.0};
    }
    ASSERT_TRUE(stored.publishText("source", key(), sourceSeriesJson(series)));
    EXPECT_NE(first().find("slices 5 mm thick"), std::string::npos) << first();
    // Nobody is kept from the case where that is damaged, and all are told.
    ASSERT_TRUE(stored.publishText("source", key(), "{"));
    EXPECT_NE(first().find("damaged"), std::string::npos) << first();
}

TEST_F(CaseTrust, FailsWhereNothingWasSearchedFor) {
    EXPECT_FALSE(readTrust(made()));
}

}  // namespace
}  // namespace haustra::store
