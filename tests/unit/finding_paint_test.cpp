// Which places of the wall belong to a finding, and which pixels of the strip are coloured.
#include "render/wall/finding_paint.h"

#include "ball_colon.h"
#include "cad/detect.h"
#include "flat_tube.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using namespace render;

const FlatTube& tube() {
    static const FlatTube made;
    return made;
}
std::shared_ptr<const StripPainter> painter() {
    static const auto made =
        StripPainter::of(WallSight::of(std::make_shared<const FlatMap>(tube().map())).value())
            .value();
    return made;
}
Grid grid() {
    return axisAlignedGrid({64, 64, 100}, {0.9, 0.8, 0.7}, {-28.0, -25.0, -4.0});
}

/// Voxels of the grid in a ball beyond the wall.
Finding lump(glm::dvec2 flat, double radiusMm, double score) {
    const glm::dvec3 place = tube().positionMm(flat);
    Finding finding;
    finding.positionMm = place;
    finding.diameterMm = 2.0 * radiusMm;
    finding.score = score;
    for (std::size_t n = 0; n < grid().voxelCount(); ++n) {
        const glm::ivec3 voxel = grid().voxelAt(n);
        const glm::dvec3 mm = grid().patientFromVoxelPoint(glm::dvec3(voxel));
        if (glm::distance(mm, place) > radiusMm) continue;
        if (glm::dot(mm - place, tube().inwardNormal(flat)) > 0.0) continue;
        if (!finding.voxels.empty() &&
            finding.voxels.back().first + glm::ivec3(finding.voxels.back().count, 0, 0) == voxel)
            ++finding.voxels.back().count;
        else
            finding.voxels.push_back({voxel, 1});
    }
    return finding;
}

/// The definition, voxel by voxel.
double shareAt(const Finding& finding, glm::dvec3 mm) {
    const glm::dvec3 at = grid().voxelFromPatientPoint(mm);
    double share = 0.0;
    for (const VoxelRun& run : finding.voxels)
        for (int i = 0; i < run.count; ++i) {
            const glm::dvec3 d = glm::abs(at - glm::dvec3(run.first + glm::ivec3(i, 0, 0)));
            if (d.x < 1.0 && d.y < 1.0 && d.z < 1.0)
                share += (1.0 - d.x) * (1.0 - d.y) * (1.0 - d.z);
        }
    return share;
}

TEST(FindingPaint, APlaceBelongsWhereTissueIsBeneathIt) {
    const std::vector<Finding> findings = {lump({0.3, 0.4}, 4.0, 0.9), lump({0.8, 0.5}, 2.5, 0.4)};
    const FindingTissue tissue(grid(), findings);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> around(0.0, 1.0);
    int within = 0, without = 0;
    for (int n = 0; n < 4000; ++n) {
        glm::dvec2 flat(around(random), tube().height() * around(random));
        if (n % 2)
            flat = glm::dvec2(0.3, 0.4) +
                   0.12 * glm::dvec2(around(random) - 0.5, around(random) - 0.5);
        const glm::dvec3 place = tube().positionMm(flat), inward = tube().inwardNormal(flat);
        // A hair's breadth from the threshold either is right.
        double most[2] = {0.0, 0.0};
        for (double deep = 0.0; deep <= tissue.reachMm(); deep += 0.25 * 0.7)
            for (int f = 0; f < 2; ++f)
                most[f] =
                    std::max(most[f], shareAt(findings[std::size_t(f)], place - deep * inward));
        if (std::abs(most[0] - FindingTissue::leastShare) < 1e-9) continue;
        const int expected = most[0] >= FindingTissue::leastShare   ? 0
                             : most[1] >= FindingTissue::leastShare ? 1
                                                                    : -1;
        EXPECT_EQ(tissue.at(place, inward), expected) << flat.x << ' ' << flat.y;
        ++(expected >= 0 ? within : without);
    }
    EXPECT_GT(within, 300);
    EXPECT_GT(without, 1500);
}

TEST(FindingPaint, AFlatBodyIsTissueAndColouredWithoutHoles) {
    // Of balls that are mostly outside, so that what stands in the lumen is thinner than two
    // voxels.
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, 2, 3));
    for (const glm::dvec3 spacingMm : {glm::dvec3(0.75), glm::dvec3(0.6, 0.6, 1.2)}) {
        for (const double radiusMm : {6.0, 8.0, 11.0}) {
            for (const double standsMm : {0.8, 1.2, 1.8}) {
                SCOPED_TRACE(testing::Message()
                             << spacingMm.z << ' ' << radiusMm << ' ' << standsMm);
                const BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0,
                                     {{(lumenMm + radiusMm - standsMm) * way, radiusMm}},
                                     spacingMm);
                const auto colon = ball.colon();
                const auto evidence = cad::gatherEvidence(colon, {});
                auto candidates = cad::findCandidates(colon, evidence, nullptr, {});
                std::erase_if(candidates, [&](const cad::Candidate& c) {
                    return glm::dot(c.lesion.topMm, way) < 0.85 * lumenMm;
                });
                ASSERT_FALSE(candidates.empty());
                for (cad::Candidate& candidate : candidates) {
                    const cad::Lesion& lesion = candidate.lesion;
                    candidate.probability = 1.0;
                    const auto told = cad::findingsOf(colon, evidence, {candidate}, {}).findings;
                    ASSERT_EQ(told.size(), 1u);
                    const FindingTissue paint(ball.hu.grid(), told);
                    const auto colouredAt = [&](std::uint32_t v) {
                        return paint.at(evidence.samples.mesh.vertices[v],
                                        -glm::dvec3(evidence.shapes[v].intoWall)) == 0;
                    };
                    const std::set<std::uint32_t> patch(lesion.patch.samples.begin(),
                                                        lesion.patch.samples.end());
                    const auto isRim = [&](std::uint32_t v) {
                        return std::ranges::any_of(
                            evidence.samples.around(v),
                            [&](std::uint32_t next) { return !patch.contains(next); });
                    };
                    for (const std::uint32_t v : patch)
                        EXPECT_TRUE(colouredAt(v) || isRim(v));
                    for (std::uint32_t v = 0; v < evidence.samples.mesh.vertices.size(); v += 7) {
                        const double mm =
                            glm::distance(evidence.samples.mesh.vertices[v], lesion.topMm);
                        if (mm > 0.5 * lesion.diameter.mm + 3.0) {
                            EXPECT_FALSE(colouredAt(v));
                        }
                    }
                    int tissue = 0, all = 0;
                    std::size_t last = 0;
                    for (const VoxelRun& run : told[0].voxels) {
                        EXPECT_TRUE(all == 0 || ball.hu.grid().index(run.first) > last)
                            << "in memory order";
                        last = ball.hu.grid().index(run.first);
                        for (int i = 0; i < run.count; ++i, ++all)
                            tissue += ball.hu.at(run.first + glm::ivec3(i, 0, 0)) >
                                      ball.tissue.airBelowHu;
                    }
                    EXPECT_GT(tissue, 0.9 * all);
                }
            }
        }
    }
}

