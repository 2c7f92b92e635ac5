#include "render/object_order/cell_grid.h"

#include <cmath>

namespace haustra::render {

glm::dvec3 CellGrid::low(glm::ivec3 cell) const {
    glm::dvec3 corner(cell * side);
    for (int axis = 0; axis < 3; ++axis)
        if (cell[axis] == 0) corner[axis] = -0.5;
    return corner;
}

glm::dvec3 CellGrid::high(glm::ivec3 cell) const {
    glm::dvec3 corner((cell + 1) * side);
    for (int axis = 0; axis < 3; ++axis)
        if (cell[axis] == count()[axis] - 1) corner[axis] = voxels[axis] - 0.5;
    return corner;
}

glm::ivec3 sourceCell(const CellGrid& cells, const Camera& camera, const Grid& grid) {
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::ivec3 last = cells.count() - 1;
    glm::ivec3 source(0);
    if (camera.lens == Lens::orthographic) {
        const glm::dvec3 along(voxelFromPatient * glm::dvec4(camera.forward, 0.0));
        for (int axis = 0; axis < 3; ++axis)
            source[axis] = along[axis] < 0.0 ? last[axis] : 0;
        return source;
    }
    const glm::dvec3 eye(voxelFromPatient * glm::dvec4(camera.positionMm, 1.0));
    // In the shader's precision, for an eye that is on a face.
    for (int axis = 0; axis < 3; ++axis)
        source[axis] =
            int(std::clamp(std::floor(float(eye[axis] / cells.side)), 0.0f, float(last[axis])));
    return source;
}

}  // namespace haustra::render
