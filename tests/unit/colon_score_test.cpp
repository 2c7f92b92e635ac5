// The chain's score on a colon of two limbs and an arch between them, closed in the second limb.
#include "phantom/colon_score.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

constexpr double tubeRadiusMm = 6.0, bendMm = 9.0, limbMm = 65.0;
const double archMm = bendMm * std::acos(-1.0);
const double tubeLengthMm = 2.0 * limbMm + archMm;

glm::dvec3 axisAt(double arcMm) {
    if (arcMm <= limbMm) return {15.0, 20.0, 10.0 + arcMm};
    if (arcMm >= limbMm + archMm)
        return {15.0 + 2.0 * bendMm, 20.0, 75.0 - (arcMm - limbMm - archMm)};
    const double turn = (arcMm - limbMm) / bendMm;
    return {15.0 + bendMm * (1.0 - std::cos(turn)), 20.0, 75.0 + bendMm * std::sin(turn)};
}

bool closedAt(double arcMm, double fromMm, double toMm) {
    return arcMm > fromMm && arcMm < toMm;
}

/// Closed between the two arcs, at whose ends the collapse's truth stands.
Phantom bent(double closedFromMm, double closedToMm) {
    Phantom phantom;
    const Grid grid = axisAlignedGrid({50, 40, 100}, {1, 1, 1}, {0, 0, 0});
    phantom.lumen = Volume<std::uint8_t>(grid, 0);
    phantom.sites = Volume<std::uint8_t>(grid, std::uint8_t(Site::elsewhere));
    for (double arc = 0.0; arc <= tubeLengthMm; arc += 1.0) {
        const glm::dvec3 p = axisAt(arc);
        const bool closed = closedAt(arc, closedFromMm, closedToMm);
        phantom.centerline.points.push_back({p, arc, closed ? 0.0 : tubeRadiusMm, closed});
    }
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        double nearest = 1e9, nearestArc = 0.0;
        for (const CenterlinePoint& point : phantom.centerline.points) {
            const double d = glm::distance(point.positionMm, p);
            if (d < nearest) nearest = d, nearestArc = point.arcMm;
        }
        if (nearest < tubeRadiusMm && !closedAt(nearestArc, closedFromMm, closedToMm))
            phantom.lumen.writable()[n] = 1;
    }
    return phantom;
}

ColonPiece pieceAt(double arcMm) {
    ColonPiece piece;
    piece.centerMm = axisAt(arcMm), piece.radiusMm = tubeRadiusMm, piece.lengthMm = 20.0;
    return piece;
}

ColonRecord chainOf(const std::vector<double>& arcsMm) {
    ColonRecord record;
    for (std::size_t n = 0; n < arcsMm.size(); ++n) {
        record.pieces.push_back(pieceAt(arcsMm[n]));
        if (n > 0) {
            ColonJunction junction;
            junction.placeMm = 0.5 * (record.pieces[n - 1].centerMm + record.pieces[n].centerMm);
            record.junctions.push_back(junction);
        }
    }
    return record;
}

using Kind = WrongStep::Kind;

TEST(ColonScore, TheTrueChainHasNoFault) {
    const Phantom truth = bent(110.0, 125.0);
    ColonRecord record = chainOf({10, 35, 60, 80, 100, 140});
    record.junctions[4].kind = JunctionKind::collapse;
    const ColonScore score = scoreColon(truth, truth.lumen, truth.centerline, record, {});
    EXPECT_TRUE(score.wrongSteps.empty());
    EXPECT_EQ(score.collapses, 1);
    EXPECT_EQ(score.collapsesCrossed, 1);
    EXPECT_EQ(score.bridges, 1);
    EXPECT_EQ(score.missedMm, 0.0);
    EXPECT_EQ(score.wrongMm, 0.0) << "a path on a true collapse is right";
    EXPECT_EQ(score.falseIleumMl + score.falseOtherBowelMl + score.falseElsewhereMl, 0.0);
    EXPECT_NEAR(score.openMm + 15.0, score.trueMm, 2.0);
}

