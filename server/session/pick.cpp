#include "session/pick.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {

std::optional<MetTriangle> firstMet(const TriMesh& mesh, const PickRay& ray) {
    const glm::dvec3 along = glm::normalize(ray.direction);
    std::optional<MetTriangle> met;
    double nearest = INFINITY;
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
        const glm::ivec3 t = mesh.triangles[n];
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        const glm::dvec3 ab = mesh.vertices[std::size_t(t.y)] - a,
                         ac = mesh.vertices[std::size_t(t.z)] - a;
        const glm::dvec3 p = glm::cross(along, ac);
        const double volume = glm::dot(ab, p);
        if (volume == 0.0) continue;  // along the triangle's plane
        const glm::dvec3 from = ray.fromMm - a;
        const double u = glm::dot(from, p) / volume;
        if (!(u >= 0.0 && u <= 1.0)) continue;
        const glm::dvec3 q = glm::cross(from, ab);
        const double v = glm::dot(along, q) / volume;
        if (!(v >= 0.0 && u + v <= 1.0)) continue;
        const double way = glm::dot(ac, q) / volume;
        if (!(way >= 0.0 && way < nearest)) continue;
        nearest = way;
        met = MetTriangle{int(n), ray.fromMm + way * along};
    }
    return met;
}

std::optional<glm::dvec3> firstTissue(const Volume<std::int16_t>& scan, const PickRay& ray) {
    const Grid& grid = scan.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = 0.5 * std::min(spacing.x, std::min(spacing.y, spacing.z));
    const glm::dvec3 along = glm::normalize(ray.direction);
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 from(voxelFromPatient * glm::dvec4(ray.fromMm, 1.0)),
        perMm(voxelFromPatient * glm::dvec4(along, 0.0));
    // The ray's stretch between the outermost voxels' faces.
    double enter = 0.0, leave = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = -0.5 - from[axis], high = grid.size[axis] - 0.5 - from[axis];
        if (perMm[axis] == 0.0) {
            if (low > 0.0 || high < 0.0) return std::nullopt;
            continue;
        }
        enter = std::max(enter, std::min(low / perMm[axis], high / perMm[axis]));
        leave = std::min(leave, std::max(low / perMm[axis], high / perMm[axis]));
    }
    const auto valueAt = [&](double way) { return trilinear(scan, from + way * perMm); };
    double before = enter, beforeHu = 0.0;
    for (double way = enter; way <= leave; way += stepMm) {
        const double hu = valueAt(way);
        if (hu >= wallHu) {
            if (way > enter) way = before + (way - before) * (wallHu - beforeHu) / (hu - beforeHu);
            return ray.fromMm + way * along;
        }
        before = way, beforeHu = hu;
    }
    return std::nullopt;
}

}  // namespace haustra::session
