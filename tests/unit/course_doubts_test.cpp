// How sure a course is said to be: less with everything by which courses are known to go wrong.
#include "segmentation/course_doubts.h"

#include <gtest/gtest.h>

using namespace haustra;
using segmentation::courseConfidence;
using segmentation::doubtsOf;

namespace {

/// All parts, of the usual lengths, open from end to end.
ColonRecord wholeColon() {
    constexpr double mm[colonParts] = {150, 400, 200, 80, 450, 80, 160, 70};
    ColonRecord record;
    for (int part = 0; part < colonParts; ++part) {
        record.pieces.push_back({.part = ColonPart(part), .radiusMm = 15.0, .tubeMm = mm[part]});
        if (part > 0) record.junctions.push_back({});
    }
    record.chainConfidence = 1.0;
    return record;
}
double confidence(const ColonRecord& record) {
    return courseConfidence(record.chainConfidence, doubtsOf(record));
}
ColonRecord collapsed(double mm, double radiusMm = 15.0) {
    ColonRecord record = wholeColon();
    record.junctions[1] = {JunctionKind::collapse, glm::dvec3(0.0), mm, 0.0, 1.0};
    record.pieces[2].radiusMm = radiusMm;
    return record;
}

TEST(CourseDoubts, AWholeOpenColonHasNone) {
    EXPECT_TRUE(doubtsOf(wholeColon()).empty());
    EXPECT_EQ(confidence(wholeColon()), 1.0);
}

TEST(CourseDoubts, GrowWithTheCollapseAndTheStepInCalibre) {
    double last = 1.0;
    for (double mm = 5.0; mm <= 90.0; mm += 5.0) {
        EXPECT_LT(confidence(collapsed(mm)), last);
        EXPECT_LT(confidence(collapsed(mm, 28.0)), confidence(collapsed(mm)) - 0.05);
        last = confidence(collapsed(mm));
    }
    EXPECT_GT(confidence(collapsed(10.0)), 0.9);
    EXPECT_LT(last, 0.3);
}

// Two walls lie between any two loops that touch; a bridge of no length is none.
TEST(CourseDoubts, AWayNoLongerThanTwoWallsIsDoubtedMoreThanALittleLongerOne) {
    EXPECT_LT(confidence(collapsed(2.0)), confidence(collapsed(8.0)) - 0.05);
    EXPECT_GT(confidence(collapsed(0.0)), confidence(collapsed(8.0)));
}

TEST(CourseDoubts, ACourseThatEndsWhereNoCecumLiesIsDoubted) {
    const auto endingAt = [](glm::dvec3 place) {
        ColonRecord record = wholeColon();
        record.endsAt = place;
        return confidence(record);
    };
    EXPECT_EQ(endingAt({-0.5, 0.0, 0.2}), 1.0);
    EXPECT_EQ(endingAt({0.1, 0.0, 0.2}), 1.0) << "a mobile cecum";
    EXPECT_LT(endingAt({-0.5, 0.0, 0.8}), 0.7) << "at the hepatic flexure";
    EXPECT_LT(endingAt({0.6, 0.0, 0.2}), 0.7) << "on the left";
}

TEST(CourseDoubts, WhatIsLikeColonAndWasLeftOutIsDoubtedMoreThanOtherGas) {
    const auto body = [](bool gas, double ml, bool likeColon) {
        return LeftOutBody{.volumeMl = ml,
                           .content = gas ? BodyContent::gas : BodyContent::tagged,
                           .nearest = ColonPart::sigmoid,
                           .distanceMm = 12.0,
                           .likeColon = likeColon};
    };
    const auto leavingOut = [](std::vector<LeftOutBody> bodies) {
        ColonRecord record = wholeColon();
        record.leftOut = std::move(bodies);
        return confidence(record);
    };
    EXPECT_LT(leavingOut({body(true, 120, false)}), 1.0);
    EXPECT_LT(leavingOut({body(true, 120, true)}), 0.5);
    EXPECT_LT(leavingOut({body(false, 120, true)}), 0.8);
    // Whatever else was left out, and in whatever order.
    EXPECT_LT(leavingOut({body(false, 200, true), body(true, 120, true)}),
              leavingOut({body(true, 120, true)}));
    EXPECT_LT(leavingOut({body(true, 200, false), body(true, 120, true)}),
              leavingOut({body(true, 120, true)}));
}

TEST(CourseDoubts, WithoutARectumItIsDoubtful) {
    ColonRecord record = wholeColon();
    record.pieces.erase(record.pieces.begin());
    record.junctions.pop_back();
    EXPECT_LT(confidence(record), 0.4);
}

TEST(CourseDoubts, APartThatIsCutTwiceIsDoubtedOnce) {
    const auto cutAt = [](std::vector<ColonPart> parts) {
        ColonRecord record = wholeColon();
        for (const ColonPart part : parts)
            record.cutEnds.push_back({part, glm::dvec3(0.0), 500.0});
        return confidence(record);
    };
    EXPECT_EQ(cutAt({ColonPart::cecum, ColonPart::cecum}), cutAt({ColonPart::cecum}));
    EXPECT_LT(cutAt({ColonPart::cecum, ColonPart::rectum}), cutAt({ColonPart::cecum}));
}

TEST(CourseDoubts, EachFactLowersTheConfidenceAndTheGravestComesFirst) {
    const auto lowers = [](const auto& change) {
        ColonRecord record = collapsed(30.0);
        const double before = confidence(record);
        change(record);
        const auto doubts = doubtsOf(record);
        for (std::size_t n = 1; n < doubts.size(); ++n)
            EXPECT_GE(doubts[n - 1].probability, doubts[n].probability);
        for (const Doubt& doubt : doubts) {
            EXPECT_GT(doubt.probability, 0.0);
            EXPECT_LT(doubt.probability, 1.0);
            EXPECT_FALSE(doubt.about.empty());
        }
        return confidence(record) < before;
    };
    EXPECT_TRUE(lowers([](ColonRecord& r) {
        r.pieces.erase(r.pieces.begin() + 2), r.junctions.erase(r.junctions.begin() + 2);
    }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.pieces.resize(5), r.junctions.resize(4); }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.junctions[4].kind = JunctionKind::thinWall; }));
    EXPECT_TRUE(lowers([](ColonRecord& r) {
        r.leftOut.push_back({{}, 30.0, BodyContent::gas, {}, 3.0, true});
    }));
    EXPECT_TRUE(lowers([](ColonRecord& r) {
        r.leftOut.push_back({{}, 200.0, BodyContent::tagged, {}, 0.0, true});
    }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.walls.push_back({{}, 14000.0, false}); }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.walls.push_back({{}, 200.0, true}); }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.untaggedPools.push_back({{}, {}, 900.0, 10.0}); }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.cutEnds.push_back({{}, {}, 500.0}); }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.maskInSoftTissue = 0.3; }));
    EXPECT_TRUE(lowers([](ColonRecord& r) { r.chainConfidence = 0.8; }));
    // What is no news of the course.
    EXPECT_FALSE(lowers([](ColonRecord& r) {
        r.leftOut.push_back({{}, 3.0, BodyContent::gas, {}, 3.0, false});
    }));
    EXPECT_FALSE(lowers([](ColonRecord& r) {
        r.leftOut.push_back({{}, 200.0, BodyContent::gas, {}, 60.0, false});
    }));
    EXPECT_FALSE(lowers([](ColonRecord& r) { r.walls.push_back({{}, 200.0, false}); }));
    EXPECT_FALSE(lowers([](ColonRecord& r) { r.maskInSoftTissue = 0.03; }));
}

TEST(CourseDoubts, AreInTheQuality) {
    ColonRecord record = collapsed(40.0);
    record.doubts = doubtsOf(record);
    record.confidence = confidence(record);
    const std::string json = qualityJson(record);
    EXPECT_NE(json.find(record.doubts.front().about), std::string::npos);
    EXPECT_NE(json.find("\"chain_confidence\": 1.0"), std::string::npos);
    const auto trust = trustOfQuality(json);
    ASSERT_TRUE(trust);
    EXPECT_NEAR(trust->confidence, record.confidence, 0.01);
}

// No two loops of bowel are pressed flat so far; another wall hardly counts.
TEST(CourseDoubts, AWideWallBetweenLoopsIsDoubted) {
    const auto walled = [](double mm2) {
        ColonRecord record = wholeColon();
        record.walls.push_back({.areaMm2 = mm2, .betweenLoops = true});
        return confidence(record);
    };
    EXPECT_GT(walled(400.0), 0.95);
    EXPECT_LT(walled(9000.0), 0.65);
}

}  // namespace
