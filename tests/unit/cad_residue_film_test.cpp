// Tagged residue on the wall of a lumen, by formula: what of it detection takes for none of the
// body's.
#include "ball_colon.h"
#include "cad/candidates.h"
#include "cad/detect.h"
#include "cad/residue_film.h"
#include "core/normal_distribution.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

using tests::BallColon;
using tests::Bump;
using tests::lumenMm;

constexpr double gasHu = -990.0, softHu = 40.0, taggedHu = 400.0;

// A layer on the wall around the ball's top, thinning out to nothing at 8 mm from it.
struct Layer {
    double thickMm;
    double hu;
};
double thickness(glm::dvec3 p, const Layer& layer) {
    const double off = glm::distance(lumenMm * glm::normalize(p), {0, 0, lumenMm}) / 8.0;
    return layer.thickMm * std::max(0.0, 1.0 - off * off);
}

// A colon with one bump or none beneath the layer, blurred; and a pool at its bottom, cleansed.
struct CoatedColon {
    BallColon ball;
    Volume<std::int16_t> scanned;
    double blurMm;
    Layer layer;
    std::vector<Bump> bumps;
    double behindMm;  // how deep in the tissue what is as bright as tagging begins

    CoatedColon(Layer with, std::vector<Bump> on, double blur, bool pool = true,
                double behind = 1e3)
        : ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, on),
          blurMm(blur),
          layer(with),
          bumps(on),
          behindMm(behind) {
        const Grid& grid = ball.hu.grid();
        for (std::size_t n = 0; n < grid.voxelCount(); ++n)
            ball.hu.writable()[n] = std::int16_t(std::lround(hu(at(grid, n))));
        scanned = ball.hu.clone();
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (!pool || !ball.lumen[n] || at(grid, n).z > -6.0) continue;
            ball.lumen.writable()[n] = std::uint8_t(LumenLabel::tagged);
            scanned.writable()[n] = std::int16_t(taggedHu);
        }
        // The surface is where the blurred scan has it.
        for (glm::dvec3& v : ball.surface.vertices) {
            const glm::dvec3 way = glm::normalize(v);
            double low = 5.0, high = lumenMm + 5.0;
            for (int step = 0; step < 40; ++step) {
                const double middle = 0.5 * (low + high);
                (hu(middle * way) < ball.tissue.airBelowHu ? low : high) = middle;
            }
            v = low * way;
        }
    }
    static glm::dvec3 at(const Grid& grid, std::size_t n) {
        return grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
    }
    double hu(glm::dvec3 p) const {
        const double d = tests::wallMm(p, bumps), e = thickness(p, layer);
        return gasHu + (layer.hu - gasHu) * normalCdf((d + e) / blurMm) -
               (layer.hu - softHu) * normalCdf(d / blurMm) +
               (taggedHu - softHu) * normalCdf((d - behindMm) / blurMm);
    }
    cad::PreparedColon colon() const {
        const cad::PreparedColon plain = ball.colon();
        return {scanned,          plain.cleansed, plain.lumen,  plain.surface, plain.flat,
                plain.centerline, plain.tissue,   plain.pieces, plain.rebuilt};
    }
};

cad::Patch aroundTheTop(const cad::WallEvidence& evidence, double radiusMm) {
    cad::Patch patch;
    const auto& places = evidence.samples.mesh.vertices;
    for (std::uint32_t v = 0; v < places.size(); ++v)
        if (places[v].z > 0.0 && glm::length(glm::dvec2(places[v])) < radiusMm)
            patch.samples.push_back(v);
    return patch;
}

// How far the surface of a patch lies off the ball, in the mean.
double risesMm(const cad::WallEvidence& evidence, const cad::Patch& patch) {
    double sum = 0.0, area = 0.0;
    for (const std::uint32_t v : patch.samples) {
        const double mm2 = evidence.samples.areaMm2[v];
        sum += mm2 * (lumenMm - glm::length(evidence.samples.mesh.vertices[v])), area += mm2;
    }
    return sum / area;
}

double residueMm(const CoatedColon& coated, const cad::WallEvidence& evidence,
                 const cad::Patch& patch) {
    return cad::ResidueFilms(coated.colon(), evidence).liftMm(coated.colon(), evidence, patch);
}