TEST(ColonScore, AStepBetweenTouchingLimbsIsALeapAndWhatItSkipsIsMissed) {
    const Phantom truth = bent(0.0, 0.0);
    const ColonRecord record = chainOf({10, tubeLengthMm - 10});
    Centerline path;
    for (double x = 15.0; x <= 33.0; x += 1.0)
        path.points.push_back({{x, 20.0, 20.0}, x - 15.0, 1.0, false});
    const std::vector<std::string> warnings{"a thin wall was taken for lumen, at (24, 20, 25) mm"};
    const ColonScore score = scoreColon(truth, truth.lumen, path, record, warnings);
    ASSERT_EQ(score.wrongSteps.size(), 1u) << "the path's leap is the chain's";
    EXPECT_EQ(score.wrongSteps[0].kind, Kind::leap);
    EXPECT_TRUE(score.wrongSteps[0].warned);
    EXPECT_GT(score.missedMm, 0.7 * tubeLengthMm);
    EXPECT_NEAR(score.wrongMm, 6.0, 3.0) << "the wall between the limbs";
    // A path that leaps where the chain does not.
    const ColonScore alone = scoreColon(truth, truth.lumen, path, chainOf({10, 35, 60, 80}), {});
    ASSERT_EQ(alone.wrongSteps.size(), 1u);
    EXPECT_EQ(alone.wrongSteps[0].kind, Kind::pathLeap);
    EXPECT_FALSE(alone.wrongSteps[0].warned);
}

TEST(ColonScore, ABridgeInAnOpenColonAndAPieceOfOtherBowelAreWrong) {
    const Phantom truth = bent(0.0, 0.0);
    ColonRecord record = chainOf({10, 35, 60});
    record.junctions[0].kind = JunctionKind::collapse;
    record.pieces[2].centerMm = {45.0, 5.0, 90.0};
    const ColonScore score = scoreColon(truth, truth.lumen, truth.centerline, record, {});
    ASSERT_EQ(score.wrongSteps.size(), 2u);
    EXPECT_EQ(score.wrongSteps[0].kind, Kind::bridge);
    EXPECT_EQ(score.wrongSteps[1].kind, Kind::foreign);
}

TEST(ColonScore, ACollapseThatNoStepCrossesIsNamedAndFluidWithoutTaggingMayBeBridged) {
    const ColonRecord record = chainOf({10, 35, 60, 80, 100});
    const Phantom closed = bent(110.0, 125.0);
    const ColonScore lost = scoreColon(closed, closed.lumen, closed.centerline, record, {});
    ASSERT_EQ(lost.wrongSteps.size(), 1u);
    EXPECT_EQ(lost.wrongSteps[0].kind, Kind::notBridged);
    EXPECT_EQ(lost.collapsesCrossed, 0);

    Phantom water = bent(0.0, 0.0);
    const Grid& grid = water.lumen.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (water.lumen[n] && v.x < 24 && v.z > 30 && v.z < 50)
            water.sites.writable()[n] = std::uint8_t(Site::untaggedFluid);
    }
    ColonRecord over = chainOf({10, 60, 80, 100, 140});
    over.junctions[0].kind = JunctionKind::collapse;
    EXPECT_TRUE(scoreColon(water, water.lumen, water.centerline, over, {}).wrongSteps.empty());
}

TEST(ColonScore, FalseLumenIsToldByWhatIsThere) {
    Phantom truth = bent(0.0, 0.0);
    const Grid& grid = truth.lumen.grid();
    Volume<std::uint8_t> found = truth.lumen.clone();
    const auto add = [&](glm::ivec3 corner, Site site) {
        for (int n = 0; n < 125; ++n) {
            const std::size_t at = grid.index(corner + glm::ivec3(n % 5, n / 5 % 5, n / 25));
            found.writable()[at] = 1, truth.sites.writable()[at] = std::uint8_t(site);
        }
    };
    add({2, 2, 2}, Site::ileum), add({40, 2, 2}, Site::otherBowel), add({2, 34, 90}, Site::lung);
    const ColonScore score =
        scoreColon(truth, found, truth.centerline, chainOf({10, 35, 60, 80, 100}), {});
    EXPECT_NEAR(score.falseIleumMl, 0.125, 1e-9);
    EXPECT_NEAR(score.falseOtherBowelMl, 0.125, 1e-9);
    EXPECT_NEAR(score.falseElsewhereMl, 0.125, 1e-9);
}

}  // namespace
