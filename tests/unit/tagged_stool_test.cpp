#include "segmentation/tagged_stool.h"

#include "core/grid.h"

#include <functional>

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
    double taggedShare(const std::function<bool(glm::ivec3)>& of) {
        segmentation::addTaggedStool(labels, hu, contents, tissue, {});
        int all = 0, tagged = 0;
        each([&](std::size_t n, glm::ivec3 v) {
            if (!of(v)) return;
            ++all;
            tagged += labels[n] == std::uint8_t(LumenLabel::tagged);
        });
        EXPECT_GT(all, 0);
        return double(tagged) / all;
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

// Nothing is between a film and the gas but their blur.
TEST(TaggedStool, AFilmOnTheWallIsOfTheLumen) {
    Scene scene(LumenLabel::air);
    scene.put(240, segmentation::Content::tagged, inLayer);
    EXPECT_EQ(scene.taggedShare(inLayer), 1.0);
}

// Between gas and gas: with its coat a fold would be gone.
TEST(TaggedStool, ACoatedFoldIsLeftAlone) {
    Scene scene(LumenLabel::air);
    const auto inCoat = [](glm::ivec3 v) {
        return v.x == 12 && v.y >= 5 && v.y < 19 && v.z >= wallBelow && v.z < wallBelow + 12;
    };
    const auto inFold = [&](glm::ivec3 v) { return inCoat(v - glm::ivec3(1, 0, 0)); };
    scene.put(40, segmentation::Content::tissue, inFold);
    scene.put(240, segmentation::Content::tagged, inCoat);
    EXPECT_EQ(scene.taggedShare(inCoat), 0.0);
}

// In wide voxels a thin wall is blur, too.
TEST(TaggedStool, InWideVoxelsAFilmIsLeftAlone) {
    Scene scene(LumenLabel::air, 1.5);
    scene.put(240, segmentation::Content::tagged, inLayer);
    EXPECT_EQ(scene.taggedShare(inLayer), 0.0);
}

// Behind 1.5 mm of wall: a loop that is pressed flat, or a rib.
TEST(TaggedStool, ALayerBehindAThinWallIsLeftAlone) {
    Scene scene(LumenLabel::air);
    const auto behind = [](glm::ivec3 v) { return inLayer(v + glm::ivec3(0, 0, 3)); };
    scene.put(700, segmentation::Content::tagged, behind);
    EXPECT_EQ(scene.taggedShare(behind), 0.0);
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

// A small polyp under fluid, as bright as tagging by its blur alone, has fluid around, not gas.
TEST(TaggedStool, WhatIsBrightByItsBlurUnderFluidIsNoCrumb) {
    Scene scene(LumenLabel::tagged);
    scene.put(240, segmentation::Content::tagged, inCrumb);
    EXPECT_EQ(scene.taggedShare(inCrumb), 0.0);
}

}  // namespace
}  // namespace haustra
