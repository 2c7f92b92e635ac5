#include "handles/self_intersection.h"

#include <algorithm>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

namespace haustra::handles {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;

/// Two triangles with the corners they share moved to the front of both.
struct TrianglePair {
    glm::ivec3 a, b;
    int shared = 0;

    TrianglePair(glm::ivec3 first, glm::ivec3 second) : a(first), b(second) {
        for (int i = 0; i < 3; ++i) {
            for (int j = shared; j < 3; ++j) {
                if (a[i] != b[j]) continue;
                std::swap(a[i], a[shared]);
                std::swap(b[j], b[shared]);
                ++shared;
                break;
            }
        }
    }
};

class ExactTests {
public:
    explicit ExactTests(const TriMesh& mesh) {
        points_.reserve(mesh.vertices.size());
        for (const glm::dvec3& v : mesh.vertices)
            points_.emplace_back(v.x, v.y, v.z);
    }

    CGAL::Bbox_3 box(glm::ivec3 t) const { return triangle(t).bbox(); }
    bool degenerate(glm::ivec3 t) const {
        return CGAL::collinear(points_[t.x], points_[t.y], points_[t.z]);
    }
    bool intersect(glm::ivec3 first, glm::ivec3 second) const {
        const auto [a, b, shared] = TrianglePair(first, second);
        switch (shared) {
            case 0:
                return CGAL::do_intersect(triangle(a), triangle(b));
            case 1:
                return CGAL::do_intersect(triangle(a), oppositeSide(b)) ||
                       CGAL::do_intersect(triangle(b), oppositeSide(a));
            case 2:
                return foldedOver(a, b);
            default:
                return true;
        }
    }

private:
    Kernel::Triangle_3 triangle(glm::ivec3 t) const {
        return {points_[t.x], points_[t.y], points_[t.z]};
    }
    Kernel::Segment_3 oppositeSide(glm::ivec3 t) const { return {points_[t.y], points_[t.z]}; }
    /// Whether triangles on a common side x–y lie over each other in one plane.
    bool foldedOver(glm::ivec3 a, glm::ivec3 b) const {
        return CGAL::coplanar(points_[a.x], points_[a.y], points_[a.z], points_[b.z]) &&
               CGAL::coplanar_orientation(points_[a.x], points_[a.y], points_[a.z], points_[b.z]) ==
                   CGAL::POSITIVE;
    }

    std::vector<Kernel::Point_3> points_;
};

}  // namespace

std::vector<std::pair<int, int>> selfIntersections(const TriMesh& mesh) {
    const ExactTests tests(mesh);
    std::vector<std::pair<int, int>> pairs;
    std::vector<Box> boxes;
    boxes.reserve(mesh.triangles.size());
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
        if (tests.degenerate(mesh.triangles[n])) {
            pairs.emplace_back(int(n), int(n));
        } else {
            boxes.emplace_back(tests.box(mesh.triangles[n]), int(n));
        }
    }
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
        if (tests.intersect(mesh.triangles[std::size_t(a.info())],
                            mesh.triangles[std::size_t(b.info())]))
            pairs.emplace_back(std::minmax(a.info(), b.info()));
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace haustra::handles