TEST(ResidueFilm, IsAsFarInTheLumenAsItLiftsTheSurface) {
    for (const double blurMm : {0.7, 0.9}) {
        // Thinner ones than the blur by far, and one that shows its own HU.
        for (const double thickMm : {2.0, 2.6, 5.0}) {
            const CoatedColon coated({thickMm, taggedHu}, {}, blurMm);
            const auto evidence = cad::gatherEvidence(coated.colon(), {});
            const cad::Patch patch = aroundTheTop(evidence, 4.0);
            EXPECT_NEAR(residueMm(coated, evidence, patch), risesMm(evidence, patch),
                        0.25 + 0.1 * thickMm)
                << thickMm << " mm, blur " << blurMm;
        }
    }
}

TEST(ResidueFilm, NoTissueIsOne) {
    const std::vector<Bump> polyp{{{0, 0, 18.5}, 4.0}};
    for (const auto& bumps : {polyp, std::vector<Bump>{}}) {
        // As dense as the wall, or enhanced by contrast medium.
        for (const double hu : {softHu, softHu + 45.0}) {
            const CoatedColon coated({3.0, hu}, bumps, 0.8);
            const auto evidence = cad::gatherEvidence(coated.colon(), {});
            EXPECT_EQ(residueMm(coated, evidence, aroundTheTop(evidence, 4.0)), 0.0);
        }
    }
}

TEST(ResidueFilm, NeitherIsBoneNorALoopBehindTheWall) {
    for (const double behindMm : {1.0, 2.0, 3.0}) {
        // A flat lesion on the wall before it.
        const CoatedColon coated({2.5, softHu}, {}, 0.8, true, behindMm);
        const auto evidence = cad::gatherEvidence(coated.colon(), {});
        EXPECT_EQ(residueMm(coated, evidence, aroundTheTop(evidence, 4.0)), 0.0) << behindMm;
    }
}

TEST(ResidueFilm, IsNotToldWhereNoTaggingIsKnown) {
    const CoatedColon coated({2.0, taggedHu}, {}, 0.8, false);
    const auto evidence = cad::gatherEvidence(coated.colon(), {});
    EXPECT_EQ(residueMm(coated, evidence, aroundTheTop(evidence, 4.0)), 0.0);
}

TEST(ResidueFilm, OnTheBareWallIsNoCandidateAndOnAPolypTakesNothingAway) {
    const auto candidatesAtTheTop = [&](const CoatedColon& coated) {
        const auto evidence = cad::gatherEvidence(coated.colon(), {});
        std::vector<cad::Candidate> residue;
        auto found = cad::findCandidates(coated.colon(), evidence, nullptr, {}, nullptr, &residue);
        for (auto* some : {&found, &residue})
            std::erase_if(*some, [](const cad::Candidate& c) {
                return c.lesion.topMm.z < 8.0 || !cad::rises(c.features);
            });
        EXPECT_EQ(residue.empty(), !found.empty()) << "told as one or the other";
        return found.size();
    };
    const Layer film{2.4, taggedHu}, tissue{2.4, softHu};
    EXPECT_GT(candidatesAtTheTop(CoatedColon(tissue, {}, 0.8)), 0u) << "a flat lesion";
    EXPECT_EQ(candidatesAtTheTop(CoatedColon(film, {}, 0.8)), 0u);
    const std::vector<Bump> polyp{{{0, 0, 18.5}, 4.0}};
    EXPECT_GT(candidatesAtTheTop(CoatedColon(film, polyp, 0.8)), 0u);
}

TEST(ResidueFilm, WhatItTakesOfAHeightIsItsShareOfTheMean) {
    EXPECT_EQ(cad::heightWithoutResidue(2.0, 1.0, 0.0), 2.0);
    EXPECT_DOUBLE_EQ(cad::heightWithoutResidue(2.0, 1.0, 0.25), 1.5);
    EXPECT_EQ(cad::heightWithoutResidue(2.0, 1.0, 1.5), 0.0);
    EXPECT_EQ(cad::heightWithoutResidue(2.0, 0.0, 1.5), 0.0);
}

}  // namespace
