// From pieces to labels: what is filled between gas and fluid, and what stays a wall.
#include "segmentation/colon_labels.h"

#include "core/ct_scan.h"

#include <functional>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

constexpr int fluidTop = 22;  // y of the fluid's first voxel; supine, so y is down

/// Gas over fluid, with what looks like tissue in between, and a level.
struct Scene {
    Volume<std::int16_t> hu;
    BowelContents contents;
    TubePieces cut;
    PieceGraph graph;
    ColonChain chain;
};

Scene emptyScene() {
    const Grid grid = axisAlignedGrid({60, 50, 40}, glm::dvec3(1.0));
    Scene scene;
    scene.hu = Volume<std::int16_t>(grid, std::int16_t(40));
    scene.contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue));
    scene.contents.down = {1, 1};
    return scene;
}

/// Cuts the scene into pieces, all of which are the chain's; it passes the orifices that `isOpen`.
void chainUp(Scene& scene, const Volume<std::uint8_t>& walls,
             const std::function<bool(const Orifice&)>& isOpen) {
    scene.cut = cutIntoPieces(scene.hu, scene.contents.content, walls, {});
    for (std::size_t p = 0; p < scene.cut.pieces.size(); ++p) {
        scene.graph.graph.nodes.emplace_back();
        scene.graph.pieceOf.push_back(std::int32_t(p));
        scene.graph.nodeOf.push_back(std::int32_t(p));
        scene.chain.nodes.push_back(int(p));
    }
    for (std::size_t o = 0; o < scene.cut.orifices.size(); ++o) {
        if (!isOpen(scene.cut.orifices[o])) continue;
        ChainJunction junction;
        junction.a = scene.cut.orifices[o].a, junction.b = scene.cut.orifices[o].b;
        junction.path = int(o);
        scene.chain.junctions.push_back(int(scene.graph.graph.junctions.size()));
        scene.graph.graph.junctions.push_back(junction);
    }
}

ColonLabels labelsOf(const Scene& scene) {
    TissueModel tissue;
    tissue.meanHu = {-1000, -100, 40, 500};
    tissue.airBelowHu = -480, tissue.taggedAboveHu = 270;
    return layLabels(scene.hu, tissue, scene.contents, scene.cut, scene.graph, scene.chain);
}

/// `wall` voxels between gas and fluid, which meet at one end where they are one lumen.
Scene gasOverFluid(int wall, bool oneLumen) {
    Scene scene = emptyScene();
    const Grid& grid = scene.hu.grid();
    const Volume<std::uint8_t> walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.x < 5 || v.x >= 55 || v.z < 5 || v.z >= 35) continue;
        const bool gas = v.y >= 5 && v.y < fluidTop - wall;
        const bool fluid = v.y >= fluidTop && v.y < 40;
        const bool door = oneLumen && v.x >= 45 && v.y >= fluidTop - wall && v.y < fluidTop;
        if (!gas && !fluid && !door) continue;
        scene.hu.writable()[n] = fluid ? 500 : -1000;
        scene.contents.content.writable()[n] = std::uint8_t(fluid ? Content::tagged : Content::gas);
    }
    Level level;
    level.height = fluidTop, level.fluidHu = 500;
    for (int x = 10; x < 50; ++x)
        level.columns.push_back({{x, fluidTop - wall - 1, 20}, {x, fluidTop, 20}});
    scene.contents.levels.push_back(level);
    chainUp(scene, walls, [](const Orifice&) { return true; });
    return scene;
}

int labelledBetween(int wall, bool oneLumen) {
    const Scene scene = gasOverFluid(wall, oneLumen);
    const ColonLabels laid = labelsOf(scene);
    int labelled = 0;
    for (int x = 10; x < 40; ++x) {
        for (int y = fluidTop - wall; y < fluidTop; ++y)
            labelled += laid.labels.at({x, y, 20}) != std::uint8_t(LumenLabel::outside);
    }
    return labelled;
}

/// Two halves of a colon, x below and from 30 on, that a gap in a wall joins and nothing else.
Scene halves(int otherLengthMm) {
    Scene scene = emptyScene();
    const Grid& grid = scene.hu.grid();
    Volume<std::uint8_t> walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.x < 2 || v.x >= 30 + otherLengthMm || v.y < 10 || v.y >= 40 || v.z < 5 || v.z >= 35)
            continue;
        // What looks like a wall leaves a gap in its middle.
        const bool isWall = v.x == 30 && (std::abs(v.y - 25) > 3 || std::abs(v.z - 20) > 3);
        scene.hu.writable()[n] = isWall ? -600 : -1000;
        scene.contents.content.writable()[n] = std::uint8_t(Content::gas);
        walls.writable()[n] = isWall;
    }
    chainUp(scene, walls, [](const Orifice&) { return false; });
    return scene;
}

TEST(ColonLabels, AWallThatPartsTheColonIsNone) {
    // 22 ml are colon, 9 ml may be a crumb.
    for (const int lengthMm : {26, 11}) {
        const Scene scene = halves(lengthMm);
        const ColonLabels laid = labelsOf(scene);
        const bool kept =
            laid.labels.at({30 + lengthMm / 2, 25, 20}) != std::uint8_t(LumenLabel::outside);
        EXPECT_EQ(kept, lengthMm == 26);
        EXPECT_EQ(laid.strandedMl < 0.1, lengthMm == 26) << laid.strandedMl;
        ASSERT_EQ(laid.walls.size(), 1u);
        EXPECT_EQ(laid.walls[0].openedAgain, lengthMm == 26);
        EXPECT_TRUE(laid.walls[0].betweenLoops);
    }
}

