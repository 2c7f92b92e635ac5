// Laws of what can be added to a phantom's bowel, on small phantoms.
#include "label_topology.h"
#include "phantom/filled_colon.h"
#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

PhantomOptions small(std::uint64_t seed) {
    PhantomOptions options;
    options.seed = seed, options.size = Size::small;
    return options;
}

Phantom made(const PhantomOptions& options) {
    auto phantom = makePhantom(options);
    EXPECT_TRUE(phantom.has_value());
    return phantom ? std::move(*phantom) : Phantom{};
}

std::uint8_t valueAt(const Volume<std::uint8_t>& volume, glm::dvec3 p) {
    const glm::ivec3 v(glm::round(volume.grid().voxelFromPatientPoint(p)));
    return volume.grid().contains(v) ? volume.at(v) : 255;
}

/// 26-connected pieces of what `in` says, of at least `least` voxels.
template <class In>
std::size_t pieces(const Grid& grid, std::size_t least, const In& in) {
    const std::vector<std::size_t> sizes = tests::pieceSizes(grid, in);
    return std::size_t(
        std::count_if(sizes.begin(), sizes.end(), [&](std::size_t size) { return size >= least; }));
}

std::size_t countOf(const Volume<std::uint8_t>& volume, std::uint8_t value) {
    return std::size_t(std::count(volume.voxels().begin(), volume.voxels().end(), value));
}

constexpr auto site(Site s) {
    return std::uint8_t(s);
}

TEST(Ileum, JoinsTheCecumTouchesTheColonAndLeavesTheRestAsItWas) {
    PhantomOptions options = small(3);
    const Phantom without = made(options);
    options.bowel.ileumMm = 500.0, options.bowel.ileumCalibreMm = 22.0;
    const FilledColon colon = makeFilledColon(options);
    ASSERT_TRUE(colon.ileum.has_value());
    const Phantom phantom = made(options);
    const Structure& structure = phantom.structure;
    ASSERT_TRUE(structure.valve.has_value());
    EXPECT_GT(structure.ileumMm, 300.0);
    // The valve: on the cecum's wall, a hand's breadth or less from its end.
    EXPECT_NEAR(phantom.centerline.lengthMm() - structure.valve->arcMm, 62.5, 13.0);
    EXPECT_FALSE(structure.valve->open);
    // Long runs along the colon.
    double touching = 0.0;
    for (const Structure::Contact& contact : structure.contacts)
        touching += contact.ileum ? contact.areaMm2 : 0.0;
    EXPECT_GT(touching, 500.0);
    // Its calibre, from its volume and its length.
    const double bore = std::sqrt(4.0 * 1e3 * structure.ileumMl / structure.ileumMm / 3.14159);
    EXPECT_NEAR(bore, 21.0, 4.0);
    // Labels apart; one lumen, and the colon's as it was but for the valve's lips.
    const Grid& grid = phantom.lumen.grid();
    std::size_t moved = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (phantom.sites[n] == site(Site::ileum)) {
            ASSERT_EQ(phantom.lumen[n], 0);
        }
        if (phantom.lumen[n] == without.lumen[n]) continue;
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        ASSERT_LT(glm::distance(p, structure.valve->positionMm),
                  colon.shape.valve()->reachMm() + 2);
        ++moved;
    }
    EXPECT_GT(moved, 20u) << "the lips stand in the lumen";
    EXPECT_EQ(phantom.polypVoxels, without.polypVoxels);
}

TEST(Ileum, AWallOfTheStatedThicknessStaysBetweenItAndTheColon) {
    for (const double septumMm : {0.6, 2.0}) {
        PhantomOptions options = small(5);
        options.bowel.ileumMm = 400.0, options.bowel.septumMm = septumMm;
        const FilledColon colon = makeFilledColon(options);
        ASSERT_TRUE(colon.ileum.has_value());
        const ColonShape& shape = colon.shape;
        ColonShape::Nearby nearby;
        double least = 1e9;
        const auto& nodes = colon.ileum->tube().nodes();
        for (const Tube::Node& node : nodes) {
            shape.findNearby(node.position, 20.0, nearby);
            for (int n = 0; n < 4000; ++n) {
                // Points on a lattice about the node.
                const glm::dvec3 p =
                    node.position +
                    1.8 * glm::dvec3(n % 16 - 7.5, n / 16 % 16 - 7.5, n / 256 - 7.5);
                const double toColon = shape.evaluate(p, nearby).lumenMm;
                if (glm::distance(p, shape.valve()->at) < 20.0) continue;
                if (colon.ileum->lumenMm(p, toColon) < 0.0) least = std::min(least, toColon);
            }
        }
        EXPECT_GE(least, septumMm);
        EXPECT_LT(least, septumMm + 0.5) << "they touch somewhere";
    }
}

