// Detection on a lumen whose wall has polyps and nothing else, all by formula.
#include "ball_colon.h"
#include "cad/along_colon.h"
#include "cad/biopsy_transfer.h"
#include "cad/candidate_table.h"
#include "cad/detect.h"
#include "cad/examined_colon.h"
#include "cad/places.h"
#include "cad/wall_edges.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

using tests::BallColon;
using tests::Bump;
using tests::bumps;
using tests::lumenMm;

cad::DetectOptions shapeAlone(int threads = 2) {
    cad::DetectOptions options;
    options.threads = threads;
    return options;
}

// The candidates by the narrow scale that stand well above the wall.
std::vector<cad::Candidate> bodies(const BallColon& ball, int threads = 2) {
    cad::EvidenceOptions gathering;
    gathering.threads = threads;
    const auto evidence = cad::gatherEvidence(ball.colon(), gathering);
    auto all = cad::findCandidates(ball.colon(), evidence, nullptr, shapeAlone(threads));
    std::erase_if(
        all, [](const cad::Candidate& c) { return c.lesion.heightMm < 1.5 || c.levelOf >= 0; });
    std::sort(all.begin(), all.end(), [](const cad::Candidate& a, const cad::Candidate& b) {
        return a.lesion.volumeMm3 > b.lesion.volumeMm3;
    });
    // Both scales may tell of one body.
    std::vector<cad::Candidate> kept;
    for (auto& c : all)
        if (std::none_of(kept.begin(), kept.end(), [&](const cad::Candidate& k) {
                return glm::distance(k.lesion.centerMm, c.lesion.centerMm) < 4.0;
            }))
            kept.push_back(std::move(c));
    return kept;
}

TEST(Detect, ProgressNeverGoesBack) {
    const auto model = cad::modelOfText(cad::builtInModelText());
    ASSERT_TRUE(model);
    const BallColon ball;
    std::vector<double> told;
    cad::DetectOptions options = shapeAlone();
    options.progress = [&](double share) { told.push_back(share); };
    (void)cad::detectPolyps(ball.colon(), *model, options);
    ASSERT_GT(told.size(), 3u);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GE(told.front(), 0.0);
    EXPECT_EQ(told.back(), 1.0);
}

TEST(Detect, BodiesOnTheWallAreFoundWithTheirSize) {
    const auto found = bodies(BallColon());
    ASSERT_EQ(found.size(), bumps.size());
    for (std::size_t n = 0; n < bumps.size(); ++n) {
        const cad::Lesion& lesion = found[n].lesion;
        const Bump& bump = bumps[n];
        EXPECT_LT(glm::distance(lesion.centerMm, bump.centerMm), 0.6 * bump.radiusMm);
        // The rounded crease belongs to the foot.
        EXPECT_NEAR(lesion.diameter.mm, 2.0 * bump.radiusMm, 1.0);
        const glm::dvec3 outward = glm::normalize(bump.centerMm);
        EXPECT_LT(glm::dot(lesion.axis, outward), -0.95) << "away from the wall";
        const double height = lumenMm - (glm::length(bump.centerMm) - bump.radiusMm);
        EXPECT_NEAR(lesion.heightMm, height, 1.0);
        // Its voxels are tissue, and as many as its volume says.
        const BallColon ball;
        double tissue = 0.0, all = 0.0;
        for (const VoxelRun& run : lesion.voxels) {
            for (int i = 0; i < run.count; ++i) {
                all += 1.0;
                tissue += ball.hu.at(run.first + glm::ivec3(i, 0, 0)) > ball.tissue.airBelowHu;
            }
        }
        EXPECT_GT(tissue / all, 0.9);
        EXPECT_NEAR(all * ball.hu.grid().voxelVolumeMm3() / lesion.volumeMm3, 1.0, 0.1);
    }
}

// Of one tissue, the voxels that are surely inside differ by nothing but the scan's noise.
TEST(Detect, DensitySpreadIsOfTheBodysOwnVoxels) {
    const auto spread = cad::featureNumber("density_spread");
    const auto found = bodies(BallColon());
    ASSERT_EQ(found.size(), bumps.size());
    EXPECT_GT(found[0].features[spread], 0.0) << "the larger one has an inside";
    for (const cad::Candidate& c : found)
        EXPECT_LT(c.features[spread], 0.3);
}

