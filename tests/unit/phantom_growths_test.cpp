// What grows on a phantom's wall: polyps dense and plain, what resembles them, and their truth.
#include "core/voxel_sweep.h"
#include "phantom/film.h"
#include "phantom/growth_truth.h"
#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

phantom::PhantomOptions grown() {
    phantom::PhantomOptions options;
    options.size = phantom::Size::small;
    options.seed = 5;
    options.preset = phantom::Preset::easy;  // little noise
    options.growths = {0.5, 8, 5};
    return options;
}

const phantom::Phantom& grownPhantom() {
    static const phantom::Phantom made = phantom::makePhantom(grown()).value();
    return made;
}

TEST(PhantomGrowths, OptionsAddAndLeaveTheRestOfThePatient) {
    phantom::PhantomOptions plain = grown();
    plain.growths = {};
    const phantom::Phantom bare = phantom::makePhantom(plain).value();
    const phantom::Phantom& more = grownPhantom();
    EXPECT_EQ(bare.centerline.points.size(), more.centerline.points.size());
    EXPECT_GT(more.growths.size(), bare.growths.size() + 8);
    // Those that the preset puts there first are where they were; only their inside may be plain.
    std::size_t same = 0;
    for (const phantom::GrowthTruth& growth : bare.growths)
        same += std::any_of(more.growths.begin(), more.growths.end(), [&](const auto& other) {
            return other.positionMm == growth.positionMm && other.kind == growth.kind &&
                   other.diameterMm == growth.diameterMm;
        });
    EXPECT_GE(same + 2, bare.growths.size()) << "but for submerged ones, which look for room";
    EXPECT_TRUE(std::none_of(bare.growths.begin(), bare.growths.end(),
                             [](const auto& g) { return g.neoplastic && g.coreHu == 0.0; }));
}

TEST(PhantomGrowths, TheTruthTellsPolypsAndWhatResemblesThem) {
    const phantom::Phantom& made = grownPhantom();
    std::vector<glm::dvec3> neoplastic;
    int stool = 0, bumps = 0;
    for (const phantom::GrowthTruth& growth : made.growths) {
        if (growth.neoplastic) neoplastic.push_back(growth.positionMm);
        stool += growth.kind == "untagged_stool";
        bumps += growth.kind == "hyperplastic";
        EXPECT_GT(growth.diameterMm, 1.0);
        EXPECT_LT(glm::distance(growth.positionMm, growth.wallMm), 25.0);
        // A head nearly as high as wide, 2.5 to 5 mm over the wall; its stalk's root in the wall is
        // none of its height.
        if (growth.kind == "pedunculated") {
            EXPECT_GE(growth.heightMm, 0.8 * growth.diameterMm + 2.5);
            EXPECT_LE(growth.heightMm, 0.95 * growth.diameterMm + 5.0);
        }
        EXPECT_GE(growth.submergedShare, 0.0);
        EXPECT_LE(growth.submergedShare, 1.0);
        // Its foot is on the wall: lumen is as near as the growth is wide, and tissue too.
        const Grid& grid = made.lumen.grid();
        const glm::ivec3 foot(glm::round(grid.voxelFromPatientPoint(growth.wallMm)));
        const int reach = int(std::ceil((0.5 * growth.diameterMm + 2.0) / grid.spacingMm().x));
        int lumen = 0, other = 0;
        visitBox(glm::max(foot - reach, glm::ivec3(0)), glm::min(foot + reach, grid.size - 1),
                 [&](glm::ivec3 v) { (made.lumen.at(v) ? lumen : other) += 1; });
        EXPECT_GT(lumen, 0) << growth.kind;
        EXPECT_GT(other, 0) << growth.kind;
    }
    EXPECT_GE(stool, 3);
    EXPECT_GE(bumps, 1);
    ASSERT_EQ(neoplastic.size(), made.polyps.findings.size());
    for (std::size_t n = 0; n < neoplastic.size(); ++n)
        EXPECT_EQ(neoplastic[n], made.polyps.findings[n].positionMm);
}