TEST(Valve, GasPassesItOnlyWhereItIsOpen) {
    for (const bool open : {false, true}) {
        PhantomOptions options = small(3);
        options.bowel.ileumMm = 300.0, options.bowel.valveOpen = open;
        options.bowel.septumMm = 2.5;
        const FilledColon colon = makeFilledColon(options);
        ASSERT_TRUE(colon.ileum.has_value());
        const Valve& valve = *colon.shape.valve();
        // Along the middle of the slit, from the ileum into the cecum.
        double most = -1e9;
        for (double height = -6.0; height <= 16.0; height += 0.25) {
            const glm::dvec3 p = valve.at + height * valve.inward;
            const double lumen = colon.shape.evaluate(p).lumenMm;
            most = std::max(most, std::min(lumen, colon.ileum->lumenMm(p, lumen)));
        }
        if (open) {
            EXPECT_LT(most, 0.0) << "a way through";
        } else {
            EXPECT_GT(most, 2.0) << "lips that meet";
        }
    }
}

TEST(Septum, ThinnerWallsJoinNoLoops) {
    PhantomOptions options = small(2);
    options.bowel.septumMm = 0.6;
    const Phantom thin = made(options);
    double least = 1e9;
    for (const auto& contact : thin.structure.contacts)
        least = std::min(least, contact.leastMm);
    EXPECT_LT(least, 1.5);
    // Colon voxels of two loops are never neighbours, so the lumen has one piece and no way from
    // one loop to the other but along the colon.
    const ColonField field = makeFilledColon(options).field;
    const Grid& grid = thin.lumen.grid();
    std::size_t shortcuts = 0;
    for (int k = 0; k + 1 < grid.size.z; ++k) {
        for (int j = 1; j + 1 < grid.size.y; ++j) {
            for (int i = 1; i + 1 < grid.size.x; ++i) {
                if (!thin.lumen.at(i, j, k)) continue;
                for (int n = 14; n < 27; ++n) {
                    const glm::ivec3 w(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1);
                    if (!grid.contains(w) || !thin.lumen.at(w)) continue;
                    shortcuts +=
                        std::abs(field.at(i, j, k).arcMm - field.at(w.x, w.y, w.z).arcMm) > 130.0f;
                }
            }
        }
    }
    EXPECT_EQ(shortcuts, 0u);
}

TEST(Collapse, ClosesTheLumenOverTheStatedLengths) {
    PhantomOptions options = small(6);
    options.bowel.collapsesMm = {5.0, 20.0, 60.0};
    const Phantom phantom = made(options);
    auto collapses = phantom.structure.collapses;
    ASSERT_EQ(collapses.size(), 3u);
    std::sort(collapses.begin(), collapses.end(),
              [](const auto& a, const auto& b) { return a.lengthMm() < b.lengthMm(); });
    EXPECT_NEAR(collapses[0].lengthMm(), 5.0, 4.0);
    EXPECT_NEAR(collapses[1].lengthMm(), 20.0, 6.0);
    EXPECT_NEAR(collapses[2].lengthMm(), 60.0, 8.0);
    for (const auto& collapse : collapses) {
        const glm::dvec3 middle = 0.5 * (collapse.beginAtMm + collapse.endAtMm);
        if (collapse.lengthMm() < 30.0) {
            EXPECT_EQ(valueAt(phantom.sites, middle), site(Site::colonWall));
        }
    }
    EXPECT_EQ(pieces(phantom.lumen.grid(), 200, [&](std::size_t n) { return phantom.lumen[n]; }),
              4u);
}

TEST(RedundantSigmoid, IsLonger) {
    const PhantomOptions options = small(2);
    BowelOptions bowel;
    bowel.redundantSigmoidMm = 150.0;
    const BodyPlan body = bodyOf(options);
    const ColonPath plain = makeColonPath(2, Preset::standard, body),
                    longer = makeColonPath(2, Preset::standard, body, bowel);
    EXPECT_GT(longer.lengthMm(), plain.lengthMm() + 70.0);
    EXPECT_GT(longer.sigmoidEndMm - longer.rectumEndMm,
              plain.sigmoidEndMm - plain.rectumEndMm + 60.0);
}

