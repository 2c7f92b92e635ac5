// The parts of the phantom by themselves: the colon's axis, its surface, fluid, the scanner.
#include "phantom/colon_field.h"
#include "phantom/colon_skeleton.h"
#include "phantom/filled_colon.h"
#include "phantom/growths.h"
#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/scanner.h"
#include "phantom/wall_place.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

TEST(ColonPath, LengthFramesAndRoomForManySeeds) {
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        SCOPED_TRACE(seed);
        const BodyPlan body;
        const ColonPath path = makeColonPath(seed, Preset(seed % 3), body);
        EXPECT_GE(path.lengthMm(), 1200.0);
        EXPECT_LE(path.lengthMm(), 1700.0);
        const auto& s = path.samples;
        // Rectum low in the midline, splenic flexure on the left, cecum low on the right.
        EXPECT_LT(std::abs(s.front().position.x), 10.0);
        EXPECT_LT(s.front().position.z, 50.0);
        EXPECT_GT(path.at(path.descendingEndMm).position.x, 50.0);
        EXPECT_GT(path.at(path.descendingEndMm).position.z, 290.0);
        EXPECT_LT(s.back().position.x, -20.0);
        EXPECT_LT(s.back().position.z, 190.0);
        for (std::size_t n = 0; n + 1 < s.size(); ++n) {
            EXPECT_NEAR(glm::distance(s[n].position, s[n + 1].position), path.stepMm, 0.06);
            EXPECT_NEAR(glm::dot(s[n].normal, s[n].tangent), 0.0, 1e-9);
            EXPECT_NEAR(glm::length(s[n].normal), 1.0, 1e-9);
            EXPECT_NEAR(glm::dot(s[n].binormal, glm::cross(s[n].tangent, s[n].normal)), 1.0, 1e-9);
            EXPECT_LT(body.skin(s[n].position), -s[n].radiusMm);
        }
        // No loop runs through another: the axes keep at least two thirds of the two radii.
        for (std::size_t a = 0; a < s.size(); a += 3) {
            for (std::size_t b = a; b < s.size(); b += 3) {
                const double arc = path.stepMm * double(b - a);
                if (arc < loopSeparationMm(s[a].radiusMm, s[b].radiusMm)) continue;
                const double room = std::max(0.0, s[a].radiusMm) + std::max(0.0, s[b].radiusMm);
                EXPECT_GT(glm::distance(s[a].position, s[b].position), 0.667 * room)
                    << a << " " << b;
            }
        }
    }
}

// Tissue fills the edge between a lesion's side and the wall, and is nowhere else.
TEST(Growth, AGentlerFootOnlyAddsTissueAroundIt) {
    const ColonShape bare(makeColonPath(5, Preset::standard, BodyPlan{}), 5);
    std::optional<WallPlace> place;
    for (double arc = 300.0; !place; arc += 5.0) {
        place = castToWall(bare, arc, 1.0);
        if (place && place->radiusMm < 16.0) place.reset();
    }
    Growth growth;
    growth.kind = Growth::Kind::flat;
    growth.inward = place->inward, growth.tangent = place->tangent;
    growth.center = growth.root = place->at;
    growth.semiAxes = {6.0, 5.0, 2.0};
    ColonShape sharp = bare, gentle = bare;
    sharp.add(growth);
    growth.footMm = 3.0;
    gentle.add(growth);
    double most = 0.0;
    for (double x = -14.0; x <= 14.0; x += 0.5) {
        for (double z = -1.0; z <= 4.0; z += 0.5) {
            const glm::dvec3 p = place->at + x * place->tangent + z * place->inward;
            const double more = gentle.evaluate(p).lumenMm - sharp.evaluate(p).lumenMm;
            EXPECT_GE(more, -1e-9);
            most = std::max(most, more);
            if (glm::distance(p, growth.center) > growth.reachMm()) {
                EXPECT_EQ(gentle.evaluate(p).lumenMm, bare.evaluate(p).lumenMm);
            }
        }
    }
    // A polynomial fillet over k adds k/4 where both surfaces are equally near.
    EXPECT_NEAR(most, 0.25 * (3.0 - 0.8), 0.1);
}

TEST(ColonPath, AnotherSeedIsAnotherPatient) {
    const ColonPath a = makeColonPath(1, Preset::standard, BodyPlan{}),
                    b = makeColonPath(2, Preset::standard, BodyPlan{});
    double apart = 0.0;
    for (double share = 0.1; share < 1.0; share += 0.05) {
        apart = std::max(apart, glm::distance(a.at(share * a.lengthMm()).position,
                                              b.at(share * b.lengthMm()).position));
    }
    EXPECT_GT(apart, 15.0);
}

