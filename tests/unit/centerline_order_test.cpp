// The order of the colon's segments.
#include "centerline/order.h"

#include <gtest/gtest.h>

namespace haustra::centerline {
namespace {

// A colon in LPS mm: rectum low and posterior at the midline, descending colon to the patient's
// left (+x), ascending colon and cecum to the right.
const SegmentEnds rectosigmoid{{0, 50, 0}, {60, 0, 60}, 300};
const SegmentEnds descending{{85, 40, 90}, {100, 45, 280}, 220};
const SegmentEnds transverse{{90, 0, 290}, {-80, -10, 280}, 350};
const SegmentEnds ascending{{-95, 20, 260}, {-90, 10, 110}, 180};
const glm::dvec3 middle(0, 10, 150);

SegmentEnds backwards(const SegmentEnds& s) {
    return {s.lastMm, s.firstMm, s.lengthMm};
}

TEST(CenterlineOrder, GoesFromRectumToCecumHoweverTheSegmentsAreGiven) {
    const std::vector<SegmentVisit> order = orderSegments(
        {transverse, backwards(ascending), rectosigmoid, backwards(descending)}, middle);
    const std::vector<SegmentVisit> truth{{2, false}, {3, true}, {0, false}, {1, true}};
    EXPECT_EQ(order, truth);
}

TEST(CenterlineOrder, OneSegmentBeginsAtTheRectum) {
    const SegmentEnds whole{{-90, 10, 110}, {0, 50, 0}, 1400};
    EXPECT_EQ(orderSegments({whole}, middle), (std::vector<SegmentVisit>{{0, true}}));
    EXPECT_EQ(orderSegments({backwards(whole)}, middle), (std::vector<SegmentVisit>{{0, false}}));
}

TEST(CenterlineOrder, LeavesOutWhatLiesFartherOffTheWayThanItIsLong) {
    const SegmentEnds duodenum{{-20, 0, 180}, {10, 0, 200}, 40};
    const auto order =
        orderSegments({rectosigmoid, duodenum, descending, transverse, ascending}, middle);
    EXPECT_EQ(order, (std::vector<SegmentVisit>{{0, false}, {2, false}, {3, false}, {4, false}}));
    // As short, but on the way.
    const SegmentEnds between{{65, 10, 65}, {80, 30, 85}, 35};
    EXPECT_EQ(
        orderSegments({rectosigmoid, between, descending, transverse, ascending}, middle).size(),
        5u);
}

TEST(CenterlineOrder, APersonsEndsAreKept) {
    const std::vector<SegmentEnds> segments{rectosigmoid, descending, transverse, ascending};
    const auto fromThere = orderSegments(segments, middle, SegmentVisit{3, true});
    EXPECT_EQ(fromThere.front(), (SegmentVisit{3, true}));
    EXPECT_EQ(fromThere.back(), (SegmentVisit{0, true}));
    const auto toThere = orderSegments(segments, middle, {}, SegmentVisit{0, true});
    EXPECT_EQ(toThere.back(), (SegmentVisit{0, true}));
    EXPECT_TRUE(orderSegments({rectosigmoid}, middle, SegmentVisit{0, false}, SegmentVisit{0, true})
                    .empty());
    EXPECT_TRUE(orderSegments({}, middle).empty());
}

TEST(CenterlineOrder, RectumIsCaudalPosteriorAndNearTheMidline) {
    const double rectum = rectumPenaltyMm({0, 50, 0}, middle);
    EXPECT_LT(rectum, rectumPenaltyMm({0, 50, 30}, middle));
    EXPECT_LT(rectum, rectumPenaltyMm({0, 0, 0}, middle));
    EXPECT_LT(rectum, rectumPenaltyMm({-40, 50, 0}, middle));
    EXPECT_EQ(rectumPenaltyMm({-40, 50, 0}, middle), rectumPenaltyMm({40, 50, 0}, middle));
}

}  // namespace
}  // namespace haustra::centerline