TEST(Detect, AFlatLesionIsAsWideAsItsFoot) {
    // Where a ball of 8 mm, most of it outside, stands 3 mm into the lumen.
    const Bump lens{{0, 0, 25}, 8.0};
    const double along = (25.0 * 25.0 + lumenMm * lumenMm - 64.0) / (2.0 * 25.0),
                 footMm = 2.0 * std::sqrt(lumenMm * lumenMm - along * along);
    const BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, {lens});
    const auto evidence = cad::gatherEvidence(ball.colon(), {});
    auto found = cad::findCandidates(ball.colon(), evidence, nullptr, shapeAlone());
    std::erase_if(found, [](const cad::Candidate& c) { return c.lesion.topMm.z < 15.0; });
    ASSERT_FALSE(found.empty());
    for (const cad::Candidate& c : found) {
        // It rises so gently that the outermost twelfth all around is beneath the foot's height.
        EXPECT_GT(c.lesion.diameter.mm, 0.8 * footMm);
        EXPECT_LT(c.lesion.diameter.mm, 1.05 * footMm);
        EXPECT_NEAR(c.lesion.topMm.z, 17.0, 0.7);
        // A tenth of the patch is higher, and what is around it is in part the lesion's foot.
        EXPECT_GT(c.features[cad::featureNumber("lift_top")], 0.5 * (lumenMm - 17.0));
        EXPECT_LT(c.features[cad::featureNumber("lift_top")], lumenMm - 17.0);
        EXPECT_LT(c.features[cad::featureNumber("lift_mean")],
                  c.features[cad::featureNumber("lift_top")]);
    }
}

TEST(Detect, GasBetweenAWidePatchAndItsFilmIsNoTissue) {
    // A soap film over a wide piece of a ball lies inside the ball.
    const BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, {});
    const auto colon = ball.colon();
    const auto evidence = cad::gatherEvidence(colon, {});
    const auto& places = evidence.samples.mesh.vertices;
    cad::Patch patch;
    for (std::uint32_t v = 0; v < places.size(); ++v)
        if (glm::distance(places[v], glm::dvec3(0, 0, lumenMm)) < 10.0) patch.samples.push_back(v);
    cad::SampleNumbers numbers(places.size());
    const auto lesion = cad::standUp(evidence, patch, ball.hu.grid(), numbers);
    ASSERT_TRUE(lesion);
    const auto gasShare = [&](const std::vector<VoxelRun>& runs) {
        double gas = 0.0, all = 0.0;
        for (const VoxelRun& run : runs)
            for (int i = 0; i < run.count; ++i, ++all)
                gas += ball.hu.at(run.first + glm::ivec3(i, 0, 0)) < ball.tissue.airBelowHu;
        return gas / all;
    };
    EXPECT_GT(gasShare(lesion->voxels), 0.9);
    EXPECT_LT(gasShare(cad::segmentationOf(colon, evidence, *lesion)), 0.1);
}

TEST(Detect, TurnsShiftsAndThreadsChangeNothing) {
    const auto plain = bodies(BallColon());
    const glm::dmat3 quarter(0, 1, 0, -1, 0, 0, 0, 0, 1);
    const auto turned = bodies(BallColon(quarter)),
               shifted = bodies(BallColon(glm::dmat3(1.0), {3, -2, 4}));
    ASSERT_EQ(turned.size(), plain.size());
    ASSERT_EQ(shifted.size(), plain.size());
    for (std::size_t n = 0; n < plain.size(); ++n) {
        const cad::Lesion& lesion = plain[n].lesion;
        EXPECT_LT(glm::distance(turned[n].lesion.centerMm, quarter * lesion.centerMm), 0.05);
        EXPECT_LT(glm::distance(shifted[n].lesion.centerMm,
                                lesion.centerMm + 0.75 * glm::dvec3(3, -2, 4)),
                  0.05);
        for (const auto* other : {&turned, &shifted}) {
            const cad::Lesion& same = (*other)[n].lesion;
            EXPECT_NEAR(same.diameter.mm, lesion.diameter.mm, 0.1);
            EXPECT_NEAR(same.heightMm, lesion.heightMm, 0.05);
            EXPECT_NEAR(same.volumeMm3 / lesion.volumeMm3, 1.0, 0.02);
        }
    }
    const auto alone = bodies(BallColon(), 1);
    ASSERT_EQ(alone.size(), plain.size());
    for (std::size_t n = 0; n < plain.size(); ++n) {
        EXPECT_EQ(alone[n].features, plain[n].features);
        EXPECT_EQ(alone[n].lesion.centerMm, plain[n].lesion.centerMm);
        EXPECT_EQ(alone[n].lesion.voxels, plain[n].lesion.voxels);
    }
}