TEST(ColonShape, LoopsTouchButNeverMerge) {
    const Grid grid = axisAlignedGrid({256, 256, 200}, {1.5, 1.5, 2.1}, {-191.25, -191.25, 1.05});
    std::size_t touching = 0;
    for (std::uint64_t seed : {1, 2, 7}) {
        ColonShape shape(makeColonPath(seed, Preset::standard, BodyPlan{}), seed);
        const ColonField field(shape, grid, 0);
        std::size_t merged = 0;
        auto otherLoop = [](const ColonField::Sample& a, const ColonField::Sample& b) {
            return a.lumenMm < 0 && b.lumenMm < 0 && std::abs(a.arcMm - b.arcMm) > 130.0f;
        };
        for (int k = 0; k + 3 < grid.size.z; ++k) {
            for (int j = 3; j + 3 < grid.size.y; ++j) {
                for (int i = 3; i + 3 < grid.size.x; ++i) {
                    const auto& here = field.at(i, j, k);
                    if (here.lumenMm >= 0) continue;
                    for (int n = 0; n < 14; ++n) {  // half of the 26 neighbours
                        const int m = 13 + n;
                        merged +=
                            m != 13 && otherLoop(here, field.at(i + m % 3 - 1, j + m / 3 % 3 - 1,
                                                                k + m / 9 - 1));
                    }
                    touching += otherLoop(here, field.at(i + 3, j, k)) ||
                                otherLoop(here, field.at(i, j + 3, k));
                }
            }
        }
        EXPECT_EQ(merged, 0u) << "seed " << seed;
    }
    EXPECT_GT(touching, 100u);  // lumens at most 4.5 mm apart
}

TEST(ColonShape, BlocksAndSinglePointsAgree) {
    const Grid grid = axisAlignedGrid({256, 256, 200}, {1.5, 1.5, 2.1}, {-191.25, -191.25, 1.05});
    ColonShape shape(makeColonPath(5, Preset::hard, BodyPlan{}), 5);
    addGrowths(shape, 5, Preset::hard, BodyPlan{});
    const ColonField field(shape, grid, 2);
    Random random(9, 9);
    int compared = 0;
    for (int n = 0; n < 3000; ++n) {
        const glm::ivec3 v{random.index(256), random.index(256), random.index(200)};
        const auto& sample = field.at(v.x, v.y, v.z);
        const ColonPoint point = shape.evaluate(grid.patientFromVoxelPoint(v));
        if (point.outerMm > ColonShape::reachMm) continue;
        ++compared;
        EXPECT_NEAR(std::max(-2.5, double(sample.lumenMm)), std::max(-2.5, point.lumenMm), 1e-3);
        EXPECT_NEAR(sample.outerMm, point.outerMm, 1e-3);
    }
    EXPECT_GT(compared, 100);
}

TEST(Pool, TheMeniscusClimbsTheWallAndLeavesTheMiddleLevel) {
    Pool pool;
    pool.levelMm = -20.0, pool.riseMm = 1.2;
    EXPECT_DOUBLE_EQ(pool.levelAt(0.0), -18.8);
    EXPECT_DOUBLE_EQ(pool.levelAt(0.4), -18.8) << "partial volume of the wall";
    EXPECT_LT(pool.levelAt(-2.0), pool.levelAt(-1.0));
    EXPECT_NEAR(pool.levelAt(-15.0), -20.0, 0.01);
}

TEST(FilledColon, PoolsHaveMenisciAndTheFieldKnowsTheSubmergedPolyps) {
    PhantomOptions options;
    options.size = Size::small;
    const FilledColon colon = makeFilledColon(options);
    for (const Pool& pool : colon.fluid.pools) {
        EXPECT_GE(pool.riseMm, 0.4);
        EXPECT_LE(pool.riseMm, 1.6);
    }
    const ColonField anew(colon.shape, colon.field.grid(), 2);
    std::size_t different = 0;
    const glm::ivec3 size = anew.grid().size;
    for (int k = 0; k < size.z; ++k) {
        for (int j = 0; j < size.y; ++j) {
            for (int i = 0; i < size.x; ++i)
                different += anew.at(i, j, k).lumenMm != colon.field.at(i, j, k).lumenMm;
        }
    }
    EXPECT_EQ(different, 0u);
}

TEST(Scanner, BlurHasTheGivenWidthAndKeepsTheSum) {
    const Grid grid = axisAlignedGrid({41, 41, 41}, {0.5, 0.5, 0.5});
    Volume<float> volume(grid, 0.0f);
    volume.writable()[grid.index(20, 20, 20)] = 1000.0f;
    blur(volume, {2.0, 2.0, 3.0}, 2);
    double sum = 0.0;
    for (float v : volume.voxels())
        sum += v;
    EXPECT_NEAR(sum, 1000.0, 0.1);
    // Half the height at half the full width.
    const double top = volume.at(20, 20, 20);
    EXPECT_NEAR(volume.at(22, 20, 20) / top, 0.5, 0.01);
    EXPECT_NEAR(volume.at(20, 22, 20) / top, 0.5, 0.01);
    EXPECT_NEAR(volume.at(20, 20, 23) / top, 0.5, 0.01);
}

