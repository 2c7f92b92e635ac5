#include "cad/smooth_scan.h"

#include "cad/gaussian_kernel.h"
#include "core/crop.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace haustra::cad {
namespace {

// Rows along i, then columns along j, slice by slice.
void smoothSlices(const Volume<std::int16_t>& hu, const VoxelBox& box,
                  const std::array<std::vector<float>, 3>& kernels, Volume<float>& out,
                  int threads) {
    const glm::ivec3 size = box.size;
    const auto values = out.writable();
    parallelFor(std::size_t(size.z), 2, threads, [&](std::size_t begin, std::size_t end) {
        const int rx = int(kernels[0].size()) / 2;
        std::vector<float> row(std::size_t(size.x + 2 * rx)),
            slice(std::size_t(size.x) * std::size_t(size.y));
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < size.y; ++j) {
                const std::int16_t* in =
                    &hu.voxels()[hu.grid().index(box.lo + glm::ivec3(0, j, int(k)))];
                for (int i = -rx; i < size.x + rx; ++i)
                    row[std::size_t(i + rx)] = float(in[std::clamp(i, 0, size.x - 1)]);
                weightedSum(
                    kernels[0], [&](int n) { return &row[std::size_t(rx + n)]; }, size.x,
                    &slice[std::size_t(j) * std::size_t(size.x)]);
            }
            for (int j = 0; j < size.y; ++j)
                weightedSum(
                    kernels[1],
                    [&](int n) {
                        return &slice[std::size_t(std::clamp(j + n, 0, size.y - 1)) *
                                      std::size_t(size.x)];
                    },
                    size.x, &values[out.grid().index(0, j, int(k))]);
        }
    });
}

void smoothAcross(const std::vector<float>& kernel, Volume<float>& volume, int threads) {
    if (kernel.size() == 1) return;
    const glm::ivec3 size = volume.grid().size;
    const auto values = volume.writable();
    parallelFor(std::size_t(size.y), 4, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> sheet(std::size_t(size.x) * std::size_t(size.z));
        for (std::size_t j = begin; j < end; ++j) {
            for (int k = 0; k < size.z; ++k)
                std::copy_n(&values[volume.grid().index(0, int(j), k)], size.x,
                            &sheet[std::size_t(k) * std::size_t(size.x)]);
            for (int k = 0; k < size.z; ++k)
                weightedSum(
                    kernel,
                    [&](int n) {
                        return &sheet[std::size_t(std::clamp(k + n, 0, size.z - 1)) *
                                      std::size_t(size.x)];
                    },
                    size.x, &values[volume.grid().index(0, int(j), k)]);
        }
    });
}

// Weights of the four coefficients around a place between the second and the third, and their first
// and second derivatives, of a uniform cubic B-spline.
struct SplineWeights {
    std::array<double, 4> value, first, second;
    explicit SplineWeights(double f) {
        const double g = 1.0 - f;
        value = {g * g * g / 6.0, (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0,
                 (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0, f * f * f / 6.0};
        first = {-0.5 * g * g, f * (1.5 * f - 2.0), -g * (1.5 * g - 2.0), 0.5 * f * f};
        second = {g, 3.0 * f - 2.0, 3.0 * g - 2.0, f};
    }
};

struct Place {
    glm::ivec3 first;
    glm::dvec3 between;
};
Place placeIn(const Grid& grid, glm::dvec3 voxel) {
    const glm::dvec3 p =
        glm::clamp(voxel, glm::dvec3(1.0), glm::dvec3(grid.size - 2) - glm::dvec3(1e-9));
    const glm::dvec3 low = glm::floor(p);
    return {glm::ivec3(low) - 1, p - low};
}

}  // namespace

SmoothScan::SmoothScan(const Volume<std::int16_t>& hu, glm::dvec3 lowMm, glm::dvec3 highMm,
                       double sigmaMm, int threads) {
    const Grid& grid = hu.grid();
    glm::dvec3 lo(1e30), hi(-1e30);
    for (int n = 0; n < 8; ++n) {
        const glm::dvec3 corner(n & 1 ? highMm.x : lowMm.x, n & 2 ? highMm.y : lowMm.y,
                                n & 4 ? highMm.z : lowMm.z);
        const glm::dvec3 voxel = grid.voxelFromPatientPoint(corner);
        lo = glm::min(lo, voxel), hi = glm::max(hi, voxel);
    }
    const glm::dvec3 last(grid.size - 1);
    VoxelBox box;
    box.lo = glm::ivec3(glm::clamp(glm::floor(lo) - 2.0, glm::dvec3(0.0), last));
    box.size = glm::ivec3(glm::clamp(glm::ceil(hi) + 2.0, glm::dvec3(0.0), last)) - box.lo + 1;
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::max(0, std::min(box.lo[axis], grid.size[axis] - leastVoxels));
        box.size[axis] =
            std::min(std::max(box.size[axis], leastVoxels), grid.size[axis] - box.lo[axis]);
    }
    std::array<std::vector<float>, 3> kernels;
    for (int axis = 0; axis < 3; ++axis) {
        const double sigma = sigmaMm / grid.spacingMm()[axis];
        kernels[std::size_t(axis)] =
            gaussianKernel(std::sqrt(std::max(0.0, sigma * sigma - 1.0 / 3.0)));
    }
    origin_ = box.lo;
    smooth_ = Volume<float>(cropped(grid, box));
    smoothSlices(hu, box, kernels, smooth_, threads);
    smoothAcross(kernels[2], smooth_, threads);
    row_ = std::size_t(box.size.x), slice_ = row_ * std::size_t(box.size.y);
    voxelFromPatient_ = smooth_.grid().voxelFromPatient();
    turn_ = glm::dmat3(voxelFromPatient_);
}