TEST(Detect, OtherLevelsOfWhatIsNotWorthTheLookNeedNotBeMeasured) {
    const BallColon ball;
    const auto evidence = cad::gatherEvidence(ball.colon(), {});
    auto model = cad::modelOfText(cad::builtInModelText()).value();
    auto all = cad::findCandidates(ball.colon(), evidence, nullptr, shapeAlone());
    const auto inTurn = cad::findCandidates(ball.colon(), evidence, nullptr, shapeAlone(1));
    EXPECT_EQ(cad::candidateTable(inTurn), cad::candidateTable(all)) << "for any number of threads";
    // A model for which about half of them are worth the look.
    std::vector<double> odds;
    for (const cad::Candidate& c : all)
        if (c.levelOf < 0) odds.push_back(cad::logit(model.probability(c.features)));
    std::ranges::sort(odds);
    model.calibrationA += 2.0 * (cad::logit(cad::worthAnotherLook) - odds[odds.size() / 2] + 1e-6);
    auto some = cad::findCandidates(ball.colon(), evidence, nullptr, shapeAlone(), &model);
    const auto levels = [](const auto& candidates) {
        return std::ranges::count_if(candidates, [](const auto& c) { return c.levelOf >= 0; });
    };
    EXPECT_GT(levels(some), 0);
    EXPECT_LT(levels(some), levels(all)) << "else nothing is saved";
    EXPECT_EQ(all.size() - std::size_t(levels(all)), some.size() - std::size_t(levels(some)));
    cad::weigh(all, model);
    cad::weigh(some, model);
    ASSERT_EQ(all.size(), some.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
        EXPECT_EQ(all[n].probability, some[n].probability);
        EXPECT_EQ(all[n].lesion.centerMm, some[n].lesion.centerMm);
    }
}

TEST(Detect, AFeatureTellsWhatStoodBeforeAPlace) {
    const BallColon ball;
    // A pool of tagging stood before the first bump.
    Volume<std::int16_t> scanned = ball.hu.clone();
    for (std::size_t n = 0; n < scanned.grid().voxelCount(); ++n) {
        const glm::ivec3 voxel = scanned.grid().voxelAt(n);
        if (ball.lumen[n] && scanned.grid().patientFromVoxelPoint(voxel).z > 8.0)
            scanned.writable()[n] = 540;
    }
    const cad::PreparedColon plain = ball.colon();
    const cad::PreparedColon colon{scanned,       plain.cleansed, plain.lumen,
                                   plain.surface, plain.flat,     plain.centerline,
                                   plain.tissue,  plain.pieces,   plain.rebuilt};
    const auto evidence = cad::gatherEvidence(colon, {});
    auto found = cad::findCandidates(colon, evidence, nullptr, shapeAlone());
    std::erase_if(found, [](const cad::Candidate& c) { return c.lesion.heightMm < 1.5; });
    const cad::WallStatistics& wall = evidence.statistics;
    const auto told = [&](double hu) { return (hu - wall.wallHu) / (wall.wallHu - wall.fatHu); };
    const std::vector<double> before{540.0, -990.0};
    std::vector<int> count(bumps.size(), 0);
    for (const cad::Candidate& c : found) {
        for (std::size_t n = 0; n < bumps.size(); ++n) {
            if (glm::distance(c.lesion.centerMm, bumps[n].centerMm) > 3.0) continue;
            EXPECT_NEAR(c.features[cad::featureNumber("outside_density")], told(before[n]), 0.5);
            ++count[n];
        }
    }
    for (const int found : count)
        EXPECT_GT(found, 0);
}

TEST(Detect, AFeatureTellsBubblesInside) {
    // A ball of gas and tissue in the middle of the first bump, 3 mm wide.
    BallColon ball;
    const auto features = [&](std::size_t bump) {
        for (const cad::Candidate& c : bodies(ball))
            if (glm::distance(c.lesion.centerMm, bumps[bump].centerMm) < 3.0) return c.features;
        ADD_FAILURE() << "no candidate at bump " << bump;
        return cad::FeatureVector{};
    };
    const auto solid = features(0), other = features(1);
    for (std::size_t n = 0; n < ball.hu.grid().voxelCount(); ++n) {
        const glm::dvec3 p = ball.hu.grid().patientFromVoxelPoint(ball.hu.grid().voxelAt(n));
        if (glm::distance(p, bumps[0].centerMm) < 1.5) ball.hu.writable()[n] = -300;
    }
    const auto crumbly = features(0), beside = features(1);
    EXPECT_GT(crumbly[cad::featureNumber("dip_p90")], crumbly[cad::featureNumber("dip_mean")]);
    for (const auto [f] :
         std::initializer_list<cad::FeatureName>{"dip_mean", "dip_p90", "dip_raw"}) {
        const std::string_view name = cad::featureNames[f];
        // In wall minus fat; noise is none. The wall's own end is no dip.
        EXPECT_LT(solid[f], 0.1) << name;
        EXPECT_LT(other[f], 0.1) << name;
        EXPECT_GT(crumbly[f], 3.0 * solid[f] + 0.1) << name;
        EXPECT_NEAR(beside[f], other[f], 0.02) << name;
    }
}

