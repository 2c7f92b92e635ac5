#include "cad/residue_film.h"

#include "cad/wall_edges.h"
#include "core/ct_scan.h"
#include "core/normal_distribution.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haustra::cad {
namespace {

constexpr double brighterThanTissueHu = 60.0;
// From where tagging shows its own HU.
constexpr int deepVoxels = 3;
// A median of fewer says nothing.
constexpr std::size_t fewest = 100;
constexpr double thicknessStepMm = 0.1;
constexpr int thicknesses = 40;
constexpr double profileStepMm = 0.25, profileMm = 6.0;
// Where a film is as bright at the latest: at twice the blur behind the surface the faintest are at
// their brightest.
constexpr double latestBlurs = 2.5;

// In the middle of fluid: of every other voxel along each axis, those that have tagging that far
// off to all six sides.
std::optional<double> deepTaggedHu(const PreparedColon& colon) {
    const Grid& grid = colon.lumen.grid();
    const auto tagged = [&](glm::ivec3 v) {
        return LumenLabel(colon.lumen.at(v)) == LumenLabel::tagged;
    };
    std::vector<double> hu;
    glm::ivec3 v;
    for (v.z = deepVoxels; v.z < grid.size.z - deepVoxels; v.z += 2) {
        for (v.y = deepVoxels; v.y < grid.size.y - deepVoxels; v.y += 2) {
            for (v.x = deepVoxels; v.x < grid.size.x - deepVoxels; v.x += 2) {
                if (!tagged(v)) continue;
                bool deep = true;
                for (int axis = 0; axis < 3 && deep; ++axis) {
                    glm::ivec3 step(0);
                    step[axis] = deepVoxels;
                    deep = tagged(v - step) && tagged(v + step);
                }
                if (deep) hu.push_back(colon.ct.at(v));
            }
        }
    }
    if (hu.size() < fewest) return std::nullopt;
    return medianOf(hu);
}

// Standard deviation of the blur across the wall's edge: in the median of its places, by how fast
// the HU rise through the surface.
std::optional<double> edgeBlurMm(const PreparedColon& colon, const WallEvidence& evidence) {
    constexpr double offMm = 0.5;
    const glm::dmat4 voxelFromPatient = colon.cleansed.grid().voxelFromPatient();
    const EdgeScale scale = edgeScale(colon, evidence);
    std::vector<double> blurs;
    for (const EdgeLine& line : edgeLines(evidence)) {
        const auto share = [&](double mm) {
            const glm::dvec3 voxel(voxelFromPatient * glm::dvec4(line.at(mm), 1.0));
            return scale.shareOf(trilinear(colon.cleansed, voxel));
        };
        const double before = share(-offMm), behind = share(offMm);
        if (before < 0.02 || behind > 0.98 || behind <= before) continue;
        blurs.push_back(2.0 * offMm / (normalQuantile(behind) - normalQuantile(before)));
    }
    if (blurs.size() < fewest) return std::nullopt;
    return medianOf(blurs);
}

}  // namespace

ResidueFilms::ResidueFilms(const PreparedColon& colon, const WallEvidence& evidence)
    : softHu_(evidence.statistics.wallHu) {
    const auto tagged = deepTaggedHu(colon);
    if (!tagged || *tagged < softHu_ + 2.0 * brighterThanTissueHu) return;
    const auto blur = edgeBlurMm(colon, evidence);
    if (!blur) return;
    taggedHu_ = *tagged, blurMm_ = *blur;
    const double gas = edgeScale(colon, evidence).gasHu;
    for (int n = 0; n <= thicknesses; ++n) {
        const double e = n * thicknessStepMm;
        const auto hu = [&](double mm) {
            return gas + (taggedHu_ - gas) * normalCdf(mm / blurMm_) -
                   (taggedHu_ - softHu_) * normalCdf((mm - e) / blurMm_);
        };
        constexpr double stepMm = 0.01;
        double crossesMm = -3.0 * blurMm_, peak = softHu_;
        while (crossesMm < e + 3.0 * blurMm_ && hu(crossesMm) < colon.tissue.airBelowHu)
            crossesMm += stepMm;
        for (double mm = crossesMm; mm < e + 3.0 * blurMm_; mm += 5.0 * stepMm)
            peak = std::max(peak, hu(mm));
        peakHu_.push_back(peak);
        liftsMm_.push_back(e - crossesMm);
    }
}

double ResidueFilms::liftMm(const PreparedColon& colon, const WallEvidence& evidence,
                            const Patch& patch) const {
    if (taggedHu_ == 0.0) return 0.0;
    constexpr std::size_t mostRays = 250;
    const auto steps = std::size_t(profileMm / profileStepMm) + 1;
    const glm::dmat4 voxelFromPatient = colon.cleansed.grid().voxelFromPatient();
    const std::size_t stride = (patch.samples.size() + mostRays - 1) / mostRays;
    std::vector<double> hu(steps, 0.0);
    double area = 0.0;
    for (std::size_t n = 0; n < patch.samples.size(); n += stride) {
        const std::uint32_t v = patch.samples[n];
        const glm::dvec3 at(voxelFromPatient * glm::dvec4(evidence.samples.mesh.vertices[v], 1.0)),
            step(voxelFromPatient *
                 glm::dvec4(profileStepMm * glm::dvec3(evidence.shapes[v].intoWall), 0.0));
        const double mm2 = evidence.samples.areaMm2[v];
        area += mm2;
        for (std::size_t s = 0; s < steps; ++s)
            hu[s] += mm2 * trilinear(colon.cleansed, at + double(s) * step);
    }
    for (double& value : hu)
        value /= area;
    // Bright right behind the surface, and not for long.
    const double brightHu = softHu_ + brighterThanTissueHu;
    const auto bright = [&](double value) { return value >= brightHu; };
    const auto begin = std::find_if(hu.begin(), hu.end(), bright);
    const auto end = std::find_if_not(begin, hu.end(), bright);
    if (end == hu.end() || profileStepMm * double(begin - hu.begin()) > latestBlurs * blurMm_)
        return 0.0;
    const auto peak = std::max_element(begin, end);
    const auto thicker = std::lower_bound(peakHu_.begin(), peakHu_.end(), *peak);
    if (thicker == peakHu_.begin()) return 0.0;
    const std::size_t n = std::min(std::size_t(thicker - peakHu_.begin()), peakHu_.size() - 1);
    const double share =
        std::clamp((*peak - peakHu_[n - 1]) / (peakHu_[n] - peakHu_[n - 1]), 0.0, 1.0);
    double lift = std::lerp(liftsMm_[n - 1], liftsMm_[n], share);
    const double half = 0.5 * (softHu_ + taggedHu_);
    if (*peak > half) {
        const auto last = std::find_if(peak, hu.end(), [&](double value) { return value < half; });
        const double past = (half - *last) / (*(last - 1) - *last);
        lift = std::max(lift, profileStepMm * (double(last - hu.begin()) - past));
    }
    return lift;
}

double heightWithoutResidue(double topMm, double meanMm, double residueMm) {
    if (residueMm <= 0.0) return topMm;
    return meanMm > 0.0 ? topMm * std::max(0.0, 1.0 - residueMm / meanMm) : 0.0;
}

}  // namespace haustra::cad
