// A prepared colon of one ball of gas whose wall has polyps and nothing else, all by formula.
#pragma once

#include "cad/wall_evidence.h"
#include "core/ct_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haustra::tests {

inline constexpr double lumenMm = 20.0;  // radius of a ball of gas

struct Bump {
    glm::dvec3 centerMm;  ///< of a ball of tissue
    double radiusMm;
};

inline const std::vector<Bump> bumps{{{0, 0, 18.5}, 4.0}, {{-18.0, 0, -2}, 3.2}};

/// Negative in the lumen. The creases between ball and bumps are rounded.
inline double wallMm(glm::dvec3 p, const std::vector<Bump>& onIt) {
    double d = glm::length(p) - lumenMm;
    for (const Bump& bump : onIt) {
        const double other = bump.radiusMm - glm::distance(p, bump.centerMm);
        const double h = std::max(0.0, 1.0 - std::abs(d - other) / 1.0);
        d = std::max(d, other) + 0.25 * h * h;
    }
    return d;
}

/// Prepared as the pipeline would, but by formula: a surface whose vertices lie where the wall is.
struct BallColon {
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> lumen;
    TriMesh surface;
    FlatMap flat;
    Centerline centerline;
    TissueModel tissue;

    // `turn`: a turn of the body about z; `shift`: of the grid and body by whole voxels.
    explicit BallColon(glm::dmat3 turn = glm::dmat3(1.0), glm::ivec3 shift = glm::ivec3(0),
                       double offsetHu = 0.0, const std::vector<Bump>& onIt = bumps,
                       glm::dvec3 spacingMm = glm::dvec3(0.75)) {
        const Grid grid =
            axisAlignedGrid(glm::ivec3(60.0 / spacingMm), spacingMm, {-29.5, -29.5, -29.5});
        hu = Volume<std::int16_t>(grid), lumen = Volume<std::uint8_t>(grid);
        const glm::dvec3 movedMm = spacingMm * glm::dvec3(shift);
        const glm::dmat3 back = glm::transpose(turn);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const double d = wallMm(
                back * (grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))) - movedMm), onIt);
            hu.writable()[n] =
                std::int16_t(std::lround(40.0 + offsetHu - 1030.0 / (1.0 + std::exp(d / 0.5))));
            lumen.writable()[n] = std::uint8_t(d < 0.0 ? LumenLabel::air : LumenLabel::outside);
        }
        tissue.meanHu = {-990.0 + offsetHu, -100.0 + offsetHu, 40.0 + offsetHu, 600.0 + offsetHu};
        tissue.airBelowHu = -475.0 + offsetHu;
        makeSurface(turn, movedMm, onIt);
        for (int n = -15; n <= 15; ++n)
            centerline.points.push_back(
                {turn * glm::dvec3(0, n, 0) + movedMm, double(n + 15), 5.0, false});
        flat.height = 1.0;
    }

    // An octahedron, divided, each vertex on its ray where the wall begins.
    void makeSurface(glm::dmat3 turn, glm::dvec3 movedMm, const std::vector<Bump>& onIt) {
        surface.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                             {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
        const cad::WallSamples fine = cad::sampleWall(surface, 0.025);
        surface = fine.mesh;
        for (glm::dvec3& v : surface.vertices) {
            const glm::dvec3 way = glm::normalize(v);
            double low = 5.0, high = lumenMm + 5.0;
            for (int step = 0; step < 40; ++step) {
                const double middle = 0.5 * (low + high);
                (wallMm(middle * way, onIt) < 0.0 ? low : high) = middle;
            }
            v = turn * (low * way) + movedMm;
        }
    }

    cad::PreparedColon colon() const {
        return {hu, hu, lumen, surface, flat, centerline, tissue, {}, {}};
    }
};

}  // namespace haustra::tests