TEST(Detect, WhatNobodyHasSeenMakesNoCandidate) {
    // The first bump stands on a bridge, or in fluid without tagging.
    for (const LumenLabel label : {LumenLabel::bridge, LumenLabel::untagged}) {
        BallColon ball;
        for (std::size_t n = 0; n < ball.lumen.grid().voxelCount(); ++n) {
            const glm::dvec3 p =
                ball.lumen.grid().patientFromVoxelPoint(glm::dvec3(ball.lumen.grid().voxelAt(n)));
            if (ball.lumen[n] && glm::distance(p, bumps[0].centerMm) < 9.0)
                ball.lumen.writable()[n] = std::uint8_t(label);
        }
        const auto found = bodies(ball);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT(glm::distance(found[0].lesion.centerMm, bumps[1].centerMm), bumps[1].radiusMm);
        // The reader is told.
        const auto evidence = cad::gatherEvidence(ball.colon(), {});
        const Findings findings = cad::findingsOf(ball.colon(), evidence, {}, {});
        ASSERT_EQ(findings.warnings.size(), 1u);
        const char* why = label == LumenLabel::bridge ? "a bridge" : "fluid without tagging";
        EXPECT_NE(findings.warnings[0].find(why), std::string::npos) << findings.warnings[0];
    }
    // A wall that was set up again counts as little.
    const BallColon whole;
    cad::PreparedColon colon = whole.colon();
    colon.rebuilt = {{bumps[1].centerMm, 20.0, true}};
    const auto evidence = cad::gatherEvidence(colon, {});
    const auto others = cad::findCandidates(colon, evidence, nullptr, shapeAlone());
    EXPECT_TRUE(std::ranges::any_of(others, [](const cad::Candidate& c) {
        return glm::distance(c.lesion.centerMm, bumps[0].centerMm) < bumps[0].radiusMm;
    }));
    for (const auto& c : others)
        EXPECT_GT(glm::distance(c.lesion.centerMm, bumps[1].centerMm), 2.0);
}

// The ball's wall, its edge as wide as asked, and brighter behind gas by some HU.
TEST(Detect, EdgesUnlikeThoseThatItHasLearntFromAreTold) {
    const auto warning = [](double widthMm, double overshootHu) -> std::string {
        BallColon ball;
        const Grid& grid = ball.hu.grid();
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const double d =
                tests::wallMm(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))), bumps);
            const double hu = 40.0 - 1030.0 / (1.0 + std::exp(d / widthMm)) +
                              overshootHu * std::exp(-(d - 2.0) * (d - 2.0));
            ball.hu.writable()[n] = std::int16_t(std::lround(hu));
        }
        const auto edges = cad::wallEdges(ball.colon(), cad::gatherEvidence(ball.colon(), {}));
        EXPECT_TRUE(edges);
        return edges ? cad::warningOfEdges(*edges, std::nullopt).value_or("") : "none";
    };
    EXPECT_EQ(warning(0.5, 0.0), "");
    EXPECT_EQ(warning(0.7, 0.0), "");
    EXPECT_NE(warning(0.5, 120.0).find("enhances edges"), std::string::npos);
    EXPECT_NE(warning(1.6, 0.0).find("more blurred"), std::string::npos);
}

/// v = u + a (u − G u) within the slices, by the definition.
Volume<std::int16_t> sharpened(const Volume<std::int16_t>& u, double a) {
    Volume<std::int16_t> v = u.clone();
    const glm::ivec3 last = u.grid().size - 1;
    for (std::size_t n = 0; n < u.grid().voxelCount(); ++n) {
        const glm::ivec3 at = u.grid().voxelAt(n);
        double sum = 0.0, weights = 0.0;
        for (int j = -3; j <= 3; ++j) {
            for (int i = -3; i <= 3; ++i) {
                const double weight = std::exp(-0.5 * (i * i + j * j));
                const glm::ivec3 beside = glm::clamp(at + glm::ivec3(i, j, 0), glm::ivec3(0), last);
                sum += weight * u.at(beside), weights += weight;
            }
        }
        v.writable()[n] = std::int16_t(std::lround(u[n] + a * (u[n] - sum / weights)));
    }
    return v;
}

