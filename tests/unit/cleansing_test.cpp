// What cleansing takes out, what it keeps and what it leaves alone.
#include "cleansing_scenes.h"

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

double distanceToSphere(glm::dvec3 p, glm::dvec3 center, double radius) {
    return radius - glm::distance(p, center);
}

TEST(Cleansing, ScanWithoutTaggingComesBackUnchanged) {
    Scene scene = tubeWithLevel(650.0, 15.0, -100.0);
    for (std::uint8_t& label : scene.labels.writable())
        label = label ? std::uint8_t(LumenLabel::air) : 0;
    const CleansedScene result = cleanseScene(scene);
    for (std::size_t n = 0; n < scene.scan.hu.voxels().size(); ++n) {
        ASSERT_EQ(result.cleansed.hu[n], scene.scan.hu[n]);
        ASSERT_EQ(result.cleansed.lumen[n], scene.labels[n]);
    }
}

TEST(Cleansing, VoxelsAwayFromTheTaggedLumenStayAsTheyWere) {
    // A second, opacified bowel lies across a wall of 3 mm and is not labelled.
    Scene scene = makeScene({70, 40, 20}, 600.0, 12.0, [](glm::dvec3 p) {
        const double colon = blurredStep(p.x - 8.0) * blurredStep(26.0 - p.x);
        const double other = blurredStep(p.x - 29.0);
        return Shares{0.0, colon + other};
    });
    const Grid& grid = scene.scan.hu.grid();
    const auto labels = scene.labels.writable();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))).x > 27.5) labels[n] = 0;
    }
    const CleansedScene result = cleanseScene(scene);
    int cleansed = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double x = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))).x;
        const bool changed = result.cleansed.hu[n] != scene.scan.hu[n];
        ASSERT_FALSE(changed && (x < 5.0 || x > 28.8)) << x;
        ASSERT_FALSE(x > 28.5 && result.cleansed.lumen[n] != 0) << x;
        cleansed += changed;
    }
    EXPECT_GT(cleansed, 10000);
}

// Gas, water that took no tagging, and tagged sediment, from above.
TEST(Cleansing, WaterBetweenGasAndSedimentLeavesNoFilm) {
    const auto lumen = [](glm::dvec3 p) {
        return blurredStep(p.x - 8.0) * blurredStep(36.0 - p.x) * blurredStep(30.0 - p.y);
    };
    Scene scene = makeScene({70, 50, 20}, 600.0, 12.0, [&](glm::dvec3 p) {
        return Shares{lumen(p) * blurredStep(12.0 - p.y), lumen(p) * blurredStep(p.y - 20.0)};
    });
    const Grid& grid = scene.scan.hu.grid();
    const auto inLumen = [](glm::dvec3 p, double mm) {
        return p.x > 8.0 + mm && p.x < 36.0 - mm && p.y < 30.0 - mm;
    };
    const auto labels = scene.labels.writable();
    const auto hu = scene.scan.hu.writable();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        hu[n] = std::int16_t(hu[n] - std::lround(35.0 * lumen(p) * blurredStep(p.y - 12.0) *
                                                 blurredStep(20.0 - p.y)));
        if (labels[n] == 0 && inLumen(p, 0.0)) labels[n] = std::uint8_t(LumenLabel::untagged);
    }
    const CleansedScene result = cleanseScene(scene);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (inLumen(p, 1.5)) {
            ASSERT_LT(result.cleansed.hu[n], scene.tissue.airBelowHu) << p.x << " " << p.y;
            ASSERT_NE(result.cleansed.lumen[n], 0)
                << p.x << " " << p.y << " " << p.z << " was " << int(scene.labels[n]);
        }
        if (!inLumen(p, -2.5)) {
            ASSERT_GT(result.cleansed.hu[n], scene.tissue.airBelowHu) << p.x << " " << p.y;
            ASSERT_EQ(result.cleansed.lumen[n], 0);
        }
    }
}

