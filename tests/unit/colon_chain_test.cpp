// Which chain is the best one, in graphs of a few pieces.
#include "segmentation/colon_chain.h"

#include <algorithm>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

ChainNode piece(double lengthMm, double rectumLogOdds) {
    ChainNode node;
    node.lengthMm = lengthMm, node.radiusMm = 12.0, node.volumeMl = 0.4 * lengthMm;
    node.rectumLogOdds = rectumLogOdds;
    return node;
}

ChainJunction junction(int a, int b, JunctionKind kind, double logOdds) {
    ChainJunction made;
    made.a = a, made.b = b, made.kind = kind, made.logOdds = logOdds;
    made.radiusMm = kind == JunctionKind::collapse ? 0.0 : 6.0;
    return made;
}

/// Twelve pieces of 120 mm in a row, the first at the anus, closed after the third.
ChainGraph row(double collapseLogOdds) {
    ChainGraph graph;
    for (int n = 0; n < 12; ++n) {
        graph.nodes.push_back(piece(120.0, n == 0 ? 0.0 : -15.0));
        graph.nodes.back().centerMm = {0.0, 0.0, 120.0 * n};
        if (n == 0) continue;
        const bool closed = n == 3;
        graph.junctions.push_back(closed
                                      ? junction(n - 1, n, JunctionKind::collapse, collapseLogOdds)
                                      : junction(n - 1, n, JunctionKind::openLumen, 20.0));
    }
    return graph;
}

TEST(ColonChain, AnUnlikelyCollapseIsLikelierThanAColonOfAThirdOfAMetre) {
    const auto chains = findChains(row(-12.0));
    ASSERT_FALSE(chains.empty());
    EXPECT_EQ(chains.front().nodes.size(), 12u);
}

TEST(ColonChain, HolesOfOneWallCountOnce) {
    // The third piece and the tenth touch.
    const auto scoreWith = [](int holes) {
        ChainGraph graph = row(-4.0);
        for (int n = 0; n < holes; ++n)
            graph.junctions.push_back(
                junction(2, 9, JunctionKind::openLumen, n == holes - 1 ? 3.0 : 0.6));
        return findChains(graph).front().score;
    };
    EXPECT_LT(scoreWith(1), scoreWith(0) - 2.0);
    EXPECT_DOUBLE_EQ(scoreWith(8), scoreWith(1));
}

// Two ways from the third piece to the fifth, alike but for their folds.
TEST(ColonChain, GoesThroughFoldedBowelRatherThanSmooth) {
    for (const bool firstIsFolded : {true, false}) {
        ChainGraph graph = row(20.0);
        graph.nodes.push_back(graph.nodes[3]);
        const int other = int(graph.nodes.size()) - 1;
        graph.junctions.push_back(junction(2, other, JunctionKind::collapse, 20.0));
        graph.junctions.push_back(junction(other, 4, JunctionKind::openLumen, 7.0));
        graph.junctions[3].logOdds = 7.0;  // 3 to 4, as unsure as the other way
        graph.nodes[3].foldLogOdds.fill(firstIsFolded ? 2.0 : -1.0);
        graph.nodes[std::size_t(other)].foldLogOdds.fill(firstIsFolded ? -1.0 : 2.0);
        const ColonChain best = findChains(graph).front();
        const int folded = firstIsFolded ? 3 : other;
        EXPECT_NE(std::find(best.nodes.begin(), best.nodes.end(), folded), best.nodes.end());
    }
}

// Beneath the first piece, whose lowest end lies 60 mm under its middle.
struct RectalEnd {
    double middleMm = -70.0, place = 1.2, radiusMm = 5.0, openMm2 = 40.0, volumeMl = 8.0;
    double firstAtAnus = 0.0, given = 0.0;
    bool isTaken() const {
        ChainGraph graph = row(20.0);
        graph.nodes[0].lowestMm = {0.0, 0.0, -60.0};
        graph.nodes.push_back(piece(20.0, -1.0));
        ChainNode& end = graph.nodes.back();
        end.centerMm = {0.0, 0.0, middleMm}, end.radiusMm = radiusMm;
        end.volumeMl = volumeMl, end.given = given;
        graph.nodes[0].rectumLogOdds = firstAtAnus;
        end.placeLogOdds[std::size_t(ColonPart::rectum)] = place;
        graph.junctions.push_back(junction(0, 12, JunctionKind::thinWall, -5.0));
        graph.junctions.back().openMm2 = openMm2;
        const ColonChain best = findChains(graph).front();
        return std::ranges::count(best.sacs, 12) + std::ranges::count(best.nodes, 12) > 0;
    }
};

TEST(ColonChain, GoesOnToTheRectumsEndThroughANarrowOpening) {
    EXPECT_TRUE(RectalEnd().isTaken());
    EXPECT_FALSE((RectalEnd{.middleMm = -40.0}.isTaken())) << "a loop beside the rectum";
    EXPECT_FALSE((RectalEnd{.place = 0.0}.isTaken())) << "not in the middle";
    EXPECT_FALSE((RectalEnd{.radiusMm = 3.0}.isTaken())) << "as wide as a catheter";
    EXPECT_FALSE((RectalEnd{.openMm2 = 0.0}.isTaken())) << "nothing but wall between";
    EXPECT_FALSE((RectalEnd{.middleMm = -120.0}.isTaken())) << "farther off than beyond a balloon";
    EXPECT_FALSE((RectalEnd{.volumeMl = 40.0}.isTaken())) << "larger than a sac";
    EXPECT_FALSE((RectalEnd{.firstAtAnus = -6.0}.isTaken())) << "what it lies under is no rectum";
    EXPECT_FALSE((RectalEnd{.given = -60.0}.isTaken())) << "a reader said that it is not";
}

TEST(ColonChain, GoesOnThroughABalloonToTheRectumsEnd) {
    const auto takesTheBalloon = [](double endMm) {
        ChainGraph graph = row(20.0);
        graph.nodes[0].lowestMm = {0.0, 0.0, -60.0};
        for (const double middleMm : {-40.0, endMm}) {
            graph.nodes.push_back(piece(20.0, -1.0));
            graph.nodes.back().centerMm = {0.0, 0.0, middleMm};
            graph.nodes.back().placeLogOdds[std::size_t(ColonPart::rectum)] = 1.2;
        }
        for (const auto& [a, b] : {std::pair(0, 12), std::pair(12, 13)}) {
            graph.junctions.push_back(junction(a, b, JunctionKind::thinWall, -5.0));
            graph.junctions.back().openMm2 = 40.0;
        }
        return std::ranges::count(findChains(graph).front().sacs, 12) > 0;
    };
    EXPECT_TRUE(takesTheBalloon(-70.0));
    EXPECT_FALSE(takesTheBalloon(-45.0)) << "leads nowhere";
}

}  // namespace
