// Which triangles meet at a vertex.
#pragma once

#include "core/tri_mesh.h"

#include <vector>

namespace haustra::flatten {

/// The triangles around each vertex, as 3·triangle + corner.
class VertexStars {
public:
    explicit VertexStars(const TriMesh& tube) : first_(tube.vertices.size() + 1, 0) {
        for (const glm::ivec3& t : tube.triangles) {
            for (int c = 0; c < 3; ++c)
                ++first_[std::size_t(t[c]) + 1];
        }
        for (std::size_t v = 1; v < first_.size(); ++v)
            first_[v] += first_[v - 1];
        corners_.resize(tube.triangles.size() * 3);
        std::vector<int> next(first_.begin(), first_.end() - 1);
        for (std::size_t n = 0; n < corners_.size(); ++n)
            corners_[std::size_t(next[std::size_t(tube.triangles[n / 3][int(n % 3)])]++)] = int(n);
    }
    struct Range {
        const int *first, *last;
        const int* begin() const { return first; }
        const int* end() const { return last; }
    };
    Range of(int v) const {
        return {corners_.data() + first_[std::size_t(v)],
                corners_.data() + first_[std::size_t(v) + 1]};
    }

private:
    std::vector<int> first_, corners_;
};

}  // namespace haustra::flatten