TEST(PhantomGrowths, TheTruthTellsWhatFluidWithoutTaggingHides) {
    phantom::PhantomOptions options = grown();
    options.growths.morePolyps = 30;
    options.bowel.untagged = 0.5, options.bowel.full = 0.8, options.bowel.layered = 0.3;
    const phantom::Phantom made = phantom::makePhantom(options).value();
    const Grid& grid = made.lumen.grid();
    int hidden = 0, submerged = 0;
    for (const phantom::GrowthTruth& growth : made.growths) {
        EXPECT_GE(growth.untaggedShare, 0.0);
        EXPECT_LE(growth.untaggedShare, growth.submergedShare + 1.0 / 64.0);
        if (!growth.neoplastic) continue;
        // By what the voxels of the lumen around it hold, the truth of both scans.
        const double reachMm = 0.5 * growth.diameterMm + 2.0;
        const glm::ivec3 center(glm::round(grid.voxelFromPatientPoint(growth.positionMm))),
            reach(glm::ceil(reachMm / grid.spacingMm()));
        int untagged = 0, other = 0;
        visitBox(glm::max(center - reach, glm::ivec3(0)), glm::min(center + reach, grid.size - 1),
                 [&](glm::ivec3 v) {
                     const glm::dvec3 at = grid.patientFromVoxelPoint(glm::dvec3(v));
                     if (!made.lumen.at(v) || glm::distance(at, growth.positionMm) > reachMm)
                         return;
                     (made.sites.at(v) == std::uint8_t(phantom::Site::untaggedFluid) ? untagged
                                                                                     : other)++;
                 });
        if (growth.untaggedShare == 1.0) {
            EXPECT_GT(untagged, other);
        } else if (growth.untaggedShare == 0.0) {
            EXPECT_LT(untagged, other);
        }
        hidden += growth.untaggedShare == 1.0;
        submerged += growth.submergedShare == 1.0 && growth.untaggedShare == 0.0;
    }
    EXPECT_GE(hidden, 2);
    EXPECT_GE(submerged, 2);
}

TEST(PhantomGrowths, MoreFlatLesionsAddTissueAndLeaveTheRest) {
    phantom::PhantomOptions options = grown();
    options.growths.moreFlat = 6;
    const phantom::Phantom made = phantom::makePhantom(options).value();
    const auto isNewTo = [](const phantom::Phantom& other) {
        return [&](const phantom::GrowthTruth& growth) {
            return std::none_of(other.growths.begin(), other.growths.end(),
                                [&](const auto& one) { return one.wallMm == growth.wallMm; });
        };
    };
    // Stool and submerged polyps, which look for room, may have found another place.
    std::vector<phantom::GrowthTruth> others;
    std::ranges::copy_if(made.growths, std::back_inserter(others), isNewTo(grownPhantom()));
    std::ranges::copy_if(grownPhantom().growths, std::back_inserter(others), isNewTo(made));
    int flat = 0;
    for (const phantom::GrowthTruth& growth : others) {
        EXPECT_TRUE(growth.kind != "flat" || growth.diameterMm >= 6.0);
        flat += growth.kind == "flat" && growth.heightMm <= 2.5;
    }
    EXPECT_GE(flat, 4);
    const Grid& grid = made.lumen.grid();
    std::size_t filled = 0, elsewhere = 0;
    visitBox(glm::ivec3(0), grid.size - 1, [&](glm::ivec3 v) {
        if (made.lumen.at(v) == grownPhantom().lumen.at(v)) return;
        const glm::dvec3 at = grid.patientFromVoxelPoint(glm::dvec3(v));
        const auto near = std::ranges::find_if(others, [&](const phantom::GrowthTruth& growth) {
            return glm::distance(at, growth.positionMm) <
                   0.5 * std::max(growth.diameterMm, growth.heightMm) * 1.2 + 6.0;
        });
        if (near == others.end())
            ++elsewhere;
        else if (near->kind == "flat" && !made.lumen.at(v))
            ++filled;
    });
    EXPECT_EQ(elsewhere, 0u);
    EXPECT_GT(filled, 30u);
}