// A loop from x = 2 around to x = 37 and back, whose limbs touch at y = 25 in a wide gap at its
// far end, and beyond x = 38 a part that a narrow gap joins and nothing else.
Scene loopAndPart() {
    Scene scene = emptyScene();
    const Grid& grid = scene.hu.grid();
    Volume<std::uint8_t> walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.x < 2 || v.x >= 58 || v.y < 5 || v.y >= 45 || v.z < 5 || v.z >= 35) continue;
        if (v.x >= 14 && v.x < 27 && std::abs(v.y - 25) < 2) continue;
        const bool ofLimbs = v.x < 14 && v.y == 25 && std::abs(v.z - 20) > 6,
                   ofPart = v.x == 38 && (std::abs(v.y - 25) > 3 || std::abs(v.z - 20) > 3);
        const bool isWall = ofLimbs || ofPart;
        scene.hu.writable()[n] = isWall ? -600 : -1000;
        scene.contents.content.writable()[n] = std::uint8_t(Content::gas);
        walls.writable()[n] = isWall;
    }
    chainUp(scene, walls, [](const Orifice& o) { return o.placeMm.x > 20 && o.placeMm.x < 36; });
    return scene;
}

TEST(ColonLabels, OnlyTheWallThatPartsTheColonIsOpened) {
    const ColonLabels laid = labelsOf(loopAndPart());
    ASSERT_EQ(laid.walls.size(), 2u);
    for (const RebuiltWall& wall : laid.walls) {
        const bool ofPart = wall.placeMm.x > 30;
        EXPECT_TRUE(wall.betweenLoops);
        EXPECT_EQ(wall.openedAgain, ofPart) << "though the other's hole is wider";
        EXPECT_EQ(wall.radiusMm < 5, ofPart);
    }
    EXPECT_NE(laid.labels.at({48, 14, 20}), std::uint8_t(LumenLabel::outside));
    EXPECT_LT(laid.strandedMl, 0.1);
    // The limbs stay apart: no column through their gap is lumen all the way.
    for (int x = 3; x < 13; ++x) {
        for (int z = 14; z <= 26; ++z) {
            int lumen = 0;
            for (int y = 22; y < 29; ++y)
                lumen += laid.labels.at({x, y, z}) != std::uint8_t(LumenLabel::outside);
            EXPECT_LT(lumen, 7) << x << ' ' << z;
        }
    }
}

TEST(ColonLabels, PartialVolumeBetweenGasAndItsFluidIsLumen) {
    EXPECT_EQ(labelledBetween(2, true), 30 * 2);
}

TEST(ColonLabels, AWallBetweenGasAndAnotherLoopsFluidStays) {
    EXPECT_EQ(labelledBetween(2, false), 0);
}

// Beside a loop of gas over fluid, up to x = 39, lies another of gas alone; the wall between is too
// thin to show. Where it is set up it parts the loops' own voxels, and what is filled in at the
// level must not lead past it.
TEST(ColonLabels, WhatIsFilledAtALevelOpensIntoNoOtherLoop) {
    constexpr int gap = 2, firstOfOther = 40;
    Scene scene = emptyScene();
    const Grid& grid = scene.hu.grid();
    Volume<std::uint8_t> walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.x < 5 || v.x >= 55 || v.y < 5 || v.y >= 40 || v.z < 5 || v.z >= 35) continue;
        const bool other = v.x >= firstOfOther, fluid = !other && v.y >= fluidTop, door = v.x < 17;
        if (!other && !fluid && !door && v.y >= fluidTop - gap) continue;
        scene.hu.writable()[n] = fluid ? 500 : v.x == firstOfOther ? -600 : -1000;
        scene.contents.content.writable()[n] = std::uint8_t(fluid ? Content::tagged : Content::gas);
        walls.writable()[n] = v.x == firstOfOther;
    }
    Level level;
    level.height = fluidTop, level.fluidHu = 500;
    for (int x = 17; x < firstOfOther; ++x)
        level.columns.push_back({{x, fluidTop - gap - 1, 20}, {x, fluidTop, 20}});
    scene.contents.levels.push_back(level);
    const auto isOther = [&](std::int32_t piece) {
        return scene.cut.pieces[std::size_t(piece)].center.x >= firstOfOther;
    };
    chainUp(scene, walls, [&](const Orifice& o) { return isOther(o.a) == isOther(o.b); });
    const ColonLabels laid = labelsOf(scene);
    ASSERT_EQ(laid.labels.at({20, fluidTop - 1, 20}), std::uint8_t(LumenLabel::tagged));
    int holes = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.x + 1 >= grid.size.x || scene.cut.pieceAt.at(v + glm::ivec3(1, 0, 0)) < 0) continue;
        const bool crosses = !(scene.cut.pieceAt[n] >= 0 && isOther(scene.cut.pieceAt[n])) &&
                             isOther(scene.cut.pieceAt.at(v + glm::ivec3(1, 0, 0)));
        holes += crosses && laid.labels[n] != std::uint8_t(LumenLabel::outside) &&
                 laid.labels.at(v + glm::ivec3(1, 0, 0)) != std::uint8_t(LumenLabel::outside);
    }
    EXPECT_EQ(holes, 0);
}

}  // namespace