TEST(Cleansing, SubmergedPolypKeepsItsShapeAndHu) {
    // A polyp of 6 mm on the floor of a pool, wholly under fluid.
    const glm::dvec3 polyp(21.0, 27.0, 12.0);
    const Scene scene = makeScene({56, 56, 24}, 650.0, 15.0, [=](glm::dvec3 p) {
        const double open = blurredStep(29.0 - p.y);
        const double solid = blurredStep(distanceToSphere(p, polyp, 3.0));
        const double fluid = blurredStep(p.y - 12.0);
        const double lumen = open * (1.0 - solid);
        return Shares{lumen * (1.0 - fluid), lumen * fluid};
    });
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    int volume = 0, kept = 0, extra = 0, core = 0;
    double coreBias = 0.0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        const double inside = distanceToSphere(p, polyp, 3.0);
        if (inside < -1.5 || p.y > 27.5) continue;
        const bool was = scene.untagged[n] > -400, is = result.cleansed.hu[n] > -400;
        volume += was, kept += was && is, extra += is && !was;
        if (inside > 1.5) ++core, coreBias += result.cleansed.hu[n] - scene.untagged[n];
    }
    ASSERT_GT(volume, 80);
    EXPECT_GE(kept, 0.95 * volume);
    EXPECT_LE(extra, 0.05 * volume);
    EXPECT_NEAR(coreBias / core, 0.0, 10.0);
}

TEST(Cleansing, ThinFoldBetweenTwoFluidsIsKeptAsItWas) {
    // 1.2 mm thin: it never shows soft tissue's HU, before or after.
    const Scene scene = makeScene({56, 40, 24}, 600.0, 10.0, [](glm::dvec3 p) {
        const double fold = blurredStep(p.x - 20.4) - blurredStep(p.x - 21.6);
        return Shares{0.0, (1.0 - fold) * blurredStep(p.x - 5.0) * blurredStep(37.0 - p.x)};
    });
    const CleansedScene result = cleanseScene(scene);
    const auto near = [](Shares, glm::dvec3 p) { return std::abs(p.x - 21.0) < 2.3; };
    const ErrorStatistics error = errorWhere(scene, result.cleansed, near);
    EXPECT_NEAR(error.bias, 0.0, 25.0);
    EXPECT_LT(error.rmse, 4.5 * 10.0);
}

TEST(Cleansing, StoolInFluidLeavesNoRing) {
    const glm::dvec3 ball(21.0, 21.0, 12.0);
    Scene scene = makeScene({56, 56, 24}, 700.0, 12.0, [](glm::dvec3 p) {
        return Shares{0.0, blurredStep(p.x - 4.0) * blurredStep(38.0 - p.x)};
    });
    const Grid& grid = scene.scan.hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        const double stool = blurredStep(distanceToSphere(p, ball, 6.0));
        scene.scan.hu.writable()[n] -= std::int16_t(std::lround(stool * 280.0));
    }
    const CleansedScene result = cleanseScene(scene);
    const ErrorStatistics ring = errorWhere(scene, result.cleansed, [&](Shares, glm::dvec3 p) {
        return std::abs(distanceToSphere(p, ball, 6.0)) < 1.5;
    });
    EXPECT_NEAR(ring.bias, 0.0, 12.0);
    EXPECT_LT(ring.rmse, 30.0);
}

TEST(Cleansing, StoolInAirLeavesNoRing) {
    // Its flat top is no level, and no wall is needed to hold it.
    const glm::dvec3 ball(21.0, 21.0, 12.0);
    const Scene scene = makeScene({56, 56, 24}, 650.0, 12.0, [=](glm::dvec3 p) {
        const double stool = blurredStep(distanceToSphere(p, ball, 6.0));
        const double open = blurredStep(p.x - 5.0) * blurredStep(37.0 - p.x);
        return Shares{open * (1.0 - stool), open * stool};
    });
    const CleansedScene result = cleanseScene(scene);
    const ErrorStatistics ring = errorWhere(scene, result.cleansed, [&](Shares, glm::dvec3 p) {
        return std::abs(distanceToSphere(p, ball, 6.0)) < 1.5;
    });
    EXPECT_NEAR(ring.bias, 0.0, 10.0);
    EXPECT_LT(ring.rmse, 30.0);
}