// A wall of 3 mm with fat behind it, whose edges are as usual, and then enhanced.
TEST(Detect, WhatAKernelAddsToEdgesIsTakenOffFirst) {
    BallColon ball;
    const Grid& grid = ball.hu.grid();
    const auto wallOf = [&](std::size_t n) {
        return tests::wallMm(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))), bumps);
    };
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const auto step = [&](double mm) { return 1.0 / (1.0 + std::exp((mm - wallOf(n)) / 0.5)); };
        ball.hu.writable()[n] =
            std::int16_t(std::lround(-990.0 + 1030.0 * step(0.0) - 140.0 * step(3.0)));
    }
    const cad::ExaminedColon asItIs(ball.colon(), {});
    EXPECT_FALSE(asItIs.edgeWarning());
    EXPECT_EQ(&asItIs.colon().cleansed, &ball.hu) << "nothing is changed";

    const Volume<std::int16_t> soft = ball.hu.clone();
    for (const double a : {2.0, 3.0}) {
        ball.hu = sharpened(soft, a);
        Volume<std::int16_t> ct = ball.hu.clone();
        for (std::size_t n = 0; n < grid.voxelCount(); n += 7)
            ct.writable()[n] = std::int16_t(ct[n] + 500);  // what cleansing took out
        const cad::PreparedColon colon{
            ct, ball.hu, ball.lumen, ball.surface, ball.flat, ball.centerline, ball.tissue, {}, {}};
        const cad::ExaminedColon examined(colon, {});
        ASSERT_TRUE(examined.edgeWarning());
        EXPECT_NE(examined.edgeWarning()->find("was taken off"), std::string::npos);
        const auto edges = cad::wallEdges(examined.colon(), examined.evidence());
        ASSERT_TRUE(edges);
        EXPECT_NEAR(edges->peak, cad::usualPeak, 0.005) << "as it is looked at";
        // By the samples that there were already.
        const auto afresh = cad::gatherEvidence(examined.colon(), {});
        const auto& taken = examined.evidence();
        EXPECT_TRUE(std::ranges::equal(afresh.samples.mesh.vertices, taken.samples.mesh.vertices));
        EXPECT_TRUE(std::ranges::equal(afresh.rays, taken.rays, {}, &cad::BiopsyRay::peakHu,
                                       &cad::BiopsyRay::peakHu));
        EXPECT_NE(taken.alongColon, nullptr);
        double off = 0.0, before = 0.0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const int made = examined.colon().cleansed[n];
            ASSERT_EQ(examined.colon().ct[n] - made, ct[n] - ball.hu[n]);
            if (std::abs(wallOf(n)) > 3.0) continue;
            off += std::pow(made - soft[n], 2.0), before += std::pow(ball.hu[n] - soft[n], 2.0);
        }
        EXPECT_LT(std::sqrt(off / before), 0.2) << a;
    }
}

// Across slices, where a shallow pool is as deep as a few pixels, as along them.
TEST(Detect, FluidWithoutTaggingIsSeenBeforeTheWallHoweverThickSlicesAre) {
    for (const double thickMm : {0.75, 1.5, 3.0, 5.0}) {
        BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, {}, {0.75, 0.75, thickMm});
        const Grid& grid = ball.lumen.grid();
        constexpr double deepMm = 3.0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n)
            if (ball.lumen[n] &&
                grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))).y > lumenMm - deepMm)
                ball.lumen.writable()[n] = std::uint8_t(LumenLabel::untagged);
        const auto evidence = cad::gatherEvidence(ball.colon(), {});
        std::size_t wet = 0, behind = 0, dry = 0, wrong = 0;
        for (std::size_t v = 0; v < evidence.samples.mesh.vertices.size(); ++v) {
            const glm::dvec3 p = evidence.samples.mesh.vertices[v];
            if (p.y > lumenMm - 0.5) ++wet, behind += evidence.untagged[v];
            if (p.y < lumenMm - deepMm - 3.0) ++dry, wrong += evidence.untagged[v];
        }
        ASSERT_GT(wet, 100u);
        EXPECT_GT(double(behind), 0.98 * double(wet)) << thickMm;
        EXPECT_EQ(wrong, 0u) << thickMm;
        EXPECT_GT(dry, 1000u);
    }
}