TEST(PhantomGrowths, AFilmFillsWhatLiesBetweenTheWallAndItsThickness) {
    phantom::Film film;
    film.radiusMm = 10.0, film.thicknessMm = 1.5, film.seed = 9;
    const double middle = film.thicknessAt({});
    EXPECT_GT(middle, 0.5 * 1.5);
    EXPECT_LT(middle, 1.5 * 1.5);
    EXPECT_EQ(film.thicknessAt({0.0, 0.0, 13.1}), 0.0) << "its edge wanders by 0.3 of its radius";
    // Across a flat wall, x its lumen's signed distance, voxels hold the film's volume in sum.
    constexpr double width = 0.8;
    double sum = 0.0;
    for (double x = 5.0 * width; x > -10.0 * width; x -= width) {
        const double lumen = std::clamp(0.5 - x / width, 0.0, 1.0),
                     share = film.share({}, x, width);
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        sum += width * lumen * share;
    }
    EXPECT_NEAR(sum, middle, 1e-9);
}

TEST(PhantomGrowths, FilmsOfResidueLieOnTheWallAndLeaveTheTissue) {
    phantom::PhantomOptions options = grown();
    options.growths.coated = 1.0;
    options.growths.films = 6;
    const phantom::Phantom coated = phantom::makePhantom(options).value();
    const phantom::Phantom& bare = grownPhantom();
    // What grows there is the same; films alone are new.
    std::vector<phantom::GrowthTruth> covered;
    std::size_t onWall = 0, over = 0, polypsAndBumps = 0;
    for (const phantom::GrowthTruth& growth : coated.growths) {
        const bool stool = growth.kind == "tagged_stool" || growth.kind == "untagged_stool",
                   film = growth.kind == "film";
        if (!stool) covered.push_back(growth);
        onWall += film, polypsAndBumps += !stool && !film;
        over += !film && growth.filmMm > 0.0;
        EXPECT_FALSE(stool && growth.filmMm > 0.0);
        EXPECT_LT(growth.filmMm, 4.5);
    }
    EXPECT_GE(onWall, 4u) << "but for what is under fluid";
    EXPECT_LE(onWall, 6u);
    EXPECT_GE(2 * over, polypsAndBumps) << "some leave the top bare";
    ASSERT_EQ(coated.growths.size(), bare.growths.size() + onWall);
    // The same places are lumen, but some that held gas hold residue, each near a film; and with
    // the tagging taken out there is gas as before.
    const Grid& grid = coated.lumen.grid();
    const double blurMm = 3.0 * glm::length(grid.spacingMm());
    std::size_t residue = 0, otherTissue = 0, farFromAll = 0, remains = 0, brighter = 0;
    visitBox(glm::ivec3(0), grid.size - 1, [&](glm::ivec3 v) {
        otherTissue += (coated.lumen.at(v) == 0) != (bare.lumen.at(v) == 0);
        remains += std::abs(coated.untaggedHu.at(v) - bare.untaggedHu.at(v)) > 1;
        const bool filled = coated.lumen.at(v) == 2 && bare.lumen.at(v) == 1;
        residue += filled;
        if (!filled) return;
        brighter += coated.scan.hu.at(v) > bare.scan.hu.at(v) + 50;
        const glm::dvec3 at = grid.patientFromVoxelPoint(glm::dvec3(v));
        farFromAll += std::none_of(covered.begin(), covered.end(), [&](const auto& growth) {
            const double reach = 0.5 * growth.diameterMm;
            return glm::distance(at, growth.positionMm) <
                   (growth.kind == "film" ? 1.3 * reach : 1.9 * reach + 6.5) + blurMm;
        });
    });
    EXPECT_GT(residue, 200u);
    EXPECT_GT(20 * brighter, 19 * residue) << "but at the edge of denser fluid";
    EXPECT_EQ(otherTissue, 0u);
    EXPECT_EQ(farFromAll, 0u);
    EXPECT_EQ(remains, 0u);
}