TEST(Fluid, WithoutTaggingIsWaterThatCleansingCannotTake) {
    PhantomOptions options = small(4);
    options.bowel.untagged = 1.0;
    const Phantom water = made(options);
    EXPECT_GT(water.structure.untaggedMl, 20.0);
    options.bowel.untagged = 0.0, options.bowel.layered = 1.0;
    const Phantom layered = made(options);
    EXPECT_GT(layered.structure.untaggedMl, 10.0);
    EXPECT_GT(layered.structure.taggedMl, 10.0);
    // The lumen is the same whatever it holds.
    for (std::size_t n = 0; n < water.lumen.grid().voxelCount(); ++n)
        ASSERT_EQ(!water.lumen[n], !layered.lumen[n]);
    // Water stands above the sediment, never below (stool balls rest anywhere).
    const Grid& grid = layered.lumen.grid();
    std::size_t above = 0, below = 0;
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j + 1 < grid.size.y; ++j) {
            for (int i = 0; i < grid.size.x; ++i) {
                const bool here = layered.sites.at(i, j, k) == site(Site::untaggedFluid),
                           under = layered.sites.at(i, j + 1, k) == site(Site::untaggedFluid);
                if (layered.lumen.at(i, j, k) != 2 || layered.lumen.at(i, j + 1, k) != 2) continue;
                above += here && !under, below += !here && under;
            }
        }
    }
    EXPECT_GT(double(above), 5.0 * double(below));
}

TEST(Fluid, FullSectionsReachTheRoof) {
    // Sections of the axis where no gas is left.
    const auto fullMm = [](const Phantom& phantom) {
        std::size_t full = 0;
        const Grid& grid = phantom.lumen.grid();
        for (const CenterlinePoint& point : phantom.centerline.points) {
            if (point.gap) continue;
            // Straight up from the axis, to the wall.
            glm::ivec3 v(glm::round(grid.voxelFromPatientPoint(point.positionMm)));
            bool gas = false;
            for (; v.y >= 0 && phantom.lumen.at(v); --v.y)
                gas = gas || phantom.lumen.at(v) == 1;
            full += !gas;
        }
        return full;
    };
    PhantomOptions options = small(4);
    options.bowel.full = 1.0;
    EXPECT_GT(fullMm(made(options)), 60u);
}

TEST(Diverticula, ArePouchesOfTheLumenThatJoinNothingElse) {
    PhantomOptions options = small(2);
    const FilledColon without = makeFilledColon(options);
    options.bowel.diverticula = 60;
    const FilledColon with = makeFilledColon(options);
    ASSERT_GT(with.shape.diverticula().size(), 40u);
    const double sigmoidEnd = with.shape.path().sigmoidEndMm;
    std::size_t sigmoid = 0;
    for (const Diverticulum& pouch : with.shape.diverticula()) {
        EXPECT_GE(pouch.sacRadiusMm, 2.0);
        EXPECT_LE(pouch.sacRadiusMm, 4.5);
        const ColonPoint inside = with.shape.evaluate(pouch.center);
        EXPECT_LT(inside.lumenMm, 0.0);
        EXPECT_GT(without.shape.evaluate(pouch.center).lumenMm, 0.0) << "outside the bare lumen";
        EXPECT_LT(with.shape.evaluate(0.5 * (pouch.mouth + pouch.center)).lumenMm, 0.3);
        EXPECT_GT(inside.arcMm, with.shape.path().rectumEndMm);
        sigmoid += inside.arcMm < sigmoidEnd;
    }
    EXPECT_GT(2 * sigmoid, with.shape.diverticula().size());
    // The same patient otherwise: growths and pools.
    ASSERT_EQ(with.shape.growths().size(), without.shape.growths().size());
    for (std::size_t n = 0; n < with.shape.growths().size(); ++n)
        EXPECT_EQ(with.shape.growths()[n].center, without.shape.growths()[n].center);
    for (std::size_t n = 0; n < with.fluid.pools.size(); ++n)
        EXPECT_EQ(with.fluid.pools[n].levelMm, without.fluid.pools[n].levelMm);
}

TEST(Insufflation, WithoutItTheColonIsNearlyEmpty) {
    PhantomOptions options = small(7);
    options.bowel.insufflated = false;
    const Phantom without = made(options);
    EXPECT_LT(without.structure.airMl, 300.0) << "litres, when insufflated";
    EXPECT_EQ(without.structure.taggedMl > 20.0, false) << "nobody drank a tagging agent";
    double closed = 0.0;
    for (const auto& collapse : without.structure.collapses)
        closed += collapse.lengthMm();
    EXPECT_GT(closed, 0.4 * without.centerline.lengthMm());
}

