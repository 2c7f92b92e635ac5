// A scan at a chosen scale, with its derivatives at any place.
#pragma once

#include "cad/fours.h"
#include "core/volume.h"

#include <array>
#include <cstring>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Value, gradient and Hessian with respect to patient coordinates: HU, HU/mm, HU/mm².
struct Derivatives {
    double hu = 0.0;
    glm::dvec3 gradient{0.0};
    glm::dmat3 hessian{0.0};
};

/// The scan smoothed by about a Gaussian. The scan's voxels are taken as coefficients of a uniform
/// cubic B-spline, which is smooth enough for curvatures and by itself spreads each voxel with a
/// variance of a third of a voxel squared; what is missing to the scale that was asked for is added
/// beforehand. So voxels larger than √3 scales are smoothed more than was asked, by their own size.
/// Immutable; any number of threads.
class SmoothScan {
public:
    /// A cubic spline has four coefficients around a place.
    static constexpr int leastVoxels = 4;

    /// Of the part of the scan between two corners, patient coordinates (with a margin of two
    /// voxels where the scan goes on). The scan has `leastVoxels` along each axis at least.
    /// `sigmaMm` ≥ 0: of the Gaussian, along each axis. O(voxels · width).
    SmoothScan(const Volume<std::int16_t>& hu, glm::dvec3 lowMm, glm::dvec3 highMm, double sigmaMm,
               int threads);

    const Grid& grid() const { return smooth_.grid(); }
    double at(glm::dvec3 patientMm) const;
    Derivatives derivatives(glm::dvec3 patientMm) const;
    /// HU/mm, by differences of linear() over a voxel and a half along each axis: a little less
    /// smooth than the gradient of derivatives(), and much faster.
    glm::dvec3 gradient(glm::dvec3 patientMm) const;

    /// Of a place in voxels of grid(): linear between the smoothed voxels, clamped at the outermost
    /// ones. For long rays; without the spline's own share of the smoothing.
    float linear(glm::vec3 voxel) const {
        const glm::vec3 most(smooth_.grid().size - 1);
        const glm::vec3 inside = glm::clamp(voxel, glm::vec3(0.0f), most - glm::vec3(1e-3f));
        return linearWithin(FourFloats{inside.x, inside.y, inside.z, 0.0f});
    }
    /// The same of a place that is known to lie within it.
    float linearWithin(FourFloats voxel) const {
        const FourInts low = __builtin_convertvector(voxel, FourInts);
        const FourFloats f = voxel - __builtin_convertvector(low, FourFloats);
        const FourFloats plane = planeAt(low, f);
        const FourFloats line =
            plane + f[1] * (__builtin_shufflevector(plane, plane, 2, 3, 2, 3) - plane);
        return line[0] + f[0] * (line[1] - line[0]);
    }
    /// The same of four such places at once, to the bit.
    FourFloats linearWithin(const std::array<FourFloats, 4>& voxels) const {
        std::array<FourFloats, 4> between, planes;
        for (std::size_t n = 0; n < 4; ++n) {
            const FourInts low = __builtin_convertvector(voxels[n], FourInts);
            between[n] = voxels[n] - __builtin_convertvector(low, FourFloats);
            planes[n] = planeAt(low, between[n]);
        }
        const auto [x, y, z, unused] = transposed(between);
        const auto [p00, p10, p01, p11] = transposed(planes);
        const FourFloats left = p00 + y * (p01 - p00), right = p10 + y * (p11 - p10);
        return left + x * (right - left);
    }
    /// Whether linear() clamps nothing there.
    bool within(glm::vec3 voxel) const {
        const glm::vec3 most = glm::vec3(smooth_.grid().size - 1) - glm::vec3(1e-3f);
        return glm::all(glm::greaterThanEqual(voxel, glm::vec3(0.0f))) &&
               glm::all(glm::lessThanEqual(voxel, most));
    }
    const glm::dmat4& voxelFromPatient() const { return voxelFromPatient_; }
    /// The scan's voxel that voxel (0, 0, 0) of grid() is.
    glm::ivec3 origin() const { return origin_; }

private:
    using Pair = float __attribute__((vector_size(8)));

    // Between the two slices around a place, whose lowest voxel is `low` = (i, j, k) and which lies
    // `between` voxels: at (i, j), (i + 1, j), (i, j + 1) and (i + 1, j + 1).
    FourFloats planeAt(FourInts low, FourFloats between) const {
        const float* c = smooth_.voxels().data() + std::size_t(low[2]) * slice_ +
                         std::size_t(low[1]) * row_ + std::size_t(low[0]);
        const auto pairs = [&](const float* at) {
            Pair near, far;
            std::memcpy(&near, at, sizeof near), std::memcpy(&far, at + row_, sizeof far);
            return __builtin_shufflevector(near, far, 0, 1, 2, 3);
        };
        const FourFloats front = pairs(c);
        return front + between[2] * (pairs(c + slice_) - front);
    }

    Volume<float> smooth_;
    glm::ivec3 origin_{0};
    glm::dmat4 voxelFromPatient_{1.0};
    glm::dmat3 turn_{1.0};  // voxelFromPatient's linear part
    std::size_t row_ = 0, slice_ = 0;
};

}  // namespace haustra::cad