TEST(Detect, LobesSideBySideAreToldToBePerhapsOneMass) {
    // Three of 8 mm, their middles 10 mm apart, and two.
    std::vector<Bump> lobes;
    for (const double angle : {-0.547, 0.0, 0.547})
        lobes.push_back({18.5 * glm::dvec3(std::sin(angle), 0, std::cos(angle)), 4.0});
    const auto told = [&] {
        const BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, lobes);
        auto found = bodies(ball);
        EXPECT_EQ(found.size(), lobes.size());
        for (cad::Candidate& candidate : found)
            candidate.probability = 0.9;
        return cad::findingsOf(ball.colon(), cad::gatherEvidence(ball.colon(), {}), found, {})
            .warnings;
    };
    const auto warnings = told();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with("findings 1, 2 and 3, from ")) << warnings[0];
    EXPECT_NE(warnings[0].find("one mass"), std::string::npos) << warnings[0];
    lobes.pop_back();
    EXPECT_TRUE(told().empty());
}

TEST(Biopsy, ARayEndsWhereTheLumenBeginsAgain) {
    // A plate of tissue 4 mm thick between gas and gas.
    const Grid grid = axisAlignedGrid({32, 32, 64}, {0.75, 0.75, 0.5}, {-12, -12, 0});
    Volume<std::int16_t> hu(grid);
    Volume<std::uint8_t> lumen(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double z = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))).z;
        const bool gas = z < 10.0 || z > 14.0;
        hu.writable()[n] = gas ? -1000 : 60;
        lumen.writable()[n] = gas;
    }
    const cad::SmoothScan scan(hu, {-12, -12, 0}, {12, 12, 32}, 0.5, 1);
    const cad::BiopsyScan biopsy{scan, lumen, -470.0};
    const cad::BiopsyTable table(cad::fixedBiopsyTransfer());
    const cad::BiopsyRay through = cad::castBiopsyRay(biopsy, table, {0, 0, 10.1}, {0, 0, 1});
    EXPECT_TRUE(through.reenters);
    EXPECT_NEAR(through.tissueMm, 4.0, 0.75);
    const cad::BiopsyRay along = cad::castBiopsyRay(biopsy, table, {-8, 0, 12.0}, {1, 0, 0});
    EXPECT_FALSE(along.reenters);
    EXPECT_NEAR(along.tissueMm, cad::biopsySteps * cad::biopsyStepMm, 1e-3);
    EXPECT_GT(along.opacity, through.opacity);
    EXPECT_GT(along.color.g, along.color.r) << "tissue of middle density is green";
}

// A biopsy ray step by step, by what its docstring says.
cad::BiopsyRay steppedRay(const cad::BiopsyScan& biopsy, const cad::BiopsyTable& table,
                          glm::dvec3 startMm, glm::dvec3 intoWall, cad::RayEnd end) {
    const glm::dmat4& voxelFromPatient = biopsy.scan.voxelFromPatient();
    glm::vec3 voxel(voxelFromPatient * glm::dvec4(startMm, 1.0));
    const glm::vec3 step(cad::biopsyStepMm * (glm::dmat3(voxelFromPatient) * intoWall));
    const glm::ivec3 last = biopsy.lumen.grid().size - 1;
    cad::BiopsyRay ray;
    bool inTissue = false, opaque = false;
    for (int n = 0; n < cad::biopsySteps; ++n, voxel += step) {
        const float hu = biopsy.scan.linear(voxel);
        const glm::ivec3 at(voxel + (glm::vec3(biopsy.scan.origin()) + 0.5f));
        const bool empty = hu < float(biopsy.airBelowHu) ||
                           biopsy.lumen.at(glm::clamp(at, glm::ivec3(0), last)) != 0;
        if (empty && (inTissue || n >= 3)) {
            ray.reenters = inTissue;
            return ray;
        }
        inTissue |= !empty;
        if (n * cad::biopsyStepMm <= cad::peakMm) ray.peakHu = std::max(ray.peakHu, hu);
        ray.tissueMm += float(cad::biopsyStepMm);
        if (opaque) continue;
        const float left = 1.0f - ray.opacity;
        for (int c = 0; c < 3; ++c)
            ray.color[c] += left * table.at(hu)[c];
        ray.opacity += left * table.at(hu)[3];
        if (ray.opacity < float(terminationOpacity)) continue;
        ray.color /= ray.opacity;
        ray.opacity = 1.0f;
        opaque = true;
        if (end == cad::RayEnd::opaque) return ray;
    }
    return ray;
}

