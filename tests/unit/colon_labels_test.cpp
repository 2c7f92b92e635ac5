// From pieces to labels: what is filled between gas and fluid, and what stays a wall.
#include "segmentation/colon_labels.h"

#include "core/ct_scan.h"

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

/// `wall` voxels between gas and fluid, which meet at one end where they are one lumen.
Scene gasOverFluid(int wall, bool oneLumen) {
    const Grid grid = axisAlignedGrid({60, 50, 40}, glm::dvec3(1.0));
    Scene scene;
    scene.hu = Volume<std::int16_t>(grid, std::int16_t(40));
    scene.contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue));
    Volume<std::uint8_t> walls(grid, std::uint8_t(0));
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
    scene.contents.down = {1, 1};
    scene.cut = cutIntoPieces(scene.hu, scene.contents.content, walls, {});
    for (std::size_t p = 0; p < scene.cut.pieces.size(); ++p) {
        scene.graph.graph.nodes.emplace_back();
        scene.graph.pieceOf.push_back(std::int32_t(p));
        scene.graph.nodeOf.push_back(std::int32_t(p));
        scene.chain.nodes.push_back(int(p));
    }
    for (std::size_t o = 0; o < scene.cut.orifices.size(); ++o) {  // the chain passes all
        ChainJunction junction;
        junction.a = scene.cut.orifices[o].a, junction.b = scene.cut.orifices[o].b;
        junction.path = int(o);
        scene.graph.graph.junctions.push_back(junction);
        scene.chain.junctions.push_back(int(o));
    }
    return scene;
}

int labelledBetween(int wall, bool oneLumen) {
    const Scene scene = gasOverFluid(wall, oneLumen);
    TissueModel tissue;
    tissue.meanHu = {-1000, -100, 40, 500};
    tissue.airBelowHu = -480, tissue.taggedAboveHu = 270;
    const ColonLabels laid =
        layLabels(scene.hu, tissue, scene.contents, scene.cut, scene.graph, scene.chain);
    int labelled = 0;
    for (int x = 10; x < 40; ++x) {
        for (int y = fluidTop - wall; y < fluidTop; ++y)
            labelled += laid.labels.at({x, y, 20}) != std::uint8_t(LumenLabel::outside);
    }
    return labelled;
}

TEST(ColonLabels, PartialVolumeBetweenGasAndItsFluidIsLumen) {
    EXPECT_EQ(labelledBetween(2, true), 30 * 2);
}

TEST(ColonLabels, AWallBetweenGasAndAnotherLoopsFluidStays) {
    EXPECT_EQ(labelledBetween(2, false), 0);
}

}  // namespace
