// Which triangles may touch a box.
#pragma once

#include "core/voxel_sweep.h"

#include <vector>

#include <glm/glm.hpp>

namespace haustra::simplification {

/// A box in single precision that surely holds what it was made around.
struct FloatBox {
    glm::vec3 low, high;

    static FloatBox around(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        constexpr float roundingMm = 1e-4f;  // far above single precision's within half a metre
        return {glm::vec3(glm::min(a, glm::min(b, c))) - roundingMm,
                glm::vec3(glm::max(a, glm::max(b, c))) + roundingMm};
    }
    void add(const FloatBox& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    bool touches(const FloatBox& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y && low.z <= other.high.z && other.low.z <= high.z;
    }
};

/// Triangles by the cells of a uniform grid that their boxes touch. What lies outside the grid's
/// box counts to the cells at its border. Of one thread.
class TriangleGrid {
public:
    /// The cell grows where there would be over 2²² of them.
    TriangleGrid(const glm::vec3& low, const glm::vec3& high, float cellMm);

    void insert(int triangle, const FloatBox& box);
    /// `box` as it was inserted.
    void remove(int triangle, const FloatBox& box);

    /// Calls visit(triangle, its box) once for each triangle whose box touches `box`.
    template <class Visit>
    void visit(const FloatBox& box, const Visit& visit) const {
        const glm::ivec3 low = cellOf(box.low), high = cellOf(box.high);
        visitBox(low, high, [&](glm::ivec3 c) {
            // Told in the first of the cells that both boxes touch.
            for (const Entry& entry : cells_[indexOf(c)]) {
                if (entry.box.touches(box) && glm::max(low, cellOf(entry.box.low)) == c)
                    visit(entry.triangle, entry.box);
            }
        });
    }

private:
    struct Entry {
        int triangle;
        FloatBox box;
    };

    template <class Visit>
    void forEachCell(const FloatBox& box, const Visit& visit) const {
        const glm::ivec3 low = cellOf(box.low), high = cellOf(box.high);
        visitBox(low, high, [&](glm::ivec3 cell) { visit(indexOf(cell)); });
    }
    glm::ivec3 cellOf(const glm::vec3& point) const {
        const glm::vec3 place = (point - low_) * cellsPerMm_;
        return glm::ivec3(glm::clamp(place, glm::vec3(0.0f), glm::vec3(size_ - 1)));
    }
    int indexOf(const glm::ivec3& cell) const {
        return (cell.z * size_.y + cell.y) * size_.x + cell.x;
    }

    glm::vec3 low_;
    float cellsPerMm_;
    glm::ivec3 size_;
    std::vector<std::vector<Entry>> cells_;
};

}  // namespace haustra::simplification