TEST(Biopsy, ARayIsWhatItIsStepByStepWhereverItEnds) {
    // Lumps of gas, tissue and something dense, and a lumen that has little to do with them.
    const Grid grid = axisAlignedGrid({40, 40, 40}, {0.8, 0.7, 1.0}, {0, 0, 0});
    std::mt19937 random(7);
    Volume<std::int16_t> hu(grid);
    Volume<std::uint8_t> lumen(grid);
    const glm::dvec3 wave(random() % 7 + 3.0, random() % 7 + 3.0, random() % 7 + 3.0);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        const double v = std::sin(p.x / wave.x) + std::sin(p.y / wave.y) + std::sin(p.z / wave.z);
        hu.writable()[n] = std::int16_t(v < -1.6 ? -1000 : 150.0 * v);
        lumen.writable()[n] = v < -1.8 && random() % 4 == 0;
    }
    const cad::SmoothScan scan(hu, {4, 4, 4}, {26, 22, 34}, 0.6, 1);
    const cad::BiopsyScan biopsy{scan, lumen, -470.0};
    TransferFunction dense = cad::fixedBiopsyTransfer();
    for (TransferFunctionPoint& point : dense.points)
        point.opacity = std::min(0.9, 3.0 * point.opacity);
    std::set<int> ends;
    int opaque = 0;
    for (const TransferFunction& transfer : {cad::fixedBiopsyTransfer(), dense}) {
        const cad::BiopsyTable table(transfer);
        for (int n = 0; n < 4000; ++n) {
            const auto within = [&](double most) { return most * double(random() % 10000) / 1e4; };
            const glm::dvec3 start(within(31), within(27), within(39)),
                way = glm::normalize(glm::dvec3(within(2), within(2), within(2)) - 0.97);
            for (const cad::RayEnd end : {cad::RayEnd::lumen, cad::RayEnd::opaque}) {
                const cad::BiopsyRay ray = cad::castBiopsyRay(biopsy, table, start, way, end),
                                     stepped = steppedRay(biopsy, table, start, way, end);
                ASSERT_EQ(ray.color, stepped.color);
                ASSERT_EQ(ray.opacity, stepped.opacity);
                ASSERT_EQ(ray.tissueMm, stepped.tissueMm);
                ASSERT_EQ(ray.reenters, stepped.reenters);
                ASSERT_EQ(ray.peakHu, stepped.peakHu);
                ends.insert(int(ray.tissueMm / cad::biopsyStepMm));
                opaque += ray.opacity == 1.0f;
            }
        }
    }
    EXPECT_GT(ends.size(), 30u) << "rays that end at any of four steps";
    EXPECT_GT(opaque, 100);
}

TEST(Detect, APlaceAlongTheColonIsWhereItsWallBelongsThoughAnotherLoopIsNearer) {
    // Wall at x = 25 of a colon along x = 0; another loop of it runs by at x = 32.
    BallColon ball;
    ball.centerline.points = {{{0, -10, 0}, 0.0, 20.0, false},
                              {{0, 10, 0}, 20.0, 20.0, false},
                              {{32, 10, 0}, 52.0, 5.0, false},
                              {{32, -10, 0}, 72.0, 5.0, false}};
    ball.flat.surface.vertices = {{25, -10, -9}, {25, 10, -9}, {25, 10, 9}, {25, -10, 9}};
    ball.flat.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
    ball.flat.flat = {{0.0, 0.0}, {0.0, 1.0}, {0.5, 1.0}, {0.5, 0.0}};
    ball.flat.camera = {0, 1, 1, 0};
    ball.flat.cameras = {{{0, -10, 0}, 0.0}, {{0, 10, 0}, 20.0}};
    ball.flat.sourceTriangle = {0, 1};
    cad::Candidate candidate;
    candidate.lesion.topMm = {25, 5, 0}, candidate.lesion.centerMm = {27, 5, 0};
    candidate.probability = 1.0;
    auto colon = ball.colon();
    auto evidence = cad::gatherEvidence(colon, {});
    colon.pieces = {{ColonPart::rectum, {0, 0, 0}, 15.0}, {ColonPart::cecum, {32, 0, 0}, 5.0}};
    evidence.alongColon = std::make_unique<const cad::AlongColon>(colon.flat, colon.centerline);
    const Findings findings = cad::findingsOf(colon, evidence, {candidate}, {});
    ASSERT_EQ(findings.findings.size(), 1u);
    EXPECT_NEAR(findings.findings.front().arcMm, 15.0, 1e-9);
    EXPECT_EQ(findings.findings.front().segment, ColonSegment::rectum);
    // Without a map there is nothing better than the nearest.
    ball.flat = {};
    evidence.alongColon = std::make_unique<const cad::AlongColon>(colon.flat, colon.centerline);
    const Findings unmapped = cad::findingsOf(colon, evidence, {candidate}, {});
    ASSERT_EQ(unmapped.findings.size(), 1u);
    EXPECT_GT(unmapped.findings.front().arcMm, 50.0);
}

