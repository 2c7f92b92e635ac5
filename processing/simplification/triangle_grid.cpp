#include "simplification/triangle_grid.h"

namespace haustra::simplification {

TriangleGrid::TriangleGrid(const glm::vec3& low, const glm::vec3& high, float cellMm) : low_(low) {
    const glm::vec3 extent = glm::max(high - low, glm::vec3(cellMm));
    while (extent.x / cellMm * (extent.y / cellMm) * (extent.z / cellMm) > float(1 << 22))
        cellMm *= 1.25f;
    cellsPerMm_ = 1.0f / cellMm;
    size_ = glm::ivec3(extent * cellsPerMm_) + 1;
    cells_.resize(std::size_t(size_.x) * size_.y * size_.z);
}

void TriangleGrid::insert(int triangle, const FloatBox& box) {
    forEachCell(box, [&](int cell) { cells_[cell].push_back({triangle, box}); });
}

void TriangleGrid::remove(int triangle, const FloatBox& box) {
    forEachCell(box, [&](int cell) {
        std::vector<Entry>& entries = cells_[cell];
        std::size_t i = 0;
        while (entries[i].triangle != triangle)
            ++i;
        entries[i] = entries.back();
        entries.pop_back();
    });
}

}  // namespace haustra::simplification
