#include "segmentation/tagged_stool.h"

#include "core/grid.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace haustra {
namespace {

constexpr int wallBelow = 8;  // soft tissue in voxels of k < wallBelow, lumen above

// A flat wall under gas or fluid, and something bright on it.
struct Scene {
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> labels;
    segmentation::BowelContents contents;
    TissueModel tissue;

    explicit Scene(LumenLabel lumen, double voxelMm = 0.75)
        : hu(axisAlignedGrid({24, 24, 24}, glm::dvec3(voxelMm))), labels(hu.grid()) {
        tissue.meanHu = {-990.0, -100.0, 40.0, 600.0};
        tissue.airBelowHu = -475.0, tissue.taggedAboveHu = 200.0;
        contents.content = Volume<std::uint8_t>(hu.grid());
        const bool gas = lumen == LumenLabel::air;
        each([&](std::size_t n, glm::ivec3 v) {
            hu.writable()[n] = std::int16_t(v.z < wallBelow ? 40 : gas ? -990 : 600);
            labels.writable()[n] = std::uint8_t(v.z < wallBelow ? LumenLabel::outside : lumen);
            contents.content.writable()[n] =
                std::uint8_t(v.z < wallBelow ? segmentation::Content::tissue
                             : gas           ? segmentation::Content::gas
                                             : segmentation::Content::tagged);
        });
    }
    void each(const std::function<void(std::size_t, glm::ivec3)>& visit) const {
        for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n)
            visit(n, hu.grid().voxelAt(n));
    }
    // Of `value`, with a voxel of partial volume around where there was lumen.
    void put(int value, segmentation::Content content,
             const std::function<bool(glm::ivec3)>& inside) {
        each([&](std::size_t n, glm::ivec3 v) {
            bool beside = false;
            visitFaces(hu.grid(), n, [&](std::size_t m, int) {
                beside = beside || inside(hu.grid().voxelAt(m));
            });
            if (inside(v)) {
                hu.writable()[n] = std::int16_t(value), labels.writable()[n] = 0;
                contents.content.writable()[n] = std::uint8_t(content);
            } else if (beside && v.z >= wallBelow) {
                hu.writable()[n] = -100, labels.writable()[n] = 0;
                contents.content.writable()[n] = std::uint8_t(segmentation::Content::tissue);
            }
        });
    }
    // Of the voxels of a kind, the share that is labelled tagged once stool is added.
    double taggedShare(const std::function<bool(glm::ivec3)>& of,
                       const segmentation::OtherMaterial& other = {}) {
        segmentation::addTaggedStool(labels, hu, contents, tissue, other);
        int all = 0, tagged = 0;
        each([&](std::size_t n, glm::ivec3 v) {
            if (!of(v)) return;
            ++all;
            tagged += labels[n] == std::uint8_t(LumenLabel::tagged);
        });
        EXPECT_GT(all, 0);
        return double(tagged) / all;
    }
    // The same where they are no lump of stool.
    double taggedShareByGas(const std::function<bool(glm::ivec3)>& of) {
        segmentation::OtherMaterial other;
        each([&](std::size_t n, glm::ivec3 v) {
            if (of(v)) other.aside.push_back(std::uint32_t(n));
        });
        return taggedShare(of, other);
    }
};

bool inCrumb(glm::ivec3 v) {  // 2 × 2 × 3, on the wall
    return v.x >= 11 && v.x < 13 && v.y >= 11 && v.y < 13 && v.z >= wallBelow &&
           v.z < wallBelow + 3;
}
bool inLayer(glm::ivec3 v) {  // one voxel thick
    return v.x >= 5 && v.x < 19 && v.y >= 5 && v.y < 19 && v.z == wallBelow;
}

TEST(TaggedStool, ACrumbInGasIsOfTheLumenThoughItHasNoInside) {
    Scene scene(LumenLabel::air);
    scene.put(240, segmentation::Content::tagged, inCrumb);
    EXPECT_EQ(scene.taggedShare(inCrumb), 1.0);
}

// Where it is cut into lobes each touches the other, one is as wide as bowel, and neither is judged
// by itself; what the lumen sees little of is no stool all the same.
TEST(TaggedStool, ALumpOfLobesIsJudgedAsOne) {
    const auto inLobes = [](glm::ivec3 v) {
        const glm::dvec3 p(v);
        return v.z >= wallBelow && (glm::distance(p, {9.0, 12.0, wallBelow + 3.0}) < 5.0 ||
                                    glm::distance(p, {15.0, 12.0, wallBelow + 3.0}) < 4.0);
    };
    const auto shareOf = [&](bool buried) {
        Scene scene(LumenLabel::air);
        scene.put(500, segmentation::Content::tagged, inLobes);
        segmentation::OtherMaterial other;
        scene.each([&](std::size_t n, glm::ivec3 v) {
            if (inLobes(v)) (v.x < 13 ? other.bowel : other.aside).push_back(std::uint32_t(n));
            if (buried && !inLobes(v) && v.z < wallBelow + 6) {
                scene.hu.writable()[n] = 40, scene.labels.writable()[n] = 0;
                scene.contents.content.writable()[n] = std::uint8_t(segmentation::Content::tissue);
            }
        });
        return scene.taggedShare(inLobes, other);
    };
    EXPECT_EQ(shareOf(false), 1.0);
    EXPECT_EQ(shareOf(true), 0.0);
}

// Nothing is between a film and the gas but their blur.
TEST(TaggedStool, AFilmOnTheWallIsOfTheLumen) {
    Scene scene(LumenLabel::air);
    scene.put(240, segmentation::Content::tagged, inLayer);
    EXPECT_EQ(scene.taggedShare(inLayer), 1.0);
}