TEST(Detect, FeaturesOfAxisAndRegionTakeThemFromTheFlatMap) {
    // The bump on the ball's side points to the axis, which a map has on its outer side instead,
    // far from the rectum.
    BallColon ball;
    const auto feature = [&](cad::FeatureName name) -> double {
        auto colon = ball.colon();
        colon.pieces = {{ColonPart::rectum, {0, 0, 0}, 15.0}, {ColonPart::cecum, {0, 15, 0}, 5.0}};
        const auto candidates =
            cad::findCandidates(colon, cad::gatherEvidence(colon, {}), nullptr, {});
        for (const cad::Candidate& each : candidates)
            if (glm::distance(each.lesion.centerMm, bumps[1].centerMm) < 4.0)
                return each.features[name.number];
        return NAN;
    };
    EXPECT_GT(feature("toward_axis"), 0.95);
    EXPECT_EQ(feature("tube_region"), 1.0);
    ball.flat.surface = ball.surface;
    for (const glm::dvec3& v : ball.surface.vertices)
        ball.flat.flat.push_back(0.5 + 0.4 * glm::dvec2(v.x, v.z) / lumenMm);
    ball.flat.camera.assign(ball.surface.vertices.size(), 0);
    ball.flat.cameras = {{{-1000, 0, -2}, 500.0}};
    ball.flat.sourceTriangle.resize(ball.surface.triangles.size());
    EXPECT_LT(feature("toward_axis"), -0.95);
    EXPECT_EQ(feature("tube_region"), 0.0);
}

TEST(Biopsy, FindingsTellByWhichColoursTheirWallWasSeen) {
    const BallColon ball;
    const cad::PreparedColon colon = ball.colon();
    const auto evidence = cad::gatherEvidence(colon, {});
    const Findings findings = cad::findingsOf(colon, evidence, {}, {});
    ASSERT_TRUE(findings.biopsy);
    EXPECT_EQ(findings.biopsy->transferFunction, cad::automaticBiopsyTransfer(evidence.statistics));
    EXPECT_EQ(findings.biopsy->wallHu, evidence.statistics.wallHu);
    const auto read = findingsOfJson(findingsJson(findings));
    ASSERT_TRUE(read) << describe(read.error());
    ASSERT_TRUE(read->biopsy);
    for (std::size_t n = 0; n < read->biopsy->transferFunction.points.size(); ++n)
        EXPECT_NEAR(read->biopsy->transferFunction.points[n].hu,
                    findings.biopsy->transferFunction.points[n].hu, 1e-3);
}

TEST(Biopsy, TheAutomaticTransferFunctionFollowsTheScan) {
    const cad::WallStatistics usual{40.0, -100.0, 5.0};
    const TransferFunction fixed = cad::fixedBiopsyTransfer(),
                           same = cad::automaticBiopsyTransfer(usual);
    for (std::size_t n = 0; n < fixed.points.size(); ++n)
        EXPECT_NEAR(same.points[n].hu, fixed.points[n].hu, 1e-9);
    const TransferFunction moved = cad::automaticBiopsyTransfer({60.0, -80.0, 5.0});
    for (std::size_t n = 0; n < fixed.points.size(); ++n)
        EXPECT_NEAR(moved.points[n].hu, fixed.points[n].hu + 20.0, 1e-9);
    const TransferFunction noisy = cad::automaticBiopsyTransfer({40.0, -100.0, 25.0});
    for (std::size_t n = 0; n < fixed.points.size(); ++n) {
        if (fixed.points[n].hu > 40.0)
            EXPECT_GT(noisy.points[n].hu, fixed.points[n].hu + 20.0);
        else
            EXPECT_NEAR(noisy.points[n].hu, fixed.points[n].hu, 1e-9);
    }
    EXPECT_TRUE(checkTransferFunction(noisy));
}

}  // namespace
