#include "cad/edge_softening.h"

#include "cad/gaussian_kernel.h"
#include "core/crop.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace haustra::cad {
namespace {

constexpr std::size_t terms = 12;
using Weights = std::array<double, terms>;

// Of the series; the last term stands for all that follow, so that an even scan stays as it is.
Weights weightsOf(double strength) {
    Weights weights;
    const double ratio = strength / (1.0 + strength);
    double left = 1.0;
    for (std::size_t k = 0; k < terms; ++k) {
        weights[k] = k + 1 < terms ? left / (1.0 + strength) : left;
        left *= ratio;
    }
    return weights;
}

// One more G, within the slices.
void blur(Volume<float>& scan, int threads) {
    const std::vector<float> kernel = gaussianKernel(1.0);
    const int reach = int(kernel.size()) / 2;
    const glm::ivec3 size = scan.grid().size;
    const std::size_t length = std::size_t(size.x);
    const auto values = scan.writable();
    parallelFor(std::size_t(size.z), 2, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> row(length + 2 * std::size_t(reach)),
            slice(length * std::size_t(size.y));
        for (std::size_t k = begin; k < end; ++k) {
            float* const in = &values[scan.grid().index(0, 0, int(k))];
            for (std::size_t j = 0; j < std::size_t(size.y); ++j) {
                for (int i = -reach; i < size.x + reach; ++i)
                    row[std::size_t(i + reach)] =
                        in[j * length + std::size_t(std::clamp(i, 0, size.x - 1))];
                weightedSum(
                    kernel, [&](int n) { return &row[std::size_t(reach + n)]; }, size.x,
                    &slice[j * length]);
            }
            for (int j = 0; j < size.y; ++j)
                weightedSum(
                    kernel,
                    [&](int n) {
                        return &slice[std::size_t(std::clamp(j + n, 0, size.y - 1)) * length];
                    },
                    size.x, in + std::size_t(j) * length);
        }
    });
}

// Calls visit(k, Gᵏ v) for the series' terms.
template <class Visit>
void forPowers(const Volume<std::int16_t>& hu, const VoxelBox& box, int threads,
               const Visit& visit) {
    const Volume<std::int16_t> part = cropped(hu, box, threads);
    Volume<float> power(part.grid());
    std::copy(part.voxels().begin(), part.voxels().end(), power.writable().begin());
    for (std::size_t k = 0; k < terms; ++k) {
        if (k > 0) blur(power, threads);
        visit(k, std::as_const(power));
    }
}

// The lines into the wall, as wallEdges looks along them, and the HU along each in each term.
struct Profiles {
    std::vector<EdgeLine> lines;
    std::array<std::vector<float>, terms> hu;  // of each line's depths
};

double peakAt(const Profiles& profiles, double strength, const EdgeScale& scale) {
    const Weights weights = weightsOf(strength);
    std::vector<double> peaks;
    for (std::size_t line = 0; line < profiles.lines.size(); ++line) {
        double most = 0.0;
        for (std::size_t d = 0; d < edgeDepths; ++d) {
            double hu = 0.0;
            for (std::size_t k = 0; k < terms; ++k)
                hu += weights[k] * double(profiles.hu[k][line * edgeDepths + d]);
            most = std::max(most, scale.shareOf(hu));
        }
        peaks.push_back(most);
    }
    return medianOf(peaks);
}

// The least that brings the peak down to what is usual.
double strengthOf(const Profiles& profiles, const EdgeScale& scale) {
    constexpr double most = 4.0;
    double low = 0.0, high = most;
    if (peakAt(profiles, most, scale) > usualPeak) return most;
    for (int n = 0; n < 20; ++n) {
        const double middle = 0.5 * (low + high);
        (peakAt(profiles, middle, scale) > usualPeak ? low : high) = middle;
    }
    return high;
}

}  // namespace

std::optional<SoftenedScan> softened(const PreparedColon& colon, const WallEvidence& evidence,
                                     const WallEdges& edges, int threads) {
    if (edges.peak <= sharpPeak) return std::nullopt;
    const Grid& grid = colon.cleansed.grid();
    glm::dvec3 low(1e30), high(-1e30);
    for (const glm::dvec3& p : colon.surface.vertices) {
        const glm::dvec3 voxel = grid.voxelFromPatientPoint(p);
        low = glm::min(low, voxel), high = glm::max(high, voxel);
    }
    const glm::ivec3 last = grid.size - 1;
    const VoxelBox box = boxWithin(grid, glm::clamp(glm::ivec3(low), glm::ivec3(0), last),
                                   glm::clamp(glm::ivec3(high) + 1, glm::ivec3(0), last),
                                   glm::dvec3(biopsyStepMm * biopsySteps + 4.0));
    const EdgeScale scale = edgeScale(colon, evidence);
    Profiles profiles;
    profiles.lines = edgeLines(evidence);
    forPowers(colon.cleansed, box, threads, [&](std::size_t k, const Volume<float>& power) {
        const glm::dmat4 voxelFromPatient = power.grid().voxelFromPatient();
        for (const EdgeLine& line : profiles.lines)
            for (std::size_t d = 0; d < edgeDepths; ++d)
                profiles.hu[k].push_back(float(trilinear(
                    power, glm::dvec3(voxelFromPatient * glm::dvec4(line.at(edgeDepth(d)), 1.0)))));
    });
    const Weights weights = weightsOf(strengthOf(profiles, scale));
    Volume<float> sum(cropped(grid, box), 0.0f);
    forPowers(colon.cleansed, box, threads, [&](std::size_t k, const Volume<float>& power) {
        const auto out = sum.writable();
        forVoxels(sum.grid(), threads,
                  [&](std::size_t n, glm::ivec3) { out[n] += float(weights[k]) * power[n]; });
    });
    SoftenedScan made{colon.ct.clone(), colon.cleansed.clone()};
    const auto cleansed = made.cleansed.writable(), ct = made.ct.writable();
    forVoxels(sum.grid(), threads, [&](std::size_t n, glm::ivec3 v) {
        const std::size_t at = grid.index(box.lo + v);
        const int before = cleansed[at], after = int(std::lround(sum[n]));
        cleansed[at] = std::int16_t(after);
        ct[at] = std::int16_t(std::clamp(int(ct[at]) + after - before, -32768, 32767));
    });
    return made;
}

}  // namespace haustra::cad