glm::dvec3 SmoothScan::gradient(glm::dvec3 patientMm) const {
    const glm::vec3 voxel(voxelFromPatient_ * glm::dvec4(patientMm, 1.0));
    glm::dvec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 off(0.0f);
        off[axis] = 0.75f;
        difference[axis] = double(linear(voxel + off) - linear(voxel - off)) / 1.5;
    }
    return glm::transpose(turn_) * difference;
}

double SmoothScan::at(glm::dvec3 patientMm) const {
    const Grid& grid = smooth_.grid();
    const Place place = placeIn(grid, glm::dvec3(voxelFromPatient_ * glm::dvec4(patientMm, 1.0)));
    const SplineWeights x(place.between.x), y(place.between.y), z(place.between.z);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        double plane = 0.0;
        for (int j = 0; j < 4; ++j) {
            const float* c = &smooth_.voxels()[grid.index(place.first + glm::ivec3(0, j, k))];
            plane += y.value[std::size_t(j)] * (x.value[0] * c[0] + x.value[1] * c[1] +
                                                x.value[2] * c[2] + x.value[3] * c[3]);
        }
        sum += z.value[std::size_t(k)] * plane;
    }
    return sum;
}

Derivatives SmoothScan::derivatives(glm::dvec3 patientMm) const {
    const Grid& grid = smooth_.grid();
    const Place place = placeIn(grid, glm::dvec3(voxelFromPatient_ * glm::dvec4(patientMm, 1.0)));
    const SplineWeights x(place.between.x), y(place.between.y), z(place.between.z);
    double f = 0, fx = 0, fy = 0, fz = 0, fxx = 0, fxy = 0, fxz = 0, fyy = 0, fyz = 0, fzz = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        double p = 0, px = 0, py = 0, pxx = 0, pxy = 0, pyy = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const float* c =
                &smooth_.voxels()[grid.index(place.first + glm::ivec3(0, int(j), int(k)))];
            double r = 0, rx = 0, rxx = 0;
            for (std::size_t i = 0; i < 4; ++i)
                r += x.value[i] * c[i], rx += x.first[i] * c[i], rxx += x.second[i] * c[i];
            p += y.value[j] * r, px += y.value[j] * rx, pxx += y.value[j] * rxx;
            py += y.first[j] * r, pxy += y.first[j] * rx, pyy += y.second[j] * r;
        }
        f += z.value[k] * p, fx += z.value[k] * px, fy += z.value[k] * py;
        fxx += z.value[k] * pxx, fxy += z.value[k] * pxy, fyy += z.value[k] * pyy;
        fz += z.first[k] * p, fxz += z.first[k] * px, fyz += z.first[k] * py;
        fzz += z.second[k] * p;
    }
    const glm::dmat3 hessian(fxx, fxy, fxz, fxy, fyy, fyz, fxz, fyz, fzz),
        back = glm::transpose(turn_);
    return {f, back * glm::dvec3(fx, fy, fz), back * hessian * turn_};
}

}  // namespace haustra::cad
