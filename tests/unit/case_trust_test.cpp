// What a reader is told of a case before anything of it is seen.
#include "store/case_trust.h"

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

TEST_F(CaseTrust, FailsWhereNothingWasSearchedFor) {
    EXPECT_FALSE(readTrust(made()));
}

}  // namespace
}  // namespace haustra::store
