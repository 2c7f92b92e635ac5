#include "core/grid.h"

#include <cmath>

namespace haustra {

glm::dvec3 Grid::spacingMm() const {
    return {glm::length(glm::dvec3(patientFromVoxel[0])),
            glm::length(glm::dvec3(patientFromVoxel[1])),
            glm::length(glm::dvec3(patientFromVoxel[2]))};
}

double Grid::voxelVolumeMm3() const {
    return std::abs(glm::determinant(glm::dmat3(patientFromVoxel)));
}

Grid axisAlignedGrid(glm::ivec3 size, glm::dvec3 spacingMm, glm::dvec3 originMm) {
    Grid grid;
    grid.size = size;
    grid.patientFromVoxel = glm::dmat4(1.0);
    for (int axis = 0; axis < 3; ++axis)
        grid.patientFromVoxel[axis][axis] = spacingMm[axis];
    grid.patientFromVoxel[3] = glm::dvec4(originMm, 1.0);
    return grid;
}

bool sameGrid(const Grid& a, const Grid& b) {
    if (a.size != b.size) return false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 v((corner & 1) ? a.size.x : 0, (corner & 2) ? a.size.y : 0,
                           (corner & 4) ? a.size.z : 0);
        if (!(glm::distance(a.patientFromVoxelPoint(v), b.patientFromVoxelPoint(v)) <= 1e-4))
            return false;
    }
    return true;
}

bool Grid::hasRightAngles() const {
    const glm::dmat3 axes(patientFromVoxel);
    for (int a = 0; a < 3; ++a) {
        const glm::dvec3 u = glm::normalize(axes[a]), v = glm::normalize(axes[(a + 1) % 3]);
        if (!(std::abs(glm::dot(u, v)) <= 1e-3)) return false;
    }
    return true;
}

Result<void> checkGrid(const Grid& grid, const std::string& place) {
    for (int axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] < 1 || grid.size[axis] > maxGridSide) {
            return fail(ErrorKind::badInput,
                        "the volume has " + std::to_string(grid.size[axis]) +
                            " voxels along axis " + std::to_string(axis) + "; 1 to " +
                            std::to_string(maxGridSide) + " are read",
                        place);
        }
    }
    if (grid.voxelCount() > maxGridVoxels) {
        return fail(ErrorKind::badInput, "the volume has more than 2^36 voxels", place);
    }
    const glm::dmat4& m = grid.patientFromVoxel;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) {
                return fail(ErrorKind::badInput, "the voxel-to-patient matrix is not finite",
                            place);
            }
        }
    }
    if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0) {
        return fail(ErrorKind::badInput, "the voxel-to-patient matrix is not affine", place);
    }
    const glm::dvec3 spacing = grid.spacingMm();
    const double product = spacing.x * spacing.y * spacing.z;
    if (!(product > 0.0) || !(grid.voxelVolumeMm3() > 1e-6 * product)) {
        return fail(ErrorKind::badInput, "the voxel-to-patient matrix is singular", place);
    }
    return {};
}

glm::dvec3 gravityDirection(PatientPosition position) {
    switch (position) {
        case PatientPosition::supine:
            return {0, 1, 0};
        case PatientPosition::prone:
            return {0, -1, 0};
        case PatientPosition::leftDecubitus:
            return {1, 0, 0};
        case PatientPosition::rightDecubitus:
            return {-1, 0, 0};
        case PatientPosition::unknown:
            break;
    }
    return glm::dvec3(0.0);
}

const char* toString(PatientPosition position) {
    switch (position) {
        case PatientPosition::supine:
            return "supine";
        case PatientPosition::prone:
            return "prone";
        case PatientPosition::leftDecubitus:
            return "left-decubitus";
        case PatientPosition::rightDecubitus:
            return "right-decubitus";
        case PatientPosition::unknown:
            break;
    }
    return "unknown";
}

PatientPosition patientPositionFromString(const std::string& text) {
    for (PatientPosition p : {PatientPosition::supine, PatientPosition::prone,
                              PatientPosition::leftDecubitus, PatientPosition::rightDecubitus}) {
        if (text == toString(p)) return p;
    }
    return PatientPosition::unknown;
}

}  // namespace haustra