TEST(PhantomGrowths, PlainPolypsHaveTheWallsDensityAndOthersMore) {
    const phantom::Phantom& made = grownPhantom();
    const Grid& grid = made.lumen.grid();
    double sum[2] = {0.0, 0.0};
    int count[2] = {0, 0};
    for (const phantom::GrowthTruth& growth : made.growths) {
        if (!growth.neoplastic || growth.kind == "flat" || growth.diameterMm < 9.0) continue;
        const glm::ivec3 middle(glm::round(grid.voxelFromPatientPoint(growth.positionMm)));
        const bool plain = growth.coreHu == 0.0;
        sum[plain] += made.untaggedHu.at(middle);
        ++count[plain];
    }
    ASSERT_GE(count[0], 2);
    ASSERT_GE(count[1], 2);
    EXPECT_GT(sum[0] / count[0], sum[1] / count[1] + 10.0);
}

TEST(PhantomGrowths, PolypsAreAsDenseAsTheyAreTold) {
    phantom::PhantomOptions options = grown();
    options.growths.polypHu = -20.0, options.growths.polypSdHu = 8.0;
    const phantom::Phantom made = phantom::makePhantom(options).value();
    const phantom::Phantom& bare = grownPhantom();
    const Grid& grid = made.lumen.grid();
    ASSERT_EQ(made.growths.size(), bare.growths.size());
    int looked = 0;
    double least = 1e9, most = -1e9;
    for (const phantom::GrowthTruth& growth : made.growths) {
        if (!growth.neoplastic) {
            EXPECT_EQ(growth.densityHu, 0.0);
        }
        // The blur reaches the middle of smaller ones.
        if (!growth.neoplastic || std::min(growth.diameterMm, growth.heightMm) < 9.0) continue;
        const glm::ivec3 v(glm::round(grid.voxelFromPatientPoint(growth.positionMm)));
        EXPECT_NEAR(made.untaggedHu.at(v) - bare.untaggedHu.at(v), growth.densityHu, 3.0);
        least = std::min(least, growth.densityHu), most = std::max(most, growth.densityHu);
        ++looked;
    }
    EXPECT_GE(looked, 3);
    EXPECT_GT(most - least, 4.0) << "each has its own";
    EXPECT_NE(phantom::growthsJson(made.growths).find("density_hu"), std::string::npos);
    EXPECT_EQ(phantom::growthsJson(bare.growths).find("density_hu"), std::string::npos);
    // And nothing else changes.
    const double blurMm = 3.0 * glm::length(grid.spacingMm());
    std::size_t elsewhere = 0;
    visitBox(glm::ivec3(0), grid.size - 1, [&](glm::ivec3 v) {
        if (made.scan.hu.at(v) == bare.scan.hu.at(v)) return;
        const glm::dvec3 at = grid.patientFromVoxelPoint(glm::dvec3(v));
        elsewhere += std::ranges::none_of(made.growths, [&](const auto& growth) {
            return growth.neoplastic &&
                   glm::distance(at, growth.wallMm) < growth.diameterMm + growth.heightMm + blurMm;
        });
    });
    EXPECT_EQ(elsewhere, 0u);
}

TEST(PhantomGrowths, WhatCannotBeIsRefused) {
    for (const phantom::GrowthOptions& growths :
         {phantom::GrowthOptions{1.5, 0, 0}, phantom::GrowthOptions{0.0, 41, 0},
          phantom::GrowthOptions{0.0, 0, -1}, phantom::GrowthOptions{NAN, 0, 0},
          phantom::GrowthOptions{0.0, 0, 0, 41}, phantom::GrowthOptions{0.0, 0, 0, 0, 1.1},
          phantom::GrowthOptions{0.0, 0, 0, 0, NAN}, phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, -1},
          phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, 41},
          phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, 0, -61.0, 0.0},
          phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, 0, 0.0, 31.0},
          phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, 0, NAN, 0.0},
          phantom::GrowthOptions{0.0, 0, 0, 0, 0.0, 0, 0.0, NAN}}) {
        phantom::PhantomOptions options = grown();
        options.growths = growths;
        EXPECT_FALSE(phantom::makePhantom(options));
    }
}

}  // namespace
