// A scan at a chosen scale, with its derivatives at any place.
#pragma once

#include "core/volume.h"

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
    /// HU/mm: that of derivatives alone, by differences of linear().
    glm::dvec3 gradient(glm::dvec3 patientMm) const;

    /// Of a place in voxels of grid(): linear between the smoothed voxels, clamped at the outermost
    /// ones. For long rays; without the spline's own share of the smoothing.
    float linear(glm::vec3 voxel) const {
        const glm::vec3 most(smooth_.grid().size - 1);
        return linearWithin(glm::clamp(voxel, glm::vec3(0.0f), most - glm::vec3(1e-3f)));
    }
    /// The same of a place that is known to lie within it.
    float linearWithin(glm::vec3 voxel) const {
        const glm::ivec3 low(voxel);
        const glm::vec3 f = voxel - glm::vec3(low);
        const float* c = smooth_.voxels().data() + std::size_t(low.z) * slice_ +
                         std::size_t(low.y) * row_ + std::size_t(low.x);
        const auto along = [&](const float* at) { return at[0] + f.x * (at[1] - at[0]); };
        const auto plane = [&](const float* at) {
            const float near = along(at);
            return near + f.y * (along(at + row_) - near);
        };
        const float near = plane(c);
        return near + f.z * (plane(c + slice_) - near);
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
    Volume<float> smooth_;
    glm::ivec3 origin_{0};
    glm::dmat4 voxelFromPatient_{1.0};
    glm::dmat3 turn_{1.0};  // voxelFromPatient's linear part
    std::size_t row_ = 0, slice_ = 0;
};

}  // namespace haustra::cad