TEST(Cleansing, WallGoesOnStraightPastALevel) {
    // A wall that leans 40° meets the level.
    const glm::dvec3 rim(21.0, 21.0, 0.0), inward(-0.766, 0.643, 0.0);
    const Scene scene = makeScene({56, 56, 24}, 650.0, 10.0, [=](glm::dvec3 p) {
        const double open =
            blurredStep(-glm::dot(p * glm::dvec3(1, 1, 0) - rim, inward)) * blurredStep(36.0 - p.x);
        const double fluid = blurredStep(p.y - 21.0);
        return Shares{open * (1.0 - fluid), open * fluid};
    });
    const CleansedScene result = cleanseScene(scene);
    const ErrorStatistics error = errorWhere(scene, result.cleansed, [&](Shares, glm::dvec3 p) {
        return std::abs(p.x - rim.x) < 2.0 && std::abs(p.y - rim.y) < 1.5;
    });
    ASSERT_GT(error.count, 100);
    EXPECT_NEAR(error.bias, 0.0, 30.0);
    EXPECT_LT(error.rmse, 70.0);
}

TEST(Cleansing, ThinWallBetweenAPoolAndAnotherLoopHasNoHoles) {
    // 0.6 mm thin, the other loop holds air: the blur takes both for one bare interface.
    const Scene scene = makeScene({56, 56, 24}, 650.0, 10.0, [](glm::dvec3 p) {
        const double pool = blurredStep(p.x - 6.0) * blurredStep(20.7 - p.x);
        const double other = blurredStep(p.x - 21.3) * blurredStep(36.0 - p.x);
        const double fluid = blurredStep(p.y - 10.0);
        return Shares{other + pool * (1.0 - fluid), pool * fluid};
    });
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    for (int k = 2; k + 2 < grid.size.z; ++k) {
        for (int j = 18; j + 2 < grid.size.y; ++j) {
            int most = -1024, truth = -1024;
            for (int i = 25; i < 32; ++i) {
                most = std::max<int>(most, result.cleansed.hu.at(i, j, k));
                truth = std::max<int>(truth, scene.untagged.at(i, j, k));
            }
            ASSERT_GT(most, truth - 150) << j << ' ' << k;
        }
    }
}

TEST(Cleansing, FilmThinnerThanTheBlurComesOffTheWall) {
    // On a floor that leans 12°; from 0.5 mm thick, where it is no denser than the wall, to 3 mm.
    const glm::dvec3 down(0.208, 0.978, 0.0), floor(21.0, 21.0, 0.0);
    const auto depth = [=](glm::dvec3 p) {
        return glm::dot(p * glm::dvec3(1, 1, 0) - floor, down);
    };
    const auto thickMm = [](glm::dvec3 p) {
        return std::clamp(0.5 + 0.07 * (p.x - 5.0), 0.5, 3.0);
    };
    const Scene scene = makeScene({56, 56, 24}, 650.0, 15.0, [=](glm::dvec3 p) {
        const double open = blurredStep(-depth(p)), air = blurredStep(-depth(p) - thickMm(p));
        return Shares{air, open - air};
    });
    const CleansedScene result = cleanseScene(scene);
    const auto beside = [=](Shares, glm::dvec3 p) {
        return depth(p) > -thickMm(p) - 1.5 && depth(p) < 1.5 && p.x > 10.0 && p.x < 30.0;
    };
    const ErrorStatistics error = errorWhere(scene, result.cleansed, beside);
    EXPECT_NEAR(error.bias, 0.0, 25.0);
    EXPECT_LT(error.rmse, 90.0);
}

TEST(Cleansing, SpecksInTheFluidAreGoneFoldsStay) {
    Scene scene = tubeWithLevel(220.0, 5.0);
    const Grid& grid = scene.scan.hu.grid();
    const glm::ivec3 speck(28, 36, 12);
    scene.scan.hu.writable()[grid.index(speck)] = 45;
    scene.labels.writable()[grid.index(speck)] = 0;
    const CleansedScene result = cleanseScene(scene);
    EXPECT_LT(result.cleansed.hu.at(speck), scene.tissue.airBelowHu);
    EXPECT_EQ(result.cleansed.lumen.at(speck), std::uint8_t(LumenLabel::tagged));
}

TEST(Cleansing, LumenIsWhereTheUntaggedTwinIsAir) {
    const Scene scene = tubeWithLevel(650.0, 15.0);
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    long both = 0, either = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const bool truth = scene.untagged[n] < scene.tissue.airBelowHu;
        const bool found = result.cleansed.lumen[n] != 0;
        both += truth && found, either += truth + found;
        if (LumenLabel(scene.labels[n]) == LumenLabel::tagged) {
            ASSERT_EQ(found, result.cleansed.hu[n] < scene.tissue.airBelowHu);
        }
    }
    EXPECT_GT(2.0 * double(both) / double(either), 0.99);
}

}  // namespace
