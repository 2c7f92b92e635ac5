#include "cad/standing_height.h"

#include "cad/wall_quadric.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace haustra::cad {
namespace {

// Around a foot at distance s from the patch the wall's circles grow by 2π a millimetre, while a
// stalk, and the side of what has none, keep theirs: where they are twice the least one c, the
// foot is c/2π behind. By rings of this width it is found up to a millimetre too far out, even on a
// plane. Looked for so far.
constexpr double longestStalkMm = 18.0, ringMm = 0.5;
// The wall around begins beyond the fillet at the foot, and ends where it bends anew.
constexpr double wallFromMm = 1.5, wallToMm = 10.0, footWidthMm = 1.0;
// Of the area's normals, as in a wall; less where they face each other, as in a narrow tube.
constexpr double leastMeanNormal = 0.2;
// A fiftieth of the patch may be noise.
constexpr double topShare = 0.98;
// A colon's wall is hollow; what bends the other way, in 1/mm, is a fold, and the quadric cuts its
// crest.
constexpr double foldBend = -0.02;
// Where the quadric misses the wall around by more, folds are near. A film D wide lies up to
// D²/16r above the wall of a tube of radius r, and hangs from the side of what it does not enclose.
// Both tuned on twenty training phantoms.
constexpr double goodFitMm = 0.5, mostBeneathFilm = 0.15;
// Across a patch as wide as the colon a quadric goes anywhere; no film lies so far above the wall.
constexpr double mostBeneathFilmMm = 5.0;

// From the patch along the wall, by the distances of samples as widen() has numbered them. None
// where the circles never grow so much.
std::optional<double> footDistanceMm(const WallSamples& wall, const SampleNumbers& numbers,
                                     const std::vector<double>& distances, std::size_t patch) {
    std::vector<double> circle(std::size_t(longestStalkMm / ringMm), 0.0);
    for (std::size_t n = patch; n < distances.size(); ++n) {
        const auto ring = std::size_t(distances[n] / ringMm);
        if (ring < circle.size())
            circle[ring] += wall.areaMm2[numbers.sample(std::uint32_t(n))] / ringMm;
    }
    double least = circle[1];  // the first is cut by the patch's rim
    for (std::size_t ring = 1; ring < circle.size() && circle[ring] > 0.0; ++ring) {
        if (circle[ring] > 2.0 * least)
            return std::max(0.0, ringMm * (double(ring) + 0.5) - least / (2.0 * std::numbers::pi));
        least = std::min(least, circle[ring]);
    }
    return std::nullopt;
}

}  // namespace

double standingHeightMm(const WallEvidence& evidence, const Lesion& lesion,
                        SampleNumbers& numbers) {
    const WallSamples& wall = evidence.samples;
    const auto& patch = lesion.patch.samples;
    const double film = std::max(0.0, lesion.heightMm);
    const auto distances = widen(wall, patch, longestStalkMm + wallToMm, numbers);
    const auto found = footDistanceMm(wall, numbers, distances, patch.size());
    const double foot = found.value_or(0.0);
    glm::dvec3 origin(0.0), axis(0.0);
    double footMm2 = 0.0, aroundMm2 = 0.0;
    std::vector<std::uint32_t> around;
    for (std::size_t n = patch.size(); n < distances.size(); ++n) {
        const std::uint32_t v = numbers.sample(std::uint32_t(n));
        const double beyond = distances[n] - foot, mm2 = wall.areaMm2[v];
        if (evidence.unseen[v] || evidence.untagged[v]) continue;
        if (beyond >= 0.0 && beyond < footWidthMm)
            origin += mm2 * wall.mesh.vertices[v], footMm2 += mm2;
        if (beyond <= wallFromMm || beyond > wallToMm) continue;
        axis -= mm2 * glm::dvec3(evidence.shapes[v].intoWall);
        aroundMm2 += mm2;
        around.push_back(v);
    }
    if (footMm2 <= 0.0 || aroundMm2 <= 0.0 || glm::length(axis) < leastMeanNormal * aroundMm2)
        return film;
    const auto quadric = quadricThrough(evidence, around, glm::normalize(axis), origin / footMm2);
    if (!quadric) return film;
    const bool isFold = quadric->leastBend() < foldBend;
    // Beneath the fillet, whatever the quadric tells.
    const glm::dvec3 root(0.0, 0.0, std::clamp(quadric->terms[0], -wallFromMm, wallFromMm));
    std::vector<double> above;
    double way = 0.0;
    for (const std::uint32_t v : patch) {
        const glm::dvec3 place = quadric->placeOf(onScanSurface(evidence, v));
        above.push_back(quadric->heightMm(place));
        way = std::max(way, glm::distance(place, root));
    }
    if (standsOnStalk(lesion) && found && !isFold)
        return std::min(way, foot + footWidthMm + lesion.diameter.mm);
    const double top = quantileOf(above, topShare);
    if (isFold) return std::clamp(top, 0.0, film);
    if (quadric->roughMm < goodFitMm) return std::clamp(top, 0.0, film + mostBeneathFilmMm);
    return std::clamp(top, film,
                      film + std::min(mostBeneathFilmMm, mostBeneathFilm * lesion.diameter.mm));
}

}  // namespace haustra::cad