TEST(RectalTubeOption, LeavesTheLumenAsItIsAndSaysWhereTheDeviceLies) {
    PhantomOptions options = small(8);
    const Phantom without = made(options);
    options.bowel.rectalTube = true;
    const Phantom with = made(options);
    const Grid& grid = with.lumen.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        ASSERT_EQ(!with.lumen[n], !without.lumen[n]);
    const double ml =
        double(countOf(with.sites, site(Site::device))) * grid.voxelVolumeMm3() * 1e-3;
    EXPECT_GT(ml, 8.0);
    EXPECT_LT(ml, 40.0);
    // Gas in the balloon, whatever else.
    std::size_t gas = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        gas += with.sites[n] == site(Site::device) && with.scan.hu[n] < -700;
    EXPECT_GT(double(gas) * grid.voxelVolumeMm3() * 1e-3, 4.0);
}

TEST(MetalHip, IsMetalInOneHipAndLeavesTheLumenAsItIs) {
    PhantomOptions options = small(9);
    const Phantom without = made(options);
    options.scan.metalHip = true, options.scan.streakHu = 20.0;
    const Phantom with = made(options);
    const Grid& grid = with.lumen.grid();
    std::size_t left = 0, right = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        ASSERT_EQ(with.lumen[n], without.lumen[n]);
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (with.scan.hu[n] < 3000) continue;
        (p.x < 0.0 ? left : right) += 1;
        EXPECT_LT(glm::distance(glm::dvec2(std::abs(p.x), p.y), glm::dvec2(105.0, 8.0)), 45.0);
    }
    EXPECT_EQ(std::min(left, right), 0u) << "one side";
    EXPECT_GT(double(left + right) * grid.voxelVolumeMm3() * 1e-3, 15.0);
    // The tagged and the untagged scan have the same streaks (but for the rounding to whole HU),
    // as far as HU are not cut off.
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (without.scan.hu[n] == without.untaggedHu[n] && without.scan.hu[n] > -1000) {
            ASSERT_LE(std::abs(with.scan.hu[n] - with.untaggedHu[n]), 1);
        }
    }
}

TEST(PhotonCountingSize, IsTheGridOfSuchAScanner) {
    const Grid grid = gridOf(Size::photonCounting);
    EXPECT_EQ(grid.size, glm::ivec3(1024, 1024, 1000));
    EXPECT_EQ(grid.spacingMm(), glm::dvec3(0.35, 0.35, 0.4));
}

TEST(Wild, IsOnePatientInEveryPositionAndDiffersBySeed) {
    bool open = false, closed = false, thin = false, pouches = false, collapses = false;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        const PhantomOptions a = wildOptions(seed), b = wildOptions(seed);
        EXPECT_EQ(a.bowel.ileumMm, b.bowel.ileumMm);
        EXPECT_EQ(a.bowel.collapsesMm, b.bowel.collapsesMm);
        EXPECT_EQ(a.seed, seed);
        open = open || a.bowel.valveOpen, closed = closed || !a.bowel.valveOpen;
        thin = thin || a.bowel.septumMm < 1.0, pouches = pouches || a.bowel.diverticula > 0;
        collapses = collapses || !a.bowel.collapsesMm.empty();
    }
    EXPECT_TRUE(open && closed && thin && pouches && collapses);
    PhantomOptions options = wildOptions(2);
    options.size = Size::small;
    EXPECT_TRUE(makePhantom(options).has_value());
}

TEST(PhantomOptionsCheck, RefusesWhatNoBowelIs) {
    const auto refused = [](const auto& change) {
        PhantomOptions options = small(1);
        change(options.bowel);
        const auto phantom = makePhantom(options);
        return !phantom && phantom.error().kind == ErrorKind::badInput;
    };
    EXPECT_TRUE(refused([](BowelOptions& b) { b.ileumCalibreMm = 40.0; }));
    EXPECT_TRUE(refused([](BowelOptions& b) { b.ileumMm = -1.0; }));
    EXPECT_TRUE(refused([](BowelOptions& b) { b.septumMm = 0.1; }));
    EXPECT_TRUE(refused([](BowelOptions& b) { b.collapsesMm = {80.0}; }));
    EXPECT_TRUE(refused([](BowelOptions& b) { b.untagged = 1.5; }));
    EXPECT_TRUE(refused([](BowelOptions& b) { b.diverticula = -1; }));
}

}  // namespace