TEST(FindingPaint, WithoutVoxelsItIsTheBallOfTheDiameter) {
    Finding truth;
    truth.positionMm = tube().positionMm({0.5, 0.5});
    truth.diameterMm = 6.0;
    const FindingTissue tissue(grid(), std::vector{truth});
    for (double x = 0.3; x < 0.7; x += 0.003) {
        const glm::dvec3 place = tube().positionMm({x, 0.5});
        EXPECT_EQ(tissue.at(place, {0, 0, 1}) == 0, glm::distance(place, truth.positionMm) <= 3.0);
    }
}

TEST(FindingPaint, APixelIsColouredIfItsPlaceBelongsToAFindingThatIsShown) {
    Findings all;
    all.grid = grid();
    all.findings = {lump({0.98, 0.45}, 4.0, 0.9)};  // across the seam
    all.candidates = {lump({0.5, 0.6}, 3.0, 0.2), lump({0.5, 0.66}, 3.0, 0.4)};
    const auto pixels = findingPixels(*painter(), all);
    std::vector<Finding> byScore = {all.findings[0], all.candidates[1], all.candidates[0]};
    const int index[] = {0, 2, 1};
    const FindingTissue tissue(grid(), byScore);
    std::map<std::int32_t, int> of;
    for (const FindingPixel& pixel : pixels)
        EXPECT_TRUE(of.emplace(pixel.pixel, pixel.finding).second);
    const int count = painter()->size().x * painter()->size().y;
    std::set<int> columns;
    for (std::int32_t n = 0; n < count; ++n) {
        const auto place = painter()->placeAt(n);
        const int finding =
            place
                ? tissue.at(
                      place->positionMm,
                      glm::dvec3(painter()->sight().facets()[std::size_t(place->triangle)].inward))
                : -1;
        const auto found = of.find(n);
        ASSERT_EQ(found == of.end() ? -1 : found->second, finding < 0 ? -1 : index[finding]);
        if (finding == 0) columns.insert(n % painter()->size().x);
    }
    EXPECT_TRUE(columns.contains(0) && columns.contains(painter()->size().x - 1));
    // Colours are of what is shown, and of that alone.
    const auto shown = colorFindings(
        pixels, std::vector{FindingShade::finding, FindingShade::none, FindingShade::candidate});
    std::set<std::int32_t> coloured;
    glm::u8vec4 strong(0), weak(0);
    for (const TintedPixel& tinted : shown) {
        coloured.insert(tinted.pixel);
        (of.at(tinted.pixel) == 0 ? strong : weak) = tinted.color;
    }
    for (const auto& [pixel, finding] : of)
        EXPECT_EQ(coloured.contains(pixel), finding != 1);
    EXPECT_GT(strong.a, weak.a);
    EXPECT_NE(glm::u8vec3(strong), glm::u8vec3(weak));
    EXPECT_TRUE(colorFindings(pixels, std::vector<FindingShade>(3)).empty());
    const auto paint = painter()->paint({}, {}, shown);
    for (std::int32_t n = 0; n < count; ++n)
        ASSERT_EQ(paint->pixels[std::size_t(n)].a > 0, coloured.contains(n));
}

TEST(FindingPaint, WhatIsSmallerThanAPixelHasThoseAroundIt) {
    // As a head on a long stalk is, which a conformal map shrinks.
    const auto& facets = painter()->sight().facets();
    for (const std::size_t t : {facets.size() / 3, facets.size() / 2}) {
        Findings all;
        all.grid = grid();
        Finding head;
        head.positionMm = painter()->sight().originMm() + glm::dvec3(facets[t].middleMm);
        head.diameterMm = 0.01;
        all.findings = {head};
        const auto pixels = findingPixels(*painter(), all);
        ASSERT_EQ(pixels.size(), 4u);
        const glm::dvec2 size(painter()->size());
        for (const FindingPixel& pixel : pixels) {
            EXPECT_EQ(pixel.finding, 0);
            const glm::dvec2 center(pixel.pixel % int(size.x) + 0.5,
                                    pixel.pixel / int(size.x) + 0.5);
            glm::dvec2 off = center - (size - glm::dvec2(facets[t].flat) * size.x);
            off.x -= size.x * std::round(off.x / size.x);
            EXPECT_LE(std::max(std::abs(off.x), std::abs(off.y)), 1.001);
        }
    }
}

}  // namespace
}  // namespace haustra::tests
