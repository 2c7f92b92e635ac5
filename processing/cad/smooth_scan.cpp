#include "cad/smooth_scan.h"

#include "cad/gaussian_kernel.h"
#include "core/crop.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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
    std::array<float, 4> value, first, second;
    explicit SplineWeights(float f) {
        const float g = 1.0f - f;
        value = {g * g * g / 6.0f, (4.0f - 6.0f * f * f + 3.0f * f * f * f) / 6.0f,
                 (4.0f - 6.0f * g * g + 3.0f * g * g * g) / 6.0f, f * f * f / 6.0f};
        first = {-0.5f * g * g, f * (1.5f * f - 2.0f), -g * (1.5f * g - 2.0f), 0.5f * f * f};
        second = {g, 3.0f * f - 2.0f, 3.0f * g - 2.0f, f};
    }
};

struct Place {
    glm::ivec3 first;
    glm::vec3 between;
};
Place placeIn(const Grid& grid, glm::dvec3 voxel) {
    const glm::dvec3 p =
        glm::clamp(voxel, glm::dvec3(1.0), glm::dvec3(grid.size - 2) - glm::dvec3(1e-9));
    const glm::ivec3 low(p);  // p > 0
    return {low - 1, glm::vec3(p - glm::dvec3(low))};
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
            plane += double(y.value[std::size_t(j)] * (x.value[0] * c[0] + x.value[1] * c[1] +
                                                       x.value[2] * c[2] + x.value[3] * c[3]));
        }
        sum += double(z.value[std::size_t(k)]) * plane;
    }
    return sum;
}

Derivatives SmoothScan::derivatives(glm::dvec3 patientMm) const {
    const Place place =
        placeIn(smooth_.grid(), glm::dvec3(voxelFromPatient_ * glm::dvec4(patientMm, 1.0)));
    const SplineWeights x(place.between.x), y(place.between.y), z(place.between.z);
    const float* const first = smooth_.voxels().data() + smooth_.grid().index(place.first);
    // Sums over j and k, of all four i at once.
    FourFloats c{}, cy{}, cz{}, cyy{}, cyz{}, czz{};
    for (std::size_t k = 0; k < 4; ++k) {
        FourFloats p{}, py{}, pyy{};
        for (std::size_t j = 0; j < 4; ++j) {
            FourFloats row;
            std::memcpy(&row, first + k * slice_ + j * row_, sizeof row);
            p += y.value[j] * row, py += y.first[j] * row, pyy += y.second[j] * row;
        }
        c += z.value[k] * p, cy += z.value[k] * py, cyy += z.value[k] * pyy;
        cz += z.first[k] * p, cyz += z.first[k] * py;
        czz += z.second[k] * p;
    }
    const auto along = [](const std::array<float, 4>& weights, const FourFloats& sums) {
        return double(weights[0] * sums[0] + weights[1] * sums[1] + weights[2] * sums[2] +
                      weights[3] * sums[3]);
    };
    const double fxy = along(x.first, cy), fxz = along(x.first, cz), fyz = along(x.value, cyz);
    const glm::dmat3 hessian(along(x.second, c), fxy, fxz,   //
                             fxy, along(x.value, cyy), fyz,  //
                             fxz, fyz, along(x.value, czz));
    const glm::dvec3 gradient(along(x.first, c), along(x.value, cy), along(x.value, cz));
    const glm::dmat3 back = glm::transpose(turn_);
    return {along(x.value, c), back * gradient, back * hessian * turn_};
}

}  // namespace haustra::cad