TEST(Scanner, ASharpKernelOvershootsAtAnEdgeAndKeepsWhatIsFlat) {
    const Grid grid = axisAlignedGrid({81, 41, 9}, {0.5, 0.5, 1.0});
    const auto edge = [&] {
        Volume<float> volume(grid, -1000.0f);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (grid.voxelAt(n).x >= 40) volume.writable()[n] = 40.0f;
        }
        return volume;
    };
    Volume<float> soft = edge(), sharp = edge();
    reconstruct(soft, {1.2, 1.2, 1.0}, 0.0, 2);
    reconstruct(sharp, {1.2, 1.2, 1.0}, 0.5, 2);
    const auto highest = [](const Volume<float>& v) {
        return *std::max_element(v.voxels().begin(), v.voxels().end());
    };
    EXPECT_NEAR(highest(soft), 40.0, 0.1);
    EXPECT_GT(highest(sharp), 40.0 + 0.03 * 1040.0);
    EXPECT_LT(highest(sharp), 40.0 + 0.2 * 1040.0);
    EXPECT_NEAR(sharp.at(5, 20, 4), -1000.0, 0.1);
    EXPECT_NEAR(sharp.at(75, 20, 4), 40.0, 0.1);
}

TEST(Scanner, PseudoEnhancementHasItsHeightAtAFlatEdgeAndFallsOff) {
    const Grid grid = axisAlignedGrid({160, 120, 3}, {0.5, 0.5, 1.0});
    const Volume<float> untagged(grid, -1000.0f);
    Volume<float> tagged = untagged.clone();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (grid.voxelAt(n).x >= 80) tagged.writable()[n] = 500.0f;
    }
    enhanceBesideTagging(tagged, untagged, 40.0, 2);
    EXPECT_NEAR(tagged.at(79, 60, 1) + 1000.0, 40.0, 3.0);
    EXPECT_LT(tagged.at(63, 60, 1) + 1000.0, 15.0) << "8 mm away";
    EXPECT_NEAR(tagged.at(5, 60, 1), -1000.0, 0.1);
}

TEST(Scanner, NoiseHasItsStandardDeviationAndIsCorrelated) {
    const Grid grid = axisAlignedGrid({128, 128, 24}, {0.75, 0.75, 1.0});
    const Volume<float> flat(grid, 40.0f), other(grid, -90.0f);
    const Noise noise{7, 20.0, 1.1};
    const auto a = addNoise(flat, noise, 1), b = addNoise(other, noise, 3);
    double sum = 0, squares = 0, beside = 0;
    std::size_t count = 0;
    for (int k = 0; k < 24; ++k) {
        for (int j = 0; j < 128; ++j) {
            for (int i = 0; i + 1 < 128; ++i) {
                const double x = a.at(i, j, k) - 40.0, y = a.at(i + 1, j, k) - 40.0;
                sum += x, squares += x * x, beside += x * y, ++count;
                ASSERT_EQ(a.at(i, j, k) - 40, b.at(i, j, k) + 90) << "one seed is one noise";
            }
        }
    }
    EXPECT_NEAR(sum / double(count), 0.0, 0.3);
    EXPECT_NEAR(std::sqrt(squares / double(count)), 20.0, 0.8);
    EXPECT_GT(beside / squares, 0.2);
}

TEST(Scanner, ClampsToTwelveBits) {
    const Grid grid = axisAlignedGrid({16, 16, 4}, {1, 1, 1});
    const auto low = addNoise(Volume<float>(grid, -1500.0f), {}, 1),
               high = addNoise(Volume<float>(grid, 5000.0f), {}, 1);
    for (std::int16_t v : low.voxels())
        EXPECT_EQ(v, -1024);
    for (std::int16_t v : high.voxels())
        EXPECT_EQ(v, 3071);
}

TEST(Implicit, EllipsoidIsExactForASphereAndSmoothMaxMeetsMax) {
    EXPECT_NEAR(ellipsoid({4, 0, 3}, {0, 0, 0}, {2, 2, 2}), 3.0, 1e-12);
    EXPECT_NEAR(ellipsoid({0.5, 0, 0}, {0, 0, 0}, {2, 2, 2}), -1.5, 1e-12);
    EXPECT_EQ(smoothMax(3.0, 1.0, 2.0), 3.0);
    EXPECT_GT(smoothMax(1.0, 1.0, 2.0), 1.0);
}

TEST(ValueNoise, IsSmoothBoundedAndSeeded) {
    Random random(3, 3);
    double most = 0.0;
    for (int n = 0; n < 2000; ++n) {
        const glm::dvec3 p = 60.0 * random.normal3();
        const double v = valueNoise(11, p, 8.0);
        EXPECT_LE(std::abs(v), 1.0);
        EXPECT_LT(std::abs(valueNoise(11, p + glm::dvec3(1e-4), 8.0) - v), 1e-3);
        most = std::max(most, std::abs(v - valueNoise(12, p, 8.0)));
    }
    EXPECT_GT(most, 0.5);
}

}  // namespace
