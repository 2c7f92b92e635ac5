// Where voxels are: the size of a volume and its place in the patient.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include <glm/glm.hpp>

namespace haustra {

/// A regular grid of voxels in patient space (DICOM LPS, millimetres). Voxel (i, j, k) has its
/// centre at patientFromVoxel · (i, j, k, 1). i runs fastest in memory.
struct Grid {
    glm::ivec3 size{0};
    glm::dmat4 patientFromVoxel{1.0};

    std::size_t voxelCount() const {
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    }
    std::size_t index(int i, int j, int k) const {
        return std::size_t(i) +
               std::size_t(size.x) * (std::size_t(j) + std::size_t(size.y) * std::size_t(k));
    }
    std::size_t index(glm::ivec3 v) const { return index(v.x, v.y, v.z); }
    glm::ivec3 voxelAt(std::size_t index) const {
        const std::size_t row = index / std::size_t(size.x);
        return {int(index % std::size_t(size.x)), int(row % std::size_t(size.y)),
                int(row / std::size_t(size.y))};
    }
    bool contains(glm::ivec3 v) const {
        return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z;
    }

    /// Distances between neighbouring voxel centres along i, j and k, mm.
    glm::dvec3 spacingMm() const;
    double voxelVolumeMm3() const;
    /// To within 0.06 degrees.
    bool hasRightAngles() const;
    /// Patient point (mm) of a voxel coordinate; fractions lie between centres.
    glm::dvec3 patientFromVoxelPoint(glm::dvec3 voxel) const {
        return glm::dvec3(patientFromVoxel * glm::dvec4(voxel, 1.0));
    }
    /// The inverse affine. Compute it once outside loops.
    glm::dmat4 voxelFromPatient() const { return glm::inverse(patientFromVoxel); }
    glm::dvec3 voxelFromPatientPoint(glm::dvec3 patientMm) const {
        return glm::dvec3(voxelFromPatient() * glm::dvec4(patientMm, 1.0));
    }
};

/// Calls visit(neighbour's index, axis) for each of the at most six voxels that share a face with
/// `voxel`, which has this index; the lower one first, along i, j, k.
template <class Visit>
void visitFaces(const Grid& grid, std::size_t index, glm::ivec3 voxel, const Visit& visit) {
    const std::size_t strides[3] = {1, std::size_t(grid.size.x),
                                    std::size_t(grid.size.x) * std::size_t(grid.size.y)};
    for (int axis = 0; axis < 3; ++axis) {
        if (voxel[axis] > 0) visit(index - strides[axis], axis);
        if (voxel[axis] + 1 < grid.size[axis]) visit(index + strides[axis], axis);
    }
}

/// The same for the voxel of this index.
template <class Visit>
void visitFaces(const Grid& grid, std::size_t index, const Visit& visit) {
    visitFaces(grid, index, grid.voxelAt(index), visit);
}

/// Step `n` (0…26, in memory order) from a voxel to those around it that share at least a corner;
/// number 13 is the voxel itself.
constexpr glm::ivec3 cornerStep(int n) {
    return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
}

/// Calls visit(neighbour's index) for each of the at most 26 voxels that share at least a corner
/// with the voxel of this index, in memory order.
template <class Visit>
void visitCorners(const Grid& grid, std::size_t index, const Visit& visit) {
    const glm::ivec3 voxel = grid.voxelAt(index);
    for (int n = 0; n < 27; ++n) {
        const glm::ivec3 neighbour = voxel + cornerStep(n);
        if (n != 13 && grid.contains(neighbour)) visit(grid.index(neighbour));
    }
}

/// Axis-aligned grid: spacing in mm, centre of voxel (0,0,0) at originMm.
Grid axisAlignedGrid(glm::ivec3 size, glm::dvec3 spacingMm, glm::dvec3 originMm = glm::dvec3(0.0));

/// Same size and the same affine to within 1e-4 mm at the farthest corner.
bool sameGrid(const Grid& a, const Grid& b);

/// Longest side and most voxels of a grid that is read: what a file format can say, and far more
/// than a disk holds. Whoever allocates first makes sure that the file is large enough.
inline constexpr int maxGridSide = 32767;
inline constexpr std::size_t maxGridVoxels = std::size_t(1) << 36;

/// Fails unless every extent is 1…maxGridSide, there are at most maxGridVoxels, and the affine is
/// finite and invertible with an affine last row. Everything that reads a grid from a file calls
/// this.
Result<void> checkGrid(const Grid& grid, const std::string& place);

/// Which way is down: the patient's position on the table (DICOM Patient Position).
enum class PatientPosition { unknown, supine, prone, leftDecubitus, rightDecubitus };

/// Unit vector along gravity in LPS: supine +y (posterior), prone −y, lying on the left side +x,
/// on the right −x. Zero where the position is unknown.
glm::dvec3 gravityDirection(PatientPosition position);

const char* toString(PatientPosition position);
PatientPosition patientPositionFromString(const std::string& text);

}  // namespace haustra
