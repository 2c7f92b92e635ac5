// What beam hardening and scatter add beside tagging is found and taken out.
#include "cleansing/pseudo_enhancement.h"
#include "cleansing_scenes.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

/// Two tubes side by side, one half full.
Scene twoTubes(int slices = 20, double taggedHu = 650.0) {
    return makeScene({112, 56, slices}, taggedHu, 14.0, [](glm::dvec3 p) {
        const auto inside = [&](double x) {
            return blurredStep(12.0 - glm::length(glm::dvec2(p) - glm::dvec2(x, 20.6)));
        };
        const double fluid = blurredStep(p.y - 20.6) * inside(20.7), open = inside(20.7) - fluid;
        return Shares{open + inside(62.0), fluid};
    });
}

/// Adds to the scan what its tagging spreads over `widthMm` within each slice, to tissue outside
/// the lumen `tissueShare` of it.
void enhance(Scene& scene, double edgeHu, double widthMm, double tissueShare = 1.0) {
    const Grid& grid = scene.scan.hu.grid();
    const double sigma = widthMm / 2.3548 / grid.spacingMm().x;
    const int reach = int(3.0 * sigma), nx = grid.size.x, ny = grid.size.y;
    std::vector<double> w;
    double sum = 0.0;
    for (int n = -reach; n <= reach; ++n)
        w.push_back(std::exp(-0.5 * n * n / (sigma * sigma))), sum += w.back();
    const auto out = scene.scan.hu.writable();
    for (int k = 0; k < grid.size.z; ++k) {
        std::vector<double> excess(std::size_t(nx * ny)), rows(excess.size());
        for (int n = 0; n < nx * ny; ++n) {
            const std::size_t at = grid.index(n % nx, n / nx, k);
            excess[std::size_t(n)] = out[at] - scene.untagged[at];
        }
        for (int n = 0; n < nx * ny; ++n) {
            for (int r = -reach; r <= reach; ++r) {
                if (n % nx + r >= 0 && n % nx + r < nx)
                    rows[std::size_t(n)] +=
                        w[std::size_t(r + reach)] / sum * excess[std::size_t(n + r)];
            }
        }
        for (int n = 0; n < nx * ny; ++n) {
            double spread = 0.0;
            for (int r = -reach; r <= reach; ++r) {
                if (n / nx + r >= 0 && n / nx + r < ny)
                    spread += w[std::size_t(r + reach)] / sum * rows[std::size_t(n + r * nx)];
            }
            const std::size_t at = grid.index(n % nx, n / nx, k);
            const bool outside = LumenLabel(scene.labels[at]) == LumenLabel::outside;
            out[at] +=
                std::int16_t(std::lround((outside ? tissueShare : 1.0) * edgeHu / 750.0 * spread));
        }
    }
}

TEST(PseudoEnhancement, IsFoundAsStrongAndAsWideAsItIs) {
    for (const double widthMm : {8.0, 16.0, 24.0}) {
        Scene scene = twoTubes();
        enhance(scene, 50.0, widthMm);
        const auto found =
            cleansing::measurePseudoEnhancement(scene.scan, scene.tissue, scene.labels, 2);
        ASSERT_TRUE(found);
        EXPECT_EQ(found.widthMm, widthMm);
        EXPECT_NEAR(found.edgeHu(), 50.0, 6.0);
    }
}

TEST(PseudoEnhancement, NoneIsFoundWhereThereIsNone) {
    const Scene scene = twoTubes();
    EXPECT_FALSE(cleansing::measurePseudoEnhancement(scene.scan, scene.tissue, scene.labels, 2));
}

TEST(PseudoEnhancement, FluidAndWallComeBackAsWithoutIt) {
    Scene scene = twoTubes();
    enhance(scene, 50.0, 16.0);
    const CleansedScene result = cleanseScene(scene), same = cleanseScene(scene, 3);
    EXPECT_TRUE(std::ranges::equal(result.cleansed.hu.voxels(), same.cleansed.hu.voxels()));
    const auto fluid =
        errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3) { return s.tagged > 0.999; });
    EXPECT_NEAR(fluid.bias, 0.0, 4.0);
    const auto wall = errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3 p) {
        return s.soft() > 0.999 && std::abs(p.x - 20.7) < 5.0 && p.y > 32.6 && p.y < 38.0;
    });
    EXPECT_NEAR(wall.bias, 0.0, 4.0);
}

// The gas of a real scan gained three times what the wall beside its pools did.
TEST(PseudoEnhancement, NoMoreIsTakenOffThanTheWallHasGained) {
    for (const double share : {0.0, 0.4, 1.0}) {
        Scene scene = twoTubes(84);
        enhance(scene, 90.0, 16.0, share);
        const auto found =
            cleansing::measurePseudoEnhancement(scene.scan, scene.tissue, scene.labels, 2);
        EXPECT_NEAR(found.edgeHu(), 90.0 * share, 8.0) << share;
        const CleansedScene result = cleanseScene(scene);
        const auto wall = errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3 p) {
            return s.soft() > 0.999 && std::abs(p.x - 20.7) < 5.0 && p.y > 32.6 && p.y < 38.0;
        });
        EXPECT_NEAR(wall.bias, 0.0, 6.0) << share;
    }
}

// Around a part of the pool lies other tissue, which makes the wall's slope less than it is.
TEST(PseudoEnhancement, OtherTissueBesideAPartOfThePoolIsNoSign) {
    Scene scene = twoTubes(84);
    enhance(scene, 50.0, 16.0);
    const Grid& grid = scene.scan.hu.grid();
    const auto hu = scene.scan.hu.writable();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const bool outside = LumenLabel(scene.labels[n]) == LumenLabel::outside;
        if (outside && v.z < 20 && grid.patientFromVoxelPoint(v).x < 41.0) hu[n] -= 60;
    }
    const auto found =
        cleansing::measurePseudoEnhancement(scene.scan, scene.tissue, scene.labels, 2);
    EXPECT_NEAR(found.edgeHu(), 50.0, 6.0);
}

// Water hardens no beam that the scanner has not reckoned with: what contents gain is a part of
// what they are denser by. Else weak tagging is taken off until it is as dark as a wall.
TEST(PseudoEnhancement, ContentsGainNoMoreThanAPartOfTheirOwnContrast) {
    for (const double taggedHu : {150.0, 200.0, 300.0}) {
        Scene scene = twoTubes(84, taggedHu);
        enhance(scene, 90.0, 16.0);
        const auto found =
            cleansing::measurePseudoEnhancement(scene.scan, scene.tissue, scene.labels, 2);
        const double gainedAtMost = 90.0 * (taggedHu - sceneAirHu) / 750.0,
                     seenHu = taggedHu + gainedAtMost;
        EXPECT_LE(found.gain * (seenHu - sceneAirHu), (seenHu - sceneSoftHu) / 3.0 + 1.0);
        const CleansedScene result = cleanseScene(scene);
        long both = 0, either = 0;
        for (std::size_t n = 0; n < scene.labels.voxels().size(); ++n) {
            const bool was = scene.labels[n] != 0, is = result.cleansed.lumen[n] != 0;
            both += was && is, either += was + is;
        }
        EXPECT_GT(2.0 * double(both) / double(either), 0.97) << taggedHu;
    }
}

}  // namespace