// Between gas and gas: with its coat a fold would be gone.
TEST(TaggedStool, ACoatedFoldIsLeftAlone) {
    for (const int coatVoxels : {1, 2, 4}) {
        Scene scene(LumenLabel::air);
        const auto between = [](glm::ivec3 v, int from, int to) {
            return v.x >= from && v.x < to && v.y >= 4 && v.y < 20 && v.z >= wallBelow &&
                   v.z < wallBelow + 12;
        };
        const auto inCoat = [&](glm::ivec3 v) { return between(v, 12 - coatVoxels, 12); };
        const auto inFold = [&](glm::ivec3 v) { return between(v, 12, 15); };
        scene.put(300, segmentation::Content::tagged, inCoat);
        scene.put(40, segmentation::Content::tissue, inFold);
        scene.each([&](std::size_t n, glm::ivec3 v) {
            if (inCoat(v)) scene.hu.writable()[n] = 300;
        });
        EXPECT_EQ(scene.taggedShareByGas(inCoat), 0.0) << coatVoxels;
    }
}

// In wide voxels a thin wall is blur, too.
TEST(TaggedStool, InWideVoxelsAFilmIsLeftAlone) {
    Scene scene(LumenLabel::air, 1.5);
    scene.put(240, segmentation::Content::tagged, inLayer);
    EXPECT_EQ(scene.taggedShare(inLayer), 0.0);
}

// Behind 2 mm of wall, blurred as a scanner does: a loop that is pressed flat, or a rib. Between
// two such bodies the walk passes few voxels of soft tissue's own HU.
TEST(TaggedStool, ALayerBehindAThinWallIsLeftAlone) {
    for (const double wallMm : {0.0, 2.0, 2.5}) {
        for (const double shiftMm : {0.0, 0.2, 0.4, 0.6}) {
            Scene scene(LumenLabel::air);
            constexpr double sdMm = 0.6;
            const auto above = [&](double mm) {
                return 0.5 * std::erfc(-mm / (sdMm * std::sqrt(2.0)));
            };
            // Gas above the plane, the wall beneath it, then 3 mm of tagging, then tissue.
            const double surfaceMm = 0.75 * wallBelow + shiftMm;
            std::vector<std::uint8_t> bright(scene.hu.grid().voxelCount());
            scene.each([&](std::size_t n, glm::ivec3 v) {
                const double deep = surfaceMm - 0.75 * v.z;
                const double hu = 40.0 - 1030.0 * above(-deep) +
                                  660.0 * (above(deep - wallMm) - above(deep - wallMm - 3.0));
                scene.hu.writable()[n] = std::int16_t(std::lround(hu));
                const bool gas = hu < scene.tissue.airBelowHu;
                scene.labels.writable()[n] =
                    std::uint8_t(gas ? LumenLabel::air : LumenLabel::outside);
                bright[n] = hu > scene.tissue.taggedAboveHu;
                scene.contents.content.writable()[n] =
                    std::uint8_t(gas         ? segmentation::Content::gas
                                 : bright[n] ? segmentation::Content::tagged
                                             : segmentation::Content::tissue);
            });
            const double share = scene.taggedShareByGas(
                [&](glm::ivec3 v) { return bright[scene.hu.grid().index(v)] != 0; });
            EXPECT_EQ(share, wallMm == 0.0 ? 1.0 : 0.0) << wallMm << " mm, shifted by " << shiftMm;
        }
    }
}

TEST(TaggedStool, NoiseIsNoFilm) {
    Scene scene(LumenLabel::air);
    scene.contents.gasSdHu = 60.0;
    scene.put(240, segmentation::Content::tagged, inLayer);
    EXPECT_EQ(scene.taggedShare(inLayer), 0.0);
}

TEST(TaggedStool, ASharpKernelsOvershootIsNoCrumb) {
    Scene scene(LumenLabel::air);
    scene.put(240, segmentation::Content::tissue, inCrumb);
    EXPECT_EQ(scene.taggedShare(inCrumb), 0.0);
}

// A small polyp under fluid, as bright as tagging by its blur alone, has fluid around and gas on
// one side at most.
TEST(TaggedStool, WhatIsBrightByItsBlurUnderFluidIsNoCrumb) {
    Scene scene(LumenLabel::tagged);
    scene.each([&](std::size_t n, glm::ivec3 v) {
        if (v.z < wallBelow + 4) return;
        scene.labels.writable()[n] = std::uint8_t(LumenLabel::air);
        scene.hu.writable()[n] = -990;
    });
    scene.put(240, segmentation::Content::tagged, inCrumb);
    EXPECT_EQ(scene.taggedShare(inCrumb), 0.0);
}

// What is surely something else is of no body; what is as wide as bowel is no film.
TEST(TaggedStool, WhatIsOtherMaterialIsLeftAlone) {
    for (int which = 0; which < 3; ++which) {
        Scene scene(LumenLabel::air);
        scene.put(240, segmentation::Content::tagged, inLayer);
        segmentation::OtherMaterial other;
        auto& list = which == 0 ? other.surely : which == 1 ? other.bowel : other.aside;
        scene.each([&](std::size_t n, glm::ivec3 v) {
            if (inLayer(v)) list.push_back(std::uint32_t(n));
        });
        EXPECT_EQ(scene.taggedShare(inLayer, other), which == 2 ? 1.0 : 0.0) << which;
    }
}

}  // namespace
}  // namespace haustra
