#include "surface/triangle_grid.h"

namespace haustra::surface {

TriangleGrid::TriangleGrid(const glm::vec3& low, const glm::vec3& high, float cellMm) : low_(low) {
    const glm::vec3 extent = glm::max(high - low, glm::vec3(cellMm));
    while (extent.x / cellMm * (extent.y / cellMm) * (extent.z / cellMm) > float(1 << 22))
        cellMm *= 1.25f;
    cellsPerMm_ = 1.0f / cellMm;
    size_ = glm::ivec3(extent * cellsPerMm_) + 1;
    first_.assign(std::size_t(size_.x) * size_.y * size_.z, -1);
}

glm::ivec3 TriangleGrid::cellOf(const glm::vec3& point) const {
    const glm::vec3 place = (point - low_) * cellsPerMm_;
    return glm::ivec3(glm::clamp(place, glm::vec3(0.0f), glm::vec3(size_ - 1)));
}

void TriangleGrid::insert(int triangle, const FloatBox& box) {
    forEachCell(box, [&](int cell) {
        int entry = free_;
        if (entry >= 0) {
            free_ = entries_[entry].next;
        } else {
            entry = int(entries_.size());
            entries_.emplace_back();
        }
        entries_[entry] = {triangle, first_[cell], box};
        first_[cell] = entry;
    });
}

void TriangleGrid::remove(int triangle, const FloatBox& box) {
    forEachCell(box, [&](int cell) {
        int* link = &first_[cell];
        while (entries_[*link].triangle != triangle)
            link = &entries_[*link].next;
        const int entry = *link;
        *link = entries_[entry].next;
        entries_[entry].next = free_;
        free_ = entry;
    });
}

}  // namespace haustra::surface
