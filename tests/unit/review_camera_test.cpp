// From where a reader looks at a place of the wall.
#include "render/wall/review_camera.h"

#include "flat_tube.h"
#include "render/wall/wall_coverage.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using namespace render;

// Folds that overhang: what lies behind one is not seen from the path across from it.
const FlatTube& tube() {
    static const FlatTube made{{.leanMm = 7.0}};
    return made;
}

class ReviewCameraTest : public ::testing::Test {
protected:
    ReviewCameraTest()
        : sight_(WallSight::of(std::make_shared<const FlatMap>(tube().map({60, 240}))).value()) {}

    glm::dvec3 middle(std::int32_t triangle) const {
        return sight_->originMm() + glm::dvec3(sight_->facets()[std::size_t(triangle)].middleMm);
    }
    MissedPatch around(glm::dvec2 flat, double radiusMm) const {
        MissedPatch patch;
        patch.centerMm = tube().positionMm(flat);
        patch.inward = tube().inwardNormal(flat);
        patch.arcMm = patch.centerMm.z;
        for (std::int32_t t = 0; t < std::int32_t(sight_->facets().size()); ++t)
            if (glm::distance(middle(t), patch.centerMm) < radiusMm &&
                glm::dot(glm::dvec3(sight_->facets()[std::size_t(t)].inward), patch.inward) > 0.5)
                patch.triangles.push_back(t);
        return patch;
    }
    // Of the patch, mm², by an eye that turns to each place of it.
    double seenFrom(glm::dvec3 eyeMm, const MissedPatch& patch) const {
        double area = 0.0;
        for (const std::int32_t t : patch.triangles) {
            const WallSight::Facet& facet = sight_->facets()[std::size_t(t)];
            const glm::dvec3 way = middle(t) - eyeMm;
            const double cosine = -glm::dot(glm::normalize(way), glm::dvec3(facet.inward));
            if (cosine > std::cos(glm::radians(sightLimits.mostAngleDegrees)) &&
                glm::length(way) >= sightLimits.nearestMm && !sight_->hides(eyeMm, t))
                area += double(facet.areaMm2);
        }
        return area;
    }

    std::shared_ptr<const WallSight> sight_;
};

TEST_F(ReviewCameraTest, LeavesThePathWhereItDoesNotShowThePlace) {
    const Centerline path = tube().centerline();
    int beside = 0, onPath = 0;
    for (double y = 0.15; y < tube().height() - 0.15; y += 0.02) {
        const MissedPatch patch = around({0.3, y}, 1.5);
        ASSERT_FALSE(patch.triangles.empty());
        ASSERT_LE(patch.triangles.size(), 64u) << "none is passed over";
        const double fromPath = seenFrom({0.0, 0.0, patch.arcMm}, patch);
        const auto view = viewBesidePath(*sight_, patch, path);
        if (!view) {
            ++onPath;
            EXPECT_GT(fromPath, 0.0) << y;
            continue;
        }
        ++beside;
        const double shown = seenFrom(view->positionMm, patch);
        EXPECT_GT(shown, 0.0) << y;
        EXPECT_GE(1.06 * shown, 2.0 * fromPath) << y;
        // It looks at the place, from within the tube.
        EXPECT_NEAR(glm::dot(view->forward, glm::normalize(patch.centerMm - view->positionMm)), 1.0,
                    1e-9);
        EXPECT_LT(glm::length(glm::dvec2(view->positionMm)), tube().shape().radiusMm);
    }
    EXPECT_GT(beside, 5);
    EXPECT_GT(onPath, 20);
}

TEST_F(ReviewCameraTest, StaysOnThePathWhereNothingShowsThePlaceOrThereIsNone) {
    MissedPatch patch = around({0.3, 0.5 * tube().height()}, 1.5);
    EXPECT_FALSE(viewBesidePath(*sight_, patch, Centerline{}));
    patch.triangles.clear();
    EXPECT_FALSE(viewBesidePath(*sight_, patch, tube().centerline()));
}

}  // namespace
}  // namespace haustra::tests
